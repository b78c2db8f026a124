// Rows of the blocks of columns, as still.wgsl marks them: row k of a block is its STILL_BLOCK slots at place k of the march. The binding extra holds a word per block: bit k tells that gas moves near row k
// before the solve.
#include "shared/blocks.wgsl"

fn block_rows(block: u32) -> u32 { return extra[params.still_at + block]; }

// Rows of a thread's column to compute: the first, and the one after the last. `all`: whatever moves.
fn moving_rows(thread: u32, all: bool) -> vec2u {
    if all { return vec2u(0u, params.march); }
    let rows = block_rows(thread / STILL_BLOCK);
    return select(vec2u(0u), vec2u(countTrailingZeros(rows), 32u - countLeadingZeros(rows)), rows != 0u);
}

// Whether nothing moves near a slot before the solve.
fn is_still(slot: u32) -> bool {
    let row = slot / columns();
    let rows = block_rows(row / params.march * blocks_across() + slot % columns() / STILL_BLOCK);
    return ((rows >> (row % params.march)) & 1u) == 0u;
}
