// Scalars of a solve by conjugate gradients. After it they tell the control of the step how it ended.

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
