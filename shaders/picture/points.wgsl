// Particles as balls, in the plane as strained squares: the nearest one in each sample of the band. A ray's place has view.samples x view.samples samples.
// measure: reads position, velocity, affine, deformation, stress, heat; writes quantity, what the colours mean.
// find_particle_range: reads quantity; writes the least and largest value that each workgroup saw.
// mix_paint: reads quantity, position, velocity, affine, deformation, colors, names; writes balls: place and radius, 0 for what is not
// drawn; then colour, and the factor by which the ball is drawn larger where balls are smoothed into a surface.
// splat_depth: reads balls, deformation; raises depth_bits to the nearest ball.
// splat_nearest: reads the same and depth_bits; writes nearest, the lowest particle index at that depth.

#include "shared/reduce.wgsl"
#include "picture/view.wgsl"
#include "picture/samples.wgsl"
#include "picture/growth.wgsl"

@group(0) @binding(1) var<storage, read> position: array<vec4f>;
@group(0) @binding(2) var<storage, read> velocity: array<vec4f>;
@group(0) @binding(3) var<storage, read> affine: array<vec4f>;
@group(0) @binding(4) var<storage, read> deformation: array<vec4f>;
@group(0) @binding(5) var<storage, read> stress: array<vec4f>;
@group(0) @binding(6) var<storage, read> heat: array<f32>;
@group(0) @binding(7) var<storage, read> colors: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> quantity: array<f32>;
@group(0) @binding(9) var<storage, read_write> ranges: array<vec2f>;
@group(0) @binding(10) var<storage, read_write> balls: array<vec4f>;
@group(0) @binding(11) var<storage, read_write> depth_bits: array<atomic<u32>>;
@group(0) @binding(12) var<storage, read_write> nearest: array<atomic<u32>>;
@group(0) @binding(13) var<storage, read> names: array<vec4f>;

// Colours of `names` that are those of bodies; those of materials follow.
override BODIES: u32 = 0u;

// Two kernels may round the same depth differently; this many units in the last place count as equal.
const DEPTH_SLACK: u32 = 64u;

// Whether the scene is in the plane.
override FLAT: bool = true;

// Samples along the edge of a square that has one depth, the nearest, in its first sample: that of balls which only say where rays to a
// surface begin.
override SHARED: u32 = 1u;

// Samples from the middle of a ball that are looked at, at most.
const MAX_REACH: f32 = 2000.0;

// Norm of the deviatoric part of the Cauchy stress [Pa].
fn deviatoric_stress(p: u32) -> f32 {
    let a = deformation[3u * p].xyz + vec3f(1.0, 0.0, 0.0);     // columns of F
    let b = deformation[3u * p + 1u].xyz + vec3f(0.0, 1.0, 0.0);
    let c = deformation[3u * p + 2u].xyz + vec3f(0.0, 0.0, 1.0);
    let volume = velocity[p].w * dot(a, cross(b, c));
    let normal = stress[2u * p].xyz;
    let shear = stress[2u * p + 1u].xyz;
    let deviator = normal - (normal.x + normal.y + normal.z) / 3.0;
    return sqrt(dot(deviator, deviator) + 2.0 * dot(shear, shear)) / max(volume, 1e-30);
}

