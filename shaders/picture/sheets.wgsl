// Normal and colour of what a sample shows, as the kernels hand them on in `sheets`.

struct Sheet {
    normal: vec3f,
    color: vec3f,
}

// Square roots spread 10 bits like the eye does.
fn pack_color(color: vec3f) -> u32 {
    let root = vec3u(1023.0 * sqrt(clamp(color, vec3f(0.0), vec3f(1.0))) + 0.5);
    return root.r | (root.g << 10u) | (root.b << 20u);
}

fn unpack_color(packed: u32) -> vec3f {
    let root = vec3f(vec3u(packed, packed >> 10u, packed >> 20u) & vec3u(1023u)) / 1023.0;
    return root * root;
}

fn pack_sheet(s: Sheet) -> vec2u {
    // The normal on an octahedron whose lower half is folded out.
    let flat = s.normal / max(abs(s.normal.x) + abs(s.normal.y) + abs(s.normal.z), 1e-20);
    let sides = select(vec2f(-1.0), vec2f(1.0), flat.xy >= vec2f(0.0));
    let place = select(flat.xy, (1.0 - abs(flat.yx)) * sides, flat.z < 0.0);
    return vec2u(pack2x16snorm(place), pack_color(s.color));
}

fn unpack_sheet(packed: vec2u) -> Sheet {
    let place = unpack2x16snorm(packed.x);
    let low = 1.0 - abs(place.x) - abs(place.y);
    let sides = select(vec2f(-1.0), vec2f(1.0), place >= vec2f(0.0));
    let across = select(place, (1.0 - abs(place.yx)) * sides, low < 0.0);
    return Sheet(normalize(vec3f(across, low)), unpack_color(packed.y));
}
