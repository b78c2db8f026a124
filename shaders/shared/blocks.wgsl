// Blocks of columns along the last axis, STILL_BLOCK next to each other and params.march slots long: what a marching kernel takes one
// column per thread, so that neighbouring threads do the same.

fn columns() -> u32 { return params.slots / params.stride[DIM - 1u]; }

fn blocks_across() -> u32 { return (columns() + STILL_BLOCK - 1u) / STILL_BLOCK; }

fn layers() -> u32 { return (params.stride[DIM - 1u] + params.march - 1u) / params.march; }

// Slot at the corner of a block.
fn corner_of(block: u32) -> u32 {
    return (block / blocks_across()) * params.march * columns() + (block % blocks_across()) * STILL_BLOCK;
}
