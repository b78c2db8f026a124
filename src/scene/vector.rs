//! Vectors in scene files: one to three numbers. A scene of `dimension` axes may leave the inactive ones out.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// An angular velocity in a scene file.
#[derive(Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected a number (about z) or three numbers (about x, y and z)")]
pub(super) enum Spin {
    /// About z, the only axis in 2D.
    AboutZ(f64),
    /// About x, y and z.
    Vector([f64; 3]),
}

/// Reads an angular velocity.
pub(super) fn spin<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 3], D::Error> {
    Ok(match Spin::deserialize(deserializer)? {
        Spin::AboutZ(rate) => [0.0, 0.0, rate],
        Spin::Vector(rates) => rates,
    })
}

/// Reads one to three numbers; the missing ones become 0.
pub(super) fn point<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 3], D::Error> {
    filled(deserializer, 0.0)
}

/// The same for a key that may be left out.
pub(super) fn optional_point<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[f64; 3]>, D::Error> {
    point(deserializer).map(Some)
}

/// Reads points of one to three numbers each.
pub(super) fn points<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<[f64; 3]>, D::Error> {
    #[derive(Deserialize)]
    struct Point(#[serde(deserialize_with = "point")] [f64; 3]);
    Ok(Vec::<Point>::deserialize(deserializer)?.into_iter().map(|point| point.0).collect())
}

/// Reads one to three sizes; along the missing axes the thing has no end.
pub(super) fn extent<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 3], D::Error> {
    filled(deserializer, f64::INFINITY)
}

/// Reads one to three lengths; the missing ones become 1, the unit thickness of an inactive axis.
pub(super) fn lengths<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 3], D::Error> {
    filled(deserializer, 1.0)
}

/// Reads one to three cell counts; an inactive axis has one cell.
pub(super) fn counts<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[u32; 3], D::Error> {
    filled(deserializer, 1)
}

/// Writes the finite entries of an extent: what [`extent`] reads back.
pub(super) fn write_extent<S: Serializer>(value: &[f64; 3], serializer: S) -> Result<S::Ok, S::Error> {
    value.iter().take_while(|v| v.is_finite()).collect::<Vec<_>>().serialize(serializer)
}

fn filled<'de, D: Deserializer<'de>, T: Deserialize<'de> + Copy>(deserializer: D, rest: T) -> Result<[T; 3], D::Error> {
    let entries = Vec::<T>::deserialize(deserializer)?;
    if entries.is_empty() || entries.len() > 3 {
        let message = format!("expected 1 to 3 numbers, one per axis, found {}", entries.len());
        return Err(serde::de::Error::custom(message));
    }
    Ok(std::array::from_fn(|d| entries.get(d).copied().unwrap_or(rest)))
}
