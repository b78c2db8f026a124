//! How a charge expands into gas at rest: a ball (in 2D a rod along z, in 1D a slab) of explosive that burns from its middle, its
//! products, and the gas around it, as zones that move with them, in double precision.
//! [J. von Neumann, R. D. Richtmyer, J. Appl. Phys. 21 (1950) 232; M. L. Wilkins, UCRL-7322, 1963]

use super::{Explosive, Jwl};

/// Zones of the charge.
const CHARGE_ZONES: usize = 120;
/// Each zone of gas is wider than the one before by this factor, up to the widest.
const GROWTH: f64 = 1.02;
/// Factors of the artificial viscosity: of the square of the velocity's step, and of it times the speed of sound.
const VISCOSITY: [f64; 2] = [2.0, 0.25];
/// Part of the time in which sound crosses a zone.
const COURANT: f64 = 0.35;
/// A zone burns while the detonation crosses this many of them.
const BURN_WIDTH: f64 = 3.0;
/// Zones of gas that the products have pressed thinner than this part of their radius are joined.
const THINNEST: f64 = 1.0 / 300.0;
/// Steps between two looks for thin zones.
const BETWEEN_JOINS: u64 = 16;
/// Heat of the products of TNT that burn on in air \[J kg^-1\], and until when \[s kg^(-1/3)\]: with them the waves of a ball in free air
/// are those of Kingery and Bulmash. It is a fifth of the 10.2e6 that the heat of combustion leaves. `docs/notes/charges.md` has the fit.
const AFTERBURN: f64 = 2.2e6;
const AFTERBURN_TIME: f64 = 1e-3;
/// Overpressure over the pressure of the gas at rest that counts as the front.
const FRONT: f64 = 0.01;

/// A charge and the gas around it.
#[derive(Clone, Copy, Debug)]
pub struct NearField {
    /// Of what it is made.
    pub explosive: &'static Explosive,
    /// Its mass, the whole ball's: \[kg\], in 2D per metre, in 1D per square metre.
    pub mass: f64,
    /// Axes of the scene, 1 to 3.
    pub axes: usize,
    /// Density of the gas \[kg m^-3\].
    pub density: f64,
    /// Pressure of the gas \[Pa\].
    pub pressure: f64,
    /// Ratio of specific heats of the gas.
    pub gamma: f64,
    /// Whether the products burn on in the gas.
    pub afterburn: bool,
}

impl NearField {
    /// Surface of the ball of radius 1: area, circumference, or both faces.
    fn surface(&self) -> f64 {
        [2.0, 2.0 * std::f64::consts::PI, 4.0 * std::f64::consts::PI][self.axes - 1]
    }

    /// Radius of the charge \[m\].
    pub fn radius(&self) -> f64 {
        let axes = self.axes as f64;
        (axes * self.mass / (self.surface() * self.explosive.density)).powf(1.0 / axes)
    }

    /// Heat that burning on has given to the products up to a time \[J kg^-1\].
    pub fn afterburnt(&self, time: f64) -> f64 {
        let heat = AFTERBURN * self.explosive.tnt_equivalent;
        if self.afterburn { heat * (time / self.afterburn_time()).min(1.0) } else { 0.0 }
    }

    /// When that ends \[s\].
    fn afterburn_time(&self) -> f64 {
        AFTERBURN_TIME * self.scale()
    }

    /// Cube root of the mass of the ball that has the radius of the charge \[kg^(1/3)\]: lengths and times grow with it.
    pub fn scale(&self) -> f64 {
        (4.0 / 3.0 * std::f64::consts::PI * self.explosive.density).cbrt() * self.radius()
    }

