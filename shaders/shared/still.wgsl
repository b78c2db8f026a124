// Rows of the blocks of columns, as still.wgsl marks them. The binding extra holds a word per block: bit k of its low half tells that gas
// moves near row k before the solve, bit k of the high half that the row is awake.
#include "shared/blocks.wgsl"

fn block_rows(block: u32) -> u32 { return extra[params.still_at + block]; }

// Rows of a thread's column near which gas moves before the solve, and those that are awake.
fn moving_rows(thread: u32) -> u32 { return block_rows(thread / STILL_BLOCK) & 0xffffu; }
fn awake_rows(thread: u32) -> u32 { return block_rows(thread / STILL_BLOCK) >> 16u; }

// First of some rows, and the one after the last.
fn row_span(rows: u32) -> vec2u { return select(vec2u(0u), vec2u(countTrailingZeros(rows), 32u - countLeadingZeros(rows)), rows != 0u); }

// Whether nothing moves near a slot before the solve.
fn is_still(slot: u32) -> bool {
    let row = slot / columns();
    let block = row / params.march * blocks_across() + slot % columns() / STILL_BLOCK;
    return ((block_rows(block) >> (row % params.march)) & 1u) == 0u;
}
