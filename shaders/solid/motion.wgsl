// What a particle sees of a vector field on the nodes. Needs `grid_vector(slot) -> vec3f`, and place.wgsl.

// The field at the nodes around a cell: rows of three along x; y is faster than z.
var<private> rows: array<mat3x3f, 9>;

fn row_at(slot: u32) -> mat3x3f { return mat3x3f(grid_vector(slot - 1u), grid_vector(slot), grid_vector(slot + 1u)); }

fn read_rows(slot: u32) {
    rows[4] = row_at(slot);
    if DIM > 1u {
        rows[3] = row_at(slot - params.stride.x);
        rows[5] = row_at(slot + params.stride.x);
    }
    if DIM > 2u {
        let layer = params.stride.x * params.stride.y;
        rows[0] = row_at(slot - layer - params.stride.x);
        rows[1] = row_at(slot - layer);
        rows[2] = row_at(slot - layer + params.stride.x);
        rows[6] = row_at(slot + layer - params.stride.x);
        rows[7] = row_at(slot + layer);
        rows[8] = row_at(slot + layer + params.stride.x);
    }
}

// Sums over nodes: of velocity times weight, and the same with the slope or the moment of one axis in place of its weight.
struct Motion { velocity: vec3f, gradient: mat3x3f, moment: mat3x3f }

fn layer_motion(low: mat3x3f, middle: mat3x3f, high: mat3x3f, at: Place) -> Motion {
    var motion: Motion;
    if DIM == 1u {
        motion.velocity = middle * at.weight[0];
        motion.gradient[0] = middle * at.slope[0];
        motion.moment[0] = middle * at.moment[0];
        return motion;
    }
    let values = mat3x3f(low * at.weight[0], middle * at.weight[0], high * at.weight[0]);
    motion.velocity = values * at.weight[1];
    motion.gradient[0] = mat3x3f(low * at.slope[0], middle * at.slope[0], high * at.slope[0]) * at.weight[1];
    motion.gradient[1] = values * at.slope[1];
    motion.moment[0] = mat3x3f(low * at.moment[0], middle * at.moment[0], high * at.moment[0]) * at.weight[1];
    motion.moment[1] = values * at.moment[1];
    return motion;
}

fn motion_at(at: Place) -> Motion {
    let middle = layer_motion(rows[3], rows[4], rows[5], at);
    if DIM < 3u { return middle; }
    let low = layer_motion(rows[0], rows[1], rows[2], at);
    let high = layer_motion(rows[6], rows[7], rows[8], at);
    let values = mat3x3f(low.velocity, middle.velocity, high.velocity);
    let w = at.weight[2];
    var motion: Motion;
    motion.velocity = values * w;
    motion.gradient = w.x * low.gradient + w.y * middle.gradient + w.z * high.gradient;
    motion.gradient[2] = values * at.slope[2];
    motion.moment = w.x * low.moment + w.y * middle.moment + w.z * high.moment;
    motion.moment[2] = values * at.moment[2];
    return motion;
}
