//! The gas beyond inlets and outlets, and what the pressure system is told about their faces.

use std::collections::HashMap;

use crate::grid::{add, shift};
use crate::{GAS, GHOST, Gas, Problem, Side, internal_energy, kinetic_energy};

/// An open face: u = velocity + (p - reference) / Z along the outward normal.
#[derive(Clone, Copy, Debug)]
pub struct OpenFace {
    /// Along +axis.
    pub velocity: f64,
    /// 1 / Z.
    pub admittance: f64,
    /// Pressure that the side drifts to, Pa.
    pub reference: f64,
}

/// Rule behind which a ring cell lies and the axis across: behind two sides a prescribed state comes first.
fn rule_behind(problem: &Problem, c: [i32; 3]) -> (Side, usize) {
    let grid = &problem.grid;
    let outside = |d: &usize| c[*d] < 0 || c[*d] >= grid.cells[*d];
    let rules: Vec<(Side, usize)> = (0..grid.dimension)
        .filter(|d| !grid.periodic[*d])
        .filter(outside)
        .map(|d| (problem.side_at(2 * d + usize::from(c[d] >= 0), grid.slot(c)), d))
        .collect();
    let prescribed = rules.iter().find(|(rule, _)| matches!(rule, Side::Inlet { .. } | Side::Subsonic { .. }));
    *prescribed.unwrap_or(&rules[0])
}

/// Velocity that a rule prescribes in a ring cell.
pub fn prescribed(problem: &Problem, c: [i32; 3]) -> Option<[f64; 3]> {
    match rule_behind(problem, c).0 {
        Side::Inlet { velocity, .. } | Side::Subsonic { velocity, .. } => Some(velocity),
        _ => None,
    }
}

/// Nearest cell of the domain.
pub fn nearest(problem: &Problem, c: [i32; 3]) -> usize {
    let grid = &problem.grid;
    grid.slot([0, 1, 2].map(|d| if grid.periodic[d] { c[d] } else { c[d].clamp(0, grid.cells[d] - 1) }))
}

/// Pressure of gas from a reservoir at a speed.
fn reservoir_pressure(density: f64, pressure: f64, speed: f64, gamma: f64) -> f64 {
    let ratio = 1.0 - 0.5 * (gamma - 1.0) * speed * speed / (gamma * pressure / density);
    pressure * ratio.max(0.0).powf(gamma / (gamma - 1.0))
}

fn reservoir_speed(density: f64, pressure: f64, outward: f64, gamma: f64) -> f64 {
    (-outward).clamp(0.0, (2.0 / (gamma + 1.0) * gamma * pressure / density).sqrt())
}

/// Density of gas where it has the far pressure.
fn far_density(density: f64, pressure: f64, far: f64, gamma: f64) -> f64 {
    density * (far / pressure).powf(1.0 / gamma)
}

/// Density and pressure of gas behind a simple wave that runs outward and changes its outward velocity.
fn from_afar(density: f64, pressure: f64, gain: f64, gamma: f64) -> (f64, f64) {
    let sound = f64::max(1.0 + 0.5 * (gamma - 1.0) * gain / (gamma * pressure / density).sqrt(), 0.1);
    (density * sound.powf(2.0 / (gamma - 1.0)), pressure * sound.powf(2.0 * gamma / (gamma - 1.0)))
}

fn beyond(problem: &Problem, rule: Side, axis: usize, outward: f64, here: [f64; 5]) -> [f64; 5] {
    let gamma = problem.gamma;
    let velocity = outward * here[1 + axis] / here[0];
    match rule {
        Side::Inlet { density, velocity, pressure } => {
            Gas::conserved_from_primitive(density, velocity, pressure, gamma)
        }
        Side::Subsonic { density, velocity } => {
            let mut u = Gas::conserved_from_primitive(density, velocity, 0.0, gamma);
            u[4] = internal_energy(here) + kinetic_energy(u);
            u
        }
        Side::Total { density, pressure } => {
            let speed = reservoir_speed(density, pressure, velocity, gamma);
            let p = reservoir_pressure(density, pressure, speed, gamma);
            let mut v = [0.0; 3];
            v[axis] = -outward * speed;
            Gas::conserved_from_primitive(density * (p / pressure).powf(1.0 / gamma), v, p, gamma)
        }
        Side::Attenuated { density, velocity, pressure, attenuation } => {
            let far = Gas::conserved_from_primitive(density, velocity, pressure, gamma);
            [0, 1, 2, 3, 4].map(|k| here[k] + attenuation * (far[k] - here[k]))
        }
        Side::Far { density, velocity: mut v, pressure } if velocity < 0.0 => {
            if velocity <= -(gamma * (gamma - 1.0) * internal_energy(here) / here[0]).sqrt() {
                return Gas::conserved_from_primitive(density, v, pressure, gamma);
            }
            let now = (gamma - 1.0) * internal_energy(here);
            let entering = far_density(here[0], now, pressure, gamma);
            let (_, p) = from_afar(entering, pressure, velocity - outward * v[axis], gamma);
            let rho = density * (p / pressure).powf(1.0 / gamma);
            v[axis] = outward * velocity;
            Gas::conserved_from_primitive(rho, v, p, gamma)
        }
        _ => here,
    }
}

