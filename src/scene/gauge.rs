//! `[[gauges]]`: what is recorded in every step of a wall, an obstacle, a body, or a point of a body.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Scene, vector};

/// What is recorded in every step: the load of the gas on a thing, or the motion of a material point of a body. One of `side`, `obstacle`
/// and `body` says where.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gauge {
    /// Its columns in `gauges.csv`, unique among gauges and probes.
    pub name: String,
    /// The walls of this side of the domain.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub side: Option<Side>,
    /// Name of an obstacle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub obstacle: Option<String>,
    /// Name of a body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub body: Option<String>,
    /// Place in that body at the start `[m]`; the gauge moves with the nearest particle.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "vector::optional_point")]
    #[schemars(with = "Option<vector::Point>")]
    pub point: Option<[f64; 3]>,
    /// What moments are about `[m]`.
    #[serde(default, with = "vector::Point")]
    pub about: [f64; 3],
}

/// A side of the domain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[allow(missing_docs)]
pub enum Side {
    XMin,
    XMax,
    YMin,
    YMax,
    ZMin,
    ZMax,
}

/// What a gauge sits on, by indices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GaugePlace {
    /// A side, numbered as in [`super::Boundaries::sides`].
    Side(usize),
    /// An obstacle.
    Obstacle(usize),
    /// A body as a whole.
    Body(usize),
    /// The material that lies at a place \[m\] of a body at the start.
    Point(usize, [f64; 3]),
}

impl Scene {
    /// What a gauge sits on; nothing if it names no thing, or more than one.
    #[must_use]
    pub fn gauge_place(&self, gauge: &Gauge) -> Option<GaugePlace> {
        let body = |name: &String| self.bodies.iter().position(|body| body.name == *name);
        let obstacle = |name: &String| self.obstacles.iter().position(|obstacle| obstacle.name == *name);
        match (gauge.side, &gauge.obstacle, &gauge.body, gauge.point) {
            (Some(side), None, None, None) => Some(GaugePlace::Side(side as usize)),
            (None, Some(name), None, None) => obstacle(name).map(GaugePlace::Obstacle),
            (None, None, Some(name), None) => body(name).map(GaugePlace::Body),
            (None, None, Some(name), Some(point)) => body(name).map(|body| GaugePlace::Point(body, point)),
            _ => None,
        }
    }

    /// What all gauges sit on, in their order.
    #[must_use]
    pub fn gauge_places(&self) -> Vec<GaugePlace> {
        self.gauges.iter().filter_map(|gauge| self.gauge_place(gauge)).collect()
    }
}
