// What every kernel knows of a run: switches, parameters and control, what lies beyond sides, the parts of arrays, and the state of the gas.
// Mirror of src/state. Declared elsewhere: constants such as GAS or NO_EXTRA by src/state/constants.rs, thread_index() and when() in
// src/gpu/head.wgsl. Both go before every shader.

// -- Switches and parameters --

// Pipeline overrides: a switched-off branch costs nothing.
override DIM: u32;
override SOLIDS: bool;          // the scene has bodies
override QUADRATIC: bool;       // gas element pair B2B1 (true) or B1B0 (false)
override PREDICTOR: bool;       // consistent predictor of the intermediate pressure
override CONSISTENT: bool;      // gas is carried by what the solve sees of its velocity, see gas/carrier.wgsl; gas only
override CUT: bool;             // obstacles cut cells; B1B0
override SPECIES: bool;         // the scene has a second gas
override PRODUCTS: bool;        // which is what an explosive leaves, see below
override ARS: bool;             // two solves per step, see below
override FOURTH: bool;          // sound of fourth order in space, see gas/carrier.wgsl
override FRACTURE: bool;        // some material breaks, see stress.wgsl
override DRIVEN: bool;          // some body has a part that is clamped or moves as prescribed
override FRICTION: bool;        // some body does not slip
override LATE_FLUX: bool;       // half of what bodies gain in the solve carries gas, see gas/late_flux.wgsl
override IMPLICIT: bool;        // one elastic step by backward Euler instead of explicit sub-steps
override SHARED_VOLUME: bool;   // the ghost pressure follows the elastic law's volumetric part, which the law then lacks
override RULES_USED: u32;        // rules of open sides in the scene, as bits, and more of them that such scenes may have
override PERIODIC: u32;          // axes whose ends meet, as bits
override MIRRORED: bool;        // some sides are planes of symmetry: walls; gas only
override JOINED: bool;          // nodes of some open sides go with the cells before them; B1B0 only
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
    row: u32,                   // Slots of a row, as sums take them (shaders/shared/pcg.wgsl)
    species_gamma: f32,         // Ratio of specific heats of the second gas
    species_least_entropy: f32, // p / rho^gamma that none of it falls below
    ambient_share: f32,         // Mass fraction of the second gas in the ambient state [1]
    ambient_volume: f32,        // Its volume fraction there [1]
    chemical_energy: f32,       // Energy that the explosive holds [J kg^-1]
    burn_rate: f32,             // Share of it that burns per time where a detonation passes [s^-1]
    fuel: f32,                  // What its products give where they burn on in the first gas, over that energy [1]
    air_needed: f32,            // Mass of the first gas with which they burn whole, over their own [1]
    afterburn_rate: f32,        // How fast those burn that have met enough of it [s^-1]
    densest: f32,               // Density beyond which the law of its products does not hold [kg m^-3]
    sides: u32,                 // Sides that are planes of symmetry, as bits, and from bit 8 on open sides whose nodes go with the cells before them
    products: vec4f,            // A and B [Pa], R1 and R2 times the density of the explosive [kg m^-3]
    scan: array<vec4u, SCAN_DISPATCHES>, // Groups of each dispatch of a prefix sum over all slots and one more
}
// End of what is generated.

@group(0) @binding(0) var<uniform> params: Params;

// Threads of all groups that leave partial results: how far a kernel with as many strides.
fn striding_threads() -> u32 { return params.groups * WORKGROUP; }

// -- Control --

