// What the arrays hold that several stages share: energy[part(PREDICTED_PRESSURE, slot)] is the pressure that the solve starts from.
// No other file counts places by hand. Who writes a part, and who reads it last: docs/inside/arrays.md.
#include "shared/params.wgsl"

// Generated from src/state/arrays.rs by scripts/generate: number of a part, array, what it holds.
const HANDED_ENERGY = 1u; // energy: what the ledger hands on to each receiver [J]
const STAGE_ENERGY = 1u; // energy: after a stage of the advection [J m^-3]
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
const HANDED_FLOW = 0u; // work: mass and momentum that the ledger hands on to each receiver [kg, kg m s^-1]
const STAGE_FLOW = 0u; // work: density and momentum after a stage of the advection [kg m^-3, kg m^-2 s^-1]
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
const LISTED_SLOTS = 1u; // extra: slots that are not deep inside the gas; from the end the frontier, the slots whose nodes they need
const LENGTHS = 2u; // extra: lengths of both lists: LENGTH_LISTED, LENGTH_FRONTIER
const APART = 1u; // vectors: h, then Q of vertices that carry them apart; then what each vertex asks of the gas around it [Pa]
const LENGTH_LISTED = 0u;
const LENGTH_FRONTIER = 1u;
// End of what is generated.

fn part(k: u32, slot: u32) -> u32 { return k * params.slots + slot; }

// In vectors of unknowns, behind P of every vertex: h, then Q, of the vertices that carry them apart.
fn apart_h(place: u32) -> u32 { return part(APART, place); }
fn apart_q(place: u32) -> u32 { return part(APART, params.extra_capacity + place); }
fn unknowns() -> u32 { return part(APART, 2u * params.extra_capacity); }
