// Lines of equal value: view.contours holds their fractions of the range.

// Share of a place covered by contour lines, from the fraction there and its change from one ray to the next.
fn contour_coverage(fraction: f32, steepness: f32) -> f32 {
    var coverage = 0.0;
    let width = 0.6 * f32(view.supersampling);
    for (var k = 0u; k < view.contour_count; k++) {
        let away = abs(fraction - view.contours[k / 4u][k % 4u]) / max(steepness, 1e-6);
        coverage = max(coverage, clamp(width + 0.5 - away, 0.0, 1.0));
    }
    return 0.85 * coverage;
}
