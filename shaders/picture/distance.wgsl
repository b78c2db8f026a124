// The obstacles as a smooth surface: reads distance, their signed distance on a grid of nodes, negative inside [m].

// The nodes lie on the corners of cells, view.fineness per cell and axis.
fn distance_nodes() -> vec3u {
    return select(vec3u(1u), view.cells * view.fineness + 1u, vec3u(0u, 1u, 2u) < vec3u(view.dimension));
}

// Signed distance of a place, in cells from the low corner of the domain [m].
fn distance_at(place: vec3f) -> f32 {
    let nodes = distance_nodes();
    let at = clamp(place * f32(view.fineness), vec3f(0.0), vec3f(nodes - 1u));
    let low = min(vec3u(at), max(nodes, vec3u(2u)) - 2u);
    let w = at - vec3f(low);
    let stride = vec3u(1u, nodes.x, nodes.x * nodes.y);
    let base = dot(low, stride);
    var sum = 0.0;
    for (var corner = 0u; corner < (1u << view.dimension); corner++) {
        let offset = vec3u(corner & 1u, (corner >> 1u) & 1u, corner >> 2u);
        let share = abs(vec3f(1.0) - vec3f(offset) - w);
        var weight = share.x;
        if view.dimension > 1u { weight *= share.y; }
        if view.dimension > 2u { weight *= share.z; }
        sum += weight * distance[base + dot(offset, stride)];
    }
    return sum;
}

// Distance along a ray to the first obstacle between the ends of a span, negative if there is none [Hart 1996].
fn hit_obstacle(ray: Ray, span: vec2f) -> f32 {
    let close = 0.01 * view.spacing;
    var s = span.x;
    for (var i = 0u; i < 200u && s < span.y; i++) {
        let gap = distance_at(in_cells(ray.start + s * ray.direction));
        if gap < close { return s; }
        // Interpolation makes the distance too long near corners.
        s += max(0.8 * gap, close);
    }
    return -1.0;
}
