// The surface of what particles make up: where the distance to the weighted mean of the particles around is half the distance of
// neighbours [Zhu and Bridson 2005]. Reads near_start, near_balls, near_names, near_reach.

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

fn nothing_around() -> Around { return Around(0.0, vec3f(0.0), 0.0, 0u, 1e30, vec4f(0.0)); }

fn largest_reach() -> f32 { return bitcast<f32>(near_reach[0]); }

// Adds one particle of the lists. With a hue the colours of particles count, too.
fn with_particle(sum: Around, k: u32, point: vec3f, widening: f32, hue: vec3f) -> Around {
    var all = sum;
    let ball = near_balls[k];
    let sizes = unpack2x16unorm(ball.w);
    let offset = point - bitcast<vec3f>(ball.xyz);
    let square = dot(offset, offset);
    let share = max(1.0 - widening * square / (sizes.x * sizes.x), 0.0);
    let weight = share * share * share;
    all.weight += weight;
    all.away += weight * offset;
    all.half += weight * sizes.y;
    if share > 0.0 && square < all.square {
        all.square = square;
        all.nearest = k;
    }
    if hue.x >= 0.0 {
        let color = unpack_color(near_names[k].x);
        let along = dot(color, hue);
        let limit = SAME_HUE * SAME_HUE * dot(color, color) * dot(hue, hue);
        all.color += select(0.0, weight, along * along >= limit) * vec4f(color, 1.0);
    }
    return all;
}

// The largest reach of the particles around a point, 0 without any.
fn reach_around(point: vec3f) -> f32 {
    let mark = near_start[cube_count() + 1u + cube_slot(cube_at_point(point, largest_reach()))];
    return largest_reach() * f32(mark) / 65535.0;
}

fn look_around(point: vec3f, scale: f32, hue: vec3f) -> Around {
    var sum = nothing_around();
    // In cubes.
    let reach = scale * reach_around(point) / largest_reach();
    if reach == 0.0 { return sum; }
    let place = (point - view.origin) / largest_reach();
    let widening = 1.0 / (scale * scale * largest_reach() * largest_reach());
    let low = vec2i(floor(place.yz - reach));
    let high = vec2i(floor(place.yz + reach));
    for (var z = low.y; z <= high.y; z++) {
        for (var y = low.x; y <= high.x; y++) {
            // Distance of the row of cubes, and how far along it particles may be near.
            let beyond = vec2f(vec2i(y, z)) - place.yz;
            let gap = max(max(beyond, -beyond - 1.0), vec2f(0.0));
            let along = sqrt(max(reach * reach - dot(gap, gap), 0.0));
            let begin = i32(floor(place.x - along));
            var left = select(0u, u32(i32(floor(place.x + along)) - begin + 1), along > 0.0);
            var first = cube_slot(vec3i(begin, y, z));
            // A row that leaves the grid goes on at its other side.
            while left > 0u {
                let count = min(left, CUBES_X - first % CUBES_X);
                let end = near_start[first + count];
                for (var k = near_start[first]; k < end; k++) { sum = with_particle(sum, k, point, widening, hue); }
                left -= count;
                first -= first % CUBES_X;
            }
        }
    }
    sum.away /= max(sum.weight, 1e-20);
    sum.half *= largest_reach() / max(sum.weight, 1e-20);
    return sum;
}

// Positive outside, about the distance to the surface [m].
fn above_surface(sum: Around) -> f32 { return length(sum.away) - sum.half * smoothstep(LOOSE, WHOLE, sum.weight); }

// What a ray meets: its distance, negative for nothing; the place in the lists of the nearest particle there; the normal of a shard, zero for
// a surface.
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
        let alone = is_lone(sum.nearest);
        var face = vec4f(-1.0);
        for (var turn = 0u; turn < when(alone); turn++) { face = meet_shard(ray, shard_of(sum.nearest)); }
        if face.w > 0.0 { return Meeting(face.w, sum.nearest, face.xyz); }
        if alone {
            before = vec2f(s, 0.3 * edge);
            s += 0.4 * edge;
            continue;
        }
        let height = above_surface(sum);
        let towards = -dot(sum.away, ray.direction) / max(length(sum.away), 1e-20);
        let facing = max(towards, 0.4);
        if height < -0.06 * edge && before.y < 0.0 {
            // Too far: from in front again.
            s -= 0.6 * edge;
            continue;
        }
        if height < 0.06 * edge {
            if before.y > height { s += clamp(height * (s - before.x) / (before.y - height), before.x - s, 0.3 * edge); } else { s += height / facing; }
            return Meeting(s, sum.nearest, vec3f(0.0));
        }
        before = vec2f(s, height);
        s += max(0.9 * height / facing, select(0.5, 1.0, towards < -0.2) * edge);
    }
    return Meeting(-1.0, 0u, vec3f(0.0));
}
