// Colours: light is computed in linear sRGB; finish.wgsl makes pixels of it.

// Bits that look random and depend on the input alone [Jarzynski and Olano 2020, PCG hash].
fn hash(input: u32) -> u32 {
    let state = input * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// A number in [0, 1) from the same bits.
fn hash_unit(input: u32) -> f32 { return f32(hash(input) >> 8u) / 16777216.0; }
