//! Where the static obstacles are: their shapes, and the images of what reaches beyond periodic sides.

use crate::scene::{Scene, Shape};

impl Scene {
    /// Signed distance of a point to the nearest obstacle `[m]`: negative inside, infinite without obstacles.
    #[must_use]
    pub fn obstacle_distance(&self, point: [f64; 3]) -> f64 {
        (0..self.obstacles.len()).map(|index| self.distance_to_obstacle(index, point)).fold(f64::INFINITY, f64::min)
    }

    /// The same to one of the obstacles, given by its place in the scene.
    ///
    /// # Panics
    /// If there is no such obstacle.
    #[must_use]
    pub fn distance_to_obstacle(&self, index: usize, point: [f64; 3]) -> f64 {
        let shape = &self.obstacles[index].shape;
        let own = shape.distance(point);
        if (0..self.domain.axes()).any(|axis| self.boundary.periodic(axis)) {
            return self.images_of(shape, point).map(|image| shape.distance(image)).fold(own, f64::min);
        }
        own
    }

    /// Where a point lies for the images of a shape. A shape that ends near or beyond a periodic side goes on at the other end; one
    /// without an end has no image there.
    fn images_of(&self, shape: &Shape, point: [f64; 3]) -> impl Iterator<Item = [f64; 3]> {
        let (low, high) = shape.bounds();
        let domain = &self.domain;
        let shifts = |axis: usize| -> Vec<f64> {
            if axis >= domain.axes() || !self.boundary.periodic(axis) {
                return vec![0.0];
            }
            let (first, size) = (domain.origin[axis], domain.size[axis]);
            let down = high[axis].is_finite() && high[axis] > first + size - domain.spacing();
            let up = low[axis].is_finite() && low[axis] < first + domain.spacing();
            [(true, 0.0), (down, size), (up, -size)].into_iter().filter_map(|(is, shift)| is.then_some(shift)).collect()
        };
        let [x, y, z] = [shifts(0), shifts(1), shifts(2)];
        let places = x.into_iter().flat_map(move |a| {
            let (y, z) = (y.clone(), z.clone());
            y.into_iter().flat_map(move |b| z.clone().into_iter().map(move |c| [a, b, c]))
        });
        places.filter(|shift| *shift != [0.0; 3]).map(move |shift| [0, 1, 2].map(|d| point[d] + shift[d]))
    }
}
