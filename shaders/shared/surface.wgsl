// What points.wgsl left for each pixel.

struct Surface {
    // Distance along the ray [m].
    depth: f32,
    // Share of the pixel that is covered.
    coverage: f32,
    // Linear colour.
    color: vec3f,
}

fn unpack_surface(packed: vec4u) -> Surface {
    let color = vec3f(unpack2x16unorm(packed.z), unpack2x16unorm(packed.w).x);
    return Surface(bitcast<f32>(packed.x), bitcast<f32>(packed.y), color);
}