// Mean p / rho of the gas in the cell of a particle and around, NO_VALUE where there is none.
fn gas_around(p: u32) -> f32 {
    let cell = vec3i(floor(in_cells(position[p].xyz)));
    var sum = 0.0;
    var count = 0.0;
    for (var i = 0u; i < 27u; i++) {
        let near = cell + vec3i(vec3u(i % 3u, (i / 3u) % 3u, i / 9u)) - 1;
        if all(near >= vec3i(0)) && all(near < vec3i(view.cells)) {
            let seen = heat[u32(near.x) + view.cells.x * (u32(near.y) + view.cells.y * u32(near.z))];
            if seen != NO_VALUE {
                sum += seen;
                count += 1.0;
            }
        }
    }
    return select(NO_VALUE, sum / max(count, 1.0), count > 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn measure(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, local);
    if p >= view.particles { return; }
    var result = NO_VALUE;
    if deformation[3u * p + 1u].w != 0.0 {
        switch (view.particle_color) {
            case PARTICLE_SPEED: { result = length(velocity[p].xyz); }
            case PARTICLE_DEVIATORIC_STRESS: { result = deviatoric_stress(p); }
            case PARTICLE_PLASTIC_STRAIN: { result = affine[3u * p + 1u].w; }
            case PARTICLE_DAMAGE: { result = deformation[3u * p + 2u].w; }
            case PARTICLE_TEMPERATURE: { result = gas_around(p); }
            default: {}
        }
    }
    // The comparison is false for NaN.
    quantity[p] = select(NO_VALUE, result, abs(result) < -NO_VALUE);
}

@compute @workgroup_size(WORKGROUP)
fn find_particle_range(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    var low = -NO_VALUE;
    var high = NO_VALUE;
    for (var p = thread_index(workgroup, local); p < view.particles; p += RANGE_GROUPS * WORKGROUP) {
        let seen = quantity[p];
        if seen != NO_VALUE {
            low = min(low, seen);
            high = max(high, seen);
        }
    }
    low = workgroup_min(local, low);
    high = workgroup_max(local, high);
    if local == 0u { ranges[workgroup.x] = vec2f(low, high); }
}

// The elastic stretch is that of the deformation; plastic flow leaves its strain alone. Cracks stay open.
fn growth(p: u32) -> f32 {
    if view.smooth_skin == 0u || deformation[3u * p + 2u].w > 0.5 {
        return select(1.0, CLOSING, view.smooth_skin == 1u);
    }
    let a = deformation[3u * p].xyz + vec3f(1.0, 0.0, 0.0);     // columns of F
    let b = deformation[3u * p + 1u].xyz + vec3f(0.0, 1.0, 0.0);
    let c = deformation[3u * p + 2u].xyz + vec3f(0.0, 0.0, 1.0);
    let elastic = sqrt(max(dot(a, a), max(dot(b, b), dot(c, c))));
    let plastic = exp(clamp(affine[3u * p + 1u].w, 0.0, 1.5));
    return min(CLOSING * max(elastic * plastic, 1.0), MOST_GROWTH);
}

@compute @workgroup_size(WORKGROUP)
fn mix_paint(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, local);
    if p >= view.particles { return; }
    var color = vec3f(0.0);
    let body = bitcast<u32>(deformation[3u * p].w);
    if view.particle_color == PARTICLE_BODY || view.particle_color == PARTICLE_MATERIAL {
        let material = bitcast<u32>(affine[3u * p + 2u].w) & 0xffffu;
        let name = select(BODIES + material, body, view.particle_color == PARTICLE_BODY);
        let plastic_strain = affine[3u * p + 1u].w;
        color = names[name].rgb / (1.0 + max(plastic_strain, 0.0) / view.dark_strain);
    } else {
        let fraction = clamp((quantity[p] - view.particle_low) / (view.particle_high - view.particle_low), 0.0, 1.0);
        color = colors[2u * COLOR_COUNT + u32(fraction * f32(COLOR_COUNT - 1u) + 0.5)].rgb;
    }
    let radius = view.particle_scale * pow(velocity[p].w, 1.0 / f32(view.dimension));
    let unseen = deformation[3u * p + 1u].w == 0.0 || names[body].w == 0.0;
    balls[2u * p] = vec4f(position[p].xyz, select(radius, 0.0, unseen));
    balls[2u * p + 1u] = vec4f(color, growth(p));
}

struct Footprint {
    centre: vec3f,
    radius: f32,
    // The middle in samples of the band, the radius in samples, and the distance from where rays start [m].
    middle: vec2f,
    samples: f32,
    distance: f32,
    // Samples from low to below high, empty if the particle is not seen.
    low: vec2i,
    high: vec2i,
    // In the plane: rows of the map from an offset in samples to the particle's square at rest, of half edge 1.
    to_square: vec4f,
    // And the radius of a disc around the middle over `radius`.
    disc: f32,
}

// Half the edge of a particle's square over its disc's radius, with some overlap.
const HALF_EDGE: f32 = 0.81;

// Fills in what a particle in the plane covers, and how many samples it reaches: its square at rest as the deformation strains it, and a disc
// for what flows plastically, which the deformation does not tell.
fn square_of(p: u32, given: Footprint) -> Footprint {
    var mark = given;
    var a = deformation[3u * p].xy + vec2f(1.0, 0.0);     // columns of F
    var b = deformation[3u * p + 1u].xy + vec2f(0.0, 1.0);
    let size = dot(a, a) + dot(b, b);
    // What is crushed or torn beyond telling is drawn as at rest.
    if a.x * b.y - a.y * b.x <= 0.02 * size || size > 60.0 {
        a = vec2f(1.0, 0.0);
        b = vec2f(0.0, 1.0);
    }
    let area = a.x * b.y - a.y * b.x;
    mark.disc = min(1.0, 1.41421356 * area / sqrt(dot(a, a) + dot(b, b)));
    // Rows of the picture run downwards.
    mark.to_square = vec4f(b.y, b.x, -a.y, -a.x) / (area * HALF_EDGE * max(mark.samples, 1e-6));
    return mark;
}

// Share of the way from the middle of a particle in the plane to its edge; 1 and more outside.
fn share_of_square(mark: Footprint, offset: vec2f) -> f32 {
    let place = abs(vec2f(dot(mark.to_square.xy, offset), dot(mark.to_square.zw, offset)));
    return min(max(place.x, place.y), length(offset) / (mark.disc * mark.samples));
}

