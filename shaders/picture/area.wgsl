// Samples around a place of the band, and bodies in the plane as areas: where particles cover half of the samples around, less what discs
// reach beyond the body. Reads nearest and balls.

// Samples across a length seen at a depth.
fn samples_across(length: f32, depth: f32) -> f32 {
    let distance = select(depth, 1.0, view.parallel == 1u);
    return length / (distance * view.half_height) * 0.5 * f32(view.size.y) * f32(view.samples);
}

// Beyond the picture is what is at its edge.
fn particle_at(place: vec2i) -> u32 {
    let inside = vec2u(clamp(place, vec2i(0), vec2i(sample_grid()) - 1));
    return nearest[inside.x + sample_grid().x * inside.y];
}

// Samples that are looked at around one, on four rings of equal area; how far, and how far particles reach beyond a straight side, both over
// the radius of a particle's disc.
const LOOKS: u32 = 48u;
const LOOK_REACH: f32 = 1.5;
const BEYOND_SIDE: f32 = 0.16;
// Radius of the disc around a particle that is covered even if it is alone, over that of its disc: less than half of the distance of
// neighbours, so that sides stay straight.
const CORE: f32 = 0.64;
// Largest width of the line around a body over the radius of a disc.
const WIDEST_LINE: f32 = 0.35;

// Shade of the line around a body.
const OUTLINE_SHADE: f32 = 0.3;

fn look(k: u32, reach: f32) -> vec2i {
    let ring = k / 12u;
    let angle = (f32(k % 12u) + 0.25 * f32(ring)) * 0.52359878;
    return vec2i(round(reach * sqrt((f32(ring) + 0.5) / 4.0) * vec2f(cos(angle), sin(angle))));
}

// The particle in a sample, or one of those around it; NOTHING if there is none.
fn particle_near(place: vec2i, reach: f32) -> u32 {
    var found = particle_at(place);
    for (var k = 0u; k < LOOKS && found == NOTHING; k++) {
        found = particle_at(place + look(k, reach));
    }
    return found;
}

// Radius of a particle's disc in samples, as far as a band allows to look.
fn disc_samples(found: u32) -> f32 {
    return clamp(samples_across(balls[2u * (FARTHEST - found)].w, 1.0), 1.0, f32(SAMPLE_MARGIN) / LOOK_REACH);
}

// Distance from a sample into the area, in samples: that to a straight side from the share of the samples around that are covered.
fn depth_inside(place: vec2i, radius: f32) -> f32 {
    let reach = LOOK_REACH * radius;
    var covered_looks = 0.0;
    for (var k = 0u; k < LOOKS; k++) {
        covered_looks += select(0.0, 1.0, particle_at(place + look(k, reach)) != NOTHING);
    }
    return (covered_looks / f32(LOOKS) - 0.5) * 1.5707963 * reach - BEYOND_SIDE * radius;
}

// Distance from a sample into the core of the particle that it shows, in samples; negative outside.
fn depth_in_core(place: vec2i, radius: f32) -> f32 {
    let found = particle_at(place);
    if found == NOTHING { return -1e9; }
    let middle = project(balls[2u * (FARTHEST - found)].xyz).xy * f32(view.samples) - vec2f(0.0, f32(sample_top()));
    return CORE * radius - length(vec2f(place) + 0.5 - middle);
}

// Colour of an area in a sample, and how much of the sample is covered.
fn area_at(place: vec2i, widest: f32) -> vec4f {
    let found = particle_near(place, widest);
    if found == NOTHING { return vec4f(0.0); }
    let radius = disc_samples(found);
    let inside = max(depth_inside(place, radius), depth_in_core(place, radius));
    let line = min(view.outline * f32(view.samples), WIDEST_LINE * radius);
    let shade = mix(OUTLINE_SHADE, 1.0, clamp(inside - line + 0.5, 0.0, 1.0));
    return vec4f(shade * balls[2u * (FARTHEST - found) + 1u].rgb, clamp(inside + 0.5, 0.0, 1.0));
}
