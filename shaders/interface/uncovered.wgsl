// interface, the ledger: gas for a cell that a body uncovers. Needs the bindings of interface/ledger.wgsl.

struct Sum { flow: vec4f, energy: f32, species: vec2f, count: f32 }

fn add_if_old_gas(sum: ptr<function, Sum>, c: vec3i) {
    if !inside(c) { return; }
    let slot = slot_of(c);
    if previous_kind_of(cells[slot]) != GAS { return; }
    (*sum).flow += conserved[slot];
    (*sum).energy += energy[slot];
    (*sum).species += summed_species(gas_at(slot));
    (*sum).count += 1.0;
}

// Mean of the cells that were gas before: face neighbours, else the 3^DIM block, else the 5^DIM block.
fn fill_from_neighbours(c: vec3i) -> Sum {
    var sum: Sum;
    for (var a = 0u; a < DIM; a++) {
        add_if_old_gas(&sum, c - axis(a));
        add_if_old_gas(&sum, c + axis(a));
    }
    if sum.count > 0.0 { return sum; }
    for (var far = 1; far <= 2; far++) {
        let r = far * reach();
        for (var z = -r.z; z <= r.z; z++) {
            for (var y = -r.y; y <= r.y; y++) {
                for (var x = -r.x; x <= r.x; x++) { add_if_old_gas(&sum, c + vec3i(x, y, z)); }
            }
        }
        if sum.count > 0.0 { return sum; }
    }
    return sum;
}

// A pocket with no gas around: gas at the ghost pressure, isentropic from the ambient state, moving with the solid.
fn trapped_gas(c: vec3i, slot: u32) -> Gas {
    var pressure = 0.0;
    for (var k = 0u; k < corner_count(); k++) { pressure += ghost[slot_of(c + corner_offset(k))]; }
    pressure = max(pressure / f32(corner_count()), 1e-3 * params.ambient_pressure);
    let density = params.ambient_density * pow(pressure / params.ambient_pressure, 1.0 / gamma_of(params.ambient_volume));
    return gas_from_primitive(density, node[slot].xyz, pressure, vec2f(density * params.ambient_share, params.ambient_volume), 0.0);
}
