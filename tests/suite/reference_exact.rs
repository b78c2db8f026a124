//! Independent solutions: the exact Riemann problem, a radial explosion, a rigid piston between two gases.

/// Density, velocity, pressure.
pub(crate) type Primitive = [f64; 3];

const GAMMA: f64 = 1.4;

/// Velocity change across the wave that connects a state to pressure p, and its derivative.
fn wave(p: f64, [density, _, pressure]: Primitive) -> (f64, f64) {
    if p > pressure {
        let a = 2.0 / ((GAMMA + 1.0) * density);
        let b = (GAMMA - 1.0) / (GAMMA + 1.0) * pressure;
        let root = (a / (p + b)).sqrt();
        ((p - pressure) * root, root * (1.0 - 0.5 * (p - pressure) / (p + b)))
    } else {
        let sound = (GAMMA * pressure / density).sqrt();
        let power = (GAMMA - 1.0) / (2.0 * GAMMA);
        let ratio = p / pressure;
        (2.0 * sound / (GAMMA - 1.0) * (ratio.powf(power) - 1.0), ratio.powf(power - 1.0) / (density * sound))
    }
}

/// Pressure and velocity between the waves of a Riemann problem.
pub(crate) fn star(left: Primitive, right: Primitive) -> (f64, f64) {
    let mut p = 0.5 * (left[2] + right[2]);
    for _ in 0..100 {
        let ((fl, dl), (fr, dr)) = (wave(p, left), wave(p, right));
        let next = (p - (fl + fr + right[1] - left[1]) / (dl + dr)).max(1e-3 * p);
        let done = (next - p).abs() <= 1e-14 * p;
        p = next;
        if done {
            break;
        }
    }
    (p, 0.5 * (left[1] + right[1]) + 0.5 * (wave(p, right).0 - wave(p, left).0))
}

/// State on the ray x/t = s left of the contact; the right side is its mirror image.
fn left_of_contact(state: Primitive, p: f64, u: f64, s: f64) -> Primitive {
    let [density, velocity, pressure] = state;
    let sound = (GAMMA * pressure / density).sqrt();
    let g = (GAMMA - 1.0) / (GAMMA + 1.0);
    if p > pressure {
        let ratio = p / pressure;
        let speed = velocity - sound * ((GAMMA + 1.0) / (2.0 * GAMMA) * ratio + (GAMMA - 1.0) / (2.0 * GAMMA)).sqrt();
        return if s < speed { state } else { [density * (ratio + g) / (g * ratio + 1.0), u, p] };
    }
    let inner = sound * (p / pressure).powf((GAMMA - 1.0) / (2.0 * GAMMA));
    if s < velocity - sound {
        state
    } else if s > u - inner {
        [density * (p / pressure).powf(1.0 / GAMMA), u, p]
    } else {
        let c = 2.0 / (GAMMA + 1.0) * (sound + 0.5 * (GAMMA - 1.0) * (velocity - s));
        let density = density * (c / sound).powf(2.0 / (GAMMA - 1.0));
        [density, s + c, density * c * c / GAMMA]
    }
}

/// State on the ray x/t = s.
pub(crate) fn sample(left: Primitive, right: Primitive, s: f64) -> Primitive {
    let (p, u) = star(left, right);
    if s <= u {
        left_of_contact(left, p, u, s)
    } else {
        let mirrored = left_of_contact([right[0], -right[1], right[2]], p, -u, -s);
        [mirrored[0], -mirrored[1], mirrored[2]]
    }
}

/// Cell averages of the density at time t, n cells on [0, 1], jump at 0.5.
pub(crate) fn riemann_density(left: Primitive, right: Primitive, n: usize, t: f64) -> Vec<f64> {
    let points = 200;
    let at = |i: usize, k: usize| (i as f64 + (k as f64 + 0.5) / points as f64) / n as f64;
    let mean =
        |i: usize| (0..points).map(|k| sample(left, right, (at(i, k) - 0.5) / t)[0]).sum::<f64>() / points as f64;
    (0..n).map(mean).collect()
}

fn limited(a: f64, b: f64) -> f64 {
    if a * b <= 0.0 { 0.0 } else { a.signum() * (2.0 * a.abs()).min(2.0 * b.abs()).min(0.5 * (a + b).abs()) }
}