// Generated from src/state/control.rs by scripts/generate.
struct Control {
    dt: f32,                    // What one solve spans [s]
    duration: f32,              // Current step: dt, or with two solves the span of both [s]
    dt_previous: f32,           // The step before [s]
    remaining: f32,             // Time left to the target [s]
    phase: u32,                 // PHASE_IDLE, PHASE_SOLVE, PHASE_BETWEEN, PHASE_SUBSTEP, PHASE_ELASTIC
    substeps: u32,              // Elastic sub-steps of this step
    substep: u32,               // Next one to run
    stage: u32,                 // Solves of this step that are done
    step: u32,                  // Finished steps
    fault: atomic<u32>,         // Smallest stage << 27 | slot that met an impossible value; NO_FAULT if none
    limited: array<atomic<u32>, 4>, // Cells where the flux limiter acted in each stage of the advection; last vertices whose gas could not pay for all that they asked, this step
    limited_before: u32,        // Sum of the first three when a stage ended
    floored: atomic<u32>,       // Cells where the energy floor acted, this step
    cold: atomic<u32>,          // 1 if the energy floor may have to act deep inside the gas
    raised: atomic<u32>,        // Cells whose pressure had to be raised before one of two solves, this step
    dense: atomic<u32>,         // Cells whose products are denser than their law allows, this step
    clamped: atomic<u32>,       // Particles held back at a wall, this step
    unsorted: atomic<u32>,      // 1 if a particle may have left its cell since they were sorted
    escaped: atomic<u32>,       // Particles that left through an open side or were dropped as debris, since the start
    extra: u32,                 // Vertices that carry P, h and Q apart, this step
    iterations: u32,            // Iterations of all solves of the last step
    residual: f32,              // Relative residual of the last solve
    listed: u32,                // Slots that are not INTERIOR
    frontier: u32,              // INTERIOR slots whose nodes listed vertices rest on
    surface_bound: atomic<u32>, // Of the eigenvalues of the preconditioner of interface pressures an upper bound, bits of a number
    sound: f32,                 // Largest speed of sound at the end of the step [m s^-1]
    time: f32,                  // Simulated time at the start of the step [s]
    time_error: f32,            // What rounding has taken from it so far [s]
    rounds: u32,                // Rounds of Newton's method in the elastic solve, this step
    round_open: u32,            // 1 while the linear system of a round is being solved
    newly_held: atomic<u32>,    // Nodes that a wall has begun to stop in this round
    elastic_iterations: u32,    // Iterations of all rounds, this step
    longest_round: u32,         // Iterations of the longest one
    imbalance: f32,             // r . D^-1 r at the start of this round
    borrowed: array<atomic<u32>, 8>, // Momentum and energy that the energy floor has taken from gas cells that have no ledger entry, since the start: each a number of 64 bits, the low half first, in 2^-32 of a unit
}
// End of what is generated.

// True for NaN and infinities; comparisons alone do not find a NaN on every driver.
fn is_broken(x: f32) -> bool { return (bitcast<u32>(x) & 0x7f800000u) == 0x7f800000u; }

// -- Sides --

// Generated from src/state/openings.rs by scripts/generate.
struct Opening {
    flow: vec4f,                // Density [kg m^-3] and momentum [kg m^-2 s^-1] of the state beyond; total density of a reservoir
    energy: f32,                // Total energy per volume of that state [J m^-3]
    pressure: f32,              // Pressure of that state, far or total pressure [Pa]
    rule: u32,                  // What is prescribed, RULE_* of constants::RULES
    share: f32,                 // Attenuation [1], or relaxation over the length of the domain [m^-1]
    first: u32,                 // First knot of the table of times
    knots: u32,                 // Knots of the table of times, 0 for a constant state
    species_density: f32,       // Density of the second gas in that state [kg m^-3]
    species_volume: f32,        // Its volume fraction [1]
}
// End of what is generated.

// -- Parts of arrays --

// What arrays hold, as energy[part(PREDICTED_PRESSURE, slot)]. Who writes a part, and who reads it last: docs/inside/arrays.md.

