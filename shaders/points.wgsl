// Particles as balls: the nearest one in each sample of the band. A ray's place has view.samples x view.samples samples.
// measure: reads position, velocity, affine, deformation, stress, heat; writes quantity, what the colours mean.
// find_particle_range: reads quantity; writes the least and largest value that each workgroup saw.
// mix_paint: reads quantity, velocity, affine, deformation, colors; writes paint: colour and radius, 0 for what is not drawn.
// clear_samples: writes depth_bits, nearest: nothing seen.
// splat_depth: reads position, paint; lowers depth_bits to the nearest ball.
// splat_nearest: reads the same and depth_bits; writes nearest, the lowest particle index at that depth.

#include "shared/thread.wgsl"
#include "shared/reduce.wgsl"
#include "shared/view.wgsl"
#include "shared/samples.wgsl"

@group(0) @binding(1) var<storage, read> position: array<vec4f>;
@group(0) @binding(2) var<storage, read> velocity: array<vec4f>;
@group(0) @binding(3) var<storage, read> affine: array<vec4f>;
@group(0) @binding(4) var<storage, read> deformation: array<vec4f>;
@group(0) @binding(5) var<storage, read> stress: array<vec4f>;
@group(0) @binding(6) var<storage, read> heat: array<f32>;
@group(0) @binding(7) var<storage, read> colors: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> quantity: array<f32>;
@group(0) @binding(9) var<storage, read_write> ranges: array<vec2f>;
@group(0) @binding(10) var<storage, read_write> paint: array<vec4f>;
@group(0) @binding(11) var<storage, read_write> depth_bits: array<atomic<u32>>;
@group(0) @binding(12) var<storage, read_write> nearest: array<atomic<u32>>;

// Two kernels may round the same depth differently; this many units in the last place count as equal.
const DEPTH_SLACK: u32 = 64u;

// Samples from the middle of a ball that are looked at, at most: a ball in front of the eye would fill the picture.
const MAX_REACH: f32 = 400.0;

// Norm of the deviatoric part of the Cauchy stress [Pa].
fn deviatoric_stress(p: u32) -> f32 {
    let a = deformation[3u * p].xyz;
    let b = deformation[3u * p + 1u].xyz;
    let c = deformation[3u * p + 2u].xyz;
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
        if (all(near >= vec3i(0)) && all(near < vec3i(view.cells))) {
            let seen = heat[u32(near.x) + view.cells.x * (u32(near.y) + view.cells.y * u32(near.z))];
            if (seen != NO_VALUE) {
                sum += seen;
                count += 1.0;
            }
        }
    }
    return select(NO_VALUE, sum / max(count, 1.0), count > 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn measure(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
           @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, groups, local);
    if (p >= view.particles) {
        return;
    }
    var result = NO_VALUE;
    if (deformation[3u * p + 1u].w != 0.0) {
        switch (view.particle_color) {
            case PARTICLE_SPEED: { result = length(velocity[p].xyz); }
            case PARTICLE_DEVIATORIC_STRESS: { result = deviatoric_stress(p); }
            case PARTICLE_PLASTIC_STRAIN: { result = affine[3u * p + 1u].w; }
            case PARTICLE_TEMPERATURE: { result = gas_around(p); }
            default: {}
        }
    }
    // The comparison is false for NaN.
    quantity[p] = select(NO_VALUE, result, abs(result) < -NO_VALUE);
}

@compute @workgroup_size(WORKGROUP)
fn find_particle_range(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
                       @builtin(local_invocation_index) local: u32) {
    var low = -NO_VALUE;
    var high = NO_VALUE;
    for (var p = thread_index(workgroup, groups, local); p < view.particles; p += groups.x * WORKGROUP) {
        let seen = quantity[p];
        if (seen != NO_VALUE) {
            low = min(low, seen);
            high = max(high, seen);
        }
    }
    low = workgroup_min(local, low);
    high = workgroup_max(local, high);
    if (local == 0u) {
        ranges[workgroup.x] = vec2f(low, high);
    }
}

