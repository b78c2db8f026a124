// What is behind everything in 3D, and the floor: a dark studio with a plain floor, or daylight over bare earth.

// Light of the sky at the horizon and above, over that of the sky on a surface.
const HORIZON: vec3f = vec3f(1.20, 1.26, 1.32);
const ZENITH: vec3f = vec3f(0.30, 0.54, 1.00);

const STUDIO_FLOOR: vec3f = vec3f(0.060, 0.062, 0.068);
const EARTH: vec3f = vec3f(0.205, 0.165, 0.122);
const PALE_EARTH: vec3f = vec3f(0.270, 0.232, 0.182);

// Patches of the earth: their number, the largest over the longest edge of the domain, and each over the next larger one.
const PATCHES: u32 = 7u;
const LARGEST_PATCH: f32 = 0.16;
const FINER: f32 = 0.47;
// Distance at which half of the ground is lost in haze, over the longest edge of the domain.
const HAZE: f32 = 14.0;

// Whether what is behind is daylight.
override DAYLIGHT: bool = true;

fn longest_edge() -> f32 {
    let extent = vec3f(view.cells) * view.spacing;
    return max(extent.x, max(extent.y, extent.z));
}

// Light behind everything along a ray of this direction through a place of the picture.
fn behind(pixel: vec2f, direction: vec3f) -> vec3f {
    if DAYLIGHT && view.backdrop == BACKDROP_DAYLIGHT {
        let up = select(view.ground.xyz, vec3f(0.0, 0.0, 1.0), all(view.ground.xyz == vec3f(0.0)));
        let height = max(dot(up, normalize(direction)), 0.0);
        return view.sky_strength * mix(HORIZON, ZENITH, 1.0 - exp(-3.0 * height));
    }
    return mix(view.background[0].rgb, view.background[1].rgb, clamp(pixel.y / f32(view.size.y), 0.0, 1.0));
}

// A smooth random number in [-1, 1] of a place in the plane.
fn noise(place: vec2f, seed: u32) -> f32 {
    let low = floor(place);
    let part = place - low;
    let w = part * part * (3.0 - 2.0 * part);
    let cell = vec2u(vec2i(low));
    var corners = array<f32, 4>();
    for (var k = 0u; k < 4u; k++) {
        let node = cell + vec2u(k & 1u, k >> 1u);
        corners[k] = hash_unit(node.x ^ hash(node.y ^ hash(seed)));
    }
    return 2.0 * mix(mix(corners[0], corners[1], w.x), mix(corners[2], corners[3], w.x), w.y) - 1.0;
}

// Bare earth; patches smaller than what a ray covers [m] are not seen.
fn earth(point: vec3f, covered: f32) -> vec3f {
    let normal = abs(view.ground.xyz);
    let place = select(select(point.yz, point.xz, normal.y > 0.5), point.xy, normal.z > 0.5);
    var size = LARGEST_PATCH * longest_edge();
    var pale = 0.0;
    var bright = 0.0;
    for (var k = 0u; k < PATCHES; k++) {
        let seen = smoothstep(1.0, 3.0, size / max(covered, 1e-9));
        // Turned from one size to the next, so that no lattice is seen.
        let turn = 2.4 * f32(k);
        let turned = vec2f(cos(turn) * place.x - sin(turn) * place.y, sin(turn) * place.x + cos(turn) * place.y);
        let own = seen * noise(turned / size, k);
        pale += select(0.0, own, k < 3u);
        bright += own * select(0.16, 0.10, k < 2u);
        size *= FINER;
    }
    return mix(EARTH, PALE_EARTH, clamp(0.5 + 0.6 * pale, 0.0, 1.0)) * max(1.0 + bright, 0.2);
}

// Colour of the floor at a distance along a ray.
fn floor_color(point: vec3f, ray: Ray, s: f32) -> vec3f {
    if !DAYLIGHT || view.backdrop != BACKDROP_DAYLIGHT { return STUDIO_FLOOR; }
    let across = select(s, 1.0, view.parallel == 1u) * 2.0 * view.half_height / f32(view.size.y);
    return earth(point, across * inverseSqrt(max(abs(dot(ray.direction, view.ground.xyz)), 1e-4)));
}

// The floor fades into what is behind it far from the domain.
fn floor_coverage(point: vec3f, s: f32) -> f32 {
    if DAYLIGHT && view.backdrop == BACKDROP_DAYLIGHT { return exp2(-s / (HAZE * longest_edge())); }
    let away = length(point - view.origin - 0.5 * vec3f(view.cells) * view.spacing) / longest_edge();
    return 1.0 - smoothstep(0.7, 2.2, away);
}