/// Flux of (rho, m, E) by Harten, Lax, van Leer with contact.
fn hllc(l: Primitive, r: Primitive) -> [f64; 3] {
    let conserved = |q: Primitive| [q[0], q[0] * q[1], q[2] / (GAMMA - 1.0) + 0.5 * q[0] * q[1] * q[1]];
    let sound = |q: Primitive| (GAMMA * q[2] / q[0]).sqrt();
    let (sl, sr) = ((l[1] - sound(l)).min(r[1] - sound(r)), (l[1] + sound(l)).max(r[1] + sound(r)));
    let middle = (r[2] - l[2] + l[0] * l[1] * (sl - l[1]) - r[0] * r[1] * (sr - r[1]))
        / (l[0] * (sl - l[1]) - r[0] * (sr - r[1]));
    let (q, s, outside) = if middle >= 0.0 { (l, sl, sl >= 0.0) } else { (r, sr, sr <= 0.0) };
    let u = conserved(q);
    let flux = [u[1], u[1] * q[1] + q[2], (u[2] + q[2]) * q[1]];
    if outside {
        return flux;
    }
    let density = q[0] * (s - q[1]) / (s - middle);
    let energy = density * (u[2] / q[0] + (middle - q[1]) * (middle + q[2] / (q[0] * (s - q[1]))));
    let star = [density, density * middle, energy];
    [0, 1, 2].map(|k| flux[k] + s * (star[k] - u[k]))
}

/// Density of the explosion of (1, 0, 1) inside r = 0.4 into (0.125, 0, 0.1), n radial cells; power 1 cylinder,
/// 2 sphere.
pub(crate) fn radial_density(n: usize, extent: f64, power: i32, t: f64) -> Vec<f64> {
    let dr = extent / n as f64;
    let start = |i: usize| if (i as f64 + 0.5) * dr < 0.4 { [1.0, 0.0, 2.5] } else { [0.125, 0.0, 0.25] };
    let mut u: Vec<[f64; 3]> = (0..n).map(start).collect();
    let primitive = |u: [f64; 3]| [u[0], u[1] / u[0], (GAMMA - 1.0) * (u[2] - 0.5 * u[1] * u[1] / u[0])];
    let rate = |u: &[[f64; 3]]| -> Vec<[f64; 3]> {
        let values: Vec<Primitive> = u.iter().map(|u| primitive(*u)).collect();
        let q = |i: i64| {
            let [density, velocity, pressure] = values[if i < 0 { (-1 - i) as usize } else { (i as usize).min(n - 1) }];
            [density, if i < 0 { -velocity } else { velocity }, pressure]
        };
        let slope = |i: i64| [0, 1, 2].map(|k| limited(q(i)[k] - q(i - 1)[k], q(i + 1)[k] - q(i)[k]));
        let side = |i: i64, s: f64| [0, 1, 2].map(|k| q(i)[k] + s * slope(i)[k]);
        let faces: Vec<_> = (0..=n as i64).map(|i| hllc(side(i - 1, 0.5), side(i, -0.5))).collect();
        let radius = |i: usize| (i as f64 * dr).powi(power);
        let cell = |i: usize| {
            let volume =
                (((i + 1) as f64 * dr).powi(power + 1) - (i as f64 * dr).powi(power + 1)) / f64::from(power + 1);
            let pressure = values[i][2] * (radius(i + 1) - radius(i)) / volume;
            let net = [0, 1, 2].map(|k| (radius(i) * faces[i][k] - radius(i + 1) * faces[i + 1][k]) / volume);
            [net[0], net[1] + pressure, net[2]]
        };
        (0..n).map(cell).collect()
    };
    let mut time = 0.0;
    while time < t {
        let speed = |u: &[f64; 3]| primitive(*u)[1].abs() + (GAMMA * primitive(*u)[2] / u[0]).sqrt();
        let dt = (0.4 * dr / u.iter().map(speed).fold(0.0, f64::max)).min(t - time);
        let first: Vec<[f64; 3]> = u.iter().zip(rate(&u)).map(|(u, r)| [0, 1, 2].map(|k| u[k] + dt * r[k])).collect();
        let second = rate(&first);
        u = (0..n).map(|i| [0, 1, 2].map(|k| 0.5 * (u[i][k] + first[i][k] + dt * second[i][k]))).collect();
        time += dt;
    }
    u.iter().map(|u| u[0]).collect()
}

