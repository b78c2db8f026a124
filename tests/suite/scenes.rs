//! Shipped scenes against their own `[expect]`, and, where that was looked through, without warnings but those that they
//! expect.

use std::path::Path;

use brisance::expect;
use brisance::scene::{Changes, Scene};

use crate::common::{files_below, gpu_or_skip, is_kind, slashed};

/// Scenes that were not looked through for warnings: what is told of them may be right, or a fault.
const UNJUDGED: &[&str] = &[
    "paper/fig01_car_landmine.toml",
    "paper/fig03_elastic_shell_2d.toml",
    "paper/fig04_trucks.toml",
    "paper/fig05_bullets_2d.toml",
    "paper/fig06_pumpkin.toml",
    "paper/fig08_supernova.toml",
    "paper/fig10_cylinder_flow.toml",
    "paper/fig11_airplane.toml",
    "paper/fig12_cactus_forest.toml",
    "paper/fig13_ghost_update.toml",
    "paper/fig14_ordering.toml",
    "paper/fig18_mach_diamond_2d.toml",
    "validation/line_explosion.toml",
];

/// Runs a shipped scene and demands that it has expectations and meets them, and that nothing but what it expects is to be warned of.
fn meets_its_expectations(path: &str, changes: [&[&str]; 2]) {
    let Some(gpu) = gpu_or_skip() else { return };
    let [variants, set] = changes.map(|words| words.iter().map(|&word| word.to_owned()).collect());
    let changes = Changes { variants, set, outside: false };
    let scene = Scene::load(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(path), changes).unwrap();
    let (checks, warnings) = expect::run(&gpu, &scene).unwrap_or_else(|error| panic!("{path}: {error}"));
    let lines: Vec<String> = checks.iter().map(ToString::to_string).collect();
    eprintln!("{path}\n{}", lines.join("\n"));
    assert!(!checks.is_empty(), "{path}: an empty [expect] tests nothing");
    assert!(checks.iter().all(|check| check.passed), "{path}\n{}", lines.join("\n"));
    if UNJUDGED.contains(&path) {
        return;
    }
    let unexpected = warnings.iter().filter(|warning| warning.expected.is_none());
    let told: Vec<String> = unexpected.map(ToString::to_string).collect();
    assert!(told.is_empty(), "{path}\n{}", told.join("\n"));
}

