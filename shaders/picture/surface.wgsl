// The surface that a ray meets, as the kernels hand it on: `surface` has that of bodies of each ray of the band, in 3D then what stands still.

struct Surface {
    // Distance along the ray [m].
    depth: f32,
    // Share of the ray's place that is covered; 0 for nothing.
    coverage: f32,
    // Light, linear.
    color: vec3f,
}

// Light up to this is kept.
const BRIGHTEST: f32 = 32.0;

fn unpack_surface(packed: vec4u) -> Surface {
    let root = vec3f(unpack2x16unorm(packed.z), unpack2x16unorm(packed.w).x);
    return Surface(bitcast<f32>(packed.x), bitcast<f32>(packed.y), BRIGHTEST * root * root);
}

// Square roots spread 16 bits like the eye does.
fn pack_surface(s: Surface) -> vec4u {
    let root = sqrt(max(s.color, vec3f(0.0)) / BRIGHTEST);
    return vec4u(bitcast<u32>(s.depth), bitcast<u32>(s.coverage), pack2x16unorm(root.rg), pack2x16unorm(vec2f(root.b, 0.0)));
}

// Where `surface` has what stands still, in 3D.
fn solid_place(i: u32) -> u32 { return arrayLength(&surface) / 2u + i; }
