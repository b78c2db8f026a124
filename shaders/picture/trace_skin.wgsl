// Where rays meet the surface of what particles make up.
// trace_skin: reads balls and what near.wgsl writes; depth_bits goes from the depths of balls to those of the surface; writes kept, the
// nearest particle there, and sheets, the normal and the colour of each sample.

#include "picture/view.wgsl"
#include "picture/samples.wgsl"

@group(0) @binding(1) var<storage, read> balls: array<vec4f>;
@group(0) @binding(2) var<storage, read> near_reach: array<u32>;
@group(0) @binding(3) var<storage, read> near_start: array<u32>;
@group(0) @binding(4) var<storage, read> near_order: array<u32>;
@group(0) @binding(5) var<storage, read> near_balls: array<vec4u>;
@group(0) @binding(6) var<storage, read_write> depth_bits: array<u32>;
@group(0) @binding(7) var<storage, read_write> kept: array<u32>;
@group(0) @binding(8) var<storage, read_write> sheets: array<vec2u>;

#include "picture/sheet.wgsl"
#include "picture/sheets.wgsl"

// What a sample shows.
struct Seen {
    depth: f32,
    particle: u32,
    // Whether it is a shard.
    alone: bool,
    sheet: Sheet,
}

// How much the normals of broken particles are those of shards.
const ROUGHNESS: f32 = 0.5;

fn nothing_seen() -> Seen { return Seen(-1.0, 0u, false, Sheet(vec3f(0.0), vec3f(0.0))); }

// Depth of the ball in a sample, negative for none.
fn ball_depth(place: vec2u) -> f32 {
    let bits = depth_bits[place.x + sample_grid().x * place.y];
    return select(bitcast<f32>(FARTHEST - bits), -1.0, bits == NOTHING);
}

// What a ray shows; a sample beside it that shows the same surface has its normal and colour.
fn see(ray: Ray, ball: f32, known: Seen) -> Seen {
    let met = meet_surface(ray, ball);
    if met.depth < 0.0 { return nothing_seen(); }
    let p = particle_of(met.nearest);
    let own = balls[2u * p + 1u].rgb;
    if is_lone(met.nearest) { return Seen(met.depth, p, true, Sheet(met.normal, own)); }
    if known.depth > 0.0 && !known.alone && abs(met.depth - known.depth) < 0.3 * largest_reach() {
        return Seen(met.depth, p, false, known.sheet);
    }
    let sum = look_around(ray.start + met.depth * ray.direction, SMOOTHER, own);
    let color = select(own, sum.color.rgb / sum.color.w, sum.color.w > 0.0);
    // A surface that is seen at its edge is not seen from behind.
    let away = sum.away - max(dot(sum.away, ray.direction), 0.0) * ray.direction;
    var normal = away / max(length(away), 1e-20);
    if is_broken(met.nearest) {
        let face = face_towards(ray.start + met.depth * ray.direction, shard_of(met.nearest));
        normal = normalize(normal + ROUGHNESS * face);
    }
    return Seen(met.depth, p, false, Sheet(normal, color));
}

// Distance to the plane that touches a surface.
fn beside(first: Seen, ray: Ray, other: Ray) -> f32 {
    let point = ray.start + first.depth * ray.direction;
    return dot(point - other.start, first.sheet.normal) / dot(other.direction, first.sheet.normal);
}

// Cosine between ray and surface above which the samples beside it show the same surface: it may end within them below.
fn steepest(first: Seen) -> f32 {
    let width = 2.0 * view.half_height / f32(view.size.y * view.samples) * select(first.depth, 1.0, view.parallel == 1u);
    return sqrt(clamp(4.0 * width / largest_reach(), 0.06, 0.9));
}

fn write_sample(place: vec2u, seen: Seen) {
    let i = place.x + sample_grid().x * place.y;
    depth_bits[i] = select(NOTHING, FARTHEST - bitcast<u32>(seen.depth), seen.depth > 0.0);
    kept[i] = select(NOTHING, FARTHEST - seen.particle, seen.depth > 0.0);
    sheets[i] = pack_sheet(seen.sheet);
}

// What another sample of the same two by two shows, of which the first shows what is given.
fn see_beside(place: vec2u, corner: vec2u, first: Seen, known: Seen) -> Seen {
    let ball = ball_depth(place);
    if ball < 0.0 { return nothing_seen(); }
    let ray = sample_ray(corner);
    let other = sample_ray(place);
    if first.depth > 0.0 && !first.alone && -dot(first.sheet.normal, ray.direction) > steepest(first) {
        let depth = beside(first, ray, other);
        if depth > ball { return Seen(depth, first.particle, false, first.sheet); }
    }
    return see(other, ball, known);
}

// Each thread has two by two samples of the band; where two at opposite corners show nothing, so do the others.
@compute @workgroup_size(WORKGROUP)
fn trace_skin(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    let grid = sample_grid();
    let across = (grid.x + 1u) / 2u;
    let rows = view.rows * view.samples;
    if i >= across * ((rows + 1u) / 2u) { return; }
    let corner = 2u * vec2u(i % across, i / across) + vec2u(0u, SAMPLE_MARGIN);
    let end = vec2u(grid.x, SAMPLE_MARGIN + rows);
    let ball = ball_depth(corner);
    var first = nothing_seen();
    if ball > 0.0 { first = see(sample_ray(corner), ball, first); }
    write_sample(corner, first);
    var known = first;
    var shown = true;
    for (var k = 0u; k < 3u; k++) {
        let place = corner + vec2u(u32(k != 2u), u32(k != 1u));
        if any(place >= end) { continue; }
        var seen = nothing_seen();
        if shown { seen = see_beside(place, corner, first, known); }
        write_sample(place, seen);
        if seen.depth > 0.0 { known = seen; }
        if k == 0u { shown = known.depth > 0.0; }
    }
}
