// Where rays meet the surface of what particles make up; samples in blocks of two by two.
// trace_coarse: as trace_first, of every other block along both axes.
// trace_first: reads what near.wgsl writes. depth_bits of the first sample of each block goes from the depth of the balls in the block to that
// of the surface, those of the others to that of the balls. Writes kept, the nearest particle there; its colour into sheets; and listed, the
// workgroups of a dispatch and samples to shade.
// look_sheets: reads listed, as samples, and the same; writes sheets, the normal and the colour of each, and of those that share them.
// trace_beside: as trace_first for the other samples of each block, of which the first has its sheet.

#include "picture/view.wgsl"
#include "picture/samples.wgsl"

@group(0) @binding(1) var<storage, read> near_reach: array<u32>;
@group(0) @binding(2) var<storage, read> near_start: array<u32>;
@group(0) @binding(3) var<storage, read> near_names: array<vec2u>;
@group(0) @binding(4) var<storage, read> near_balls: array<vec4u>;
@group(0) @binding(5) var<storage, read_write> depth_bits: array<u32>;
@group(0) @binding(6) var<storage, read_write> kept: array<u32>;
@group(0) @binding(7) var<storage, read_write> sheets: array<vec2u>;
@group(0) @binding(8) var<storage, read_write> listed: array<atomic<u32>>;
@group(0) @binding(9) var<storage, read> samples: array<u32>;

#include "picture/sheet.wgsl"
#include "picture/sheets.wgsl"

// Numbers before the entries of a list: the workgroups of its dispatch, then how many entries it has.
const LIST_HEAD: u32 = 4u;
// Bits of a sample in an entry; those of the block that share its sheet follow, the first one left out.
const SAMPLE_BITS: u32 = 28u;

fn index_of(place: vec2u) -> u32 { return place.x + sample_grid().x * place.y; }

// The first sample of a block of the band; beyond the last one it is below the band.
fn first_of(i: u32) -> vec2u {
    let across = (sample_grid().x + 1u) / 2u;
    // Threads are shared out in halves, so every other row of blocks is in the first.
    let rows = (view.rows * view.samples + 1u) / 2u;
    let half = (rows + 1u) / 2u;
    let row = i / across;
    let own = select(2u * row, 2u * (row - half) + 1u, row >= half);
    return vec2u(2u * (i % across), 2u * select(rows, own, row < rows) + SAMPLE_MARGIN);
}

fn is_in_band(place: vec2u) -> bool { return all(place < vec2u(sample_grid().x, SAMPLE_MARGIN + view.rows * view.samples)); }

// Another sample of a block, 1 beside the first, 2 below it, 3 opposite.
fn other_of(first: vec2u, k: u32) -> vec2u { return first + vec2u(k & 1u, k >> 1u); }

// Depth of the ball or the surface in a sample, negative for none.
fn depth_at(place: vec2u) -> f32 {
    let bits = depth_bits[index_of(place)];
    return select(bitcast<f32>(FARTHEST - bits), -1.0, bits == NOTHING);
}

fn ball_at(place: vec2u) -> f32 {
    if !is_in_band(place) { return -1.0; }
    return depth_at(place);
}

fn list_sample(place: vec2u, sharing: u32) {
    let slot = atomicAdd(&listed[3], 1u);
    let groups = groups_of(slot + 1u);
    atomicMax(&listed[0], min(groups, MAX_GROUPS));
    atomicMax(&listed[1], (groups + MAX_GROUPS - 1u) / MAX_GROUPS);
    atomicStore(&listed[LIST_HEAD + slot], index_of(place) | (sharing << SAMPLE_BITS));
}

// How much the normals of broken particles are those of shards.
const ROUGHNESS: f32 = 0.5;

// What a sample shows: its depth, negative for nothing; the particle as `kept` has it; and its sheet, for which look_sheets takes the place of
// the particle in the lists and what near_names has of it. A sheet of a shard has the bit LONE above its colour.
struct Seen {
    depth: f32,
    kept: u32,
    sheet: vec2u,
}

const NOTHING_SEEN: Seen = Seen(-1.0, NOTHING, vec2u(0u));

