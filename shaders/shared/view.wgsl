// What a picture shows and from where: the grid, the camera, and the rays through pixels.
// Mirror of src/render/view.rs.

struct View {
    // Cells per axis without the ring; 1 on inactive axes.
    cells: vec3u,
    // Active axes.
    dimension: u32,
    // Low corner of the domain [m].
    origin: vec3f,
    // Edge of a cell [m].
    spacing: f32,
    // Where rays start: all of them, or the middle one of parallel rays [m].
    eye: vec3f,
    // 1 for parallel rays.
    parallel: u32,
    // Unit vectors of the camera.
    right: vec3f,
    // Half the height of the picture: at unit distance, or in metres for parallel rays.
    half_height: f32,
    up: vec3f,
    // Ratio of specific heats.
    gamma: f32,
    forward: vec3f,
    // Quantity shown, FIELD_*.
    field: u32,
    // Towards the light, unit.
    light: vec3f,
    // Radius of a particle over the edge of its volume.
    particle_scale: f32,
    // Pixels of the picture.
    size: vec2u,
    particles: u32,
    // 1 if cells are drawn as squares, 0 if values are interpolated.
    squares: u32,
    // Values at the two ends of the colours.
    low: f32,
    high: f32,
    // Fraction of the range that is transparent in the ray march.
    neutral: f32,
    // Extinction of the most opaque value [m^-1].
    opacity: f32,
    // Length of a step of the ray march [m].
    step: f32,
    // 1 if cells of the domain may be walls.
    obstacles: u32,
    // Power applied to fractions of the range in the ray march.
    contrast: f32,
    // Plastic strain at which a particle has lost half of its brightness.
    dark_strain: f32,
}

struct Ray {
    start: vec3f,
    direction: vec3f,
}

@group(0) @binding(0) var<uniform> view: View;

// Cells in the ring on each side.
fn ring() -> vec3u {
    return select(vec3u(0u), vec3u(1u), vec3u(0u, 1u, 2u) < vec3u(view.dimension));
}

fn stored() -> vec3u {
    return view.cells + 2u * ring();
}

fn slot_of(cell: vec3i) -> u32 {
    let place = vec3u(cell + vec3i(ring()));
    let stride = stored();
    return place.x + stride.x * (place.y + stride.y * place.z);
}

// Cell of the i-th element of an unpadded array, x fastest.
fn cell_of(i: u32) -> vec3i {
    return vec3i(vec3u(i % view.cells.x, (i / view.cells.x) % view.cells.y, i / (view.cells.x * view.cells.y)));
}

fn cell_count() -> u32 {
    return view.cells.x * view.cells.y * view.cells.z;
}

// Bricks of BRICK^3 cubes between cell centres, per axis.
fn brick_grid() -> vec3u {
    return (view.cells + BRICK) / BRICK;
}

// Largest distance of a fraction of the range from the transparent one.
fn contrast_scale() -> f32 {
    return max(view.neutral, 1.0 - view.neutral);
}

fn kind_of(word: u32) -> u32 {
    return word & 3u;
}

// The ray through a point of the picture, in pixels from the top left corner.
fn ray_through(pixel: vec2f) -> Ray {
    let size = vec2f(view.size);
    let offset = (pixel - 0.5 * size) / (0.5 * size.y) * view.half_height;
    let across = offset.x * view.right - offset.y * view.up;
    if (view.parallel == 1u) {
        return Ray(view.eye + across, view.forward);
    }
    return Ray(view.eye, normalize(view.forward + across));
}

// Where a point appears, in pixels, and its depth along the view axis [m].
fn project(point: vec3f) -> vec3f {
    let relative = point - view.eye;
    let depth = dot(relative, view.forward);
    let scale = select(depth, 1.0, view.parallel == 1u) * view.half_height;
    let offset = vec2f(dot(relative, view.right), -dot(relative, view.up)) / scale;
    let size = vec2f(view.size);
    return vec3f(0.5 * size + offset * 0.5 * size.y, depth);
}