// Generated from src/state/arrays.rs by scripts/generate: number of a part, array, what it holds.
const HANDED_ENERGY = 1u; // energy: what the ledger hands on to each receiver [J]
const HALFWAY_ENERGY = 1u; // energy: halfway through the advection [J m^-3]
const PREDICTED_PRESSURE = 1u; // energy: pressure that the solve starts from [Pa]
const OPEN_PRESSURE = 1u; // energy: p0 of open faces [Pa]
const FILTER_ENERGY = 1u; // energy: what the filter changes [J m^-3]
const RECEIVERS = 2u; // energy: who receives what a solid slot hands on
const ADVECTED_ENERGY = 2u; // energy: of the advected state [J m^-3]
const INVERSE_MASS = 2u; // energy: inverse mass of gas nodes [kg^-1]
const OPEN_VELOCITY = 2u; // energy: u0 of open faces [m s^-1]
const START_ENERGY = 3u; // energy: at the start of the step [J m^-3]
const KEPT_ENERGY = 4u; // energy: what the first solve started from [J m^-3]
const START_HEAT = 5u; // energy: internal energy at the start of the step [J m^-3]
const COLD_ENERGY = 6u; // energy: what the next solve starts from, without the part that it carries [J m^-3]
const SPECIES_DENSITY = 7u; // energy: density of the second gas, with the slots of conserved [kg m^-3]
const SPECIES_VOLUME = 8u; // energy: its volume fraction; in bodies its share of the energy [1, J m^-3]
const UNBURNED = 9u; // energy: density of an explosive that has not burned [kg m^-3]
const HANDED_SPECIES_MASS = 10u; // energy: mass of the second gas that the ledger hands on to each receiver [kg]
const HALFWAY_SPECIES_DENSITY = 10u; // energy: halfway through the advection [kg m^-3]
const FILTER_SPECIES_DENSITY = 10u; // energy: what the filter changes [kg m^-3]
const HANDED_SPECIES_ENERGY = 11u; // energy: its share of the energy [J]
const HALFWAY_SPECIES_VOLUME = 11u; // energy: halfway through the advection [1]
const FILTER_SPECIES_VOLUME = 11u; // energy: what the filter changes [1]
const ADVECTED_SPECIES_DENSITY = 12u; // energy: of the advected state [kg m^-3]
const ADVECTED_SPECIES_VOLUME = 13u; // energy: of the advected state [1]
const START_SPECIES_DENSITY = 14u; // energy: at the start of the step, with two solves [kg m^-3]
const START_SPECIES_VOLUME = 15u; // energy: at the start of the step, with two solves [1]
const BURN_TIME = 16u; // energy: when a detonation comes [s]
const HALFWAY_UNBURNED = 17u; // energy: halfway through the advection [kg m^-3]
const ADVECTED_UNBURNED = 18u; // energy: of the advected state [kg m^-3]
const START_UNBURNED = 19u; // energy: at the start of the step, with two solves [kg m^-3]
const HANDED_FLOW = 0u; // work: mass and momentum that the ledger hands on to each receiver [kg, kg m s^-1]
const HALFWAY_FLOW = 0u; // work: density and momentum halfway through the advection [kg m^-3, kg m^-2 s^-1]
const FILM_PRESSURE = 0u; // work: pressure of gas films at walls, across each axis [Pa]
const GAS_NODE = 0u; // work: velocity change of gas nodes per time, of the right-hand side their velocity; w: inverse mass [m s^-2, kg^-1]
const FILTER_FLOW = 0u; // work: what the filter changes [kg m^-3, kg m^-2 s^-1]
const ELASTIC_FORCE = 1u; // work: elastic force of nodes at the start of the step [N]
const ADVECTED_FLOW = 1u; // work: density and momentum of the advected state [kg m^-3, kg m^-2 s^-1]
const LEFT_KICK = 1u; // work: velocity that light nodes leave to those around them [m s^-1]
const SOLID_NODE = 1u; // work: as GAS_NODE, of solid nodes; after the solve by the solved pressures [m s^-2, kg^-1]
const START_FLOW = 2u; // work: at the start of the step [kg m^-3, kg m^-2 s^-1]
const KEPT_FLOW = 3u; // work: what the first solve started from [kg m^-3, kg m^-2 s^-1]
const NODE_FORCE = 0u; // elastic: elastic force of nodes at the start of the step [N]
const REACTION = 0u; // elastic: reaction to the load of a node [m s^-2]
const TO_SPREAD = 0u; // elastic: acceleration to spread over the sub-steps; w: the mass that it was for [m s^-2, kg]
const KICKED_VELOCITY = 0u; // elastic: velocity after the solve; w: components that a wall stopped, as bits [m s^-1]
const ELASTIC_ACCELERATION = 0u; // elastic: of nodes at the start of the step [m s^-2]
const START_VELOCITY = 1u; // elastic: velocity and mass of nodes at the start of the step [m s^-1, kg]
const PASSED_ON = 1u; // elastic: velocity that nodes which have grown lighter pass on [m s^-1]
const OWED_SPECIES_MASS = 1u; // owed_energy: the same of the second gas [kg]
const OWED_SPECIES_ENERGY = 2u; // owed_energy: its share of the energy [J]
const LOOSE_DUST = 1u; // dust: what still lies on the ground beside the slot [kg m^-3]
const LISTED_SLOTS = 1u; // extra: slots that are not deep inside the gas; from the end the frontier, the slots whose nodes they need
const LENGTHS = 2u; // extra: lengths of both lists: LENGTH_LISTED, LENGTH_FRONTIER
const APART = 1u; // vectors: h, then Q of vertices that carry them apart; then what each vertex asks of the gas around it [Pa]
const LENGTH_LISTED = 0u;
const LENGTH_FRONTIER = 1u;
// End of what is generated.

