// p2g: what do the solids look like on the grid?
// Form by columns, for software devices: each thread marches along the last axis, takes in the particles of one column of cells, and adds
// them to the nodes of that column and of those beside it. Columns are colored: of three next to each other along an axis only one is in a
// dispatch, so no two threads share a node. The colors follow one another in a fixed order: equal bits on every run.
// Reads particles, order. Writes node (velocity, mass). On return the sums of mass and momentum are the particles'.
// With WITH_FORCE it leaves the elastic force [N] in the part ELASTIC_FORCE of work instead. [Jiang et al. 2015; Cao et al. 2022, section 2.2]
#include "shared/index.wgsl"
#include "solid/place.wgsl"
#include "solid/transfer.wgsl"

@group(0) @binding(9) var<uniform> color: vec4u;                    // first column of the color along x and y, 0 to 2

// What a particle gives to the node at `offset`: the product of its weights times `constant`, and for each axis the product with
// the second factor of that axis in place of the weight, times `along` of the axis.
// Mass and momentum: w m (v + C (x_node - x_p)); the second factor is w times the offset, in cells.
// Force: -vol0 tau grad w; the second factor is the slope of w. With it the driver of fracture, w m driver. [materials/stress.wgsl]
struct Share { constant: vec4f, along: mat3x4f, second: mat3x3f }

// `x`: position and mass of the particle.
fn share_of(p: u32, x: vec4f, place: Place) -> Share {
    var share: Share;
    if WITH_FORCE {
        let d = stress[2u * p].xyz;         // xx, yy, zz of vol0 tau [J]
        let o = stress[2u * p + 1u].xyz;    // xy, yz, zx
        share.constant = vec4f(0.0);
        if WITH_DRIVER { share.constant.w = x.w * stress[2u * p + 1u].w; }
        share.along = mat3x4f(vec4f(-d.x, -o.x, -o.z, 0.0), vec4f(-o.x, -d.y, -o.y, 0.0), vec4f(-o.z, -o.y, -d.z, 0.0));
        share.second = place.slope;
    } else {
        let c = mat3x3f(affine[3u * p].xyz, affine[3u * p + 1u].xyz, affine[3u * p + 2u].xyz);
        let scale = x.w * params.spacing;
        share.constant = vec4f(x.w * velocity[p].xyz - scale * (c * place.center), x.w);
        share.along = mat3x4f(vec4f(scale * c[0], 0.0), vec4f(scale * c[1], 0.0), vec4f(scale * c[2], 0.0));
        share.second = place.moment;
    }
    return share;
}

// Sums of the nodes of one layer across the march: rows along y, of three nodes along x.
struct Layer { low: mat3x4f, middle: mat3x4f, high: mat3x4f }

// One row of a layer: `even` times the weights `w` along x, and `odd` times their second factors.
fn row_of(even: vec4f, odd: vec4f, w: vec3f, second: vec3f) -> mat3x4f {
    if DIM == 1u { return mat3x4f(vec4f(0.0), even, vec4f(0.0)); }
    return mat3x4f(w.x * even + second.x * odd, w.y * even + second.y * odd, w.z * even + second.z * odd);
}

// One layer with the share of a particle that has weight `w` and second factor `second` along the march.
fn with_share(layer: Layer, share: Share, place: Place, w: f32, second: f32) -> Layer {
    let constant = w * share.constant + second * share.along[DIM - 1u];
    let along_x = w * share.along[0];
    let x = place.weight[0];
    let x_second = share.second[0];
    var sum = layer;
    if DIM < 3u {
        sum.middle += row_of(constant, along_x, x, x_second);
    } else {
        let along_y = w * share.along[1];
        let y = place.weight[1];
        let y_second = share.second[1];
        sum.low += row_of(y.x * constant + y_second.x * along_y, y.x * along_x, x, x_second);
        sum.middle += row_of(y.y * constant + y_second.y * along_y, y.y * along_x, x, x_second);
        sum.high += row_of(y.z * constant + y_second.z * along_y, y.z * along_x, x, x_second);
    }
    return sum;
}

