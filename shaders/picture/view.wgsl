// What a picture shows and from where: the grid, the camera, the light, and the rays through the picture.
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
    // Rays across the whole picture.
    size: vec2u,
    // The band of rows drawn now: its first, and how many.
    first_row: u32,
    rows: u32,
    // Samples of a ray's place along each axis where particles are drawn.
    samples: u32,
    // Rays per pixel along each axis.
    supersampling: u32,
    particles: u32,
    // Width of the line around bodies in the plane, in rays.
    outline: f32,
    // Values at the two ends of the colours.
    low: f32,
    high: f32,
    // Power applied to fractions of the range in the ray march.
    contrast: f32,
    // Length of a step of the ray march [m].
    step: f32,
    // Extinction at opacity 1 [m^-1].
    opacity: f32,
    // 1 if the ray march draws the gas.
    volume: u32,
    // Nodes of the obstacles' distance per cell and axis, 0 without obstacles.
    fineness: u32,
    // OPTICS_*.
    optics: u32,
    // The floor: the points x with dot(ground.xyz, x) = ground.w; zero for none.
    ground: vec4f,
    // Radius of a particle over the edge of its volume.
    particle_scale: f32,
    // Plastic strain at which a particle has lost half of its brightness.
    dark_strain: f32,
    // Quantity of the particles, PARTICLE_*.
    particle_color: u32,
    // 1 if the particles are smoothed into a surface.
    smooth_skin: u32,
    particle_low: f32,
    particle_high: f32,
    // Factor on all light.
    exposure: f32,
    // TONE_*.
    tone: u32,
    // Towards the light, unit, and its strength.
    light: vec3f,
    light_strength: f32,
    // Unit vectors across the light, and the strength of the sky.
    light_right: vec3f,
    sky_strength: f32,
    light_up: vec3f,
    // 1 if there are shadows.
    shadows: u32,
    // The corner of the light grid that is nearest to the light, and the edge of its cells [m].
    light_origin: vec3f,
    light_spacing: f32,
    // Heat, the place in the black-body ramp, is scale p / rho - offset.
    heat_scale: f32,
    heat_offset: f32,
    // Extinction of the hottest gas [m^-1]; 0 for no emission.
    heat_opacity: f32,
    // Values at the ends of the line-of-sight pictures' grey are -gain and gain.
    gain: f32,
    slice_count: u32,
    contour_count: u32,
    arrows: vec2u,
    // Light behind everything in 3D.
    background_top: vec4f,
    background_bottom: vec4f,
    // Planes: the points x with dot(xyz, x) = w.
    slices: array<vec4f, 4>,
    // Values of the contour lines.
    contours: array<vec4f, 8>,
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

// A point in cells from the low corner of the domain.
fn in_cells(point: vec3f) -> vec3f {
    return (point - view.origin) / view.spacing;
}

fn kind_of(word: u32) -> u32 {
    return word & 3u;
}

// Rays of the band drawn now.
fn band_rays() -> u32 {
    return view.size.x * view.rows;
}

// Column and row, in the whole picture, of a ray of the band.
fn place_of(i: u32) -> vec2u {
    return vec2u(i % view.size.x, view.first_row + i / view.size.x);
}

// The ray through a point of the picture, in rays from the top left corner.
fn ray_through(pixel: vec2f) -> Ray {
    let size = vec2f(view.size);
    let offset = (pixel - 0.5 * size) / (0.5 * size.y) * view.half_height;
    let across = offset.x * view.right - offset.y * view.up;
    if (view.parallel == 1u) {
        return Ray(view.eye + across, view.forward);
    }
    return Ray(view.eye, normalize(view.forward + across));
}

// Where a point appears, in rays, and its depth along the view axis [m].
fn project(point: vec3f) -> vec3f {
    let relative = point - view.eye;
    let depth = dot(relative, view.forward);
    let scale = select(depth, 1.0, view.parallel == 1u) * view.half_height;
    let offset = vec2f(dot(relative, view.right), -dot(relative, view.up)) / scale;
    let size = vec2f(view.size);
    return vec3f(0.5 * size + offset * 0.5 * size.y, depth);
}

// Entry and exit of the domain along a ray, in metres; empty if the exit is not behind the entry.
fn domain_span(ray: Ray) -> vec2f {
    let extent = vec3f(view.cells) * view.spacing;
    let safe = select(ray.direction, vec3f(1e-9), abs(ray.direction) < vec3f(1e-9));
    let a = (view.origin - ray.start) / safe;
    let b = (view.origin + extent - ray.start) / safe;
    let low = min(a, b);
    let high = max(a, b);
    return vec2f(max(max(low.x, max(low.y, low.z)), 0.0), min(high.x, min(high.y, high.z)));
}
