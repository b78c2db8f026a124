//! Whole steps on the device against the CPU twin: gas alone, bodies in gas, bodies at walls and open sides.

use crate::common::gpu_or_skip;
use crate::twins::Twins;

const CHANNEL: &str = r#"
title = "Channel with a block"
gravity = [0.3, -0.5]
[domain]
dimension = 2
cells = [20, 16]
size = [1.25, 1.0]
[gas]
ambient = { density = 1.0, velocity = [0.3, 0.0], pressure = 1.0 }
[boundary]
x_min = { inlet = { density = 1.4, velocity = [0.5, 0.1], pressure = 1.3 } }
x_max = "outlet"
[[obstacles]]
name = "block"
shape = { box = { center = [0.6, 0.35], size = [0.25, 0.25] } }
[time]
until = 1.0
[numerics]
tolerance = 1e-6
paper.obstacles = "cells"
"#;

fn channel(overrides: &[&str]) {
    let Some(gpu) = gpu_or_skip() else { return };
    let mut twins = Twins::new(gpu, CHANNEL, overrides, 1.0);
    for _ in 0..3 {
        let (_, trace) = twins.step();
        twins.compare_pressure(&trace, 2e-5);
        twins.compare_gas(2e-5);
    }
    twins.finish();
}

#[test]
fn gas_with_open_sides_and_a_block() {
    channel(&[]);
}

#[test]
fn gas_with_open_sides_and_a_block_quadratic() {
    channel(&["numerics.pair=b2b1"]);
}

#[test]
fn gas_without_predictor() {
    channel(&["numerics.integrator=paper"]);
}

#[test]
fn gas_carried_by_the_velocity_of_its_cells() {
    channel(&["numerics.paper.face_velocity=cell"]);
}

/// Steps so long that the first of two solves, too, needs more iterations than are recorded at first.
#[test]
fn two_solves_that_go_on_in_the_next_recording() {
    let Some(gpu) = gpu_or_skip() else { return };
    let quiet = [
        "numerics.integrator=ars222",
        "time.fixed_step=0.5",
        "gas.ambient.velocity=[0.0,0.0]",
        "boundary.x_min=wall",
        "gravity=[0.0,0.0]",
    ];
    let mut twins = Twins::new(gpu, CHANNEL, &quiet, 0.01);
    let (_, trace) = twins.step();
    assert!(twins.recordings > 1, "the step fits into one recording");
    twins.compare_pressure(&trace, 2e-5);
    twins.compare_gas(2e-5);
    twins.finish();
}

#[test]
fn gas_with_two_solves() {
    channel(&["numerics.integrator=ars222"]);
    channel(&["numerics.integrator=auto", "numerics.pair=b2b1"]);
}

#[test]
fn gas_between_subsonic_sides() {
    channel(&[
        "boundary.x_min={ subsonic_inlet = { density = 1.4, velocity = [0.5, 0.1] } }",
        "boundary.x_max={ pressure_outlet = { pressure = 0.9, relaxation = 2.0 } }",
        "boundary.y_min={ total_inlet = { density = 1.3, pressure = 1.6 } }",
        "boundary.y_max={ far_field = { density = 1.1, velocity = [0.3, 0.1], pressure = 1.05 } }",
    ]);
}

#[test]
fn gas_leaving_through_an_attenuated_outlet() {
    channel(&[
        "boundary.x_max={ attenuated_outlet = { density = 1.1, pressure = 1.0, attenuation = 0.3 } }",
        "boundary.y_max=outlet",
        "numerics.pair=b2b1",
    ]);
}

#[test]
fn gas_with_one_periodic_axis() {
    channel(&["boundary.y_min=periodic", "boundary.y_max=periodic"]);
}

#[test]
fn gas_with_periodic_axes_quadratic() {
    let periodic = ["x_min", "x_max", "y_min", "y_max"].map(|side| format!("boundary.{side}=periodic"));
    let mut overrides: Vec<&str> = periodic.iter().map(String::as_str).collect();
    overrides.push("numerics.pair=b2b1");
    channel(&overrides);
}