    /// The start: gas reaches to `reach` \[m\], in zones of at most `width` \[m\].
    pub fn start(&self, reach: f64, width: f64) -> Expansion {
        let radius = self.radius();
        let first = radius / CHARGE_ZONES as f64;
        let mut nodes: Vec<f64> = (0..=CHARGE_ZONES).map(|k| k as f64 * first).collect();
        let mut zone = first;
        while nodes[nodes.len() - 1] < reach {
            nodes.push(nodes[nodes.len() - 1] + zone);
            zone = (zone * GROWTH).min(width.max(first));
        }
        let gas = self.pressure / (self.gamma - 1.0) / self.density;
        let of = |zone: usize| {
            let inside = zone < CHARGE_ZONES;
            if inside { (self.explosive.density, self.explosive.specific_energy()) } else { (self.density, gas) }
        };
        let power = self.axes as i32;
        let volume = |pair: &[f64]| (pair[1].powi(power) - pair[0].powi(power)) / f64::from(power);
        let volumes: Vec<f64> = nodes.windows(2).map(volume).collect();
        let zones = volumes.iter().enumerate().map(|(zone, &volume)| {
            let (density, energy) = of(zone);
            let pressure = if zone < CHARGE_ZONES { 0.0 } else { self.pressure };
            Zone { mass: density * volume, volume, energy, pressure, viscosity: 0.0, sound: 0.0 }
        });
        let zones = zones.collect();
        Expansion { field: *self, time: 0.0, steps: 0, walled: false, velocities: vec![0.0; nodes.len()], nodes, zones }
    }
}

/// One zone, per unit of solid angle.
#[derive(Clone, Copy, Debug)]
struct Zone {
    /// \[kg\]
    mass: f64,
    /// \[m^3\]
    volume: f64,
    /// \[J kg^-1\]
    energy: f64,
    /// \[Pa\]
    pressure: f64,
    /// Artificial viscosity \[Pa\].
    viscosity: f64,
    /// Speed of sound \[m s^-1\].
    sound: f64,
}

/// A charge on its way.
#[derive(Clone, Debug)]
pub struct Expansion {
    field: NearField,
    /// Time since the detonation began \[s\].
    pub time: f64,
    steps: u64,
    /// Whether the outermost node stays.
    walled: bool,
    /// Radii between zones \[m\] and their speeds \[m s^-1\].
    nodes: Vec<f64>,
    velocities: Vec<f64>,
    zones: Vec<Zone>,
}

/// Means over shells of equal thickness around the middle.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Outer radius of the last shell \[m\].
    pub radius: f64,
    /// Density \[kg m^-3\], momentum outward \[kg m^-2 s^-1\], internal energy \[J m^-3\], density of products \[kg m^-3\] and their volume
    /// fraction of each shell.
    pub shells: Vec<[f64; 5]>,
}

impl Expansion {
    /// With a rigid wall in place of the gas beyond the outermost zone.
    #[must_use]
    pub fn with_wall(self) -> Self {
        Self { walled: true, ..self }
    }

    /// Outermost radius \[m\], and the pressure of the zone within \[Pa\].
    pub fn outermost(&self) -> [f64; 2] {
        [self.nodes[self.nodes.len() - 1], self.zones[self.zones.len() - 1].pressure]
    }

    /// One step, at most to a time \[s\].
    pub fn step(&mut self, until: f64) {
        let dt = self.time_step().min(until - self.time);
        let power = self.field.axes as i32 - 1;
        let stress = |zone: &Zone| zone.pressure + zone.viscosity;
        let last = self.nodes.len() - 1;
        for node in 1..=last - usize::from(self.walled) {
            let (inner, outer) = (&self.zones[node - 1], self.zones.get(node));
            let push = stress(inner) - outer.map_or(self.field.pressure, stress);
            let mass = 0.5 * (inner.mass + outer.map_or(inner.mass, |zone| zone.mass));
            self.velocities[node] += dt * self.nodes[node].powi(power) * push / mass;
        }
        for (node, velocity) in self.nodes.iter_mut().zip(&self.velocities) {
            *node += dt * velocity;
        }
        let heat = self.field.afterburnt(self.time + dt) - self.field.afterburnt(self.time);
        self.zones[..CHARGE_ZONES].iter_mut().for_each(|zone| zone.energy += heat);
        self.time += dt;
        let power = self.field.axes as i32;
        for index in 0..self.zones.len() {
            let radii = [self.nodes[index], self.nodes[index + 1]];
            let volume = (radii[1].powi(power) - radii[0].powi(power)) / f64::from(power);
            let closing = self.velocities[index] - self.velocities[index + 1];
            let burnt = self.burnt(index);
            self.zones[index].compress(&self.field, index < CHARGE_ZONES, volume, closing, burnt);
        }
        self.steps += 1;
        if self.steps.is_multiple_of(BETWEEN_JOINS) {
            self.join_thin_zones();
        }
    }