/// One gas column in Lagrangian coordinates.
struct Column {
    edges: Vec<f64>,
    mass: Vec<f64>,
    velocity: Vec<f64>,
    energy: Vec<f64>,
}

impl Column {
    fn new(low: f64, high: f64, n: usize, state: impl Fn(f64) -> Primitive) -> Self {
        let dx = (high - low) / n as f64;
        let centre = |i: usize| low + (i as f64 + 0.5) * dx;
        Self {
            edges: (0..=n).map(|i| low + i as f64 * dx).collect(),
            mass: (0..n).map(|i| state(centre(i))[0] * dx).collect(),
            velocity: vec![0.0; n],
            energy: (0..n).map(|i| state(centre(i))[2] / (GAMMA - 1.0) / state(centre(i))[0]).collect(),
        }
    }

    fn primitive(&self, i: usize) -> Primitive {
        let density = self.mass[i] / (self.edges[i + 1] - self.edges[i]);
        let internal = self.energy[i] - 0.5 * self.velocity[i] * self.velocity[i];
        [density, self.velocity[i], (GAMMA - 1.0) * density * internal]
    }

    /// Pressure on a wall of given speed beyond the last (upper) or before the first cell.
    fn wall(&self, upper: bool, speed: f64) -> f64 {
        let q = self.primitive(if upper { self.mass.len() - 1 } else { 0 });
        let mirror = [q[0], 2.0 * speed - q[1], q[2]];
        if upper { star(q, mirror).0 } else { star(mirror, q).0 }
    }

    /// One Godunov step with the given wall speeds.
    fn step(&mut self, walls: [f64; 2], dt: f64) {
        let n = self.mass.len();
        let state: Vec<Primitive> = (0..n).map(|i| self.primitive(i)).collect();
        let mut faces = vec![(self.wall(false, walls[0]), walls[0])];
        faces.extend((1..n).map(|i| star(state[i - 1], state[i])));
        faces.push((self.wall(true, walls[1]), walls[1]));
        for i in 0..n {
            let ((pl, ul), (pr, ur)) = (faces[i], faces[i + 1]);
            self.velocity[i] += dt * (pl - pr) / self.mass[i];
            self.energy[i] += dt * (pl * ul - pr * ur) / self.mass[i];
        }
        for (edge, face) in self.edges.iter_mut().zip(&faces) {
            *edge += dt * face.1;
        }
    }

    fn step_limit(&self) -> f64 {
        let one = |i: usize| {
            let q = self.primitive(i);
            (self.edges[i + 1] - self.edges[i]) / (GAMMA * q[2] / q[0]).sqrt()
        };
        0.5 * (0..self.mass.len()).map(one).fold(f64::INFINITY, f64::min)
    }
}

/// Rigid slab [0.5, 0.6] in a closed tube [0, 1] between gas (1, 1) with a driver (4, 6) on x < 0.25: samples of
/// (time, displacement, velocity) until t = 0.5.
pub(crate) fn slab_path(density: f64, n: usize) -> Vec<(f64, f64, f64)> {
    let gas = |x: f64| if x < 0.25 { [4.0, 0.0, 6.0] } else { [1.0, 0.0, 1.0] };
    let (mut left, mut right) = (Column::new(0.0, 0.5, n, gas), Column::new(0.6, 1.0, n, gas));
    let mass = 0.1 * density;
    let (mut t, mut x, mut u) = (0.0, 0.0, 0.0);
    let mut path = vec![(t, x, u)];
    while t < 0.5 {
        let dt = left.step_limit().min(right.step_limit()).min(0.5 - t + 1e-15);
        let force = |speed: f64, left: &Column, right: &Column| left.wall(true, speed) - right.wall(false, speed);
        let half = u + 0.5 * dt * force(u, &left, &right) / mass;
        let new = u + dt * force(half, &left, &right) / mass;
        let mean = 0.5 * (u + new);
        left.step([0.0, mean], dt);
        right.step([mean, 0.0], dt);
        x += dt * mean;
        u = new;
        t += dt;
        path.push((t, x, u));
    }
    path
}
