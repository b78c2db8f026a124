//! The quantities of wholes: of bodies, their pieces, what bears loads, points of bodies, probes, and of each step.

use super::columns::{Columns, Compute};
use super::{Place, TABLE};
use crate::bodies::{BodyState, Fragment};
use crate::diagnostics::{Borne, PointRecord, ProbeRecord, StepRecord, Total};

macro_rules! lines {
    ($($kind:ident $name:literal, $symbol:literal, $unit:literal, $caption:literal, $compute:expr;)*) => {
        &[$(Columns { name: $name, symbol: $symbol, unit: $unit, caption: $caption, compute: Compute::$kind($compute) }),*]
    };
}

/// Of a body, in `bodies.csv`.
pub const BODY: &[Columns<BodyState>] = lines! {
    Count "particles", "N", "1", "particles inside the domain", |b| b.particles;
    One "mass", "m", "kg", "mass", |b| b.mass;
    Vector "", "x", "m", "centre of mass", |b| b.centroid;
    Vector "velocity", "v", "m s^-1", "velocity of the centre of mass", |b| b.velocity;
    Vector "angular_momentum", "L", "kg m^2 s^-1", "angular momentum about the centre of mass", |b| b.angular_momentum;
    Vector "min", "x_min", "m", "low corner of the box around the particles", |b| b.extent[0];
    Vector "max", "x_max", "m", "high corner of the box around the particles", |b| b.extent[1];
    One "plastic_strain", "eps_p,max", "1", "largest equivalent plastic strain", |b| b.plastic_strain;
    Count "pieces", "N_c", "1", "pieces", |b| b.pieces.into();
    One "mean_plastic_strain", "<eps_p>", "1", "mean equivalent plastic strain, by mass", |b| b.mean_plastic_strain;
    One "elastic_strain", "|E|", "1", "largest norm of the elastic strain of Green and Lagrange", |b| b.elastic_strain;
    One "deviatoric_stress", "sigma_vM", "Pa", "largest deviatoric stress", |b| b.deviatoric_stress;
    One "kinetic_energy", "E_kin", "J", "kinetic energy of the particles", |b| b.kinetic_energy;
    One "broken_mass", "m_b", "kg", "mass of the particles that have broken", |b| b.broken_mass;
    One "elastic_energy", "E_el", "J", "elastic energy of the particles, less what damage takes of it", |b| b.elastic_energy;
};

/// Of a piece of a body, in `fragments.csv` and `mesh/NNNN.csv`.
pub const PIECE: &[Columns<Fragment>] = lines! {
    Count "particles", "N", "1", "particles", |p| p.particles.len() as u64;
    One "mass", "m", "kg", "mass", |p| p.mass;
    Vector "", "x", "m", "centre of mass", |p| p.centre;
    Vector "velocity", "v", "m s^-1", "velocity of the centre of mass", |p| p.velocity;
    Vector "spin", "omega", "s^-1", "angular velocity of a rigid piece with the same angular momentum", |p| p.spin;
    One "length", "l_1", "m", "longest edge of the box with the same moments", |p| p.size[0];
    One "width", "l_2", "m", "the second edge", |p| p.size[1];
    One "height", "l_3", "m", "the shortest edge", |p| p.size[2];
    One "volume", "V", "m^3", "volume as it is deformed; in `mesh/` that inside the surface", |p| p.volume;
    Shares "mass_at_speed", "m_k", "kg", "mass with a speed in each eighth of `fastest`", |p| p.speeds;
};

/// Of what bears a load: in `gauges.csv` and `obstacles.csv` all but `work`, in `bodies.csv` with `gas_` before each name.
pub const LOAD: &[Columns<Borne>] = lines! {
    Vector "force", "F", "N", "force of the gas, mean since the last row", |l| l.force;
    Vector "moment", "M", "N m", "its moment", |l| l.moment;
    One "pressure", "<p>", "Pa", "mean pressure over the faces that gas touches", |l| l.pressure;
    Vector "impulse", "I", "kg m s^-1", "force over the time since the start", |l| l.impulse;
    One "work", "W", "J", "work of the gas since the start", |l| l.work;
};