/// Rows `test: scene [variants], changes`; those with the time that they take, in software, two at a time, run when asked for.
macro_rules! scenes {
    ($($name:ident: $path:literal $([$($variant:ident),*])? $(, $set:literal)* $(takes $time:literal)?;)*) => {
        $(#[test] $(#[ignore = $time])? fn $name() { meets_its_expectations($path, [&[$($(stringify!($variant)),*)?], &[$($set),*]]); })*

        /// Files that a test above runs.
        const TESTED: &[&str] = &[$($path),*];
    };
}

scenes! {
    sod: "gas/sod.toml";
    lax: "gas/lax.toml";
    mach3: "gas/mach3.toml";
    high_mach: "gas/high_mach.toml";
    strong_shock_tube: "gas/strong_shock_tube.toml";
    rarefactions: "gas/rarefactions.toml";
    blast: "gas/blast.toml";
    circular_shock: "paper/fig16_convergence.toml" [b1b0], "domain.cells=[128, 128]";
    circular_shock_b2b1: "paper/fig16_convergence.toml" [small, b2b1];
    modified_sod: "validation/modified_sod.toml";
    stationary_contact: "validation/stationary_contact.toml";
    shu_osher: "validation/shu_osher.toml";
    shock_reflection: "validation/shock_reflection.toml";
    noh_planar: "validation/noh_planar.toml";
    sedov_planar: "validation/sedov_planar.toml";
    acoustic_wave: "validation/acoustic_wave.toml";
    acoustic_wave_in_small_steps: "validation/acoustic_wave.toml" [small_steps];
    density_wave: "validation/density_wave.toml";
    sedov_cylindrical: "validation/sedov_cylindrical.toml";
    spherical_explosion: "validation/spherical_explosion.toml", "domain.cells=[16, 16, 16]", "expect.peak_density=[0.6, 1.02]";
    air_burst: "validation/air_burst.toml" [small], "time.until=0.001";
    forward_step: "paper/fig15_stair_flow.toml", "domain.cells=[60, 20]", "time.until=1.0", "expect.peak_density=[5.0, 7.4]", "expect.probes=[]";
    wedge: "validation/wedge.toml", "domain.cells=[50, 30]";
    wedge_at_mach_2: "validation/wedge_mach2.toml", "domain.cells=[50, 40]";
    compression_corner: "validation/compression_corner.toml", "domain.cells=[50, 20]";
    expansion_corner: "validation/expansion_corner.toml", "domain.cells=[50, 40]";
    regular_reflection: "validation/regular_reflection.toml", "domain.cells=[60, 15]", "expect.peak_density=[2.5, 2.9]";
    noh_cylindrical: "validation/noh_cylindrical.toml", "domain.cells=[50, 50]", "expect.peak_density=[25.0, 45.0]";
    line_explosion: "validation/line_explosion.toml", "domain.cells=[56, 56]";
    linear_wave: "validation/linear_wave.toml";
    entropy_wave: "validation/linear_wave.toml" [entropy];
    sphere: "validation/sphere.toml", "domain.cells=[6, 12, 12]", "expect.peak_density=[4.0, 7.0]";
    cylinder: "validation/cylinder.toml", "domain.cells=[15, 30]", "time.until=4.0", "expect.peak_density=[4.5, 7.0]";
    mach_diamond: "validation/mach_diamond.toml", "domain.cells=[60, 10]", "time.until=4.0";
    subsonic_duct: "validation/subsonic_duct.toml";
    subsonic_duct_with_fixed_inlet: "validation/subsonic_duct.toml" [fixed];
    riemann_2d: "validation/riemann_2d.toml", "domain.cells=[50, 50]";
    riemann_2d_4: "validation/riemann_2d.toml" [configuration_4], "domain.cells=[50, 50]";
    riemann_2d_6: "validation/riemann_2d.toml" [configuration_6], "domain.cells=[50, 50]";
    riemann_2d_12: "validation/riemann_2d.toml" [configuration_12], "domain.cells=[50, 50]";
    rest_noise: "validation/rest_noise.toml", "domain.cells=[16, 16]", "domain.size=[16.0, 16.0]", "probes[0].position=[8.0, 8.0]";
    double_mach_reflection: "validation/double_mach_reflection.toml", "domain.cells=[52, 16]", "expect.peak_density=[10.0, 33.0]";
    isentropic_vortex: "validation/isentropic_vortex.toml", "domain.cells=[32, 32]", "time.until=2.0";
    hydrostatic_column: "validation/hydrostatic_column.toml", "time.until=20.0";
    still_air: "validation/still_air.toml", "time.until=2.0";
    still_air_in_space: "validation/still_air.toml" [space], "domain.cells=[8, 8, 8]", "time.until=1.0";
    leaving_blast: "validation/leaving_blast.toml";
    drifting_contact: "validation/drifting_contact.toml", "time.until=0.3";
    two_gas_contact: "validation/two_gas_contact.toml";
    two_gas_disc: "validation/two_gas_disc.toml", "domain.cells=[32, 32]", "time.until=0.5";
    two_gas_tube: "validation/two_gas_tube.toml";
    helium_shock: "validation/helium_shock.toml";
    plane_detonation: "validation/plane_detonation.toml";
    copper_cylinder: "validation/copper_cylinder.toml" [small];
    lined_charge: "demos/lined_charge_2d.toml" [small], "time.until=8e-6";
    helium_bubble: "validation/helium_bubble.toml", "domain.cells=[125, 25]", "time.until=1e-4";
    hot_bubble: "validation/hot_bubble.toml", "domain.cells=[20, 40]", "time.until=20.0";
    kelvin_helmholtz: "gas/kelvin_helmholtz.toml", "domain.cells=[48, 48]", "time.until=0.5";
    mach_diamond_of_the_paper: "paper/fig18_mach_diamond_2d.toml", "domain.cells=[48, 48]", "time.until=0.5", "expect.probes=[]";
    lifting_cylinder: "paper/fig17_lifting_cylinder.toml", "domain.cells=[50, 10]", "time.until=0.05", "expect.bodies=[]";
    free_plate: "validation/free_plate.toml", "domain.cells=[205]";
    plate_in_tube: "validation/plate_in_tube.toml", "domain.cells=[155]";
    acoustic_plate: "validation/acoustic_plate.toml", "domain.cells=[180]";
    lagrange_gun: "validation/lagrange_gun.toml", "domain.cells=[260]";
    piston_into_vacuum: "validation/piston_into_vacuum.toml";
    elastic_half_space: "validation/elastic_half_space.toml";
    translation: "validation/translation.toml", "time.until=0.2", "expect.bodies=[]";
    exploding_shell: "validation/exploding_shell.toml", "domain.cells=[32, 32]", "expect.energy_drift=0.03";
    free_cylinder: "validation/free_cylinder.toml", "domain.cells=[32, 32]", "time.until=0.4", "expect.bodies=[]";
    fragments: "validation/fragments.toml", "time.until=0.02";
    materials_in_flow: "validation/materials_in_flow.toml", "domain.cells=[16, 16]", "time.until=0.2";
    striking_bar: "validation/striking_bar.toml";
    elastic_waves: "validation/elastic_waves.toml", "time.until=1e-3";
    colliding_discs: "validation/colliding_discs.toml", "time.until=0.5";
    spinning_disc: "validation/spinning_disc.toml", "time.until=0.02";
    thin_vessel: "validation/thin_vessel.toml", "time.until=10.0";
    soft_bodies: "validation/soft_bodies.toml", "time.until=0.05";
    loaded_plate: "validation/loaded_plate.toml", "time.until=60.0";
    loaded_ring: "validation/loaded_ring.toml", "domain.cells=[32, 32]";
    held_disc: "validation/held_disc.toml", "time.until=0.02";
    static_load: "validation/static_load.toml";
    driven_piston: "validation/driven_piston.toml", "domain.cells=[200]";
    compressed_chamber: "validation/compressed_chamber.toml", "domain.cells=[64]", "time.until=2.0", "expect.bodies=[]";
    flying_wedge: "validation/flying_wedge.toml", "domain.cells=[72, 14]", "time.until=0.5";
    sprung_piston: "validation/sprung_piston.toml", "time.until=0.5";
    hanging_bar: "validation/hanging_bar.toml", "time.until=0.05";
    vibrating_bar: "validation/vibrating_bar.toml", "time.until=10.0";
    cantilever: "validation/cantilever.toml", "domain.cells=[40, 12]", "time.until=2.0";
    blasted_strip: "validation/blasted_strip.toml", "domain.cells=[120, 48]", "time.until=1e-5";
    blasted_plate: "validation/blasted_plate.toml", "time.until=2e-6";
    broken_pane: "validation/broken_pane.toml", "time.until=1e-5", "expect.bodies=[]";
    spall: "validation/spall.toml";
    notched_plate: "validation/notched_plate.toml", "domain.cells=[48, 48]", "time.until=0.5", "expect.bodies=[]";
    brazilian_disc: "validation/brazilian_disc.toml", "domain.cells=[34, 34]", "time.until=0.5", "expect.bodies=[]";
    breaking_ring: "validation/breaking_ring.toml", "domain.cells=[70, 70]", "time.until=0.5", "expect.bodies=[]";
    kalthoff_winkler: "validation/kalthoff_winkler.toml", "domain.cells=[110, 54]", "time.until=2e-6";
    shocked_panel: "validation/shocked_panel.toml", "domain.cells=[300, 68]", "time.until=1e-6";
    blasted_ellipse: "paper/fig14_ordering.toml", "domain.cells=[32, 32]";
    blasted_ellipse_coupling_first: "paper/fig14_ordering.toml" [small, coupling_first];
    blasted_ellipse_elasticity_first: "paper/fig14_ordering.toml" [small, coupling_last] takes "17 s";
    supernova_2d: "paper/fig08_supernova_2d.toml", "domain.cells=[40, 16]";
    car_over_a_mine: "paper/fig01_car_landmine.toml" [small] takes "68 s";
    three_rabbits: "paper/fig02_tribunny.toml" [small] takes "83 s";
    strong_truck: "paper/fig04_trucks.toml" [small, strong] takes "51 s";
    weak_truck: "paper/fig04_trucks.toml" [small, weak] takes "51 s";
    elastic_pumpkin: "paper/fig06_pumpkin.toml" [small, elastic] takes "107 s";
    plastic_pumpkin: "paper/fig06_pumpkin.toml" [small, plastic] takes "270 s";
    supernova: "paper/fig08_supernova.toml" [small] takes "222 s";
    stiff_elastic_cylinder: "paper/fig10_cylinder_flow.toml" [small, stiff_elastic] takes "107 s";
    soft_elastic_cylinder: "paper/fig10_cylinder_flow.toml" [small, soft_elastic] takes "116 s";
    stiff_plastic_cylinder: "paper/fig10_cylinder_flow.toml" [small, stiff_plastic] takes "246 s";
    soft_plastic_cylinder: "paper/fig10_cylinder_flow.toml" [small, soft_plastic] takes "292 s";
    aeroplane_in_a_wind_tunnel: "paper/fig11_airplane.toml" [small] takes "188 s";
    aeroplane_for_pictures: "paper/fig11_airplane.toml" [gallery] takes "24 min";
    cactus_forest: "paper/fig12_cactus_forest.toml" [small] takes "135 s";
    cactus_forest_for_pictures: "paper/fig12_cactus_forest.toml" [gallery] takes "33 min";
    koalas_above_jets: "paper/fig19_koalas.toml" [small] takes "43 s";
    koalas_for_pictures: "paper/fig19_koalas.toml" [gallery] takes "9 min";
    piston: "coupled/piston.toml";
    slab_at_rest: "coupled/slab_at_rest.toml", "time.until=1.5";
    shell_at_rest: "paper/fig13_ghost_update.toml", "time.until=3.0";
    shell_at_rest_by_forces: "paper/fig13_ghost_update.toml" [small, forces];
    shell_at_rest_by_gradients: "paper/fig13_ghost_update.toml" [small, gradients] takes "13 s";
    bursting_shell_2d: "paper/fig03_elastic_shell_2d.toml" [small] takes "23 s";
    heavy_bullet: "paper/fig05_bullets_2d.toml" [small, heavy] takes "67 s";
    light_bullet: "paper/fig05_bullets_2d.toml" [small, light] takes "67 s";
    light_bullet_with_silencer: "paper/fig05_bullets_2d.toml" [small, light_silencer] takes "102 s";
    forward_step_to_its_end: "paper/fig15_stair_flow.toml" [small] takes "14 s";
    lifting_cylinder_to_its_end: "paper/fig17_lifting_cylinder.toml" [small];
    mach_diamond_to_its_end: "paper/fig18_mach_diamond_2d.toml" [small] takes "20 s";
    perforated_plate: "demos/perforated_plate_2d.toml" [small] takes "62 s";
    ice_ball: "demos/ice_ball_2d.toml" [small] takes "60 s";
    glass_front: "demos/glass_front_2d.toml" takes "47 s";
    sonic_boom: "demos/sonic_boom_2d.toml" takes "54 s";
    shaped_cavity: "demos/shaped_cavity_2d.toml" takes "60 s";
    bursting_diaphragm: "demos/bursting_diaphragm_2d.toml" takes "41 s";
    meteor: "demos/meteor_3d.toml" takes "40 s";
    playground: "demos/playground_2d.toml" takes "56 s";
    bursting_shell_3d: "demos/bursting_shell_3d.toml" takes "59 s";
    bursting_shell_askew: "demos/bursting_shell_3d.toml" [askew] takes "90 s";
    bursting_vessel_3d: "demos/bursting_vessel_3d.toml" [small];
    gelatine_3d: "demos/gelatine_3d.toml", "domain.cells=[12, 12, 12]", "time.until=0.1";
    fireball: "demos/fireball_3d.toml", "domain.cells=[16, 16, 24]", "time.until=0.05";
    street_blast: "demos/street_blast_3d.toml" [small], "time.until=0.003";
    ball_in_blast_3d: "demos/ball_in_blast_3d.toml", "domain.cells=[12, 12, 12]", "time.until=0.1";
}

#[test]
fn every_scene_is_tested() {
    let files = files_below(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes"));
    let mut found: Vec<_> = files.iter().filter(|path| is_kind(path, "toml")).map(|path| slashed(path)).collect();
    found.sort();
    let mut tested = TESTED.to_vec();
    tested.sort_unstable();
    tested.dedup();
    assert_eq!(found, tested, "tests/suite/scenes.rs lists every scene");
}
