// What the vertices have of the ghost pressure, or of its change, at a place. Needs the binding ghost.
#include "shared/index.wgsl"
#include "solid/place.wgsl"

fn ghost_between(x: vec3f) -> f32 {
    let place = (x - params.origin) / params.spacing;
    let base = nearest_inside(vec3i(floor(place)));
    let f = place - vec3f(base);
    var value = 0.0;
    for (var k = 0u; k < corner_count(); k++) {
        let corner = corner_offset(k);
        var w = 1.0;
        for (var a = 0u; a < DIM; a++) { w *= select(1.0 - f[a], f[a], corner[a] == 1); }
        value += w * ghost[slot_of(base + corner)];
    }
    return value;
}
