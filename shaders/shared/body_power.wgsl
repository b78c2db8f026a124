// Power between gas and body through the faces of the interface.
// Needs element and system, interface_indices(), face_vertices(), and the bindings control, cells, pressure, node and work.
#include "shared/arrays.wgsl"

// Means of the low and the high vertex of an axis on the node of a body at an offset from the cell between them.
fn means_of(a: u32, offset: i32) -> vec2f {
    if a >= DIM { return vec2f(1.0, 0.0); }
    return vec2f(mean_entry(true, offset, false), mean_entry(true, offset, true));
}

// Velocity of a node of a body after the solve; the mean of that and of the one that it came with, without its reaction to the
// load [elastic_reaction.wgsl]. With SHARED_VOLUME the solve starts from a predicted velocity, and the prediction is no motion.
fn body_velocity(at: u32, n: u32) -> f32 {
    return node[at][n] - select(0.5, 1.0, SHARED_VOLUME) * control.dt * work[part(SOLID_NODE, at)][n];
}

// Power through a face between gas and solid: what the solid receives.
fn interface_power(c: vec3i, n: u32, up: bool) -> f32 {
    let beyond = select(c - axis(n), c + axis(n), up);
    let a = (n + 1u) % 3u;
    let b = (n + 2u) % 3u;
    let at = interface_indices(face_vertices(select(c, beyond, up), n));
    let p = vec4f(pressure[at.x], pressure[at.y], pressure[at.z], pressure[at.w]);
    var power = 0.0;
    for (var k = -reach()[b]; k <= reach()[b]; k++) {
        let mean_b = means_of(b, k);
        for (var j = -reach()[a]; j <= reach()[a]; j++) {
            let mean_a = means_of(a, j);
            let mean = dot(mean_b, vec2f(dot(mean_a, p.xy), dot(mean_a, p.zw)));
            let away = j * axis(a) + k * axis(b);
            // A face takes a half from each of the nodes across it.
            power += 0.5 * mean * (body_velocity(slot_of(c + away), n) + body_velocity(slot_of(beyond + away), n));
        }
    }
    return power;
}