fn see(ray: Ray, from_distance: f32) -> Seen {
    let met = meet_surface(ray, from_distance);
    if met.depth < 0.0 { return NOTHING_SEEN; }
    let nearest = near_names[met.nearest];
    var sheet = vec2u(met.nearest, nearest.x);
    if (nearest.x & LONE) != 0u { sheet = pack_sheet(Sheet(met.normal, unpack_color(nearest.x))) | vec2u(0u, LONE); }
    return Seen(met.depth, FARTHEST - nearest.y, sheet);
}

fn is_shard(seen: Seen) -> bool { return (seen.sheet.y & LONE) != 0u; }

fn write_sample(place: vec2u, seen: Seen) {
    let i = index_of(place);
    depth_bits[i] = select(NOTHING, FARTHEST - bitcast<u32>(seen.depth), seen.depth > 0.0);
    kept[i] = seen.kept;
    sheets[i] = seen.sheet;
}

// Samples across the largest reach from which on what lies between blocks that show nothing shows nothing: bodies are wider.
const WIDE_REACH: f32 = 18.0;

fn sample_width(depth: f32) -> f32 {
    return 2.0 * view.half_height / f32(view.size.y * view.samples) * select(depth, 1.0, view.parallel == 1u);
}

// Distance between the first samples of coarse blocks.
const COARSE: u32 = 4u;

// The coarse blocks beside a block along an axis: itself, or the ones before and behind it.
fn beside_along(place: u32) -> vec2u { return vec2u(place, place + COARSE - 1u) / COARSE * COARSE; }

// Whether a coarse block around a block shows something, or is not known.
fn is_near_shown(place: vec2u) -> bool {
    let columns = beside_along(place.x);
    let rows = beside_along(place.y - SAMPLE_MARGIN) + SAMPLE_MARGIN;
    var shown = false;
    for (var k = 0u; k < 4u; k++) {
        let coarse = vec2u(columns[k & 1u], rows[k >> 1u]);
        if !is_in_band(coarse) || depth_at(coarse) > 0.0 { shown = true; }
    }
    return shown;
}

fn is_coarse(place: vec2u) -> bool { return all((place - vec2u(0u, SAMPLE_MARGIN)) % COARSE == vec2u(0u)); }

@compute @workgroup_size(WORKGROUP)
fn trace_coarse(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, local);
    let across = (sample_grid().x + COARSE - 1u) / COARSE;
    let place = COARSE * vec2u(i % across, i / across) + vec2u(0u, SAMPLE_MARGIN);
    if is_in_band(place) { trace_block(place, true); }
}

@compute @workgroup_size(WORKGROUP)
fn trace_first(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let place = first_of(thread_index(workgroup, local));
    if !is_in_band(place) || is_coarse(place) { return; }
    let is_wide = largest_reach() > WIDE_REACH * sample_width(depth_at(place));
    trace_block(place, !is_wide || is_near_shown(place));
}

fn trace_block(place: vec2u, wanted: bool) {
    let ball = depth_at(place);
    if ball <= 0.0 { return; }
    for (var k = 1u; k < 4u; k++) {
        let other = other_of(place, k);
        if is_in_band(other) { depth_bits[index_of(other)] = depth_bits[index_of(place)]; }
    }
    if !wanted { write_sample(place, NOTHING_SEEN); }
    for (var turn = 0u; turn < when(wanted); turn++) {
        let seen = see(sample_ray(place), ball);
        write_sample(place, seen);
        if seen.depth > 0.0 && !is_shard(seen) { list_sample(place, 0u); }
    }
}

@compute @workgroup_size(WORKGROUP)
fn look_sheets(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let entry = thread_index(workgroup, local);
    if entry >= samples[3] { return; }
    let packed = samples[LIST_HEAD + entry];
    let i = packed & ((1u << SAMPLE_BITS) - 1u);
    let place = vec2u(i % sample_grid().x, i / sample_grid().x);
    let ray = sample_ray(place);
    let near = sheets[i];
    let own = unpack_color(near.y);
    let point = ray.start + depth_at(place) * ray.direction;
    let sum = look_around(point, SMOOTHER, own);
    let color = select(own, sum.color.rgb / sum.color.w, sum.color.w > 0.0);
    // A surface that is seen at its edge is not seen from behind.
    let away = sum.away - max(dot(sum.away, ray.direction), 0.0) * ray.direction;
    var normal = away / max(length(away), 1e-20);
    for (var turn = 0u; turn < when((near.y & BROKEN) != 0u); turn++) {
        normal = normalize(normal + ROUGHNESS * face_towards(point, shard_of(near.x)));
    }
    let sheet = pack_sheet(Sheet(normal, color));
    sheets[i] = sheet;
    let first = place & vec2u(0xfffffffeu);
    for (var k = 1u; k < 4u; k++) {
        if ((packed >> (SAMPLE_BITS + k)) & 1u) == 1u { sheets[index_of(other_of(first, k))] = sheet; }
    }
}

