// What one run fixes: grid, gas, limits, switches. Mirror of src/state/params.rs (Params).
// The dimension and the switches of the method are pipeline overrides, so that a switched-off branch costs nothing.

override DIM: u32;
override SOLIDS: bool;          // the scene has bodies
override QUADRATIC: bool;       // gas element pair B2B1 (true) or B1B0 (false)
override PREDICTOR: bool;       // consistent predictor of the intermediate pressure
override CONSISTENT: bool;      // gas is carried by what the solve sees of its velocity, see carrier.wgsl; gas only
override CUT: bool;             // obstacles cut cells; gas only, B1B0
override ARS: bool;             // two solves per step, see ars.wgsl
override FOURTH: bool;          // sound of fourth order in space, see carrier.wgsl
override LIMITER: bool;         // conservative flux limiter for positivity
override LEDGER: bool;          // gas of covered cells is kept and given back
override FRACTURE: bool;        // some material breaks, see fracture.wgsl
override DRIVEN: bool;          // some body has a part that is clamped or moves as prescribed
override FRICTION: bool;        // some body does not slip
override MIDPOINT_POWER: bool;  // interface power with the mean of the old and the new solid velocity
override LATE_FLUX: bool;       // half of what bodies gain in the solve carries gas, see late_flux.wgsl
override IMPLICIT: bool;        // one elastic step by backward Euler instead of explicit sub-steps
override SHARED_VOLUME: bool;   // the ghost pressure follows the elastic law's volumetric part, which the law then lacks
override RULES_USED: u32;        // rules of open sides in the scene, as bits
override PERIODIC: u32;          // axes whose ends meet, as bits
override MIRRORED: u32;         // sides that are planes of symmetry: walls, as bits; gas only
override JOINED: u32;           // open sides whose nodes go with the cells before them, as bits; B1B0 only
override SLEEPS: bool;          // gas that nothing reaches in a step may be left out of it, see still.wgsl
override FILM_NEAREST: bool;    // gas film at walls carries the nearest gas pressure, else the ghost pressure
override INTERFACE: u32;        // INTERFACE_RESOLVED, INTERFACE_H or INTERFACE_SINGLE

struct Params {
    cells: vec3u,               // cells per axis, 1 on inactive axes
    slots: u32,                 // length of every cell, node and vertex array
    stride: vec3u,              // cells plus the ring on active axes
    particles: u32,
    origin: vec3f,              // [m] low corner of the domain
    spacing: f32,               // [m] cell edge
    gravity: vec3f,             // [m s^-2]
    gamma: f32,                 // ratio of specific heats
    ambient_density: f32,       // [kg m^-3]
    ambient_pressure: f32,      // [Pa]
    cfl: f32,
    max_courant: f32,           // cap of c dt / dx
    max_growth: f32,            // cap of dt / previous dt
    fixed_step: f32,            // [s] 0 = from the bounds
    elastic_cfl: f32,
    solid_threshold: f32,       // share of a cell that makes it solid
    mass_floor: f32,            // [kg] least node mass that the pressure solve sees, of the heaviest body
    tolerance: f32,             // of the solve, relative
    extra_capacity: u32,        // vertices that may carry P, h and Q apart
    max_iterations: u32,
    probes: u32,
    history: u32,               // steps that the history ring holds
    bodies: u32,
    max_substeps: u32,
    groups: u32,                // groups that leave partial results
    march: u32,                 // slots that one thread of a marching kernel takes, along the last axis
    wall_sides: u32,            // sides that hold solids back, as bits: x-, x+, y-, y+, z-, z+
    blending: u32,              // 1: faces of partly filled cells are blocked by their share
    least_entropy: f32,         // p / rho^gamma that no gas falls below
    surface_rows: u32,          // vertices whose interface pressure has a row in the preconditioner
    still: u32,                 // what is left out where nothing moves: STILL_NONE, STILL_ADVECTION, STILL_ASLEEP
    runs_at: u32,               // place of the runs of slots that are awake, in the buffer extra
    still_at: u32,              // place of the rows of blocks there
    table_at: u32,              // place of the table of cut cells there
    list_runs_at: u32,          // place of the runs of the list there
    scan: array<vec4u, SCAN_DISPATCHES>,    // groups of each dispatch of a prefix sum over all slots
}

@group(0) @binding(0) var<uniform> params: Params;

// Threads of all groups that leave partial results: how far a kernel with as many strides.
fn striding_threads() -> u32 { return params.groups * WORKGROUP; }
