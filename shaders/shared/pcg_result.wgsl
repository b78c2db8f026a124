// What a solve tells the control of the step. Mirror of PcgControl in src/numerics/pcg.rs.
struct PcgResult { rho: f32, alpha: f32, beta: f32, reference: f32, tolerance: f32, iterations: u32, max_iterations: u32, outcome: u32,
    length: u32, listed_wide: u32, listed_high: u32, frontier_wide: u32, frontier_high: u32,
    groups_wide: u32, groups_high: u32, groups_partial: u32, groups_block: u32,
    size: f32, most: f32, levels: u32, joined: u32, runs: u32, apart: u32, reference_at: u32, level_groups: array<u32, PCG_LEVELS> }