// Place of a slot in part k of an array. Part 0 of energy is the total energy per volume: energy[slot].
fn part(k: u32, slot: u32) -> u32 { return k * params.slots + slot; }

// -- The gas --

// U = (rho, rho u, E) and what follows from them. [Cao et al. 2022, eqs. 8-9] A second gas adds its density rho Y and its volume fraction
// phi; both gases of a cell have one velocity and one pressure. [Allaire, Clerc and Kokh 2002]

struct Gas {
    flow: vec4f,    // density [kg m^-3], momentum [kg m^-2 s^-1]
    energy: f32,    // total energy per volume [J m^-3]
    species: vec2f, // of the second gas: density [kg m^-3], volume fraction [1]; 0 in scenes without one
    unburned: f32,  // of an explosive: its chemical energy per volume over that of its detonation per mass [kg m^-3]
}

// The momentum along axes that the scene has not is zero. Said where a state is loaded, so that no kernel reads it or reckons with it.
fn in_space(flow: vec4f) -> vec4f {
    if DIM == 1u { return vec4f(flow.xy, 0.0, 0.0); }
    if DIM == 2u { return vec4f(flow.xyz, 0.0); }
    return flow;
}

fn velocity_of(flow: vec4f) -> vec3f { return flow.yzw / flow.x; }
fn kinetic_energy(flow: vec4f) -> f32 { return 0.5 * dot(flow.yzw, flow.yzw) / flow.x; }
// Internal energy, without what an explosive still holds.
fn internal_energy(gas: Gas) -> f32 { return gas.energy - kinetic_energy(gas.flow) - chemical_energy_of(gas); }
// Where one gas has less than this share of volume and mass, the other counts as pure.
const PURE = 1e-3;
// gamma - 1 at a volume fraction: its inverse is linear in it, so the pressure at a contact stays as it is. [Abgrall 1996; Shyue 1998]
fn grueneisen_of(phi: f32) -> f32 {
    if !SPECIES { return params.gamma - 1.0; }
    return 1.0 / mix(1.0 / (params.gamma - 1.0), 1.0 / (params.species_gamma - 1.0), phi);
}
fn gamma_of(phi: f32) -> f32 {
    if !SPECIES { return params.gamma; }
    return 1.0 + grueneisen_of(phi);
}
// Share of the second gas in the internal energy, at a volume fraction, and back.
fn energy_share_of(phi: f32) -> f32 { return phi * grueneisen_of(phi) / (params.species_gamma - 1.0); }
// Internal energy at no pressure, with what an explosive still holds; of ideal gases 0.
fn reference_energy(gas: Gas) -> f32 {
    if !PRODUCTS { return 0.0; }
    return chemical_energy_of(gas) + cold_energy_of(gas);
}
fn pressure_of(gas: Gas) -> f32 {
    if PRODUCTS { return grueneisen_of(gas.species.y) * (internal_energy(gas) - cold_energy_of(gas)); }
    return grueneisen_of(gas.species.y) * internal_energy(gas);
}
// rho c^2 over the pressure: gamma of ideal gases.
fn stiffness_ratio(gas: Gas, pressure: f32) -> f32 {
    if PRODUCTS { return gamma_of(gas.species.y) + cold_stiffness_of(gas) / max(pressure, 1e-30); }
    return gamma_of(gas.species.y);
}
fn sound_speed(gamma: f32, density: f32, pressure: f32) -> f32 { return sqrt(gamma * max(pressure, 0.0) / density); }
fn gas_from_primitive(density: f32, velocity: vec3f, pressure: f32, species: vec2f, unburned: f32) -> Gas {
    var gas = Gas(vec4f(density, density * velocity), pressure / grueneisen_of(species.y) + 0.5 * density * dot(velocity, velocity), species, unburned);
    if PRODUCTS { gas.energy += reference_energy(gas); }
    return gas;
}