    /// Joins zones of gas that are too thin with the next one: mass, momentum and energy stay.
    fn join_thin_zones(&mut self) {
        let least = THINNEST * self.contact();
        let mut index = CHARGE_ZONES;
        while index + 1 < self.zones.len() {
            if self.nodes[index + 1] - self.nodes[index] >= least {
                index += 1;
                continue;
            }
            let (here, next) = (self.zones[index], self.zones.remove(index + 1));
            self.nodes.remove(index + 1);
            let between = self.velocities.remove(index + 1);
            let mut lost = 0.25 * (here.mass + next.mass) * between * between;
            // each side of the pair takes half of the mass of the zone it had not touched
            for (node, taken, own) in [(index, next.mass, here.mass), (index + 1, here.mass, next.mass)] {
                let beyond = if node == index { self.zones[index - 1].mass } else { self.outer_mass(index) };
                let (before, mass) = (self.velocities[node], 0.5 * (own + beyond));
                self.velocities[node] = (mass * before + 0.5 * taken * between) / (mass + 0.5 * taken);
                lost += 0.5 * mass * before * before;
                lost -= 0.5 * (mass + 0.5 * taken) * self.velocities[node].powi(2);
            }
            let mass = here.mass + next.mass;
            let energy = (here.mass * here.energy + next.mass * next.energy + lost) / mass;
            let volume = here.volume + next.volume;
            let pressure = (self.field.gamma - 1.0) * energy * mass / volume;
            let viscosity = here.viscosity.max(next.viscosity);
            let sound = (self.field.gamma * pressure * volume / mass).sqrt();
            self.zones[index] = Zone { mass, volume, energy, pressure, viscosity, sound };
            index += 1;
        }
    }

    /// Mass of the zone outside of one, or nothing.
    fn outer_mass(&self, zone: usize) -> f64 {
        self.zones.get(zone + 1).map_or(0.0, |zone| zone.mass)
    }

    /// Part of a zone that has burned.
    fn burnt(&self, zone: usize) -> f64 {
        let width = self.field.radius() / CHARGE_ZONES as f64;
        let passed = self.field.explosive.detonation_speed * self.time - zone as f64 * width;
        (passed / (BURN_WIDTH * width)).clamp(0.0, 1.0)
    }

    fn time_step(&self) -> f64 {
        let limit = |(index, zone): (usize, &Zone)| {
            let width = self.nodes[index + 1] - self.nodes[index];
            let closing = (self.velocities[index + 1] - self.velocities[index]).abs();
            let sound = if index < CHARGE_ZONES && zone.sound == 0.0 {
                self.field.explosive.detonation_speed
            } else {
                zone.sound
            };
            width / (sound + 4.0 * closing + f64::MIN_POSITIVE)
        };
        let least = self.zones.iter().enumerate().map(limit).fold(f64::INFINITY, f64::min);
        // before the first step the gas has no speed of sound yet
        let first = (self.nodes[1] - self.nodes[0]) / self.field.explosive.detonation_speed;
        COURANT * if self.time == 0.0 { first } else { least }
    }

    /// Radius of the front \[m\]: the outer edge of the outermost zone whose pressure has risen.
    pub fn front(&self) -> f64 {
        let risen = |zone: &Zone| zone.pressure > (1.0 + FRONT) * self.field.pressure;
        let last = self.zones.iter().rposition(risen).unwrap_or(CHARGE_ZONES - 1);
        self.nodes[last + 1]
    }

    /// Radius of the products \[m\].
    pub fn contact(&self) -> f64 {
        self.nodes[CHARGE_ZONES]
    }

    /// Pressure at a radius \[Pa\].
    pub fn pressure_at(&self, radius: f64) -> f64 {
        let zone = self.nodes.partition_point(|&node| node <= radius);
        let middle = |zone: usize| 0.5 * (self.nodes[zone] + self.nodes[zone + 1]);
        let zone = zone.clamp(1, self.zones.len()) - 1;
        let other = if radius < middle(zone) { zone.saturating_sub(1) } else { (zone + 1).min(self.zones.len() - 1) };
        let (here, there) = (self.zones[zone].pressure, self.zones[other].pressure);
        if other == zone {
            return here;
        }
        here + (there - here) * (radius - middle(zone)) / (middle(other) - middle(zone))
    }

