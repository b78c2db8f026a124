// The vector kernels of the conjugate gradient method with a diagonal preconditioner. All scalars stay on the device; a zero
// entry in pcg_extents ends the iteration. [Saad 2003, algorithm 9.1]
// Two forms. Apart: residual, then direction; between them comes what a preconditioner adds to the diagonal. The solution is a step
// behind, so that the kernel which reads the direction anyway takes it along: what has converged is solution + alpha direction.
// Joined, where the diagonal is all: the operator leaves q . D^-1 q beside p . q, so that beta is known with alpha and one kernel
// takes everything along; r . z for step length and tolerance is still summed from the residual itself. [Meurant 1987]
#include "shared/pcg.wgsl"
#include "shared/reduce.wgsl"

@group(0) @binding(2) var<storage, read_write> solution: array<f32>;
@group(0) @binding(3) var<storage, read_write> residual: array<f32>;
@group(0) @binding(4) var<storage, read_write> direction: array<f32>;
@group(0) @binding(5) var<storage, read> product: array<f32>;
@group(0) @binding(6) var<storage, read> inverse_diagonal: array<f32>;
@group(0) @binding(7) var<storage, read_write> partials: array<vec4f>;

fn total_from(first: u32, lane: u32) -> vec4f {
    var sum = vec4f(0.0);
    for (var k = lane; k < pcg.groups_partial; k += WORKGROUP) { sum += partials[first + k]; }
    return workgroup_sum4(lane, sum);
}

fn total(lane: u32) -> vec4f { return total_from(0u, lane); }

// The unknowns of a thread: octets in turn, and in each one unknown or none.
fn first_unknowns(thread: u32) -> Octet { return first_octet(thread, pcg.groups_partial, pcg.row); }
fn are_left(octet: Octet) -> bool { return octet.at.y * pcg.row < pcg.length; }
fn unknown_in(octet: Octet, thread: u32) -> u32 { return element_in(octet, thread, pcg.row, pcg.length); }

// What the block's own preconditioner has left in the product's place.
fn of_block(i: u32) -> f32 {
    let within = i - pcg.block_at;
    var z = 0.0;
    for (var turn = 0u; turn < when(i >= pcg.block_at && within < pcg.block_length); turn++) { z = product[i]; }
    return z;
}

// Without the block's part, which the caller then adds to the direction and to the sum.
fn begin(i: u32) -> vec4f {
    let z = inverse_diagonal[i] * residual[i];
    solution[i] = 0.0;
    direction[i] = z;
    return vec4f(z * residual[i], select(inverse_diagonal[i] * product[i] * product[i], 0.0, pcg.reference_at != 0u), 0.0, 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn pcg_begin(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    var sum = vec4f(0.0);
    for (var octet = first_unknowns(thread); are_left(octet); octet = next_octet(octet)) {
        let i = unknown_in(octet, thread);
        if i < pcg.length { sum += begin(i); }
    }
    let part = workgroup_sum4(lane, sum);
    if lane == 0u { partials[thread / WORKGROUP] = part; }
}

@compute @workgroup_size(WORKGROUP)
fn pcg_begin_choose(@builtin(local_invocation_index) lane: u32) {
    let sum = total(lane);
    let reference = total_from(pcg.reference_at, lane);
    if lane == 0u {
        begin_iteration(sum.x, sum.x + sum.z, reference.y);
        decide();
    }
}

// Step length, and joined the weight of the old direction, from what the operator leaves. Every group finds them for itself: a kernel less.
// Joined: the new r . z is alpha^2 q . D^-1 q - rho, for z and q meet as p and q do. Sums of single precision make an error of
// 1e-7 in it, which matters as little as the old direction does then.
fn weight_before(dots: vec4f) -> f32 { return max(step_length(dots.x) * dots.y / dots.x - 1.0, 0.0); }

fn update(i: u32, alpha: f32) -> f32 {
    let r = residual[i] - alpha * product[i];
    residual[i] = r;
    return r * r * inverse_diagonal[i];
}

@compute @workgroup_size(WORKGROUP)
fn pcg_update(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let alpha = step_length(total_from(pcg.dots_at, lane).x);
    var sum = vec4f(0.0);
    for (var octet = first_unknowns(thread); are_left(octet); octet = next_octet(octet)) {
        let i = unknown_in(octet, thread);
        if i < pcg.length { sum.x += update(i, alpha); }
    }
    let part = workgroup_sum4(lane, sum);
    if lane == 0u { partials[thread / WORKGROUP] = part; }
}

@compute @workgroup_size(WORKGROUP)
fn pcg_beta(@builtin(local_invocation_index) lane: u32) {
    let dots = total_from(pcg.dots_at, lane);
    let sum = total(lane);
    // Dispatched always: it writes the table that gates the others.
    if lane == 0u && pcg.outcome == PCG_RUNNING {
        end_iteration(sum.x, sum.x + sum.z, dots.x);
        decide();
    }
}

fn turn(i: u32, alpha: f32, beta: f32) {
    let step = direction[i];
    solution[i] += alpha * step;
    direction[i] = inverse_diagonal[i] * residual[i] + of_block(i) + beta * step;
}

@compute @workgroup_size(WORKGROUP)
fn pcg_direction(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let alpha = pcg.alpha;
    let beta = pcg.beta;
    for (var octet = first_unknowns(thread); are_left(octet); octet = next_octet(octet)) {
        let i = unknown_in(octet, thread);
        if i < pcg.length { turn(i, alpha, beta); }
    }
}

// Update and direction at once, joined.
fn step(i: u32, alpha: f32, beta: f32) -> f32 {
    let old = direction[i];
    let r = residual[i] - alpha * product[i];
    let z = inverse_diagonal[i] * r;
    solution[i] += alpha * old;
    residual[i] = r;
    direction[i] = z + beta * old;
    return r * z;
}

@compute @workgroup_size(WORKGROUP)
fn pcg_step(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = thread_index(group, lane);
    let dots = total_from(pcg.dots_at, lane);
    let alpha = step_length(dots.x);
    let beta = weight_before(dots);
    var sum = vec4f(0.0);
    for (var octet = first_unknowns(thread); are_left(octet); octet = next_octet(octet)) {
        let i = unknown_in(octet, thread);
        if i < pcg.length { sum.x += step(i, alpha, beta); }
    }
    let part = workgroup_sum4(lane, sum);
    if lane == 0u { partials[thread / WORKGROUP] = part; }
}
