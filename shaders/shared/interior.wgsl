// The B1B0 stencils deep inside the gas, one axis after the other: no table, no loop. A pair of neighbours gives its difference
// along the axis it spans and its mean along every other.

fn mean2(a: f32, b: f32) -> f32 { return 0.5 * (a + b); }

// Steps from a slot along the two axes across axis n; 0 for inactive axes, whose only layer is then met twice.
fn across(n: u32) -> vec2u {
    let a = (n + 1u) % 3u;
    let b = (n + 2u) % 3u;
    return vec2u(select(0u, step_of(a), a < DIM), select(0u, step_of(b), b < DIM));
}