// -- Products of an explosive --

// p = f + w rho e, f the sum of A (1 - w / x) exp(-x), x = R rho_0 / r, r their density in their own volume. [Jones, Wilkins and Lee;
// UCRL-52997] What has not burned still holds its chemical energy, and has the pressure of a heavy ideal gas.
const TRACE = 1e-6; // share of the density that a gas of no volume has in it
fn expansions_of(gas: Gas) -> vec2f {
    let density = (max(gas.species.x, 0.0) + TRACE * gas.flow.x) / (max(gas.species.y, 0.0) + TRACE);
    return min(params.products.zw / clamp(density, 1e-9 * params.densest, params.densest), vec2f(80.0));
}
fn chemical_energy_of(gas: Gas) -> f32 { return select(0.0, params.chemical_energy * gas.unburned, PRODUCTS); }
// Volume fraction of what has burned.
fn products_volume(gas: Gas) -> f32 { return gas.species.y * (1.0 - clamp(gas.unburned / max(gas.species.x, 1e-30) - params.fuel, 0.0, 1.0)); }
fn cold_energy_of(gas: Gas) -> f32 {
    let w = params.species_gamma - 1.0;
    let x = expansions_of(gas);
    return -products_volume(gas) / w * dot(params.products.xy, (1.0 - w / x) * exp(-x));
}
// r f' - f: rho c^2 beyond that of ideal gases at the same pressure. [Pa]
fn cold_stiffness_of(gas: Gas) -> f32 {
    let x = expansions_of(gas);
    let share = products_volume(gas) * grueneisen_of(gas.species.y) / (params.species_gamma - 1.0);
    return share * dot(params.products.xy, (x - params.species_gamma) * exp(-x));
}

// -- Two solves per step --

// U1 = S_a(U0 + a dt A(U0)),  V = U0 + dt/2 (A(U1) + I1),  U2 = S_a(U0 + dt A(V) + (1 - a) dt I1): docs/method/two_solves.md.
const ARS_SHARE = 0.29289322;   // a: part of the step that each solve spans
const ARS_MIDDLE = 1.7071068;   // dt/2 over a dt
const ARS_LAST = 3.4142136;     // dt over a dt
const ARS_RETURNED = 2.4142136; // (1 - a) dt over a dt
