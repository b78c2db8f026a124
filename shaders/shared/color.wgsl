// Colours: light is computed in linear sRGB and leaves as 8-bit sRGB.

// sRGB value of a light intensity [IEC 61966-2-1].
fn srgb_from_linear(linear: vec3f) -> vec3f {
    let light = clamp(linear, vec3f(0.0), vec3f(1.0));
    return select(1.055 * pow(light, vec3f(1.0 / 2.4)) - 0.055, 12.92 * light, light <= vec3f(0.0031308));
}

// Red in the lowest byte, alpha opaque; dither in [0, 1) breaks the bands of dark gradients.
fn packed_pixel(linear: vec3f, dither: f32) -> u32 {
    let levels = vec3u(srgb_from_linear(linear) * 255.0 + dither);
    return levels.x | (levels.y << 8u) | (levels.z << 16u) | 0xff000000u;
}

// Bits that look random and depend on the input alone [Jarzynski and Olano 2020, PCG hash].
fn hash(input: u32) -> u32 {
    let state = input * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// A number in [0, 1) from the same bits.
fn hash_unit(input: u32) -> f32 {
    return f32(hash(input) >> 8u) / 16777216.0;
}
