// Density that goes from cell to cell in whole units of the last place of the denser one: what one gives up is then, to the last bit,
// what the other takes.

const LAST_PLACE = 1.1920928955078125e-7;   // 2^-23

fn power_of_two(density: f32) -> f32 { return bitcast<f32>(bitcast<u32>(density) & 0x7f800000u); }

fn whole(density: f32, unit: f32) -> f32 {
    if unit == 0.0 { return density; }
    return round(density / unit) * unit;
}
