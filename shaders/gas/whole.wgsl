// Density that goes from cell to cell in whole units of the last place of the denser one: what one gives up is then, to the last bit,
// what the other takes.

const LAST_PLACE = 1.1920928955078125e-7;   // 2^-23

fn power_of_two(density: f32) -> f32 { return bitcast<f32>(bitcast<u32>(density) & 0x7f800000u); }

// Of a power of two, exactly: a division may be off by some units in the last place.
fn inverse_of_power(unit: f32) -> f32 { return bitcast<f32>(0x7f000000u - bitcast<u32>(unit)); }

// A unit below the smallest normal number is none.
fn whole(density: f32, unit: f32) -> f32 {
    if bitcast<u32>(unit) < 0x00800000u { return density; }
    return round(density * inverse_of_power(unit)) * unit;
}
