//! A body that is held by the mouse: a critically damped spring from the held point to where the pointer is.

use glam::DVec3;

use crate::scene::Scene;

/// How often the body could catch up with the pointer in the scene's whole run.
const FOLLOWS: f64 = 60.0;
/// How fast it goes at most, over the speed of sound of the ambient gas.
const FASTEST: f64 = 1.0;

/// A spring whose force is bounded, over the mass that hangs on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Its angular frequency \[s^-1\].
    rate: f64,
    /// What it brings a body to at most \[m s^-1\].
    fastest: f64,
}

impl Spring {
    /// Of a scene: the whole run is long enough to follow the pointer many times.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let sound = scene.gas.ambient.sound_speed(scene.gas.gamma);
        Self { rate: FOLLOWS / scene.time.until, fastest: FASTEST * sound }
    }

    /// The velocity \[m s^-1\] at which spring and damping are in balance, so far from where it pulls to \[m\].
    #[must_use]
    pub fn towards(&self, way: DVec3) -> DVec3 {
        (0.5 * self.rate * way).clamp_length_max(self.fastest)
    }

    /// The velocity \[m s^-1\] after a time \[s\]: an implicit step of Euler, which is stable however long that is.
    #[must_use]
    pub fn after(&self, velocity: DVec3, way: DVec3, time: f64) -> DVec3 {
        let turned = self.rate * time;
        (velocity + 2.0 * turned * self.towards(way)) / ((1.0 + turned) * (1.0 + turned))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPRING: Spring = Spring { rate: 30.0, fastest: 10.0 };

    #[test]
    fn it_comes_to_rest_at_the_pointer_whatever_the_step() {
        for time in [1e-4, 1e-2, 1.0] {
            let (mut place, mut velocity, target) = (DVec3::ZERO, DVec3::new(0.0, 5.0, 0.0), DVec3::new(0.4, 0.1, 0.0));
            for _ in 0..(4.0 / time) as usize + 60 {
                velocity = SPRING.after(velocity, target - place, time);
                place += time * velocity;
                assert!(velocity.length() < 2.0 * SPRING.fastest, "{velocity}");
            }
            assert!(place.distance(target) < 1e-3 && velocity.length() < 1e-2, "{time}: {place} {velocity}");
        }
    }

    #[test]
    fn it_does_nothing_in_no_time_and_is_bounded_far_away() {
        let velocity = DVec3::new(1.0, 2.0, 3.0);
        assert_eq!(SPRING.after(velocity, DVec3::X, 0.0), velocity);
        assert!((SPRING.towards(1e6 * DVec3::Y).length() - 10.0).abs() < 1e-9);
        assert_eq!(SPRING.towards(0.1 * DVec3::X), DVec3::new(1.5, 0.0, 0.0));
    }
}
