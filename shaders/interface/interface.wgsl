// interface: where do gas and solid meet?
// Reads sorted particles. Writes the word of every slot (kind, blocked fraction, flags), the solid volume and mean compliance
// of cells, the ghost pressure of vertices, and marks the vertices that carry P, h and Q apart.
// [Cao et al. 2022, section 2.3; a cell is solid when the bodies fill more than `solid_threshold` of it, when it and one beside it hold a
// thin wall, or when it holds a particle and nothing around it is that full or a wall: fragments]
#include "materials/stress.wgsl"
#include "shared/driven.wgsl"

@group(0) @binding(1) var<storage, read> position: array<vec4f>;
@group(0) @binding(2) var<storage, read> affine: array<vec4f>;
@group(0) @binding(3) var<storage, read> deformation: array<vec4f>;
@group(0) @binding(4) var<storage, read> velocity: array<vec4f>;
@group(0) @binding(5) var<storage, read> order: array<u32>;
@group(0) @binding(6) var<storage, read> cell_start: array<u32>;
@group(0) @binding(7) var<storage, read_write> fill: array<vec2f>; // solid volume [m^DIM], mean 1 / (lambda J) [Pa^-1], below 0: of a given motion
@group(0) @binding(8) var<storage, read_write> ghost: array<f32>;  // vertex mean of the particles' ghost pressure [Pa]

fn volume_of(p: u32) -> f32 {
    return velocity[p].w * (1.0 + swelling(deformation_of(p)));
}

fn find_fill(slot: u32) {
    let first = cell_start[slot];
    let end = cell_start[slot + 1u];
    var volume = 0.0;
    var compliance = vec2f(0.0);    // of what gives way, and of what has a given motion
    for (var i = first; i < end; i++) {
        let p = order[i];
        volume += volume_of(p);
        // A body with a given motion does not give way. A part that is held must: else its layer of vertices without compliance, on a
        // layer of nodes that is half free, has pressures that nothing bounds.
        let gives = strains(p);
        let own = 1.0 / ghost_stiffness(materials[material_index(affine[3u * p + 2u].w)], affine[3u * p].w);
        compliance += select(vec2f(0.0, own), vec2f(own, 0.0), gives);
    }
    // Below zero: that of a cell in which nothing gives way, for vertices that need it all the same [vertex_pressure].
    let mean = select(-compliance.y, compliance.x, compliance.x > 0.0) / f32(max(end - first, 1u));
    fill[slot] = vec2f(volume, mean);
}

// A march along the last axis over the four cells around each vertex: particles are read four times, not eight.
fn find_ghost(thread: u32) {
    let n = DIM - 1u;
    let step = step_of(n);
    let first = thread / step * params.march;
    var v = cell_of(thread % step);
    v[n] = 0;
    if first >= params.stride[n] || !is_vertex(v) { return; }
    // Weight and weighted ghost pressure over the ambient one (a mean of equal numbers is that number): from the layer of cells below, and to the vertex above.
    var from_below = vec2f(0.0);
    // Layers are counted with the ring, from 0.
    for (var k = max(first, 1u) - 1u; k < min(first + params.march, params.stride[n]); k++) {
        v[n] = i32(k) - 1;
        let place = vec3f(v);
        var sum = from_below;
        from_below = vec2f(0.0);
        for (var column = 0u; column < corner_count() / 2u; column++) {
            let c = v - corner_offset(column);
            if !inside(c) { continue; }
            let source = slot_of(c);
            let end = cell_start[source + 1u];
            for (var i = cell_start[source]; i < end; i++) {
                let p = order[i];
                let away = min(abs((position[p].xyz - params.origin) / params.spacing - place), vec3f(1.0));
                var w = velocity[p].w;
                for (var a = 0u; a < n; a++) { w *= 1.0 - away[a]; }
                let carried = w * vec2f(1.0, affine[3u * p].w - params.ambient_pressure);
                sum += (1.0 - away[n]) * carried;
                from_below += away[n] * carried;
            }
        }
        if k >= first && is_vertex(v) { ghost[slot_of(v)] = select(0.0, params.ambient_pressure + sum.y / sum.x, sum.x > 0.0); }
    }
}

// One slot per thread, and of every so many groups the threads march.
@compute @workgroup_size(WORKGROUP)
fn interface_fill(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let slot = thread_index(group, lane);
    if slot < params.slots && inside(cell_of(slot)) { find_fill(slot); } // the ring keeps what open faces know
    let n = DIM - 1u;
    let marching = step_of(n) * ((params.stride[n] + params.march - 1u) / params.march);
    let every = groups_of(params.slots) / groups_of(marching);
    let own = group_index(group);
    if own % every == 0u { find_ghost(own / every * WORKGROUP + lane); }
}
