// The samples of a band: view.samples per ray and axis, with a margin above and below for what looks at its neighbours.

// Depths and particles are stored as their difference from this, so that cleared memory means nothing seen and the nearest is
// the largest.
const FARTHEST: u32 = 0xffffffffu;
const NOTHING: u32 = 0u;

// Row of the whole picture's samples that is the first of the band's.
fn sample_top() -> i32 { return i32(view.first_row * view.samples) - i32(SAMPLE_MARGIN); }

fn sample_grid() -> vec2u { return vec2u(view.size.x * view.samples, view.rows * view.samples + 2u * SAMPLE_MARGIN); }

fn sample_ray(place: vec2u) -> Ray {
    let row = f32(i32(place.y) + sample_top());
    return ray_through((vec2f(f32(place.x), row) + 0.5) / f32(view.samples));
}

// Distance along the ray to a sphere, negative if it is missed [m].
fn hit_sphere(ray: Ray, centre: vec3f, radius: f32) -> f32 {
    let relative = centre - ray.start;
    let along = dot(relative, ray.direction);
    let miss = relative - along * ray.direction;
    let inside = radius * radius - dot(miss, miss);
    return select(-1.0, along - sqrt(max(inside, 0.0)), inside >= 0.0);
}
