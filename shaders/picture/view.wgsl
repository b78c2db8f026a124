// What a picture shows and from where: the grid, the camera, the light, and the rays through the picture.

// Generated from src/render/view.rs by scripts/generate.
struct View {
    cells: vec3u,               // Cells per axis without the ring; 1 on inactive axes
    dimension: u32,             // Active axes
    origin: vec3f,              // Low corner of the domain [m]
    spacing: f32,               // Edge of a cell [m]
    eye: vec3f,                 // Where rays start: all of them, or the middle one of parallel rays [m]
    parallel: u32,              // 1 for parallel rays
    right: vec3f,               // Unit vector to the right of the picture
    half_height: f32,           // Half the height of the picture: at unit distance, or in metres for parallel rays
    up: vec3f,                  // Unit vector to the top of the picture
    gamma: f32,                 // Ratio of specific heats
    forward: vec3f,             // Unit vector into the picture
    field: u32,                 // Quantity shown, a FIELD_ constant of the shaders
    size: vec2u,                // Rays across the whole picture
    first_row: u32,             // First row of rays of the band drawn now
    rows: u32,                  // Rows of rays of that band
    samples: u32,               // Samples of a ray's place along each axis where particles are drawn
    supersampling: u32,         // Rays per pixel along each axis
    particles: u32,             // Number of particles
    outline: f32,               // Width of the line around bodies in the plane, in rays
    low: f32,                   // Value at the low end of the colours
    high: f32,                  // Value at the high end of the colours
    contrast: f32,              // Power applied to fractions of the range in the ray march
    step: f32,                  // Length of a step of the ray march [m]
    opacity: f32,               // Extinction at opacity 1 [m^-1]
    volume: u32,                // 1 if the ray march draws the gas
    fineness: u32,              // Nodes of the obstacles' distance per cell and axis, 0 without obstacles
    optics: u32,                // Kind of line-of-sight picture, an OPTICS_ constant of the shaders
    ground: vec4f,              // The floor: the points x with dot(xyz, x) = w; zero for none
    particle_scale: f32,        // Radius of a particle over the edge of its volume
    dark_strain: f32,           // Plastic strain at which a particle has lost half of its brightness
    particle_color: u32,        // Quantity of the particles, a PARTICLE_ constant of the shaders
    smooth_skin: u32,           // 1 if the particles make up a smooth surface
    particle_low: f32,          // Value at the low end of the particles' colours
    particle_high: f32,         // Value at the high end of the particles' colours
    exposure: f32,              // Factor on all light
    tone: u32,                  // Tone map, a TONE_ constant of the shaders
    light: vec3f,               // Unit vector towards the light
    light_strength: f32,        // Strength of the light
    light_right: vec3f,         // Unit vector across the light
    sky_strength: f32,          // Strength of the sky
    light_up: vec3f,            // Unit vector across the light
    shadows: u32,               // 1 if there are shadows
    light_origin: vec3f,        // Corner of the light grid that is nearest to the light [m]
    light_spacing: f32,         // Edge of a cell of the light grid [m]
    heat_scale: f32,            // Place in the black-body ramp per p / rho
    heat_offset: f32,           // What is taken off that place
    heat_opacity: f32,          // Extinction of the hottest gas [m^-1]; 0 for no emission
    gain: f32,                  // Values at the ends of the line-of-sight pictures' grey are -gain and gain
    species_gamma: f32,         // Ratio of specific heats of the second gas; 0 without one
    species_constant: f32,      // Its gas constant over that of the first
    species_start: u32,         // Word where its density begins, behind which is its volume fraction
    soot: f32,                  // Its extinction in the ray march [m^2 kg^-1]
    slice_count: u32,           // Number of slices
    contour_count: u32,         // Number of contour lines
    arrows: vec2u,              // Velocity arrows along x and y
    products: vec4f,            // Products of an explosive: A and B [Pa], R1 and R2 times its density [kg m^-3]; 0 without
    chemical_energy: f32,       // Energy that the explosive holds [J kg^-1]
    densest: f32,               // Density beyond which the law of its products does not hold [kg m^-3]
    bend_pitch: u32,            // Rays from one that is followed through the gas to the next
    backdrop: u32,              // What is behind everything, a BACKDROP_ constant of the shaders
    refraction: f32,            // n - 1 per density of what bends rays, exaggerated [m^3 kg^-1]; 0 where nothing does
    ambient_density: f32,       // Density of the ambient gas [kg m^-3]
    bend_near: f32,             // Distance along rays from which they may be bent [m]
    bend_far: f32,              // The same up to which [m]
    fuel: f32,                  // What its products give where they burn on in the first gas, over that energy [1]
    dust: f32,                  // Extinction of dust in the ray march [m^2 kg^-1]; 0 without any
    dust_color: vec4f,          // Share of the light that dust scatters, by colour
    far_from_low: vec4f,        // Added to the distance in cells from the low sides before what is seen of gas fades: 0 for open sides, far for others
    far_from_high: vec4f,       // The same of the high sides
    background: array<vec4f, 2>, // Light behind everything in 3D, at the top and the bottom of the picture
    slices: array<vec4f, 4>,    // Slices: the points x with dot(xyz, x) = w
    contours: array<vec4f, 8>,  // Values of the contour lines, as fractions of the range
}
// End of what is generated.

struct Ray {
    start: vec3f,
    direction: vec3f,
}

@group(0) @binding(0) var<uniform> view: View;

// Cells in the ring on each side.
fn ring() -> vec3u { return select(vec3u(0u), vec3u(1u), vec3u(0u, 1u, 2u) < vec3u(view.dimension)); }

fn stored() -> vec3u { return view.cells + 2u * ring(); }

fn slot_of(cell: vec3i) -> u32 {
    let place = vec3u(cell + vec3i(ring()));
    let stride = stored();
    return place.x + stride.x * (place.y + stride.y * place.z);
}

// Cell of the i-th element of an unpadded array, x fastest.
fn cell_of(i: u32) -> vec3i {
    return vec3i(vec3u(i % view.cells.x, (i / view.cells.x) % view.cells.y, i / (view.cells.x * view.cells.y)));
}

fn cell_count() -> u32 { return view.cells.x * view.cells.y * view.cells.z; }

// A point in cells from the low corner of the domain.
fn in_cells(point: vec3f) -> vec3f { return (point - view.origin) / view.spacing; }

fn kind_of(word: u32) -> u32 { return word & 3u; }

// Rays of the band drawn now.
fn band_rays() -> u32 { return view.size.x * view.rows; }

// Column and row, in the whole picture, of a ray of the band.
fn place_of(i: u32) -> vec2u { return vec2u(i % view.size.x, view.first_row + i / view.size.x); }

// The ray through a point of the picture, in rays from the top left corner.
fn ray_through(pixel: vec2f) -> Ray {
    let size = vec2f(view.size);
    let offset = (pixel - 0.5 * size) / (0.5 * size.y) * view.half_height;
    let across = offset.x * view.right - offset.y * view.up;
    if view.parallel == 1u { return Ray(view.eye + across, view.forward); }
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

// Where glow has a cube. With soot, and with dust, it has a further entry of each: the root of the optical depth of a cell over SOOT_DEPTH.
fn glow_place(cube: u32) -> u32 { return cube * (1u + u32(view.soot > 0.0) + u32(view.dust > 0.0)); }
fn dust_place(cube: u32) -> u32 { return glow_place(cube) + 1u + u32(view.soot > 0.0); }
