// Scalars of a solve by conjugate gradients, and how it goes on: step length, outcome, and the table that gates the dispatches of an
// iteration. After it the scalars tell the control of the step how it ended.

// Generated from src/numerics/pcg.rs by scripts/generate.
struct Pcg {
    rho: f32,                   // r . z, z the preconditioner times r
    alpha: f32,                 // Step length
    beta: f32,                  // Weight of the old direction
    reference: f32,             // Squared norm that the tolerance refers to
    tolerance: f32,             // Relative tolerance
    iterations: u32,            // Iterations so far
    max_iterations: u32,        // Iterations after which the solve counts as stalled
    outcome: u32,               // PCG_RUNNING, PCG_CONVERGED, PCG_STALLED
    length: u32,                // Unknowns
    near_wide: u32,             // Groups of kernels over a list that the caller keeps, x
    near_high: u32,             // The same, y
    groups_wide: u32,           // Groups of the kernels with one thread per slot, x
    groups_high: u32,           // The same, y
    groups_partial: u32,        // Groups of the kernels that leave partial sums
    groups_block: u32,          // Groups, at most as many, of the kernels of Block
    block_at: u32,              // Its first unknown
    block_length: u32,          // Its unknowns, now
    size: f32,                  // r . D^-1 r, and r . z of Block: what the tolerance looks at
    most: f32,                  // A solve that begins with a larger one is not worth it: it ends with nothing done
    levels: u32,                // Coarse levels in use
    joined: u32,                // 1 for Dots::Both
    row: u32,                   // Unknowns of a row, as sums take them
    reference_at: u32,          // Place of the partial sums for the reference, 0 if pcg_begin makes them from product
    dots_at: u32,               // Place of the partial sums that the operator leaves
    level_groups: array<u32, PCG_LEVELS>, // Groups, at most as many as leave partial sums, of the kernels of each level, the finest first; 0 without
}
// End of what is generated.

@group(0) @binding(20) var<storage, read_write> pcg: Pcg;
@group(0) @binding(21) var<storage, read_write> pcg_extents: array<vec4u>;

// -- How it goes on --

fn takes_joined() -> bool { return pcg.joined != 0u && pcg.levels == 0u; }

fn open_iteration(on: bool) {
    let keep = u32(on);
    let joined = keep * u32(takes_joined());
    pcg_extents[PCG_SLOTS] = vec4u(pcg.groups_wide, pcg.groups_high, 1u, 0u) * keep;
    pcg_extents[PCG_PARTIAL] = vec4u(pcg.groups_partial, 1u, 1u, 0u) * keep;
    pcg_extents[PCG_APART] = vec4u(pcg.groups_partial, 1u, 1u, 0u) * (keep - joined);
    pcg_extents[PCG_JOINED] = vec4u(pcg.groups_partial, 1u, 1u, 0u) * joined;
    pcg_extents[PCG_NEAR] = vec4u(pcg.near_wide, pcg.near_high, 1u, 0u) * keep;
    pcg_extents[PCG_BLOCK] = vec4u(pcg.groups_block, 1u, 1u, 0u) * keep;
    // Without levels their entries stay zero.
    for (var k = 0u; k < select(0u, PCG_LEVELS, pcg.levels > 0u); k++) { pcg_extents[PCG_LEVEL + k] = vec4u(pcg.level_groups[k], 1u, 1u, 0u) * keep; }
}

// By its bits: fast arithmetic may take every comparison with NaN for true.
fn is_no_number(x: f32) -> bool { return (bitcast<u32>(x) & 0x7f800000u) == 0x7f800000u; }

// Of one thread, after one of the two below.
fn decide() {
    pcg.outcome = PCG_RUNNING;
    if pcg.iterations == 0u && pcg.size > pcg.most { pcg.outcome = PCG_CONVERGED; }
    else if is_no_number(pcg.size) || is_no_number(pcg.rho) { pcg.outcome = PCG_STALLED; }
    else if pcg.size <= pcg.tolerance * pcg.tolerance * pcg.reference { pcg.outcome = PCG_CONVERGED; }
    else if pcg.iterations >= pcg.max_iterations || pcg.rho >= 1e38 { pcg.outcome = PCG_STALLED; }
    open_iteration(pcg.outcome == PCG_RUNNING);
}

fn step_length(dot: f32) -> f32 { return select(0.0, pcg.rho / dot, dot > 0.0); }

// Of one thread, before the first iteration: `size` as the tolerance sees it, r . z, and the squared norm that the tolerance refers to.
fn begin_iteration(size: f32, rho: f32, reference: f32) {
    pcg.size = size;
    pcg.rho = rho;
    pcg.reference = reference;
    pcg.iterations = 0u;
    pcg.alpha = 0.0;
}

// Of one thread, in an iteration; `dot`: direction . product.
fn end_iteration(size: f32, rho: f32, dot: f32) {
    if takes_joined() { pcg.alpha = 0.0; } // the solution has it
    else {
        pcg.alpha = step_length(dot);
        pcg.beta = select(0.0, rho / pcg.rho, pcg.rho > 0.0);
    }
    pcg.size = size;
    pcg.rho = rho;
    pcg.iterations += 1u;
}

// -- Order of sums --

// In which order does a sum over many elements take its terms? From this order follow its last bits.
// Neighbouring lanes take neighbouring elements: each octet of lanes its own octets of elements, the first one by its number, the next ones
// as many further as there are octets of lanes. The elements stand in rows; the last octet of a row may be partly empty.

struct Octet {
    at: vec2u,      // its number in the row, and the number of the row
    step: vec2u,    // from one to the next
    across: u32,    // octets of a row
}

// The first octet of a thread, of so many groups of threads; `row`: elements of a row.
fn first_octet(thread: u32, groups: u32, row: u32) -> Octet {
    let across = (row + OCTET - 1u) / OCTET;
    let own = thread / OCTET;
    let all = groups * (WORKGROUP / OCTET);
    return Octet(vec2u(own % across, own / across), vec2u(all % across, all / across), across);
}

fn next_octet(octet: Octet) -> Octet {
    var at = octet.at + octet.step;
    if at.x >= octet.across { at = vec2u(at.x - octet.across, at.y + 1u); }
    return Octet(at, octet.step, octet.across);
}

// Element of a thread's lane, or `none`.
fn element_in(octet: Octet, thread: u32, row: u32, none: u32) -> u32 {
    let place = OCTET * octet.at.x + thread % OCTET;
    return select(none, row * octet.at.y + place, place < row);
}
