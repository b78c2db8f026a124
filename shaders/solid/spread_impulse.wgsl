// The impulse that is spread over the elastic sub-steps [elastic_reaction.wgsl].
#include "shared/index.wgsl"

// A node takes at most this times the acceleration that was meant for its mass of before.
const MOST_SPREAD = 2.0;

fn substep_time() -> f32 { return control.dt / f32(control.substeps); }
