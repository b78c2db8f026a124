// Quadratic B-spline of a particle in a cell, axis by axis. On inactive axes weight 0, 1, 0 and no slope.
// [Steffen et al. 2008; Jiang et al. 2016, section 5.5]

// Factors of a particle for the nodes at -1, 0 and 1 along each axis.
struct Place {
    center: vec3f,      // from the middle node to the particle, in cells; 0 on inactive axes
    weight: mat3x3f,    // [axis][offset + 1]
    slope: mat3x3f,     // [m^-1] derivative of the weight
    moment: mat3x3f,    // weight times offset
}

// `middle`: center of the cell, in cells from the origin.
fn place_at(position: vec3f, middle: vec3f) -> Place {
    var at: Place;
    let f = ((position - params.origin) / params.spacing - middle) * vec3f(reach());
    at.center = f;
    let low = 0.5 * (0.5 - f) * (0.5 - f);
    let high = 0.5 * (0.5 + f) * (0.5 + f);
    let falling = (f - 0.5) / params.spacing;
    let rising = (f + 0.5) / params.spacing;
    at.weight[0] = vec3f(low.x, 0.75 - f.x * f.x, high.x);
    at.slope[0] = vec3f(falling.x, -2.0 * f.x / params.spacing, rising.x);
    at.moment[0] = vec3f(-low.x, 0.0, high.x);
    at.weight[1] = vec3f(0.0, 1.0, 0.0);
    at.slope[1] = vec3f(0.0);
    at.moment[1] = vec3f(0.0);
    if DIM > 1u {
        at.weight[1] = vec3f(low.y, 0.75 - f.y * f.y, high.y);
        at.slope[1] = vec3f(falling.y, -2.0 * f.y / params.spacing, rising.y);
        at.moment[1] = vec3f(-low.y, 0.0, high.y);
    }
    at.weight[2] = vec3f(0.0, 1.0, 0.0);
    at.slope[2] = vec3f(0.0);
    at.moment[2] = vec3f(0.0);
    if DIM > 2u {
        at.weight[2] = vec3f(low.z, 0.75 - f.z * f.z, high.z);
        at.slope[2] = vec3f(falling.z, -2.0 * f.z / params.spacing, rising.z);
        at.moment[2] = vec3f(-low.z, 0.0, high.z);
    }
    return at;
}