const BODY: &str = r#"
title = "A body in moving gas"
[domain]
dimension = 2
cells = [16, 16]
size = [1.0, 1.0]
[gas]
ambient = { density = 1.0, pressure = 1.0 }
[materials.rubber]
neo_hookean = { young_modulus = 100.0, poisson_ratio = 0.3 }
[[bodies]]
name = "ball"
shape = { sphere = { center = [0.47, 0.55], radius = 0.22 } }
material = "rubber"
density = 10.0
velocity = [0.6, -0.4]
[time]
until = 1.0
fixed_step = 0.0078125
[numerics]
tolerance = 1e-6
"#;

const SOFT_METAL: &str =
    "materials.rubber={ von_mises = { young_modulus = 100.0, poisson_ratio = 0.3, yield_stress = 0.5 } }";

fn body(steps: usize, overrides: &[&str]) {
    let Some(gpu) = gpu_or_skip() else { return };
    let mut twins = Twins::new(gpu, BODY, overrides, 0.5);
    for _ in 0..steps {
        let (_, trace) = twins.step();
        twins.compare_pressure(&trace, 5e-5);
        twins.compare_gas(5e-5);
        twins.compare_solid(&trace, 2e-5);
    }
    twins.finish();
}

#[test]
fn elastic_ball() {
    body(3, &[]);
}

#[test]
fn elastic_ball_quadratic_with_three_pressures() {
    body(3, &["numerics.pair=b2b1", "numerics.paper.interface=h"]);
}

#[test]
fn stiff_ball_in_elastic_substeps() {
    body(3, &["materials.rubber.neo_hookean.young_modulus=1000.0"]);
}

#[test]
fn yielding_ball() {
    body(3, &[SOFT_METAL]);
}

#[test]
fn yielding_ball_in_space() {
    body(
        2,
        &[
            SOFT_METAL,
            "materials.rubber.von_mises.yield_stress=0.1", // strains far above the rounding of F
            "domain.dimension=3",
            "domain.cells=[12,12,12]",
            "domain.size=[0.75,0.75,0.75]",
            "bodies[0].shape.sphere.center=[0.36,0.38,0.41]",
            "bodies[0].velocity=[0.6,-0.4,0.3]",
        ],
    );
}

/// On the floor, half out of the open side, pressed down and out. No cell is nearly half full, where rounding would choose its kind.
const AT_THE_SIDES: [&str; 6] = [
    "bodies[0].shape.sphere.center=[0.772,0.224]",
    "bodies[0].velocity=[1.5,-0.8]",
    "boundary.x_max=outlet",
    "gravity=[0.4,-1.0]",
    "gas.ambient.velocity=[0.3,0.0]",
    SOFT_METAL,
];

#[test]
fn ball_on_the_floor_leaving_through_the_outlet() {
    body(4, &AT_THE_SIDES);
}

#[test]
fn ball_on_the_floor_with_one_pressure() {
    body(2, &[&AT_THE_SIDES[..], &["numerics.paper.interface=single"]].concat());
}

#[test]
fn ball_moved_by_local_gradients() {
    body(3, &["numerics.paper.solid_update=gradients"]);
    body(3, &[&AT_THE_SIDES[..], &["numerics.paper.solid_update=gradients", "numerics.paper.interface=h"]].concat());
}

#[test]
fn ball_whose_elastic_step_comes_first() {
    let short = ["numerics.paper.coupling=last", "time.fixed_step=0.004"];
    body(3, &short);
    body(3, &[&AT_THE_SIDES[..], &short].concat());
}

