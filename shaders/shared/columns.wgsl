// Columns of cells along the last axis, in colors: of three next to each other along an axis each has another one.

// Columns along x and y.
fn columns_across() -> vec2u {
    return vec2u(select(1u, params.cells.x, DIM > 1u), select(1u, params.cells.y, DIM > 2u));
}

// The same for one color.
fn columns_of_color() -> vec2u { return (columns_across() + 2u) / 3u; }
