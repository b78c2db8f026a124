//! Numbers in the text of a scene, before it is read.

use toml::de::{DeTable, DeValue};

use crate::scene::file::source::walk;
use crate::scene::finding::Finding;

/// Keys that hold one number per axis.
const VECTORS: [&str; 16] = [
    "cells", "origin", "size", "velocity", "center", "axis", "from", "to", "point", "normal", "offset", "about",
    "radii", "position", "gravity", "vector",
];

/// Numbers that are not finite and vectors of the wrong length, in the text itself.
pub(crate) fn findings(root: &DeTable<'_>, findings: &mut Vec<Finding>) {
    let domain = root.get("domain").and_then(|domain| domain.get_ref().get("dimension"));
    let dimension =
        domain.and_then(|value| value.get_ref().as_integer()).and_then(|value| value.as_str().parse::<usize>().ok());
    walk(root, &mut |entry| {
        let (path, place) = (entry.path, entry.place());
        match entry.value.get_ref() {
            DeValue::Float(number) if !number.as_str().parse::<f64>().is_ok_and(f64::is_finite) => {
                let message = format!("{} is not finite", number.as_str());
                findings.push(Finding {
                    span: Some(place),
                    ..Finding::new(path, message, "give a finite number, or leave the key out")
                });
            }
            DeValue::Array(entries) => {
                let key = path.rsplit('.').next().unwrap_or(path);
                let vector = VECTORS.contains(&key) && !path.starts_with("render.");
                if let Some(dimension @ 1..=3) =
                    dimension.filter(|d| vector && entries.len() != *d && entries.len() != 3)
                {
                    let message = format!("{} entries in a scene of dimension {dimension}", entries.len());
                    findings.push(Finding {
                        span: Some(place),
                        ..Finding::new(path, message, format!("give {dimension} numbers, one per axis"))
                    });
                }
            }
            _ => {}
        }
    });
}
