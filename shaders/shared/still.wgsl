// Blocks of columns of marching kernels in which all gas stays at rest until the solve (see still.wgsl). A thread takes one column of
// params.march slots along the last axis; the columns of a block lie next to each other, so that neighbouring threads do the same.
// Needs the binding still: a word per block of STILL_BLOCK columns.

fn march_start(thread: u32) -> u32 {
    let s = step_of(DIM - 1u);
    return (thread / s) * params.march * s + thread % s;
}

fn is_still(thread: u32) -> bool { return still[thread / STILL_BLOCK] == 1u; }
