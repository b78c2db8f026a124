// How a body is held.

// Generated from src/state/supports.rs by scripts/generate.
struct Support {
    velocity: vec3f,            // Velocity of the driven part now [m s^-1]
    friction: f32,              // Coefficient of friction at walls and obstacles [1]; STICK for a body that sticks
    spin: vec3f,                // Angular velocity of the driven part now [rad s^-1]
    first: u32,                 // First entry of the motion over time
    pivot: vec3f,               // The point that the driven part turns about, at the start of the step [m]
    entries: u32,               // Entries of the motion over time
    advance: vec3f,             // How far that point moves in this step [m]
    clamped: u32,               // 1 where only a part of the body is driven: that part strains next to the rest
}
// End of what is generated.
