// The table of indirect dispatches: a zero entry makes every dispatch that uses it a no-op. The device steers the step with it.

@group(0) @binding(9) var<storage, read_write> extents: array<vec4u>;

fn groups_for(threads: u32) -> vec4u {
    let groups = (threads + WORKGROUP - 1u) / WORKGROUP;
    let x = min(groups, MAX_GROUPS);
    return vec4u(x, (groups + MAX_GROUPS - 1u) / MAX_GROUPS, 1u, 0u);
}

// Groups of a kernel that strides over n items and leaves one partial result per group.
fn groups_for_partials(n: u32) -> vec4u {
    return vec4u(clamp((n + WORKGROUP - 1u) / WORKGROUP, 1u, PARTIALS), 1u, 1u, 0u);
}

// Switches the dispatches of one phase on or off.
fn open_phase(first: u32, on: bool) {
    let keep = u32(on);
    extents[first + EXTENT_SLOTS] = groups_for(params.slots) * keep;
    extents[first + EXTENT_PARTICLES] = groups_for(params.particles) * keep;
    extents[first + EXTENT_REDUCE] = groups_for_partials(max(params.slots, params.particles)) * keep;
    extents[first + EXTENT_SINGLE] = vec4u(keep);
}
