// Rays that differences of density bend: reads bends, how far each of a grid of rays has left its straight line at a row of distances.

// Whether gas bends rays.
override REFRACTION: bool = false;

// Where the ray through a place has come to at each distance, across the view axis [m].
var<private> offsets: array<vec2f, BEND_KNOTS + 1u>;
var<private> is_bent: bool;

// Rays in the grid of those that are followed.
fn bend_grid() -> vec2u { return view.size / view.bend_pitch + 2u; }

// Distances at which offsets are known: from the near end of the ball around the domain to its far end.
fn bend_distance(knot: u32) -> f32 {
    return mix(view.bend_near, view.bend_far, f32(knot) / f32(BEND_KNOTS));
}

// Reads the offsets of the ray through a place of the picture, in rays.
fn read_bend(pixel: vec2f) {
    is_bent = false;
    if !REFRACTION { return; }
    let grid = bend_grid();
    let place = clamp(pixel / f32(view.bend_pitch), vec2f(0.0), vec2f(grid) - 1.001);
    let low = vec2u(place);
    let w = place - vec2f(low);
    offsets[0] = vec2f(0.0);
    for (var knot = 0u; knot < BEND_KNOTS; knot++) {
        var sum = vec2f(0.0);
        for (var corner = 0u; corner < 4u; corner++) {
            let offset = vec2u(corner & 1u, corner >> 1u);
            let share = abs(1.0 - vec2f(offset) - w);
            let node = low.x + offset.x + grid.x * (low.y + offset.y);
            sum += share.x * share.y * bends[BEND_KNOTS * node + knot];
        }
        offsets[knot + 1u] = view.spacing * sum;
    }
    // A hundredth of a cell is not seen.
    let last = offsets[BEND_KNOTS];
    is_bent = dot(last, last) > 1e-4 * view.spacing * view.spacing;
}

// Stretches of a ray: what lies before the first distance, then one between each two; the last goes on for ever.
const STRETCHES: u32 = BEND_KNOTS + 1u;

// A straight stretch: at a distance s along the ray, up to `end`, the light is at start + s direction.
struct Stretch {
    ray: Ray,
    end: f32,
}

fn stretch(ray: Ray, number: u32) -> Stretch {
    if !is_bent { return Stretch(ray, 1e30); }
    if number == 0u { return Stretch(ray, view.bend_near); }
    let slope = (offsets[number] - offsets[number - 1u]) / (bend_distance(1u) - bend_distance(0u));
    let start = offsets[number - 1u] - slope * bend_distance(number - 1u);
    let part = Ray(ray.start + start.x * view.right + start.y * view.up,
                   ray.direction + slope.x * view.right + slope.y * view.up);
    return Stretch(part, select(bend_distance(number), 1e30, number == BEND_KNOTS));
}

// Offset at a distance.
fn offset_at(s: f32) -> vec3f {
    if !is_bent { return vec3f(0.0); }
    let from_near = max(s - view.bend_near, 0.0) / (view.bend_far - view.bend_near) * f32(BEND_KNOTS);
    let knot = min(u32(from_near), BEND_KNOTS - 1u);
    let offset = mix(offsets[knot], offsets[knot + 1u], from_near - f32(knot));
    return offset.x * view.right + offset.y * view.up;
}

// Where a ray that has left the domain behind seems to come from: its place in the picture, in rays, and its direction.
struct Beyond {
    pixel: vec2f,
    direction: vec3f,
}

fn beyond(pixel: vec2f, ray: Ray) -> Beyond {
    if !is_bent { return Beyond(pixel, ray.direction); }
    let last = stretch(ray, STRETCHES - 1u).ray.direction;
    if view.parallel == 1u { return Beyond(pixel, last); }
    let size = vec2f(view.size);
    let offset = vec2f(dot(last, view.right), -dot(last, view.up)) / (dot(last, view.forward) * view.half_height);
    return Beyond(0.5 * size + offset * 0.5 * size.y, last);
}