/// Writes the ring cells outside inlets and outlets.
pub fn fill_ghosts(problem: &Problem, cells: &[u32], gas: &mut Gas) {
    let grid = &problem.grid;
    for c in grid.all() {
        let slot = grid.slot(c);
        if cells[slot] == GHOST {
            let (rule, axis) = rule_behind(problem, c);
            let outward = if c[axis] < 0 { -1.0 } else { 1.0 };
            gas.set(slot, beyond(problem, rule, axis, outward, gas.get(nearest(problem, c))));
        }
    }
}

/// Velocity of the node in a GHOST cell; none if only the gas cells around know it.
pub fn node_velocity(problem: &Problem, cells: &[u32], star: &Gas, c: [i32; 3]) -> Option<[f64; 3]> {
    let near = nearest(problem, c);
    if let Some(velocity) = prescribed(problem, c) {
        return Some(velocity);
    }
    match rule_behind(problem, c).0 {
        _ if cells[near] != GAS => None,
        Side::Attenuated { .. } => Some(star.velocity(problem.grid.slot(c))),
        _ => Some(star.velocity(near)),
    }
}

/// Velocity through an open face before the solve: prescribed, or the cell's own.
pub fn carried_velocity(problem: &Problem, star: &Gas, axis: usize, upper: bool, cell: [i32; 3]) -> f64 {
    match problem.sides[2 * axis + usize::from(upper)] {
        Side::Inlet { velocity, .. } | Side::Subsonic { velocity, .. } => velocity[axis],
        _ => star.velocity(problem.grid.slot(cell))[axis],
    }
}

/// What an outlet with a far pressure knows of itself, by ring slot: velocity and pressure that the last step assumed, pressure that it found.
pub type Memory = HashMap<usize, [f64; 3]>;

/// The open faces of a step, by ring slot.
pub type OpenFaces = HashMap<usize, OpenFace>;

/// Velocities by ring slot.
pub type Surplus = HashMap<usize, f64>;

/// Ring slot behind a face.
pub fn behind(problem: &Problem, (cell, axis, upper): ([i32; 3], usize, bool)) -> usize {
    problem.grid.slot(shift(cell, axis, if upper { 1 } else { -1 }))
}

/// What the pressure system is told about every open face. `predicted` are the predicted pressures of the cells.
pub fn faces(problem: &Problem, cells: &[u32], star: &Gas, predicted: &[f64], memory: &Memory, dt: f64) -> OpenFaces {
    let face = |place| (behind(problem, place), open_face(problem, star, predicted, memory, place, dt));
    open_faces(problem, cells).into_iter().map(face).collect()
}