    /// Mass \[kg\] and energy \[J\] of the whole.
    pub fn totals(&self) -> [f64; 2] {
        let mass: f64 = self.zones.iter().map(|zone| zone.mass).sum();
        let heat: f64 = self.zones.iter().map(|zone| zone.mass * zone.energy).sum();
        let moving = |(node, velocity): (usize, &f64)| {
            let inner = node.checked_sub(1).map_or(0.0, |zone| self.zones[zone].mass);
            0.25 * (inner + self.zones.get(node).map_or(0.0, |zone| zone.mass)) * velocity * velocity
        };
        let kinetic: f64 = self.velocities.iter().enumerate().map(moving).sum();
        [mass, heat + kinetic].map(|total| total * self.field.surface())
    }

    /// Runs until the front has come to a radius \[m\], at most `steps` steps.
    pub fn run_to(&mut self, radius: f64, steps: usize) {
        for _ in 0..steps {
            if self.front() >= radius {
                break;
            }
            self.step(f64::INFINITY);
        }
    }

    /// Means over `count` shells out to a radius \[m\].
    pub fn profile(&self, radius: f64, count: usize) -> Profile {
        let power = self.field.axes as i32;
        let mut shells = vec![[0.0; 5]; count];
        let thickness = radius / count as f64;
        let volume = |low: f64, high: f64| (high.powi(power) - low.powi(power)) / f64::from(power);
        for (index, zone) in self.zones.iter().enumerate() {
            let (low, high) = (self.nodes[index], self.nodes[index + 1].min(radius));
            let velocity = 0.5 * (self.velocities[index] + self.velocities[index + 1]);
            let density = zone.mass / zone.volume;
            let products = if index < CHARGE_ZONES { 1.0 } else { 0.0 };
            let state = [density, density * velocity, density * zone.energy, density * products, products];
            let first = (low / thickness) as usize;
            for (shell, sums) in shells.iter_mut().enumerate().skip(first) {
                let (inner, outer) = ((shell as f64 * thickness).max(low), ((shell + 1) as f64 * thickness).min(high));
                if inner >= outer {
                    break;
                }
                let share = volume(inner, outer);
                for (sum, part) in sums.iter_mut().zip(state) {
                    *sum += share * part;
                }
            }
        }
        for (shell, sums) in shells.iter_mut().enumerate() {
            let whole = volume(shell as f64 * thickness, (shell + 1) as f64 * thickness);
            *sums = sums.map(|sum| sum / whole);
        }
        Profile { radius, shells }
    }
}

impl Zone {
    /// Takes a new volume, and the energy of the work on the way. `closing`: by how much its inner side is faster than its outer one.
    fn compress(&mut self, field: &NearField, products: bool, volume: f64, closing: f64, burnt: f64) {
        let density = self.mass / volume;
        let viscosity =
            if closing > 0.0 { density * closing * (VISCOSITY[0] * closing + VISCOSITY[1] * self.sound) } else { 0.0 };
        let work = volume - self.volume;
        // the pressure is linear in the energy: p = cold + slope e, at the end of the step
        let (cold, slope) = if products {
            let Jwl { omega, .. } = field.explosive.products;
            let relative = field.explosive.density / density;
            (burnt * field.explosive.products.cold(relative), burnt * omega * density)
        } else {
            (0.0, (field.gamma - 1.0) * density)
        };
        let given =
            self.mass * self.energy - work * (0.5 * (self.pressure + cold) + 0.5 * (viscosity + self.viscosity));
        self.energy = given / (self.mass + 0.5 * work * slope);
        (self.volume, self.viscosity) = (volume, viscosity);
        self.pressure = cold + slope * self.energy;
        let stiffness = if products {
            let relative = field.explosive.density / density;
            field.explosive.products.stiffness(relative, field.explosive.density * self.energy)
                / field.explosive.density
        } else {
            field.gamma * self.pressure / density
        };
        self.sound = if products && burnt == 0.0 { 0.0 } else { stiffness.max(0.0).sqrt() };
    }
}
