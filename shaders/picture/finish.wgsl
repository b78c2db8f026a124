// From light to pixels.
// finish: reads light; writes pixels, red in the lowest byte, alpha opaque: the mean of each pixel's rays.
// finish_deep: reads light; writes deep, the mean of each pixel's rays behind the tone map.

#include "picture/view.wgsl"
#include "picture/color.wgsl"

@group(0) @binding(1) var<storage, read> light: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> pixels: array<u32>;
@group(0) @binding(3) var<storage, read_write> deep: array<vec4f>;

// sRGB value of a light intensity [IEC 61966-2-1].
fn srgb_from_linear(linear: vec3f) -> vec3f {
    let clamped = clamp(linear, vec3f(0.0), vec3f(1.0));
    return select(1.055 * pow(clamped, vec3f(1.0 / 2.4)) - 0.055, 12.92 * clamped, clamped <= vec3f(0.0031308));
}

// The film's curve in its own primaries, a fit [Hill 2016, of the ACES reference].
fn aces(color: vec3f) -> vec3f {
    let seen = vec3f(dot(vec3f(0.59719, 0.35458, 0.04823), color), dot(vec3f(0.07600, 0.90834, 0.01566), color),
                     dot(vec3f(0.02840, 0.13383, 0.83777), color));
    let film = (seen * (seen + 0.0245786) - 0.000090537) / (seen * (0.983729 * seen + 0.4329510) + 0.238081);
    return vec3f(dot(vec3f(1.60475, -0.53108, -0.07367), film), dot(vec3f(-0.10208, 1.10813, -0.00605), film),
                 dot(vec3f(-0.00327, -0.07276, 1.07602), film));
}

fn toned(color: vec3f) -> vec3f {
    if view.tone == TONE_ACES {
        // The curve darkens; 1.6 brings middle grey back.
        return clamp(aces(1.6 * color), vec3f(0.0), vec3f(1.0));
    }
    return min(color, vec3f(1.0));
}

// Pixels of the band drawn now.
fn band_pixels() -> u32 {
    let n = view.supersampling;
    return view.size.x / n * (view.rows / n);
}

// Mean light of a pixel's rays, behind the tone map.
fn mean_light(i: u32) -> vec3f {
    let n = view.supersampling;
    let width = view.size.x / n;
    let place = vec2u(i % width, i / width);
    var sum = vec3f(0.0);
    for (var k = 0u; k < n * n; k++) {
        let ray = place * n + vec2u(k % n, k / n);
        sum += toned(light[ray.x + view.size.x * ray.y].rgb);
    }
    return sum / f32(n * n);
}

@compute @workgroup_size(WORKGROUP)
fn finish_deep(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i < band_pixels() { deep[i] = vec4f(mean_light(i), 1.0); }
}

@compute @workgroup_size(WORKGROUP)
fn finish(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    if i >= band_pixels() { return; }
    let n = view.supersampling;
    let width = view.size.x / n;
    let place = vec2u(i % width, i / width);
    // In dark gradients of 3D noise breaks the bands.
    let noise = hash_unit((place.x + width * (place.y + view.first_row / n)) ^ 0x9e3779b9u);
    let dither = select(0.5, noise, view.dimension == 3u);
    let levels = vec3u(srgb_from_linear(mean_light(i)) * 255.0 + dither);
    pixels[i] = levels.x | (levels.y << 8u) | (levels.z << 16u) | 0xff000000u;
}