@compute @workgroup_size(WORKGROUP)
fn mix_paint(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
             @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, groups, local);
    if (p >= view.particles) {
        return;
    }
    var color = vec3f(0.0);
    if (view.particle_color == PARTICLE_BODY) {
        let body = bitcast<u32>(deformation[3u * p].w);
        let plastic_strain = affine[3u * p + 1u].w;
        color = BODY_COLORS[body % BODY_COLOR_COUNT] / (1.0 + max(plastic_strain, 0.0) / view.dark_strain);
    } else {
        let fraction = clamp((quantity[p] - view.particle_low) / (view.particle_high - view.particle_low), 0.0, 1.0);
        color = colors[2u * COLOR_COUNT + u32(fraction * f32(COLOR_COUNT - 1u) + 0.5)].rgb;
    }
    let radius = view.particle_scale * pow(velocity[p].w, 1.0 / f32(view.dimension));
    paint[p] = vec4f(color, select(radius, 0.0, deformation[3u * p + 1u].w == 0.0));
}

struct Footprint {
    centre: vec3f,
    radius: f32,
    // Samples from low to below high, empty if the particle is not seen.
    low: vec2i,
    high: vec2i,
}

fn footprint(p: u32) -> Footprint {
    var mark = Footprint(position[p].xyz, paint[p].w, vec2i(0), vec2i(0));
    let place = project(mark.centre);
    if (mark.radius == 0.0 || (place.z <= mark.radius && view.parallel == 0u)) {
        return mark;
    }
    let distance = select(place.z - mark.radius, 1.0, view.parallel == 1u);
    let reach = min(1.2 * mark.radius / (distance * view.half_height) * 0.5 * f32(view.size.y) + 1.0, MAX_REACH);
    let limit = vec2f(sample_grid());
    let first = vec2f(0.0, f32(sample_top()));
    let scale = f32(view.samples);
    mark.low = vec2i(clamp((place.xy - reach) * scale - first, vec2f(0.0), limit));
    mark.high = vec2i(clamp((place.xy + reach) * scale + 1.0 - first, vec2f(0.0), limit));
    return mark;
}

@compute @workgroup_size(WORKGROUP)
fn clear_samples(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
                 @builtin(local_invocation_index) local: u32) {
    let i = thread_index(workgroup, groups, local);
    let samples = sample_grid();
    if (i < samples.x * samples.y) {
        atomicStore(&depth_bits[i], NOTHING);
        atomicStore(&nearest[i], NOTHING);
    }
}

@compute @workgroup_size(WORKGROUP)
fn splat_depth(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
               @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, groups, local);
    if (p >= view.particles) {
        return;
    }
    let mark = footprint(p);
    for (var y = mark.low.y; y < mark.high.y; y++) {
        for (var x = mark.low.x; x < mark.high.x; x++) {
            let place = vec2u(vec2i(x, y));
            let depth = hit_sphere(sample_ray(place), mark.centre, mark.radius);
            if (depth > 0.0) {
                // Positive floats order like their bits.
                atomicMin(&depth_bits[place.x + sample_grid().x * place.y], bitcast<u32>(depth));
            }
        }
    }
}

@compute @workgroup_size(WORKGROUP)
fn splat_nearest(@builtin(workgroup_id) workgroup: vec3u, @builtin(num_workgroups) groups: vec3u,
                 @builtin(local_invocation_index) local: u32) {
    let p = thread_index(workgroup, groups, local);
    if (p >= view.particles) {
        return;
    }
    let mark = footprint(p);
    for (var y = mark.low.y; y < mark.high.y; y++) {
        for (var x = mark.low.x; x < mark.high.x; x++) {
            let place = vec2u(vec2i(x, y));
            let depth = hit_sphere(sample_ray(place), mark.centre, mark.radius);
            let i = place.x + sample_grid().x * place.y;
            if (depth > 0.0 && bitcast<u32>(depth) <= atomicLoad(&depth_bits[i]) + DEPTH_SLACK) {
                atomicMin(&nearest[i], p);
            }
        }
    }
}
