// The cubes of the lists in near.wgsl: their edge is the largest reach, and they repeat after a power of two along each axis.

override CUBES_X: u32 = 16u;
override CUBES_Y: u32 = 16u;
override CUBES_Z: u32 = 16u;

fn cube_count() -> u32 { return CUBES_X * CUBES_Y * CUBES_Z; }

fn cube_at_point(point: vec3f, reach: f32) -> vec3i { return vec3i(floor((point - view.origin) / reach)); }

fn cube_slot(cube: vec3i) -> u32 {
    let place = vec3u(cube) & (vec3u(CUBES_X, CUBES_Y, CUBES_Z) - 1u);
    return place.x + CUBES_X * (place.y + CUBES_Y * place.z);
}
