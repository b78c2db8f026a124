// Rows of the blocks of columns, as still.wgsl marks them. The binding extra holds a word per block: bit k of its low half tells that gas
// moves near row k before the solve, bit k of the high half that the row is awake.
#include "shared/blocks.wgsl"

fn block_rows(block: u32) -> u32 { return extra[params.still_at + block]; }

// Rows of a thread's column near which gas moves before the solve, and those that are awake.
fn moving_rows(thread: u32) -> u32 { return block_rows(thread / STILL_BLOCK) & 0xffffu; }
fn awake_rows(thread: u32) -> u32 { return block_rows(thread / STILL_BLOCK) >> 16u; }

// First of some rows, and the one after the last.
fn row_span(rows: u32) -> vec2u { return select(vec2u(0u), vec2u(countTrailingZeros(rows), 32u - countLeadingZeros(rows)), rows != 0u); }

// The two bits of a slot's row, at places 0 and 16.
fn row_bits(slot: u32) -> u32 {
    let row = slot / columns();
    return block_rows(row / params.march * blocks_across() + slot % columns() / STILL_BLOCK) >> (row % params.march);
}

// Whether nothing moves near a slot before the solve.
fn is_still(slot: u32) -> bool { return (row_bits(slot) & 1u) == 0u; }

fn is_awake(slot: u32) -> bool { return (row_bits(slot) & 0x10000u) != 0u; }
