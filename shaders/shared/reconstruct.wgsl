// Third-order WENO value at the face downstream of b, from the cells a (upstream), b and c.
// Two-point sub-stencils with linear weights 1/3 and 2/3 [Liu et al. 1994]; smoothness is measured relative to the largest
// of the three values, so that neither the unit system nor float32's range changes the scheme.

// Differences below its root, 2.6 % of a value, count as smooth: waves of some cells survive [docs/method.md].
const WENO_EPSILON = 7e-4;

fn weno3_vector(a: vec4f, b: vec4f, c: vec4f) -> vec4f {
    let scale = 1.0 / max(max(abs(a), abs(b)), max(abs(c), vec4f(1e-30)));
    let left = (b - a) * scale;
    let right = (c - b) * scale;
    let rough_left = left * left + WENO_EPSILON;
    let rough_right = right * right + WENO_EPSILON;
    let weight_left = rough_right * rough_right;
    let weight_right = 2.0 * rough_left * rough_left;
    return (weight_left * (1.5 * b - 0.5 * a) + weight_right * 0.5 * (b + c)) / (weight_left + weight_right);
}

fn weno3(a: f32, b: f32, c: f32) -> f32 {
    let scale = 1.0 / max(max(abs(a), abs(b)), max(abs(c), 1e-30));
    let left = (b - a) * scale;
    let right = (c - b) * scale;
    let rough_left = left * left + WENO_EPSILON;
    let rough_right = right * right + WENO_EPSILON;
    let weight_left = rough_right * rough_right;
    let weight_right = 2.0 * rough_left * rough_left;
    return (weight_left * (1.5 * b - 0.5 * a) + weight_right * 0.5 * (b + c)) / (weight_left + weight_right);
}