fn add_to(slot: u32, value: vec4f) {
    if WITH_FORCE { work[part(ELASTIC_FORCE, slot)] += value; } else { node[slot] += value; }
}

fn add_row(slot: u32, row: mat3x4f) {
    if DIM > 1u { add_to(slot - 1u, row[0]); }
    add_to(slot, row[1]);
    if DIM > 1u { add_to(slot + 1u, row[2]); }
}

fn add_layer(slot: u32, layer: Layer) {
    if DIM > 2u { add_row(slot - params.stride.x, layer.low); }
    add_row(slot, layer.middle);
    if DIM > 2u { add_row(slot + params.stride.x, layer.high); }
}

@compute @workgroup_size(WORKGROUP)
fn p2g_clear(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    if WITH_FORCE { work[part(ELASTIC_FORCE, slot)] = vec4f(0.0); } else { node[slot] = vec4f(0.0); }
}

// The index of a thread, but with octets of threads from everywhere: particles lie close together, and a software driver gives each of its
// threads as many workgroups in a row, so that one of them would get most of the work.
fn spread_index(workgroup: vec3u, local: u32, threads: u32) -> u32 {
    let first = group_index(workgroup);
    let all = groups_of(threads);
    if first >= all { return first * WORKGROUP + local; }
    return OCTET * (local / OCTET * all + first) + local % OCTET;
}

@compute @workgroup_size(WORKGROUP)
fn p2g_gather(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let thread = spread_index(group, lane, color_marches());
    let across = columns_across();
    let wide = columns_of_color();
    let column = 3u * vec2u(thread % wide.x, (thread / wide.x) % wide.y) + color.xy;
    let layers = params.cells[DIM - 1u];
    // Layers are counted with the ring, from 0; cells of the ring hold no particles.
    let first = thread / (wide.x * wide.y) * params.march;
    if any(column >= across) || first >= layers + 2u { return; }
    let end = min(first + params.march, layers + 2u);
    let step = step_of(DIM - 1u);
    var cell = vec3i(vec3u(column, 0u)) * vec3i(i32(DIM > 1u), i32(DIM > 2u), 0);
    let bottom = slot_of(cell) - step;
    var below = Layer();
    var level = Layer();
    var touched = vec2u(0u);    // particles of the two cell layers before: without any, a layer has nothing to add
    // The particles of layer k reach the nodes of layers k - 1, k and k + 1: node layer k - 1 is complete after cell layer k.
    for (var k = max(first, 1u) - 1u; k <= end; k++) {
        let slot = bottom + k * step;
        var above = Layer();
        var i = 0u;
        var last = 0u;
        if k >= 1u && k <= layers {
            i = cell_start[slot];
            last = cell_start[slot + 1u];
        }
        cell[DIM - 1u] = i32(k) - 1;
        let middle = vec3f(cell) + 0.5;
        let found = last - i;
        for (; i < last; i++) {
            let p = order[i];
            let x = position[p];
            let place = place_at(x.xyz, middle);
            let share = share_of(p, x, place);
            let w = place.weight[DIM - 1u];
            let second = share.second[DIM - 1u];
            below = with_share(below, share, place, w.x, second.x);
            level = with_share(level, share, place, w.y, second.y);
            above = with_share(above, share, place, w.z, second.z);
        }
        if k > first && found + touched.x + touched.y > 0u { add_layer(slot - step, below); }
        touched = vec2u(touched.y, found);
        below = level;
        level = above;
    }
}

// Momentum becomes velocity.
@compute @workgroup_size(WORKGROUP)
fn p2g_finish(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot >= params.slots { return; }
    let sum = node[slot];
    node[slot] = vec4f(select(vec3f(0.0), sum.xyz / sum.w, sum.w > 0.0), sum.w);
}