fn open_face(
    problem: &Problem,
    star: &Gas,
    predicted: &[f64],
    memory: &Memory,
    (cell, axis, upper): ([i32; 3], usize, bool),
    dt: f64,
) -> OpenFace {
    let (grid, gamma) = (&problem.grid, problem.gamma);
    let slot = grid.slot(cell);
    let ring = behind(problem, (cell, axis, upper));
    let outward = if upper { 1.0 } else { -1.0 };
    let (density, velocity, pressure) =
        (star.conserved[slot][0], star.velocity(slot)[axis], star.pressure(slot, gamma));
    let sound = (gamma * pressure / density).sqrt();
    let mach = outward * velocity / sound;
    let predicted_sound = (gamma * predicted[slot] / density).sqrt();
    let passing = 1.0 / (density * predicted_sound);
    let prescribed = |velocity: f64| OpenFace { velocity, admittance: 0.0, reference: pressure };
    let drift = |relaxation: f64| {
        let rate = relaxation * (1.0 - mach * mach).max(0.0) * sound / (grid.spacing * f64::from(grid.cells[axis]));
        (rate * dt).min(1.0)
    };
    let known = memory
        .get(&ring)
        .map_or([velocity, pressure], |[u, p, found]| [u + outward * (found - p) / (density * sound), *found]);
    match problem.side_at(2 * axis + usize::from(upper), ring) {
        Side::Inlet { velocity, .. } | Side::Subsonic { velocity, .. } => prescribed(velocity[axis]),
        Side::Total { density: total, pressure } => {
            let speed = reservoir_speed(total, pressure, outward * velocity, gamma);
            OpenFace {
                velocity: -outward * speed,
                admittance: 1.0 / (density * speed.max(0.1 * predicted_sound)),
                reference: reservoir_pressure(total, pressure, speed, gamma),
            }
        }
        Side::Attenuated { .. } => {
            let ghost = star.conserved[ring];
            prescribed((star.conserved[slot][1 + axis] + ghost[1 + axis]) / (density + ghost[0]))
        }
        Side::Far { velocity, .. } if mach <= -1.0 => prescribed(velocity[axis]),
        _ if mach >= 1.0 => prescribed(velocity),
        Side::Far { velocity: u, pressure: p, .. } => {
            // without the kick of gravity, which the pressure that it is solved for balances
            let velocity = velocity - dt * problem.gravity[axis];
            let gain = outward * (velocity - u[axis]);
            let (_, reference) = from_afar(far_density(density, pressure, p, gamma), p, gain, gamma);
            let rho = far_density(density, predicted[slot], p, gamma) * (reference / p).powf(1.0 / gamma);
            OpenFace { velocity, admittance: 1.0 / (gamma * reference * rho).sqrt(), reference }
        }
        Side::Pressure { pressure: far, relaxation } => OpenFace {
            velocity: known[0] + outward * drift(relaxation) * (known[1] - far) / (density * sound),
            admittance: passing,
            reference: known[1],
        },
        Side::Wall | Side::Periodic => unreachable!("no open face"),
    }
}

/// What the next step knows of this one's faces.
pub fn remember(problem: &Problem, cells: &[u32], faces: &OpenFaces, pressure: &[f64]) -> Memory {
    let note = |place| {
        let ring = behind(problem, place);
        (ring, [faces[&ring].velocity, faces[&ring].reference, face_pressure(problem, place, pressure)])
    };
    open_faces(problem, cells).into_iter().map(note).collect()
}

/// Mean pressure of a face, from that of the vertices.
fn face_pressure(problem: &Problem, (cell, axis, upper): ([i32; 3], usize, bool), pressure: &[f64]) -> f64 {
    let grid = &problem.grid;
    let low = if upper { shift(cell, axis, 1) } else { cell };
    let corners: Vec<_> = grid.offsets(0, 1).into_iter().filter(|k| k[axis] == 0).collect();
    corners.iter().map(|k| pressure[grid.slot(add(low, *k))]).sum::<f64>() / corners.len() as f64
}

/// By how much what passes open faces exceeds the `carried` velocities of the cells before them, where the pressure changes it.
pub fn surplus(
    problem: &Problem,
    cells: &[u32],
    (faces, pressure): (&OpenFaces, &[f64]),
    carried: &[[f64; 3]],
) -> Surplus {
    let note = |place: ([i32; 3], usize, bool)| {
        let solved = solved_velocity(problem, faces, place, face_pressure(problem, place, pressure));
        (behind(problem, place), solved - carried[problem.grid.slot(place.0)][place.1])
    };
    let free = |place: &([i32; 3], usize, bool)| faces[&behind(problem, *place)].admittance > 0.0;
    open_faces(problem, cells).into_iter().filter(free).map(note).collect()
}

/// Faces of gas cells towards GHOST cells: cell, axis, upper.
pub fn open_faces(problem: &Problem, cells: &[u32]) -> Vec<([i32; 3], usize, bool)> {
    let grid = &problem.grid;
    let mut found = Vec::new();
    for c in grid.interior().into_iter().filter(|c| cells[grid.slot(*c)] == GAS) {
        for axis in 0..grid.dimension {
            for upper in [false, true] {
                if cells[grid.slot(shift(c, axis, if upper { 1 } else { -1 }))] == GHOST {
                    found.push((c, axis, upper));
                }
            }
        }
    }
    found
}

/// Velocity of an open face with the solved pressure.
pub fn solved_velocity(problem: &Problem, faces: &OpenFaces, place: ([i32; 3], usize, bool), pressure: f64) -> f64 {
    let face = faces[&behind(problem, place)];
    let outward = if place.2 { 1.0 } else { -1.0 };
    face.velocity + outward * face.admittance * (pressure - face.reference)
}
