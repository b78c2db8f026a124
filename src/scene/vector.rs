//! Vectors in scene files: one to three numbers. A scene of `dimension` axes may leave the inactive ones out.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Declares vectors by what the missing entries are.
macro_rules! vectors {
    ($($(#[$doc:meta])* $name:ident: $number:ty = $rest:expr;)*) => {
        $($(#[$doc])*
        pub(super) struct $name;

        impl $name {
            pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[$number; 3], D::Error> {
                filled(deserializer, $rest)
            }

            /// Where missing entries have no end, those without one are left out.
            pub(super) fn serialize<S: Serializer>(value: &[$number; 3], serializer: S) -> Result<S::Ok, S::Error> {
                let written = |v: &&$number| f64::from($rest).is_finite() || f64::from(**v).is_finite();
                value.iter().take_while(written).collect::<Vec<_>>().serialize(serializer)
            }
        }

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn inline_schema() -> bool {
                true
            }

            fn json_schema(generator: &mut SchemaGenerator) -> Schema {
                let items = generator.subschema_for::<$number>();
                json_schema!({ "type": "array", "items": items, "minItems": 1, "maxItems": 3 })
            }
        })*
    };
}

vectors! {
    /// A point or a direction: the missing entries are 0.
    Point: f64 = 0.0;
    /// Sizes: along the missing axes the thing has no end.
    Extent: f64 = f64::INFINITY;
    /// Lengths of the domain: an inactive axis has unit thickness.
    Lengths: f64 = 1.0;
    /// Cells of the domain: an inactive axis has one.
    Counts: u32 = 1;
}

/// An angular velocity in a scene file.
#[derive(Deserialize, JsonSchema)]
#[serde(untagged, expecting = "expected a number (about z) or three numbers (about x, y and z)")]
pub(super) enum Spin {
    /// About z, the only axis in 2D.
    AboutZ(f64),
    /// About x, y and z.
    Vector([f64; 3]),
}

impl Spin {
    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<[f64; 3], D::Error> {
        Ok(match <Self as Deserialize>::deserialize(deserializer)? {
            Spin::AboutZ(rate) => [0.0, 0.0, rate],
            Spin::Vector(rates) => rates,
        })
    }

    pub(super) fn serialize<S: Serializer>(rates: &[f64; 3], serializer: S) -> Result<S::Ok, S::Error> {
        rates.serialize(serializer)
    }
}

/// Reads a point of a key that may be left out.
pub(super) fn optional_point<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[f64; 3]>, D::Error> {
    Point::deserialize(deserializer).map(Some)
}

/// Reads points of one to three numbers each.
pub(super) fn points<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<[f64; 3]>, D::Error> {
    #[derive(Deserialize)]
    struct Read(#[serde(with = "Point")] [f64; 3]);
    Ok(Vec::<Read>::deserialize(deserializer)?.into_iter().map(|point| point.0).collect())
}

fn filled<'de, D: Deserializer<'de>, T: Deserialize<'de> + Copy>(deserializer: D, rest: T) -> Result<[T; 3], D::Error> {
    let entries = Vec::<T>::deserialize(deserializer)?;
    if entries.is_empty() || entries.len() > 3 {
        let message = format!("expected 1 to 3 numbers, one per axis, found {}", entries.len());
        return Err(serde::de::Error::custom(message));
    }
    Ok(std::array::from_fn(|d| entries.get(d).copied().unwrap_or(rest)))
}
