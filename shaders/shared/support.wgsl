// How a body is held. Mirror of src/state/supports.rs (Support).

struct Support {
    velocity: vec3f,    // [m s^-1] of the driven part now
    friction: f32,      // coefficient at walls and obstacles [1]; STICK for a body that sticks
    spin: vec3f,        // [rad s^-1] of the driven part now
    first: u32,         // first entry of its motion over time
    pivot: vec3f,       // [m] the point it turns about, at the start of the step
    entries: u32,       // entries of its motion over time
    advance: vec3f,     // [m] how far that point moves in this step
    clamped: u32,       // 1 where only a part of the body is driven
}
