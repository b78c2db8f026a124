//! The quantities of wholes: of bodies, their pieces, what bears loads, points of bodies, probes, and of each step.

use super::columns::{Columns, Compute};
use super::{Place, TABLE};
use crate::bodies::{BodyState, Fragment};
use crate::diagnostics::{Borne, PointRecord, ProbeRecord, StepRecord, Total};

macro_rules! lines {
    ($($kind:ident $name:literal, $unit:literal, $caption:literal, $compute:expr;)*) => {
        &[$(Columns { name: $name, unit: $unit, caption: $caption, compute: Compute::$kind($compute) }),*]
    };
}

/// Of a body, in `bodies.csv`.
pub const BODY: &[Columns<BodyState>] = lines! {
    Count "particles", "1", "particles inside the domain", |b| b.particles;
    One "mass", "kg", "mass", |b| b.mass;
    Vector "", "m", "centre of mass", |b| b.centroid;
    Vector "velocity", "m s^-1", "velocity of the centre of mass", |b| b.velocity;
    Vector "angular_momentum", "kg m^2 s^-1", "angular momentum about the centre of mass", |b| b.angular_momentum;
    Vector "min", "m", "low corner of the box around the particles", |b| b.extent[0];
    Vector "max", "m", "high corner of the box around the particles", |b| b.extent[1];
    One "plastic_strain", "1", "largest equivalent plastic strain", |b| b.plastic_strain;
    Count "pieces", "1", "pieces", |b| b.pieces.into();
    One "mean_plastic_strain", "1", "mean equivalent plastic strain, by mass", |b| b.mean_plastic_strain;
    One "elastic_strain", "1", "largest norm of the elastic strain of Green and Lagrange", |b| b.elastic_strain;
    One "deviatoric_stress", "Pa", "largest deviatoric stress", |b| b.deviatoric_stress;
    One "kinetic_energy", "J", "kinetic energy of the particles", |b| b.kinetic_energy;
    One "broken_mass", "kg", "mass of the particles that have broken", |b| b.broken_mass;
};

/// Of a piece of a body, in `fragments.csv` and `mesh/NNNN.csv`.
pub const PIECE: &[Columns<Fragment>] = lines! {
    Count "particles", "1", "particles", |p| p.particles.len() as u64;
    One "mass", "kg", "mass", |p| p.mass;
    Vector "", "m", "centre of mass", |p| p.centre;
    Vector "velocity", "m s^-1", "velocity of the centre of mass", |p| p.velocity;
    Vector "spin", "s^-1", "angular velocity of a rigid piece with the same angular momentum", |p| p.spin;
    One "length", "m", "longest edge of the box with the same moments", |p| p.size[0];
    One "width", "m", "the second edge", |p| p.size[1];
    One "height", "m", "the shortest edge", |p| p.size[2];
    One "volume", "m^3", "volume as it is deformed; in `mesh/` that inside the surface", |p| p.volume;
    Shares "mass_at_speed", "kg", "mass with a speed in each eighth of `fastest`", |p| p.speeds;
};

/// Of what bears a load: in `gauges.csv` and `obstacles.csv` all but `work`, in `bodies.csv` with `gas_` before each name.
pub const LOAD: &[Columns<Borne>] = lines! {
    Vector "force", "N", "force of the gas, mean since the last row", |l| l.force;
    Vector "moment", "N m", "its moment", |l| l.moment;
    One "pressure", "Pa", "mean pressure over the faces that gas touches", |l| l.pressure;
    Vector "impulse", "kg m s^-1", "force over the time since the start", |l| l.impulse;
    One "work", "J", "work of the gas since the start", |l| l.work;
};

/// Of a point of a body, in `gauges.csv`.
pub const POINT: &[Columns<PointRecord>] = lines! {
    Vector "displacement", "m", "from its place at the start", |p| p.displacement.map(f64::from);
    Vector "velocity", "m s^-1", "velocity", |p| p.velocity.map(f64::from);
    Tensor "elastic_strain", "1", "elastic strain of Green and Lagrange", |p| p.elastic_strain.map(f64::from);
    Tensor "stress", "Pa", "stress of Cauchy", |p| p.stress.map(f64::from);
    One "plastic_strain", "1", "equivalent plastic strain", |p| p.plastic_strain.into();
    One "damage", "1", "damage", |p| p.damage.into();
};

/// Of a probe, in `probes.csv`: the gas.
pub const PROBE: &[Columns<ProbeRecord>] = lines! {
    One "density", "kg m^-3", "density", |p| p.density.into();
    Vector "velocity", "m s^-1", "velocity", |p| p.velocity.map(f64::from);
    One "pressure", "Pa", "pressure", |p| p.pressure.into();
    Count "kind", "1", "0 gas, 1 solid, 2 wall, 3 beyond an open side", |p| p.kind.into();
};

/// The same: the wave so far; no numbers of what has not come by.
pub const WAVE: &[Columns<[f64; 4]>] = lines! {
    One "overpressure", "Pa", "pressure less the first one", |w| w[0];
    One "arrival", "s", "when the wave arrived", |w| w[1];
    One "positive_phase", "s", "how long the overpressure lasted", |w| w[2];
    One "impulse", "Pa s", "overpressure over the positive phase, as far as it has come", |w| w[3];
};