/// Stiff enough for sub-steps, so that what the solve gives is spread.
#[test]
fn ball_that_shares_its_volume() {
    // at 1e-6 the stiff ball's ghost pressure is off by the tolerance of the solve
    let stiff = [
        "numerics.paper.ghost=shared_volume",
        "materials.rubber.neo_hookean.young_modulus=1000.0",
        "numerics.tolerance=3e-7",
    ];
    body(3, &stiff);
    body(3, &[&AT_THE_SIDES[..], &["numerics.paper.ghost=shared_volume"]].concat());
}

/// A step of several elastic Courant numbers.
#[test]
fn stiff_ball_by_backward_euler() {
    let implicit = ["numerics.elasticity=implicit", "numerics.expert.elastic_tolerance=1e-6"];
    let stiff = "materials.rubber.neo_hookean.young_modulus=1000.0";
    body(3, &[&implicit[..], &[stiff]].concat());
    body(2, &[&implicit[..], &[stiff, "numerics.expert.transfer=nodes"]].concat());
    body(2, &["numerics.elasticity=implicit", "numerics.expert.elastic_tolerance=1e-7", SOFT_METAL]);
}

#[test]
fn ball_on_the_floor_by_backward_euler() {
    let implicit = ["numerics.elasticity=implicit", "numerics.expert.elastic_tolerance=1e-6"];
    body(3, &[&implicit[..], &AT_THE_SIDES[..5], &["materials.rubber.neo_hookean.young_modulus=1000.0"]].concat());
}

/// Bodies of very different density: the lightest nodes of each are as heavy as its own material makes them.
#[test]
fn a_light_ball_beside_a_heavy_one() {
    let heavy = r#"bodies=[{ name = "ball", shape = { sphere = { center = [0.3, 0.55], radius = 0.15 } }, material = "rubber",
        density = 0.5 }, { name = "heavy", shape = { sphere = { center = [0.7, 0.55], radius = 0.15 } }, material = "rubber", density = 100.0 }]"#;
    body(3, &[heavy]);
}

/// A block that fills a corner of the box: whole rows of the pressure system with nothing but the body and the sides around.
#[test]
fn block_in_a_corner_in_space() {
    for pair in ["numerics.pair=b1b0", "numerics.pair=b2b1"] {
        body(
            2,
            &[
                pair,
                "domain.dimension=3",
                "domain.cells=[10,10,10]",
                "domain.size=[0.625,0.625,0.625]",
                "bodies[0].shape={box={center=[0.2,0.2,0.16],size=[0.4,0.4,0.32]}}",
                "bodies[0].velocity=[0.3,-0.4,-0.6]",
            ],
        );
    }
}

#[test]
fn crumbs_by_nodes() {
    body(
        3,
        &[
            SOFT_METAL,
            "bodies[0].shape.sphere.radius=0.04",
            "bodies[0].density=2.0",
            "numerics.expert.transfer=nodes",
            "numerics.tolerance=2e-7",
        ],
    );
}

/// One hot cell beside a plate in thin gas, and a step so long that vertices ask more of it than it has: they get what there is.
#[test]
fn vertices_that_ask_more_than_the_gas_around_them_has() {
    let Some(gpu) = gpu_or_skip() else { return };
    let overrides = [
        "domain={ dimension = 2, cells = [12, 12], size = [12.0, 12.0] }",
        "gas.ambient.density=0.02",
        "gas.regions=[{ shape = { box = { center = [7.5, 6.5], size = [1.0, 1.0] } }, density = 1.0, pressure = 1e6 }]",
        "materials.rubber={ neo_hookean = { young_modulus = 2e4, poisson_ratio = 0.25 } }",
        "bodies=[{ name = 'plate', material = 'rubber', density = 40.0, shape = { box = { center = [5.6, 6.5], size = [2.5, 5.0] } } }]",
        "time.fixed_step=8e-4",
    ];
    let mut twins = Twins::new(gpu, BODY, &overrides, 0.1);
    let (report, trace) = twins.step();
    assert!(report.limited > 0, "no vertex asked too much");
    twins.compare_pressure(&trace, 5e-5);
    twins.compare_gas(5e-5);
    twins.finish();
}