fn footprint(p: u32) -> Footprint {
    let ball = balls[2u * p];
    var mark = Footprint(ball.xyz, ball.w * balls[2u * p + 1u].w, vec2f(0.0), 0.0, 0.0, vec2i(0), vec2i(0), vec4f(0.0), 1.0);
    let place = project(mark.centre);
    if mark.radius == 0.0 || (place.z <= mark.radius && view.parallel == 0u) { return mark; }
    let per_metre = 0.5 * f32(view.size.y) * f32(view.samples) / view.half_height;
    mark.middle = place.xy * f32(view.samples) - vec2f(0.0, f32(sample_top()));
    mark.samples = mark.radius * per_metre / select(place.z, 1.0, view.parallel == 1u);
    mark.distance = select(length(mark.centre - view.eye), place.z, view.parallel == 1u);
    // Perspective stretches balls towards the corners of the picture.
    let near = select(place.z - mark.radius, 1.0, view.parallel == 1u);
    let stretched = min(1.2 * mark.radius * per_metre / near + 1.0, MAX_REACH);
    var reach = select(mark.samples, stretched, mark.samples > LARGE);
    if FLAT {
        mark = square_of(p, mark);
        let sides = abs(deformation[3u * p].xy) + abs(deformation[3u * p + 1u].xy) + 1.0;
        reach = min(mark.samples * max(1.0, HALF_EDGE * max(sides.x, sides.y)), MAX_REACH);
    }
    let limit = vec2f(sample_grid());
    mark.low = vec2i(clamp(mark.middle - reach, vec2f(0.0), limit));
    mark.high = vec2i(clamp(mark.middle + reach + 1.0, vec2f(0.0), limit));
    return mark;
}

// Balls of more samples than this are seen along the line of sight of each sample.
const LARGE: f32 = 12.0;

// Depth of a large ball in a sample, negative if it is missed [m].
fn depth_of_large(mark: Footprint, place: vec2u) -> f32 { return hit_sphere(sample_ray(place), mark.centre, mark.radius); }

// The same of any other one. Its outline is round, and its depth that of a ball seen along its own line of sight.
fn depth_of_small(mark: Footprint, place: vec2u) -> f32 {
    let nearest = clamp(mark.middle, vec2f(place), vec2f(place + SHARED));
    let offset = select(vec2f(place) + 0.5, nearest, SHARED > 1u) - mark.middle;
    if FLAT {
        let share = share_of_square(mark, offset);
        return select(-1.0, mark.distance + mark.radius * share, share < 1.0);
    }
    let inside = 1.0 - dot(offset, offset) / (mark.samples * mark.samples);
    return select(-1.0, mark.distance - mark.radius * sqrt(max(inside, 0.0)), inside >= 0.0);
}

fn is_large(mark: Footprint) -> bool { return !FLAT && mark.samples > LARGE; }

// Positive floats order like their bits.
fn raise_depth(place: vec2u, depth: f32) {
    let first = place / SHARED * SHARED;
    let i = first.x + sample_grid().x * first.y;
    let bits = FARTHEST - bitcast<u32>(depth);
    if depth > 0.0 && bits > atomicLoad(&depth_bits[i]) { atomicMax(&depth_bits[i], bits); }
}

fn raise_nearest(place: vec2u, depth: f32, p: u32) {
    let i = place.x + sample_grid().x * place.y;
    if depth > 0.0 && FARTHEST - bitcast<u32>(depth) + DEPTH_SLACK >= atomicLoad(&depth_bits[i]) {
        atomicMax(&nearest[i], FARTHEST - p);
    }
}

// The first sample that a particle may cover, and number of samples `step` apart; looked at row by row. Large balls have a loop of their own,
// because software computes both branches of a condition.
fn first_sample(mark: Footprint, step: u32) -> vec2u { return vec2u(mark.low) / step * step; }

fn count_of(mark: Footprint, step: u32, large: bool) -> u32 {
    let size = (vec2u(max(mark.high, mark.low)) - first_sample(mark, step) + step - 1u) / step;
    return select(0u, size.x * size.y, is_large(mark) == large && all(mark.high > mark.low));
}

fn next_sample(mark: Footprint, place: vec2u, step: u32) -> vec2u {
    let right = place.x + step;
    return select(vec2u(right, place.y), vec2u(first_sample(mark, step).x, place.y + step), right >= u32(mark.high.x));
}

@compute @workgroup_size(WORKGROUP)
fn splat_depth(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, local);
    if p >= view.particles { return; }
    let mark = footprint(p);
    var place = first_sample(mark, SHARED);
    for (var left = count_of(mark, SHARED, false); left > 0u; left--) {
        raise_depth(place, depth_of_small(mark, place));
        place = next_sample(mark, place, SHARED);
    }
    place = vec2u(mark.low);
    for (var left = count_of(mark, 1u, true); left > 0u; left--) {
        raise_depth(place, depth_of_large(mark, place));
        place = next_sample(mark, place, 1u);
    }
}

@compute @workgroup_size(WORKGROUP)
fn splat_nearest(@builtin(workgroup_id) workgroup: vec3u, @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, local);
    if p >= view.particles { return; }
    let mark = footprint(p);
    var place = vec2u(mark.low);
    for (var left = count_of(mark, 1u, false); left > 0u; left--) {
        raise_nearest(place, depth_of_small(mark, place), p);
        place = next_sample(mark, place, 1u);
    }
    for (var left = count_of(mark, 1u, true); left > 0u; left--) {
        raise_nearest(place, depth_of_large(mark, place), p);
        place = next_sample(mark, place, 1u);
    }
}
