// How much larger balls are drawn where they become a surface: so that it lies inside of them, also where a body is stretched.

// Of a body at rest: its surface is half of the distance of neighbours away from them, and balls are 0.625 of it.
const CLOSING: f32 = 1.45;
const MOST_GROWTH: f32 = 2.2;
