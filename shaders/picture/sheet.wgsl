// The surface of what particles make up: where the distance to the weighted mean of the particles around is half the distance of
// neighbours [Zhu and Bridson 2005]. Reads near_start, near_order, near_balls, near_reach, balls.

#include "picture/near_cubes.wgsl"
#include "picture/shard.wgsl"

// Below the first sum of weights there is nothing, so that gaps between two surfaces stay open; from the second on a surface is whole.
const LOOSE: f32 = 0.2;
const WHOLE: f32 = 0.6;
// How much farther than the surface its normals look.
const SMOOTHER: f32 = 2.0;
// Cosine between colours that differ in brightness alone.
const SAME_HUE: f32 = 0.995;

// Sums over the particles around a point.
struct Around {
    weight: f32,
    // From the mean of the particles to the point [m].
    away: vec3f,
    // Half of the distance of neighbours [m].
    half: f32,
    // The nearest particle, and its distance squared.
    nearest: u32,
    square: f32,
    // Colour of those with the hue asked for, and their weight.
    color: vec4f,
}

fn largest_reach() -> f32 { return bitcast<f32>(near_reach[0]); }

// First cube of a row and how many follow; a row that leaves the grid goes on at its other side.
fn row_part(row: u32, first: u32, count: u32, k: u32) -> vec2u {
    let before = min(count, CUBES_X - first);
    if k == 0u { return vec2u(row + first, row + first + before); }
    return vec2u(row, row + count - before);
}

// Adds what one list has. With a hue the colours of particles count, too.
fn with_list(sum: Around, first: u32, end: u32, point: vec3f, scale: f32, hue: vec3f) -> Around {
    var all = sum;
    for (var k = first; k < end; k++) {
        let ball = near_balls[k];
        let sizes = largest_reach() * unpack2x16unorm(ball.w);
        let offset = point - bitcast<vec3f>(ball.xyz);
        let square = dot(offset, offset);
        let share = 1.0 - square / (scale * scale * sizes.x * sizes.x);
        if share <= 0.0 { continue; }
        let weight = share * share * share;
        all.weight += weight;
        all.away += weight * offset;
        all.half += weight * sizes.y;
        if square < all.square {
            all.square = square;
            all.nearest = k;
        }
        if hue.x >= 0.0 {
            let color = balls[2u * particle_of(k) + 1u].rgb;
            if dot(color, hue) >= SAME_HUE * length(color) * length(hue) { all.color += weight * vec4f(color, 1.0); }
        }
    }
    return all;
}

// The largest reach of the particles around a point, 0 without any.
fn reach_around(point: vec3f) -> f32 {
    let mark = near_start[cube_count() + 1u + cube_slot(cube_at_point(point, largest_reach()))];
    return largest_reach() * f32(mark) / 65535.0;
}

fn look_around(point: vec3f, scale: f32, hue: vec3f) -> Around {
    var sum = Around(0.0, vec3f(0.0), 0.0, 0u, 1e30, vec4f(0.0));
    let reach = scale * reach_around(point);
    if reach == 0.0 { return sum; }
    let edge = 0.5 * largest_reach();
    let low = cube_at_point(point - reach, largest_reach());
    let high = cube_at_point(point + reach, largest_reach());
    let place = (point - view.origin) / edge;
    let first = cube_slot(vec3i(low.x, 0, 0));
    for (var z = low.z; z <= high.z; z++) {
        for (var y = low.y; y <= high.y; y++) {
            // Distance of the row of cubes.
            let beyond = vec2f(vec2i(y, z)) - place.yz;
            let gap = edge * max(max(beyond, -beyond - 1.0), vec2f(0.0));
            if dot(gap, gap) > reach * reach { continue; }
            let row = cube_slot(vec3i(0, y, z));
            for (var k = 0u; k < 2u; k++) {
                let part = row_part(row, first, u32(high.x - low.x + 1), k);
                if part.y > part.x { sum = with_list(sum, near_start[part.x], near_start[part.y], point, scale, hue); }
            }
        }
    }
    sum.away /= max(sum.weight, 1e-20);
    sum.half /= max(sum.weight, 1e-20);
    return sum;
}

// Positive outside, about the distance to the surface [m].
fn above_surface(sum: Around) -> f32 { return length(sum.away) - sum.half * smoothstep(LOOSE, WHOLE, sum.weight); }

// What a ray meets: its distance, negative for nothing, and the nearest particle there; the normal of a shard, zero for a surface.
struct Meeting {
    depth: f32,
    nearest: u32,
    normal: vec3f,
}

// Follows a ray from a distance on to the first surface.
fn meet_surface(ray: Ray, from_distance: f32) -> Meeting {
    let edge = 0.5 * largest_reach();
    let far = max(domain_span(ray).y, from_distance + 8.0 * edge);
    var s = from_distance;
    var before = vec2f(0.0, -1.0);
    for (var k = 0u; k < 32u && s < far; k++) {
        let sum = look_around(ray.start + s * ray.direction, 1.0, vec3f(-1.0));
        if sum.weight < 1e-4 {
            before.y = -1.0;
            s += edge;
            while s < far && reach_around(ray.start + (s + edge) * ray.direction) == 0.0 { s += edge; }
            continue;
        }
        if is_lone(sum.nearest) {
            let face = meet_shard(ray, shard_of(sum.nearest));
            if face.w > 0.0 { return Meeting(face.w, sum.nearest, face.xyz); }
            before = vec2f(s, 0.3 * edge);
            s += 0.4 * edge;
            continue;
        }
        let height = above_surface(sum);
        let towards = -dot(sum.away, ray.direction) / max(length(sum.away), 1e-20);
        let facing = max(towards, 0.7);
        if height < -0.06 * edge && before.y < 0.0 {
            // Too far: from in front again.
            s -= 0.6 * edge;
            continue;
        }
        if height < 0.06 * edge {
            if before.y > 0.0 && height < 0.0 { s = mix(before.x, s, before.y / (before.y - height)); } else { s += height / facing; }
            return Meeting(s, sum.nearest, vec3f(0.0));
        }
        before = vec2f(s, height);
        s += max(0.7 * height / facing, select(0.3, 0.7, towards < -0.2) * edge);
    }
    return Meeting(-1.0, 0u, vec3f(0.0));
}
