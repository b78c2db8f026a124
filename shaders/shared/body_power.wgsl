// Power between gas and body through the faces of the interface, and the internal energy that goes with it.
// Needs element and system, interface_indices(), face_vertices(), face_pressure(), and the bindings control, cells, pressure, node and work.

// Means of the low and the high vertex of an axis on the node of a body at an offset from the cell between them.
fn means_of(a: u32, offset: i32) -> vec2f {
    if a >= DIM { return vec2f(1.0, 0.0); }
    return vec2f(mean_entry(true, offset, false), mean_entry(true, offset, true));
}

// Velocity of a node of a body after the solve; with MIDPOINT_POWER the mean of the old and the new one.
fn body_velocity(at: u32, n: u32) -> f32 {
    return node[at][n] - select(1.0, 0.5, MIDPOINT_POWER) * control.dt * work[params.slots + at][n];
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

// The advection has carried internal energy through a face between gas and body with the velocity of before the solve. Gas that follows
// a body half a step late drives its vibrations, so half of what the body gains in the solve carries internal energy, too: from the slot
// of the body to the gas, or back. [docs/method.md, step 8]
fn late_heat(near: vec3i, n: u32, up: bool) -> f32 {
    if !LATE_HEAT { return 0.0; }
    let a = slot_of(near);
    let b = slot_of(select(near - axis(n), near + axis(n), up));
    let mass = vec2f(node[a].w, node[b].w);
    let gain = -control.dt * dot(mass, vec2f(work[params.slots + a][n], work[params.slots + b][n])) / max(mass.x + mass.y, 1e-30);
    return 0.5 * gain * blocked_of(cells[b]) * face_pressure(near, n, up, SOLID) / (params.gamma - 1.0);
}

// What the gas around a SOLID cell takes from its slot.
fn late_heat_of(slot: u32) -> f32 {
    let c = cell_of(slot);
    var heat = 0.0;
    let faces = select(0u, 2u * DIM, LATE_HEAT && has(cells[slot], NODE_GAS));
    for (var face = 0u; face < faces; face++) {
        let n = face / 2u;
        let up = (face & 1u) == 1u;
        let other = select(c - axis(n), c + axis(n), up);
        if !inside(other) || kind_of(cells[slot_of(other)]) != GAS { continue; }
        heat += select(1.0, -1.0, up) * late_heat(other, n, !up);
    }
    return heat;
}
