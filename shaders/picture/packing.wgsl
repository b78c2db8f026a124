// Values of cells as the ray march reads them: per cube between eight cell centres, in 8 bits each.
// Needs picture/view.wgsl.

// The fractions of a cube's eight corners in 8 bits each. Corners without gas are negative; they take the mean of the others,
// so that bodies have no halo of false values.
fn packed_corners(given: array<f32, 8>) -> vec2u {
    var fractions = given;
    var sum = 0.0;
    var count = 0.0;
    for (var corner = 0u; corner < 8u; corner++) {
        if fractions[corner] >= 0.0 {
            sum += fractions[corner];
            count += 1.0;
        }
    }
    for (var corner = 0u; corner < 8u; corner++) {
        if fractions[corner] < 0.0 { fractions[corner] = sum / max(count, 1.0); }
    }
    let near = vec4f(fractions[0], fractions[1], fractions[2], fractions[3]);
    let far = vec4f(fractions[4], fractions[5], fractions[6], fractions[7]);
    return vec2u(pack4x8unorm(near), pack4x8unorm(far));
}

// Cube (i, j, k) lies between the centres of cells i-1 and i, and so on: one more than cells per axis.
fn cube_of(i: u32) -> vec3i {
    let cubes = view.cells + 1u;
    return vec3i(vec3u(i % cubes.x, (i / cubes.x) % cubes.y, i / (cubes.x * cubes.y)));
}

fn cube_count() -> u32 {
    let cubes = view.cells + 1u;
    return cubes.x * cubes.y * cubes.z;
}

// The first cube of a thread, and the end of its run; with no cubes the end is not behind the first.
struct Run {
    first: vec3i,
    end: i32,
}

fn run_of(i: u32) -> Run {
    let cubes = view.cells + 1u;
    let first = vec3u(i % cubes.x, (i / cubes.x) % cubes.y, i / (cubes.x * cubes.y) * RUN);
    return Run(vec3i(first), i32(min(first.z + RUN, cubes.z)));
}

fn cube_index(cube: vec3i) -> u32 {
    let cubes = view.cells + 1u;
    return u32(cube.x) + cubes.x * (u32(cube.y) + cubes.y * u32(cube.z));
}

fn corner_cell(cube: vec3i, corner: u32) -> vec3i {
    return cube - 1 + vec3i(vec3u(corner & 1u, (corner >> 1u) & 1u, corner >> 2u));
}

// Optical depth of a cell as a fraction: its root, for faint smoke has few values.
fn depth_fraction(depth: f32) -> f32 { return sqrt(min(depth / SOOT_DEPTH, 1.0)); }
