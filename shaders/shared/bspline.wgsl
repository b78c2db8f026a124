// Quadratic B-spline of a particle over the 3^DIM nodes around its cell. On inactive axes weight 1, gradient 0.
// [Steffen et al. 2008; Jiang et al. 2016, section 5.5]

struct Spline {
    base: vec3i,            // cell that holds the particle: the middle node
    weight: mat3x3f,        // [axis][node - base + 1]
    slope: mat3x3f,         // [m^-1] the same for the derivative
}

fn spline_at(position: vec3f) -> Spline {
    var s: Spline;
    let x = (position - params.origin) / params.spacing;
    s.base = cell_at(position);
    let f = x - vec3f(s.base) - 0.5; // distance to the middle node, in cells
    s.weight = mat3x3f(weights(f.x), NO_WEIGHTS, NO_WEIGHTS);
    s.slope = mat3x3f(slopes(f.x), vec3f(0.0), vec3f(0.0));
    if DIM > 1u {
        s.weight[1] = weights(f.y);
        s.slope[1] = slopes(f.y);
    }
    if DIM > 2u {
        s.weight[2] = weights(f.z);
        s.slope[2] = slopes(f.z);
    }
    return s;
}

// Along an inactive axis.
const NO_WEIGHTS = vec3f(0.0, 1.0, 0.0);

fn weights(f: f32) -> vec3f { return vec3f(0.5 * (0.5 - f) * (0.5 - f), 0.75 - f * f, 0.5 * (0.5 + f) * (0.5 + f)); }

fn slopes(f: f32) -> vec3f { return vec3f(f - 0.5, -2.0 * f, f + 0.5) / params.spacing; }

// Weight and gradient of the node at `base + offset`.
fn spline_node(s: Spline, offset: vec3i) -> vec4f {
    let k = vec3u(offset + vec3i(1));
    let w = vec3f(s.weight[0][k.x], s.weight[1][k.y], s.weight[2][k.z]);
    let g = vec3f(s.slope[0][k.x], s.slope[1][k.y], s.slope[2][k.z]);
    return vec4f(g.x * w.y * w.z, w.x * g.y * w.z, w.x * w.y * g.z, w.x * w.y * w.z);
}

// From a particle to the node at `base + offset` [m]; zero on inactive axes, wherever the particle lies there.
fn node_distance(s: Spline, offset: vec3i, position: vec3f) -> vec3f {
    return (world_from_cell(s.base + offset) - position) * vec3f(reach());
}
