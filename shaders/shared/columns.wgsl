// Columns of cells along the last axis, in colors: of three next to each other along an axis each has another one.
#include "shared/blocks.wgsl"

// Columns along x and y.
fn columns_across() -> vec2u {
    return vec2u(select(1u, params.cells.x, DIM > 1u), select(1u, params.cells.y, DIM > 2u));
}

// The same for one color.
fn columns_of_color() -> vec2u { return (columns_across() + 2u) / 3u; }

// Marches over the columns of one color, the ring's layers included.
fn color_marches() -> u32 {
    let columns = columns_of_color();
    return columns.x * columns.y * layers();
}
