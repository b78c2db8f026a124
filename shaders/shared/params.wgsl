// What one run fixes: grid, gas, limits, switches.
// The dimension and the switches of the method are pipeline overrides, so that a switched-off branch costs nothing.

override DIM: u32;
override SOLIDS: bool;          // the scene has bodies
override QUADRATIC: bool;       // gas element pair B2B1 (true) or B1B0 (false)
override PREDICTOR: bool;       // consistent predictor of the intermediate pressure
override CONSISTENT: bool;      // gas is carried by what the solve sees of its velocity, see carrier.wgsl; gas only
override CUT: bool;             // obstacles cut cells; gas only, B1B0
override ARS: bool;             // two solves per step, see ars.wgsl
override FOURTH: bool;          // sound of fourth order in space, see carrier.wgsl
override FRACTURE: bool;        // some material breaks, see fracture.wgsl
override DRIVEN: bool;          // some body has a part that is clamped or moves as prescribed
override FRICTION: bool;        // some body does not slip
override LATE_FLUX: bool;       // half of what bodies gain in the solve carries gas, see late_flux.wgsl
override IMPLICIT: bool;        // one elastic step by backward Euler instead of explicit sub-steps
override SHARED_VOLUME: bool;   // the ghost pressure follows the elastic law's volumetric part, which the law then lacks
override RULES_USED: u32;        // rules of open sides in the scene, as bits
override PERIODIC: u32;          // axes whose ends meet, as bits
override MIRRORED: u32;         // sides that are planes of symmetry: walls, as bits; gas only
override JOINED: u32;           // open sides whose nodes go with the cells before them, as bits; B1B0 only
override INTERFACE: u32;        // INTERFACE_RESOLVED, INTERFACE_H or INTERFACE_SINGLE

// Generated from src/state/params.rs by scripts/generate.
struct Params {
    cells: vec3u,               // Cells per axis, 1 on inactive axes
    slots: u32,                 // Length of every cell, node and vertex array
    stride: vec3u,              // Cells per axis with the ring
    particles: u32,             // Particles
    origin: vec3f,              // Low corner of the domain [m]
    spacing: f32,               // Cell edge [m]
    gravity: vec3f,             // Gravity [m s^-2]
    gamma: f32,                 // Ratio of specific heats
    ambient_density: f32,       // Ambient density [kg m^-3]
    ambient_pressure: f32,      // Ambient pressure [Pa]
    cfl: f32,                   // Courant number of the material velocity
    max_courant: f32,           // Cap of c dt / dx
    max_growth: f32,            // Cap of dt over the previous dt
    fixed_step: f32,            // Fixed step [s], 0 for none
    elastic_cfl: f32,           // Courant number of the elastic sub-steps
    solid_threshold: f32,       // Share of a cell that makes it solid
    mass_floor: f32,            // Least node mass that the pressure solve sees [kg]
    tolerance: f32,             // Relative tolerance of the solve
    extra_capacity: u32,        // Vertices that may carry P, h and Q apart
    max_iterations: u32,        // Iterations after which a solve counts as stalled
    probes: u32,                // Probes
    history: u32,               // Steps that the history ring holds
    bodies: u32,                // Bodies
    max_substeps: u32,          // Largest number of sub-steps of one step
    groups: u32,                // Groups that leave partial results
    march: u32,                 // Slots that one thread of a marching kernel takes one after the other, along the last axis
    wall_sides: u32,            // Sides that hold solids back, as bits: x-, x+, y-, y+, z-, z+
    least_entropy: f32,         // p / rho^gamma that no gas falls below
    surface_rows: u32,          // Vertices whose interface pressure has a row in the preconditioner
    still: u32,                 // 1 if the advection leaves out what motion does not reach by the solve, with the same result
    still_at: u32,              // Place of the rows of blocks in super::Interface::extra
    table_at: u32,              // Place of the table of cut cells there
    row: u32,                   // Slots of a row, as sums take them (shaders/shared/octets.wgsl)
    scan: array<vec4u, SCAN_DISPATCHES>, // Groups of each dispatch of a prefix sum over all slots and one more
}
// End of what is generated.

@group(0) @binding(0) var<uniform> params: Params;

// Threads of all groups that leave partial results: how far a kernel with as many strides.
fn striding_threads() -> u32 { return params.groups * WORKGROUP; }
