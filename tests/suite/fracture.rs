//! Fracture against what a law of fracture promises: strength, energy and place of a crack, whatever the grid.

use brisance::gpu::{Gpu, readback};
use brisance::scene::Scene;
use brisance::simulation::Simulation;

use crate::common::gpu_or_skip;

/// Tensile strength over Young's modulus, which is 1.
const STRENGTH: f64 = 1e-3;
/// Strength of the weak part in the middle over that of the rest.
const WEAK: f64 = 0.95;
/// Width of the bar over its length, which is 1.
const WIDTH: f64 = 0.2;

/// A bar of unit length between two grips that part.
#[derive(Clone, Copy)]
struct Bar {
    dimension: usize,
    /// Cells along the bar.
    cells: u32,
    per_axis: u32,
    degrees: f64,
    strength: f64,
    /// Young's modulus times the fracture energy over the square of the strength: a length.
    brittleness: f64,
    transits: f64,
    /// Whether the grips come back as far again beyond where they were, after these transits.
    returns: bool,
    more: &'static str,
}

/// Along a line of cells.
const LINE: Bar = Bar {
    dimension: 1,
    cells: 20,
    per_axis: 4,
    degrees: 0.0,
    strength: STRENGTH,
    brittleness: 1.0,
    transits: 40.0,
    returns: false,
    more: "",
};

/// What a bar was seen to do: work of the grips and energy of cracks over fracture energy times section, largest stress over the strength of
/// the weak part, stress left at the end over the strength.
#[derive(Debug)]
struct Pulled {
    work: f64,
    cracks: f64,
    peak: f64,
    left: f64,
}

impl Bar {
    fn energy(&self) -> f64 {
        self.brittleness * self.strength * self.strength
    }

    /// By how much the grips part: what opens the crack wholly, 2 G / f, and the strain of a bar that is about to break.
    fn parting(&self) -> f64 {
        1.15 * 2.0 * self.energy() / self.strength + 0.2 * self.strength
    }

    fn section(&self) -> f64 {
        if self.dimension > 1 { WIDTH } else { 1.0 }
    }

    /// How a grip moves.
    fn grip(&self, sign: f64) -> String {
        let (sine, cosine) = self.degrees.to_radians().sin_cos();
        let speed = sign * 0.5 * self.parting() / self.transits;
        let all = [speed * cosine, speed * sine, 0.0];
        let (out, back) = (&all[..self.dimension], &all.map(|v| -v)[..self.dimension]);
        if !self.returns {
            return format!("motion = {{ velocity = {out:?} }}");
        }
        let turn = |share: f64| share * self.transits;
        format!(
            "motion = {{ table = [{{ time = {:?}, velocity = {out:?} }}, {{ time = {:?}, velocity = {back:?} }}] }}",
            turn(0.99),
            turn(1.01)
        )
    }

