// What every material law takes and gives.

// Generated from src/material/mod.rs by scripts/generate.
struct MaterialParams {
    mu: f32,                    // Shear modulus [Pa]
    lambda: f32,                // First Lame constant of the body [Pa]
    yield_stress: f32,          // Yield stress [Pa]; f32::MAX for laws that do not yield
    kind: u32,                  // Position in KINDS
    ghost_modulus: f32,         // Modulus of the ghost pressure at the pressure that bodies start with [Pa]
    hardening: f32,             // Growth of the yield stress per equivalent plastic strain [Pa]
    friction: f32,              // Growth of the yield stress over minus the trace of the Kirchhoff stress [1]
    elastic_lambda: f32,        // What the ghost pressure leaves of lambda to the elastic stress [Pa]
    tensile_strength: f32,      // Tensile strength [Pa]; 0 for what does not break
    toughness: f32,             // Twice the fracture energy over the width of a band, times the modulus of pressure waves [Pa^2]
    softening: u32,             // Softening as a number
    crack_modulus: f32,         // Density times the square of the rate of damage at most: Rayleigh's waves over the width of a band [kg m^-3 s^-2]
    voids: vec4f,               // Plastic strain at which voids join, see JohnsonCook: d1, d2, d3, d4 [1]
    void_rate: f32,             // Strain rate from which on it grows [s^-1]
    void_softening: f32,        // Damage over the sum of plastic strains over those at failure, beyond 1; 0 for what does not break by voids [1]
    void_heat: f32,             // Growth of the strain at failure from the start to melting, see JohnsonCook: d5 [1]
    heating: f32,               // Share of the way to melting per plastic work and mass [kg J^-1]
    flow: vec4f,                // Flow stress, see Flow: exponent of the strain, 0 for linear hardening; rate [1], reference rate [s^-1], softening [1]
    rubble: f32,                // Growth of the yield stress of what has crumbled over minus the trace of the Kirchhoff stress; 0 for what does not crumble [1]
    debris: u32,                // Debris as a number
}
// End of what is generated.

// The index of a material, the low half of a particle's word; the high half has what scatters its strength [materials/stress.wgsl].
fn material_index(word: f32) -> u32 { return bitcast<u32>(word) & 0xffffu; }

// What the ghost pressure leaves of a law.
fn elastic_part(m: MaterialParams) -> MaterialParams {
    var part = m;
    part.lambda = m.elastic_lambda;
    return part;
}

// What plastic flow leaves of a deformation.
struct PlasticReturn {
    deformation: mat3x3f,   // of the elastic part, F - I
    plastic_strain: f32,    // equivalent plastic strain that the flow added
}

// 3x3 matrices: inverse, outer product, trace, eigen-decomposition of symmetric ones. Columns first, as everywhere in WGSL.

const IDENTITY = mat3x3f(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0);

// a b^T
fn outer_product(a: vec3f, b: vec3f) -> mat3x3f { return mat3x3f(a * b.x, a * b.y, a * b.z); }

fn trace(a: mat3x3f) -> f32 { return a[0].x + a[1].y + a[2].z; }

// Rows of the inverse are cross products of the columns over the determinant. The caller checks the determinant.
fn inverse(a: mat3x3f) -> mat3x3f {
    let scale = 1.0 / dot(a[0], cross(a[1], a[2]));
    return transpose(mat3x3f(cross(a[1], a[2]) * scale, cross(a[2], a[0]) * scale, cross(a[0], a[1]) * scale));
}

fn diagonal(d: vec3f) -> mat3x3f { return mat3x3f(d.x, 0.0, 0.0, 0.0, d.y, 0.0, 0.0, 0.0, d.z); }

struct Eigen {
    values: vec3f,     // unsorted
    vectors: mat3x3f,  // columns, orthonormal: a = vectors diag(values) vectors^T
}

// A symmetric matrix in the basis of its rotated axes.
struct Jacobi {
    diagonal: vec3f,  // xx, yy, zz
    off: vec3f,       // xy, yz, zx
    vectors: mat3x3f,
}

// Rotates x and y so that xy vanishes, then renames the axes y, z, x -> x, y, z.
// Stable form of the rotation: t = sgn(theta) / (|theta| + sqrt(theta^2 + 1)), theta = (yy - xx) / (2 xy). [Golub & Van Loan, 8.5.2]
fn jacobi_rotate(a: Jacobi) -> Jacobi {
    let theta = 0.5 * (a.diagonal.y - a.diagonal.x);
    // theta / xy overflows when xy is far below it; scaled by xy nothing does, and scaled by the larger of both no square vanishes
    let largest = max(abs(theta), abs(a.off.x));
    let share = vec2f(theta, a.off.x) / select(1.0, largest, largest > 0.0);
    let reach = abs(theta) + largest * length(share);
    let t = select(0.0, select(-a.off.x, a.off.x, theta >= 0.0) / reach, reach > 0.0);
    let c = inverseSqrt(1.0 + t * t);
    let s = t * c;
    let turned_diagonal = a.diagonal + vec3f(-t, t, 0.0) * a.off.x;
    let turned_off = vec3f(0.0, s * a.off.z + c * a.off.y, c * a.off.z - s * a.off.y);
    let turned_x = c * a.vectors[0] - s * a.vectors[1];
    let turned_y = s * a.vectors[0] + c * a.vectors[1];
    return Jacobi(turned_diagonal.yzx, turned_off.yzx, mat3x3f(turned_y, a.vectors[2], turned_x));
}

// Eigenvalues and eigenvectors by cyclic Jacobi rotations: three rotations name the axes as before and make one sweep.
// Convergence is quadratic; five sweeps reach f32 rounding from any start.
fn symmetric_eigen(a: mat3x3f) -> Eigen {
    var state = Jacobi(vec3f(a[0].x, a[1].y, a[2].z), vec3f(a[1].x, a[2].y, a[0].z), IDENTITY);
    for (var rotation = 0u; rotation < 15u; rotation++) {
        state = jacobi_rotate(state);
    }
    return Eigen(state.diagonal, state.vectors);
}