// Distance to the plane that touches a surface where a ray meets it at a depth.
fn beside(depth: f32, normal: vec3f, ray: Ray, other: Ray) -> f32 {
    let point = ray.start + depth * ray.direction;
    return dot(point - other.start, normal) / dot(other.direction, normal);
}

// Cosine between ray and surface above which the samples beside it show the same surface: it may end within them below.
fn steepest(depth: f32) -> f32 {
    return sqrt(clamp(4.0 * sample_width(depth) / largest_reach(), 0.06, 0.9));
}

// Share of the largest reach by which samples of one surface differ in depth at most.
const SAME_SURFACE: f32 = 0.3;
// Share of it between ball and surface at most, seen from in front.
const BALL_TO_SURFACE: f32 = 0.6;

// Where two samples at opposite corners show nothing, so do the others. A sample whose depth is near that of the one before has its sheet.
fn trace_others(corner: vec2u) {
    let ray = sample_ray(corner);
    let first = Seen(depth_at(corner), kept[index_of(corner)], sheets[index_of(corner)]);
    let normal = unpack_sheet(first.sheet).normal;
    let is_whole = first.depth > 0.0 && !is_shard(first);
    let is_flat = is_whole && -dot(normal, ray.direction) > steepest(first.depth);
    // Depth of the sample before, 0 of a shard, and the sample whose sheet it has; four bits for each sample: those that share its sheet.
    var known = select(first.depth, 0.0, is_shard(first));
    var owner = 0u;
    var sharing = 0u;
    var shown = true;
    for (var turn = 0u; turn < 3u; turn++) {
        let k = select(turn, 3u, turn == 0u);
        let place = other_of(corner, k);
        let ball = ball_at(place);
        if ball < 0.0 { continue; }
        let other = sample_ray(place);
        var touching = -1.0;
        if is_whole { touching = beside(first.depth, normal, ray, other); }
        var seen = NOTHING_SEEN;
        if shown && is_flat && touching > ball {
            seen = Seen(touching, first.kept, first.sheet);
            owner = 0u;
        } else if shown {
            let is_near = touching > ball && touching < ball + BALL_TO_SURFACE * largest_reach();
            seen = see(other, select(ball, touching, is_near));
            if seen.depth > 0.0 && !is_shard(seen) {
                if known <= 0.0 || abs(seen.depth - known) >= SAME_SURFACE * largest_reach() { owner = k; }
                if owner == 0u { seen.sheet = first.sheet; } else { sharing |= (1u << k) << (4u * owner); }
            }
        }
        write_sample(place, seen);
        if seen.depth > 0.0 { known = select(seen.depth, 0.0, is_shard(seen)); }
        if turn == 0u { shown = known >= 0.0; }
    }
    for (var k = 1u; k < 4u; k++) {
        let own = (sharing >> (4u * k)) & 15u;
        if own != 0u { list_sample(other_of(corner, k), own); }
    }
}

@compute @workgroup_size(WORKGROUP)
fn trace_beside(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let corner = first_of(thread_index(workgroup, local));
    if !is_in_band(corner) { return; }
    let balls = vec3f(ball_at(other_of(corner, 1u)), ball_at(other_of(corner, 2u)), ball_at(other_of(corner, 3u)));
    let around = vec4f(depth_at(corner), ball_at(corner + vec2u(2u, 0u)), ball_at(corner + vec2u(0u, 2u)), ball_at(corner + vec2u(2u, 2u)));
    let met = any(around > vec4f(0.0));
    let close = any(balls > vec3f(0.0));
    for (var turn = 0u; turn < when(close && met); turn++) { trace_others(corner); }
    for (var k = 1u; k <= 3u * when(close && !met); k++) {
        if is_in_band(other_of(corner, k)) { write_sample(other_of(corner, k), NOTHING_SEEN); }
    }
}