/// Of a step, in `diagnostics.csv`.
pub const STEP: &[Columns<StepRecord>] = lines! {
    Count "step", "1", "number of the step", |r| r.step.into();
    One "time", "s", "time at its end", |r| r.time;
    One "dt", "s", "its length", |r| r.dt.into();
    One "gas_mass", "kg", "mass of the gas", |r| r.gas.mass.into();
    Vector "gas_momentum", "kg m s^-1", "momentum of the gas", |r| momentum(&r.gas);
    One "gas_energy", "J", "energy of the gas", |r| r.gas.energy.into();
    One "owed_mass", "kg", "mass of gas that is owed: under bodies, and not yet given back", |r| r.owed.mass.into();
    Vector "owed_momentum", "kg m s^-1", "its momentum", |r| momentum(&r.owed);
    One "owed_energy", "J", "its energy", |r| r.owed.energy.into();
    One "crossed_mass", "kg", "mass that has left through the sides since the start", |r| r.crossed.mass.into();
    Vector "crossed_momentum", "kg m s^-1", "impulse through the sides", |r| momentum(&r.crossed);
    One "crossed_energy", "J", "energy through the sides", |r| r.crossed.energy.into();
    One "solid_mass", "kg", "mass of the bodies", |r| r.solid.mass.into();
    Vector "solid_momentum", "kg m s^-1", "momentum of the bodies", |r| momentum(&r.solid);
    One "solid_kinetic_energy", "J", "kinetic energy of the bodies", |r| r.solid.energy.into();
    One "solid_elastic_energy", "J", "elastic energy of the bodies", |r| r.elastic_energy.into();
    One "solid_ghost_energy", "J", "energy of the ghost pressure", |r| r.ghost_energy.into();
    One "solid_plastic_heat", "J", "heat of plastic flow since the start", |r| r.plastic_heat.into();
    Vector "given_momentum", "kg m s^-1", "impulse that walls and gravity have given", |r| momentum(&r.given);
    One "given_energy", "J", "energy that walls, gravity, blasts and charges have given", |r| r.given.energy.into();
    Count "pcg_iterations", "1", "iterations of the coupled solve", |r| r.iterations.into();
    One "pcg_residual", "1", "its relative residual", |r| r.residual.into();
    Count "substeps", "1", "elastic sub-steps", |r| r.substeps.into();
    Count "extra_vertices", "1", "vertices with pressures apart", |r| r.extra.into();
    One "min_density", "kg m^-3", "least density of the gas", |r| r.density[0].into();
    One "max_density", "kg m^-3", "largest density of the gas", |r| r.density[1].into();
    One "min_pressure", "Pa", "least pressure of the gas", |r| r.pressure[0].into();
    One "max_pressure", "Pa", "largest pressure of the gas", |r| r.pressure[1].into();
    One "max_gas_speed", "m s^-1", "largest speed of the gas", |r| r.gas_speed.into();
    One "max_solid_speed", "m s^-1", "largest speed of a particle", |r| r.solid_speed.into();
    Count "limited_cells", "1", "cells where the flux limiter acted", |r| r.limited.into();
    Count "floored_cells", "1", "cells where the energy floor acted", |r| r.floored.into();
    Count "clamped_particles", "1", "particles held back at a wall", |r| r.clamped.into();
    One "acoustic_courant", "1", "largest speed of sound in cells per step", |r| r.courant.into();
    Count "newton_rounds", "1", "rounds of Newton's method of implicit elasticity", |r| r.rounds.into();
    Count "elastic_iterations", "1", "its iterations of conjugate gradients", |r| r.elastic_iterations.into();
    Count "raised_cells", "1", "cells whose pressure was raised before one of two solves", |r| r.raised.into();
    One "gas_kinetic_energy", "J", "kinetic energy of the gas", |r| r.gas_kinetic.into();
    One "owed_mass_of_either_sign", "kg", "mass that is owed or too much, whatever its sign", |r| r.owed_either.into();
    One "min_entropy", "Pa (m^3 kg^-1)^gamma", "least pressure over density to the power gamma", |r| r.min_entropy.into();
    One "solid_fracture_energy", "J", "energy that cracks have taken since the start", |r| r.fracture_energy.into();
    One "broken_mass", "kg", "mass of the particles that have broken", |r| r.broken_mass.into();
    Count "dense_cells", "1", "cells denser than the law of the explosive allows", |r| r.dense.into();
};

fn momentum(total: &Total) -> [f64; 3] {
    total.momentum.map(f64::from)
}

/// The page of the book: all quantities of cells and particles, then those of wholes.
#[must_use]
pub fn pages() -> [String; 2] {
    let line = |cells: [&str; 4]| format!("| {} |\n", cells.join(" | "));
    let head = |names: [&str; 4]| line(names) + "|---|---|---|---|\n";
    let mut fields = head(["Quantity", "Of", "Unit", "Caption"]);
    for own in TABLE {
        let place = if own.place == Place::Cell { "cell" } else { "particle" };
        fields += &line([&format!("`{}`", own.name), place, &format!("`{}`", own.unit), own.caption]);
    }
    let mut wholes = head(["Column", "Of", "Unit", "Meaning"]);
    let mut add = |of: &str, lines: Vec<[String; 3]>| {
        lines.iter().for_each(|[name, unit, meaning]| wholes += &line([name, of, &format!("`{unit}`"), meaning]));
    };
    add("body", described(BODY));
    add("piece", described(PIECE));
    add("load", described(LOAD));
    add("point", described(POINT));
    add("probe", [described(PROBE), described(WAVE)].concat());
    add("step", described(STEP));
    [fields, wholes]
}

/// Columns, unit and meaning of each.
fn described<T>(quantities: &[Columns<T>]) -> Vec<[String; 3]> {
    quantities.iter().map(|own| [own.written(), own.unit.to_owned(), own.caption.to_owned()]).collect()
}
