// still: where does nothing move? Through the faces of gas at rest passes zero times something, so that it keeps its bits until the
// solve. A block of columns is still if nothing moves as far around it as its results depend on. Sides that let gas through, bodies
// and seams of periodic axes count as moving; walls and obstacles pass nothing on.
// Reads gas and cells. Writes busy: blocks in which something moves; still: those which nothing from there reaches.
#include "shared/index.wgsl"
#include "shared/cell.wgsl"
#include "shared/still.wgsl"

@group(0) @binding(2) var<storage, read> cells: array<u32>;
@group(0) @binding(3) var<storage, read> conserved: array<vec4f>;
@group(0) @binding(6) var<storage, read_write> busy: array<u32>;
@group(0) @binding(12) var<storage, read_write> still: array<u32>;

// Slots that motion gets on until the solve: three per stage of the advection (a face has three cells on each side, its carrier reaches
// less far, and the limiter cuts fluxes there but makes none), and one in the carrier of the advected state.
const SPAN = 7;

fn blocks() -> u32 {
    let rows = params.stride[DIM - 1u];
    let columns = params.slots / rows * ((rows + params.march - 1u) / params.march);
    return (columns + STILL_BLOCK - 1u) / STILL_BLOCK;
}

fn rests(slot: u32) -> bool {
    let kind = kind_of(cells[slot]);
    if PERIODIC != 0u && is_alias(cell_of(slot)) { return false; }
    return kind == WALL || (kind == GAS && all(bitcast<vec3u>(conserved[slot].yzw) == vec3u(0u)));
}

fn moves(block: u32) -> bool {
    for (var column = 0u; column < STILL_BLOCK; column++) {
        let first = march_start(STILL_BLOCK * block + column);
        for (var k = 0u; k < params.march; k++) {
            let slot = first + k * step_of(DIM - 1u);
            if slot < params.slots && !rests(slot) { return true; }
        }
    }
    return false;
}

@compute @workgroup_size(WORKGROUP)
fn still_find(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
              @builtin(local_invocation_index) lane: u32) {
    let total = groups.x * groups.y * WORKGROUP;
    for (var block = thread_index(group, groups, lane); block < blocks(); block += total) { busy[block] = u32(moves(block)); }
}

// Whether anything moves within reach of a block.
fn reached(block: u32) -> bool {
    if busy[block] == 1u { return true; }
    let size = i32(STILL_BLOCK);
    let layers = (SPAN + i32(params.march) - 1) / i32(params.march);
    let rows = select(0, SPAN, DIM == 3u);
    let beside = select(SPAN, 0, DIM == 1u);
    for (var layer = -layers; layer <= layers; layer++) {
        for (var row = -rows; row <= rows; row++) {
            let first = i32(block) * size + layer * i32(step_of(DIM - 1u)) + row * i32(params.stride.x);
            let low = max(first - beside, 0) / size;
            let high = (min(first + size + beside, i32(blocks()) * size) + size - 1) / size;
            for (var at = low; at < high; at++) { if busy[at] == 1u { return true; } }
        }
    }
    return false;
}

@compute @workgroup_size(WORKGROUP)
fn still_spread(@builtin(workgroup_id) group: vec3u, @builtin(num_workgroups) groups: vec3u,
                @builtin(local_invocation_index) lane: u32) {
    let total = groups.x * groups.y * WORKGROUP;
    for (var block = thread_index(group, groups, lane); block < blocks(); block += total) {
        still[block] = u32(params.still == 1u && !reached(block));
    }
}
