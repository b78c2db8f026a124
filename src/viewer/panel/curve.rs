//! The editor of the opacity curve: points to drag over the colours of the bar.

use egui::{Color32, Pos2, Rect, Sense, Stroke, Ui, Vec2};

use super::super::theme;
use crate::render::colors;
use crate::scene::Colormap;

/// Height of the editor in points.
const HEIGHT: f32 = 84.0;
/// How near to a point the mouse must be to take it, in points.
const REACH: f32 = 9.0;
/// Height of the strip of colours in points.
const STRIP: f32 = 8.0;

/// Shows the curve and changes it: drag a point, double-click adds one, a right click takes one away.
pub(super) fn show(ui: &mut Ui, points: &mut Vec<[f64; 2]>, colormap: Colormap) {
    let (whole, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), HEIGHT), Sense::click_and_drag());
    let area = Rect::from_min_max(whole.min + Vec2::splat(6.0), whole.max - Vec2::new(6.0, 6.0 + STRIP));
    let place = |point: [f64; 2]| {
        Pos2::new(area.left() + point[0] as f32 * area.width(), area.bottom() - point[1] as f32 * area.height())
    };
    let value = |place: Pos2| {
        let x = (place.x - area.left()) / area.width();
        let y = (area.bottom() - place.y) / area.height();
        [x, y].map(|share| f64::from(share.clamp(0.0, 1.0)))
    };
    let taken = response.id.with("taken");
    if let Some(pointer) = response.interact_pointer_pos() {
        let nearest = nearest(points, |point| place(point).distance(pointer));
        if response.drag_started() {
            // The press was where the drag began, the pointer has moved on.
            ui.data_mut(|data| data.insert_temp(taken, nearest));
        }
        let held: Option<Option<usize>> = ui.data(|data| data.get_temp(taken));
        if let (true, Some(index)) = (response.dragged(), held.flatten()) {
            move_point(points, index, value(pointer));
        } else if response.double_clicked() && nearest.is_none() {
            insert(points, value(pointer));
        } else if let (true, Some(index), true) = (response.secondary_clicked(), nearest, points.len() > 2) {
            points.remove(index);
        }
    }
    let painter = ui.painter_at(whole);
    painter.rect_filled(whole, 3.0, ui.visuals().extreme_bg_color);
    for (index, [red, green, blue]) in colors(colormap, STEPS).into_iter().enumerate() {
        let width = area.width() / STEPS as f32;
        let left = Pos2::new(area.left() + index as f32 * width, whole.bottom() - STRIP);
        let strip = Rect::from_min_size(left, Vec2::new(width + 0.5, STRIP - 2.0));
        painter.rect_filled(strip, 0.0, Color32::from_rgb(red, green, blue));
    }
    let ends = [points.first().map(|p| [0.0, p[1]]), points.last().map(|p| [1.0, p[1]])];
    let line = ends[0].into_iter().chain(points.iter().copied()).chain(ends[1]).map(place).collect();
    painter.line(line, Stroke::new(1.5, theme::ACCENT));
    for point in points.iter() {
        painter.circle(place(*point), 4.0, Color32::WHITE, Stroke::new(1.0, theme::BACKGROUND));
    }
    response.on_hover_text("drag points; double-click adds one, right click takes one away");
}

/// Colours of the strip.
const STEPS: usize = 48;

fn nearest(points: &[[f64; 2]], distance: impl Fn([f64; 2]) -> f32) -> Option<usize> {
    let near = points.iter().enumerate().map(|(index, point)| (index, distance(*point)));
    near.filter(|(_, away)| *away < REACH).min_by(|a, b| a.1.total_cmp(&b.1)).map(|(index, _)| index)
}

/// Moves a point no farther than its neighbours.
fn move_point(points: &mut [[f64; 2]], index: usize, to: [f64; 2]) {
    let low = if index == 0 { 0.0 } else { points[index - 1][0] };
    let high = points.get(index + 1).map_or(1.0, |next| next[0]);
    points[index] = [to[0].clamp(low, high), to[1]];
}

fn insert(points: &mut Vec<[f64; 2]>, new: [f64; 2]) {
    let index = points.partition_point(|point| point[0] < new[0]);
    points.insert(index, new);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_stay_in_order() {
        let mut points = vec![[0.0, 0.0], [0.5, 0.2], [1.0, 1.0]];
        move_point(&mut points, 1, [1.7, 0.9]);
        assert_eq!(points[1], [1.0, 0.9]);
        move_point(&mut points, 1, [0.25, 0.5]);
        insert(&mut points, [0.6, 0.1]);
        insert(&mut points, [0.1, 0.3]);
        assert!(points.windows(2).all(|pair| pair[0][0] <= pair[1][0]), "{points:?}");
        assert_eq!(points.len(), 5);
        assert_eq!(nearest(&points, |point| (100.0 * (point[0] - 0.58)).abs() as f32), Some(3));
        assert_eq!(nearest(&points, |point| (100.0 * (point[0] - 0.4)).abs() as f32), None);
    }
}
