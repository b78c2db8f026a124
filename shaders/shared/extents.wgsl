// The table of indirect dispatches: a zero entry makes every dispatch that uses it a no-op. The device steers the step with it.
// Needs the binding control.
#include "shared/index.wgsl"

@group(0) @binding(9) var<storage, read_write> extents: array<vec4u>;

fn groups_for(threads: u32) -> vec4u {
    let groups = groups_of(threads);
    return vec4u(min(groups, MAX_GROUPS), (groups + MAX_GROUPS - 1u) / MAX_GROUPS, 1u, 0u);
}

// Of kernels that take the list, too [shared/domain.wgsl].
fn groups_over_both(threads: u32) -> vec4u { return groups_for(LIST_PARTS * groups_apart(threads) * WORKGROUP); }

fn surface_rows() -> u32 { return min(control.extra, params.surface_rows); }
fn surface_groups() -> vec4u { return vec4u(min(groups_of(surface_rows()), params.groups), 1u, 1u, 0u); }

// The same for a phase of kernels over slots alone.
fn open_slots(first: u32, on: bool) { extents[first + OVER_SLOTS] = groups_for(params.slots) * u32(on); }

// Switches the dispatches of one phase on or off.
fn open_phase(first: u32, on: bool) {
    let keep = u32(on);
    extents[first + OVER_SLOTS] = groups_for(params.slots) * keep;
    extents[first + OVER_INTERIOR] = groups_for(params.slots) * keep;
    extents[first + OVER_BOTH] = groups_over_both(params.slots) * keep;
    extents[first + OVER_PARTICLES] = groups_for(params.particles) * keep;
    extents[first + OVER_REDUCE] = vec4u(params.groups, 1u, 1u, 0u) * keep;
    extents[first + OVER_LISTED] = groups_for(control.listed) * keep;
    extents[first + OVER_FRONTIER] = groups_for(control.frontier) * keep;
    extents[first + OVER_NEAR] = groups_for(max(control.listed, control.frontier)) * keep;
    extents[first + OVER_SURFACE] = surface_groups() * keep;
    extents[first + OVER_MARCHES] = groups_for(marches()) * keep;
    extents[first + OVER_WHOLE] = groups_over_both(marches()) * keep;
    extents[first + OVER_COLOR] = groups_for(color_marches()) * keep;
    extents[first + OVER_SINGLE] = vec4u(keep);
}

// The same with prefix sums.
fn open_with_scan(first: u32, on: bool) {
    open_phase(first, on);
    for (var k = 0u; k < SCAN_DISPATCHES; k++) { extents[first + OVER_SCAN + k] = params.scan[k] * u32(on); }
}

// Particles that are all in the cells where they were need no sorting.
fn open_sort(due: bool) {
    var sort = due;
    if due { sort = atomicExchange(&control.unsorted, 0u) == 1u; }
    open_with_scan(PHASE_SORT_EXTENTS, sort);
}