/// Of a point of a body, in `gauges.csv`.
pub const POINT: &[Columns<PointRecord>] = lines! {
    Vector "displacement", "u", "m", "displacement from the place at the start", |p| p.displacement.map(f64::from);
    Vector "velocity", "v", "m s^-1", "velocity", |p| p.velocity.map(f64::from);
    Tensor "elastic_strain", "E", "1", "elastic strain of Green and Lagrange", |p| p.elastic_strain.map(f64::from);
    Tensor "stress", "sigma", "Pa", "stress of Cauchy", |p| p.stress.map(f64::from);
    One "plastic_strain", "eps_p", "1", "equivalent plastic strain", |p| p.plastic_strain.into();
    One "damage", "d", "1", "damage", |p| p.damage.into();
};

/// Of a probe, in `probes.csv`: the gas.
pub const PROBE: &[Columns<ProbeRecord>] = lines! {
    One "density", "rho", "kg m^-3", "density", |p| p.density.into();
    Vector "velocity", "u", "m s^-1", "velocity", |p| p.velocity.map(f64::from);
    One "pressure", "p", "Pa", "pressure", |p| p.pressure.into();
    Count "kind", "k", "1", "0 gas, 1 solid, 2 wall, 3 beyond an open side", |p| p.kind.into();
};

/// The same: the wave so far; no numbers of what has not come by.
pub const WAVE: &[Columns<[f64; 4]>] = lines! {
    One "overpressure", "p - p_0", "Pa", "pressure less the first one", |w| w[0];
    One "arrival", "t_a", "s", "when the wave arrived", |w| w[1];
    One "positive_phase", "t_d", "s", "how long the overpressure lasted", |w| w[2];
    One "impulse", "i_s", "Pa s", "overpressure over the positive phase, as far as it has come", |w| w[3];
};

/// Of a step, in `diagnostics.csv`.
pub const STEP: &[Columns<StepRecord>] = lines! {
    Count "step", "n", "1", "number of the step", |r| r.step.into();
    One "time", "t", "s", "time at its end", |r| r.time;
    One "dt", "dt", "s", "its length", |r| r.dt.into();
    One "gas_mass", "m_g", "kg", "mass of the gas", |r| r.gas.mass.into();
    Vector "gas_momentum", "P_g", "kg m s^-1", "momentum of the gas", |r| momentum(&r.gas);
    One "gas_energy", "E_g", "J", "energy of the gas", |r| r.gas.energy.into();
    One "owed_mass", "m_o", "kg", "mass of gas that is owed: under bodies, and not yet given back", |r| r.owed.mass.into();
    Vector "owed_momentum", "P_o", "kg m s^-1", "its momentum", |r| momentum(&r.owed);
    One "owed_energy", "E_o", "J", "its energy", |r| r.owed.energy.into();
    One "crossed_mass", "m_c", "kg", "mass that has left through the sides since the start", |r| r.crossed.mass.into();
    Vector "crossed_momentum", "P_c", "kg m s^-1", "impulse through the sides", |r| momentum(&r.crossed);
    One "crossed_energy", "E_c", "J", "energy through the sides", |r| r.crossed.energy.into();
    One "solid_mass", "m_s", "kg", "mass of the bodies", |r| r.solid.mass.into();
    Vector "solid_momentum", "P_s", "kg m s^-1", "momentum of the bodies", |r| momentum(&r.solid);
    One "solid_kinetic_energy", "E_kin", "J", "kinetic energy of the bodies", |r| r.solid.energy.into();
    One "solid_elastic_energy", "E_el", "J", "elastic energy of the bodies", |r| r.elastic_energy.into();
    One "solid_ghost_energy", "E_q", "J", "energy of the ghost pressure", |r| r.ghost_energy.into();
    One "solid_plastic_heat", "Q_p", "J", "heat of plastic flow since the start", |r| r.plastic_heat.into();
    Vector "given_momentum", "P_in", "kg m s^-1", "impulse that walls and gravity have given", |r| momentum(&r.given);
    One "given_energy", "E_in", "J", "energy that walls, gravity, blasts and charges have given", |r| r.given.energy.into();
    Count "pcg_iterations", "N_it", "1", "iterations of the coupled solve", |r| r.iterations.into();
    One "pcg_residual", "r", "1", "its relative residual", |r| r.residual.into();
    Count "substeps", "N_sub", "1", "elastic sub-steps", |r| r.substeps.into();
    Count "extra_vertices", "N_v", "1", "vertices with pressures apart", |r| r.extra.into();
    One "min_density", "rho_min", "kg m^-3", "least density of the gas", |r| r.density[0].into();
    One "max_density", "rho_max", "kg m^-3", "largest density of the gas", |r| r.density[1].into();
    One "min_pressure", "p_min", "Pa", "least pressure of the gas", |r| r.pressure[0].into();
    One "max_pressure", "p_max", "Pa", "largest pressure of the gas", |r| r.pressure[1].into();
    One "max_gas_speed", "|u|_max", "m s^-1", "largest speed of the gas", |r| r.gas_speed.into();
    One "max_solid_speed", "|v|_max", "m s^-1", "largest speed of a particle", |r| r.solid_speed.into();
    Count "limited_cells", "N_l", "1", "cells where the flux limiter acted", |r| r.limited.into();
    Count "floored_cells", "N_f", "1", "cells where the energy floor acted", |r| r.floored.into();
    Count "clamped_particles", "N_cl", "1", "particles held back at a wall", |r| r.clamped.into();
    One "acoustic_courant", "c dt / dx", "1", "largest speed of sound in cells per step", |r| r.courant.into();
    Count "newton_rounds", "N_n", "1", "rounds of Newton's method of implicit elasticity", |r| r.rounds.into();
    Count "elastic_iterations", "N_e", "1", "its iterations of conjugate gradients", |r| r.elastic_iterations.into();
    Count "raised_cells", "N_r", "1", "cells whose pressure was raised before one of two solves", |r| r.raised.into();
    One "gas_kinetic_energy", "E_g,kin", "J", "kinetic energy of the gas", |r| r.gas_kinetic.into();
    One "owed_mass_of_either_sign", "|m_o|", "kg", "mass that is owed or too much, whatever its sign", |r| r.owed_either.into();
    One "min_entropy", "s_min", "Pa (m^3 kg^-1)^gamma", "least pressure over density to the power gamma", |r| r.min_entropy.into();
    One "solid_fracture_energy", "E_f", "J", "energy that cracks have taken since the start", |r| r.fracture_energy.into();
    One "broken_mass", "m_b", "kg", "mass of the particles that have broken and are still there", |r| r.broken_mass.into();
    One "dust_mass", "m_d", "kg", "dust in the gas", |r| r.dust_mass[0].into();
    One "loose_dust_mass", "m_l", "kg", "dust on the ground", |r| r.dust_mass[1].into();
    One "crossed_dust_mass", "m_dc", "kg", "dust that has left through the sides since the start", |r| r.dust_mass[2].into();
    One "dropped_mass", "m_x", "kg", "mass of debris that was taken out since the start", |r| r.dropped_mass.into();
    Count "dense_cells", "N_d", "1", "cells denser than the law of the explosive allows", |r| r.dense.into();
};