    fn scene(&self) -> Scene {
        let count = self.cells / 2 * 3 + 8;
        let across = if self.degrees == 0.0 { (WIDTH * f64::from(self.cells)) as u32 + 8 } else { count };
        let all = [count, across, across];
        let edge = 1.0 / f64::from(self.cells);
        let (size, axes) = (all.map(|n| f64::from(n) * edge), self.dimension);
        let middle: Vec<f64> = size[..axes].iter().map(|s| 0.5 * s).collect();
        let (sine, cosine) = self.degrees.to_radians().sin_cos();
        let body = |name: &str, material: &str, from: f64, to: f64, rest: &str| {
            let box_size = [to - from, WIDTH, WIDTH];
            let half = 0.5 * (from + to);
            let place = [middle[0] + half * cosine, middle.get(1).map_or(0.0, |y| y + half * sine)];
            let center: Vec<f64> = (0..axes).map(|a| if a < 2 { place[a] } else { middle[a] }).collect();
            let bare = format!("{{ box = {{ center = {center:?}, size = {:?} }} }}", &box_size[..axes]);
            let shape = match self.degrees {
                0.0 => bare,
                angle => format!("{{ rotate = {{ shape = {bare}, degrees = {angle:?}, about = {center:?} }} }}"),
            };
            format!(
                "[[bodies]]\nname = \"{name}\"\nmaterial = \"{material}\"\ndensity = 1.0\nshape = {shape}\n\
                 particles_per_cell = {}\n{rest}\n",
                self.per_axis
            )
        };
        let material = |name: &str, share: f64| {
            format!(
                "[materials.{name}]\nneo_hookean = {{ young_modulus = 1.0, poisson_ratio = 0.2 }}\n\
                 fracture = {{ tensile_strength = {:?}, fracture_energy = {:?} }}\n",
                share * self.strength,
                self.energy()
            )
        };
        let text = format!(
            "title = \"bar\"\n[domain]\ndimension = {axes}\ncells = {:?}\nsize = {:?}\n\
             [gas]\nambient = {{ density = 1e-6, pressure = 1e-10 }}\n[time]\nuntil = {:?}\n[numerics]\n{}\n{}",
            &all[..axes],
            &size[..axes],
            if self.returns { 3.0 } else { 1.0 } * self.transits,
            self.more,
            [
                material("strong", 1.0),
                material("weak", WEAK),
                material("ends", 2.0),
                body("left", "strong", -0.5 - 4.0 * edge, -0.5, &self.grip(-1.0)),
                body("right", "strong", 0.5, 0.5 + 4.0 * edge, &self.grip(1.0)),
                body("weak", "weak", -2.0 * edge, 2.0 * edge, ""),
                body("first", "strong", -0.25, -2.0 * edge, ""),
                body("second", "strong", 2.0 * edge, 0.25, ""),
                body("first end", "ends", -0.5, -0.25, ""),
                body("second end", "ends", 0.25, 0.5, ""),
            ]
            .concat(),
        );
        Scene::parse(&text, "bar.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
    }

    fn pull(&self, gpu: &Gpu) -> Pulled {
        const PARTS: u32 = 150;
        let scene = self.scene();
        let mut simulation = Simulation::new(gpu, &scene).unwrap_or_else(|error| panic!("{error}"));
        let (mut work, mut peak, mut stress, mut cracks) = (0.0, 0.0_f64, 0.0, 0.0);
        // stress of a time in which a wave runs along the bar
        let mut recent = vec![0.0; (f64::from(PARTS) / self.transits).ceil() as usize];
        for part in 0..PARTS {
            let time = self.transits * f64::from(part + 1) / f64::from(PARTS);
            let records = simulation.advance_to(time).unwrap_or_else(|error| panic!("{error}"));
            cracks = records.last().map_or(cracks, |record| f64::from(record.fracture_energy));
            stress = self.stress(gpu, &simulation);
            work += stress * self.section() * self.parting() / f64::from(PARTS);
            let length = recent.len();
            recent[part as usize % length] = stress;
            peak = peak.max(recent.iter().sum::<f64>() / length as f64);
        }
        let whole = self.energy() * self.section();
        let found = Pulled {
            work: work / whole,
            cracks: cracks / whole,
            peak: peak / (WEAK * self.strength),
            left: stress / self.strength,
        };
        eprintln!(
            "{}D {} cells, {} degrees, strength {:e}, {}: {found:?}",
            self.dimension, self.cells, self.degrees, self.strength, self.more
        );
        found
    }

    /// Mean stress along the bar where it is twice as strong, two cells and more from the grips: what holds the nodes there concentrates
    /// stress.
    fn stress(&self, gpu: &Gpu, simulation: &Simulation) -> f64 {
        let all = &simulation.state.particles;
        let get = |buffer| readback::read(gpu, buffer).expect("a device");
        let (position, velocity, affine) = (get(&all.position), get(&all.velocity), get(&all.affine));
        let (stress, deformation) = (get(&all.stress), get(&all.deformation));
        let (sine, cosine) = self.degrees.to_radians().sin_cos();
        let (size, spacing) = (self.scene().domain.size, self.scene().domain.spacing());
        let along_bar = |p: usize| {
            let [x, y] = [0, 1].map(|axis| f64::from(position[p][axis]) - 0.5 * size[axis]);
            cosine * x + if self.dimension > 1 { sine * y } else { 0.0 }
        };
        let (mut sum, mut volume) = (0.0, 0.0);
        for p in 0..all.count as usize {
            let body = deformation[3 * p][3].to_bits();
            if body < 5 || along_bar(p).abs() > 0.5 - 2.0 * spacing {
                continue;
            }
            let [xx, yy] = [0, 1].map(|axis| f64::from(stress[2 * p][axis]));
            let along = cosine * cosine * xx + 2.0 * cosine * sine * f64::from(stress[2 * p + 1][0]) + sine * sine * yy;
            let own = f64::from(velocity[p][3]);
            sum += along - own * f64::from(affine[3 * p][3]);
            volume += own;
        }
        sum / volume
    }
}

/// What holds for a pull of forty times a wave's way along the bar: the strength, the energy of the crack, the work of the grips, and that
/// nothing is borne in the end.
fn assert_bar(found: &Pulled) {
    assert!((0.95..1.05).contains(&found.peak), "strength {}", found.peak);
    assert!((0.78..1.02).contains(&found.cracks), "energy of cracks {}", found.cracks);
    assert!((0.94..1.10).contains(&found.work), "work {}", found.work);
    assert!(found.left.abs() < 0.03, "left {}", found.left);
}

#[test]
fn a_bar_breaks_at_its_strength_and_takes_its_energy() {
    let Some(gpu) = gpu_or_skip() else { return };
    assert_bar(&LINE.pull(&gpu));
    assert_bar(&Bar { more: "expert.transfer = \"nodes\"", ..LINE }.pull(&gpu));
}

/// Pulled until it is broken, and pressed together again: it bears nothing until the crack is closed, and then pressure as before.
#[test]
fn a_closed_crack_bears_pressure_again() {
    let Some(gpu) = gpu_or_skip() else { return };
    let bar = Bar { returns: true, ..LINE };
    let mut simulation = Simulation::new(&gpu, &bar.scene()).unwrap_or_else(|error| panic!("{error}"));
    let speed = bar.parting() / bar.transits;
    let mut stress_at = |elongation: f64| {
        let back = 2.0 * bar.transits - elongation / speed;
        let _ = simulation.advance_to(back).unwrap_or_else(|error| panic!("{error}"));
        bar.stress(&gpu, &simulation) / STRENGTH
    };
    let open = [2.0e-3, 1.5e-3, 1.0e-3, 0.5e-3, 0.0].map(&mut stress_at);
    let [low, high] = [-1.0e-3, -2.0e-3].map(&mut stress_at);
    // lambda + 2 mu over Young's modulus of the whole bar
    let stiffness = (low - high) * STRENGTH / 1.0e-3 / (0.8 / (1.2 * 0.6));
    eprintln!("stress while it closes {open:?}, pressed {low} and {high}, stiffness {stiffness}");
    assert!(open.iter().all(|stress| stress.abs() < 0.1), "stress over strength of an open crack: {open:?}");
    assert!((0.6..0.9).contains(&stiffness), "stiffness over that of the whole bar: {stiffness}");
}

/// Strains of 1e-5 in all.
#[test]
fn a_stiff_bar_breaks_likewise() {
    let Some(gpu) = gpu_or_skip() else { return };
    assert_bar(&Bar { strength: 1e-5, ..LINE }.pull(&gpu));
}

/// Aslant to the grid the crack is the same.
#[test]
fn a_bar_aslant_breaks_likewise() {
    let Some(gpu) = gpu_or_skip() else { return };
    let found = Bar { dimension: 2, per_axis: 2, degrees: 30.0, ..LINE }.pull(&gpu);
    assert_bar(&found);
}

/// Pressed to several times its strength, across the whole domain so that it cannot spread, and pulled below it beside a weaker body that
/// bears less than its own.
#[test]
fn what_is_pressed_or_bears_its_load_has_no_damage() {
    let Some(gpu) = gpu_or_skip() else { return };
    let damage = |velocity: [f64; 2], strength: [f64; 2]| {
        let material = |name: &str, strength: f64| {
            format!(
                "[materials.{name}]\nhencky = {{ young_modulus = 1.0, poisson_ratio = 0.2, yield_stress = 1e3 }}\n\
                 fracture = {{ tensile_strength = {strength:?}, fracture_energy = 1e-6 }}\n"
            )
        };
        let body = |name: &str, from: f64, to: f64, rest: &str| {
            format!(
                "[[bodies]]\nname = \"{name}\"\nmaterial = \"{name}\"\ndensity = 1.0\n{rest}\n\
                 shape = {{ box = {{ center = [{:?}], size = [{:?}] }} }}\n",
                0.5 * (from + to),
                to - from
            )
        };
        let speed = |v: f64| format!("velocity = [{v:?}]");
        let text = format!(
            "title = \"t\"\n[domain]\ndimension = 1\ncells = [60]\nsize = [3.0]\n\
             [gas]\nambient = {{ density = 1e-6, pressure = 1e-10 }}\n[time]\nuntil = 0.4\n{}{}{}{}",
            material("a", strength[0]),
            material("b", strength[1]),
            body("a", 1.0, 1.5, &speed(velocity[0])),
            body("b", 1.5, 2.0, &speed(velocity[1])),
        );
        let scene = Scene::parse(&text, "t.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
        let mut simulation = Simulation::new(&gpu, &scene).unwrap_or_else(|error| panic!("{error}"));
        simulation.advance_to(scene.time.until).unwrap_or_else(|error| panic!("{error}"));
        let snapshot = simulation.snapshot().expect("a device");
        snapshot.particles.iter().map(|particle| particle.damage).fold(0.0, f32::max)
    };
    // stress of the waves: half of the difference of velocities times density times speed of sound, 1.054
    assert!(damage([0.01, -0.01], [1e-3, 1e-3]) == 0.0, "pressed to ten times the strength");
    assert!(damage([-4e-4, 4e-4], [1e-3, 6e-4]) == 0.0, "pulled to 0.4 and 0.7 of the strengths");
    assert!(damage([-2e-3, 2e-3], [1e-3, 1e-3]) > 0.0, "pulled to twice the strength");
}

/// A disc of each law in a blast, one of which breaks: energies of bodies on the host are together that of the step, from the device.
#[test]
fn elastic_energies_of_bodies_are_those_of_the_step() {
    let Some(gpu) = gpu_or_skip() else { return };
    let laws = [
        ("neo_hookean", "", "\nfracture = { tensile_strength = 0.02, fracture_energy = 1e-4 }"),
        ("von_mises", ", yield_stress = 0.2", ""),
        ("fixed_corotated", "", "\nfracture = { tensile_strength = 0.02, fracture_energy = 1e-4 }"),
        ("hencky", ", yield_stress = 0.3", ""),
        ("drucker_prager", ", cohesion = 0.2", ""),
    ];
    let disc = |(k, (law, more, fracture)): (usize, &(&str, &str, &str))| {
        let height = 0.2 + 0.4 * k as f64;
        format!(
            "[materials.{law}]\n{law} = {{ young_modulus = 20.0, poisson_ratio = 0.3{more} }}{fracture}\n\
             [[bodies]]\nname = \"{law}\"\nmaterial = \"{law}\"\ndensity = 4.0\n\
             shape = {{ sphere = {{ center = [0.6, {height:?}], radius = 0.15 }} }}\n"
        )
    };
    let discs: String = laws.iter().enumerate().map(disc).collect();
    let text = format!(
        "title = \"laws\"\n[domain]\ndimension = 2\ncells = [32, 40]\nsize = [1.6, 2.0]\n\
         [gas]\nambient = {{ density = 1.0, pressure = 1.0 }}\n[[gas.regions]]\ndensity = 4.0\npressure = 8.0\n\
         shape = {{ half_space = {{ point = [0.35, 0.0], normal = [1.0, 0.0] }} }}\n{discs}[time]\nuntil = 0.4\n"
    );
    let scene = Scene::parse(&text, "laws.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(&gpu, &scene).unwrap_or_else(|error| panic!("{error}"));
    let last = simulation.advance_to(0.4).unwrap_or_else(|error| panic!("{error}")).pop().expect("some steps");
    let bodies = simulation.snapshot().unwrap().bodies(laws.len());
    let (energy, right) = (bodies.iter().map(|body| body.elastic_energy).sum::<f64>(), f64::from(last.elastic_energy));
    let cracks = last.fracture_energy;
    println!("{energy} {right}, cracks {cracks}, broken {}", last.broken_mass);
    assert!(bodies.iter().all(|body| body.elastic_energy > 0.0) && cracks > 0.0, "{bodies:?}");
    assert!((energy / right - 1.0).abs() < 1e-5, "{energy}, not {right}");
}