fn momentum(total: &Total) -> [f64; 3] {
    total.momentum.map(f64::from)
}

/// The page of the book: all quantities of cells and particles, then those of wholes.
#[must_use]
pub fn pages() -> [String; 2] {
    // a bar would end a cell
    let symbol = |text: &str| format!("`{}`", text.replace('|', "\\|"));
    let line = |cells: [&str; 5]| format!("| {} |\n", cells.join(" | "));
    let head = |names: [&str; 5]| line(names) + "|---|---|---|---|---|\n";
    let mut fields = head(["Quantity", "Symbol", "Of", "Unit", "Caption"]);
    for own in TABLE {
        let place = if own.place == Place::Cell { "cell" } else { "particle" };
        fields +=
            &line([&format!("`{}`", own.name), &symbol(own.symbol), place, &format!("`{}`", own.unit), own.caption]);
    }
    let mut wholes = head(["Column", "Symbol", "Of", "Unit", "Meaning"]);
    let mut add = |of: &str, lines: Vec<[String; 4]>| {
        lines.iter().for_each(|[name, sign, unit, meaning]| {
            wholes += &line([name, &symbol(sign), of, &format!("`{unit}`"), meaning]);
        });
    };
    add("body", described(BODY));
    add("piece", described(PIECE));
    add("load", described(LOAD));
    add("point", described(POINT));
    add("probe", [described(PROBE), described(WAVE)].concat());
    add("step", described(STEP));
    [fields, wholes]
}

/// Columns, symbol, unit and meaning of each.
fn described<T>(quantities: &[Columns<T>]) -> Vec<[String; 4]> {
    quantities
        .iter()
        .map(|own| [own.written(), own.symbol.to_owned(), own.unit.to_owned(), own.caption.to_owned()])
        .collect()
}
