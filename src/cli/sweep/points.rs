//! The points of a sweep: keys, their values, and which of them are whose.

use crate::{Error, Result};

/// Runs that one sweep may have.
const MOST_RUNS: usize = 1_000_000;

/// A key and the values that it takes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    pub(super) key: String,
    values: Values,
}

/// What a key takes.
#[derive(Clone, Debug, PartialEq)]
enum Values {
    /// Texts as `--set` takes them.
    List(Vec<String>),
    /// Numbers between two ends, so many of them where a grid is asked for.
    Range { low: f64, high: f64, count: usize },
}

/// `key=a,b,c` or `key=low:high:count`.
pub(super) fn axis(text: &str) -> Result<Axis> {
    let wrong = |why: &str| {
        Error::Usage(format!(
            "--over {text}: {why}; write KEY=a,b,c or KEY=low:high:count, as in gas.regions[0].pressure=5,10"
        ))
    };
    let (key, values) = text.split_once('=').ok_or_else(|| wrong("no values"))?;
    let numbers: Option<Vec<f64>> = values.split(':').map(|part| part.trim().parse().ok()).collect();
    let values = match numbers.as_deref() {
        Some([low, high]) => Values::Range { low: *low, high: *high, count: 0 },
        Some([low, high, count]) if *count >= 2.0 && count.fract() == 0.0 && *count <= MOST_RUNS as f64 => {
            Values::Range { low: *low, high: *high, count: *count as usize }
        }
        Some([_, _, ..]) => return Err(wrong("the count of a range is a whole number from 2 on")),
        _ => Values::List(parts(values)),
    };
    match &values {
        Values::Range { low, high, .. } if !(low.is_finite() && high.is_finite() && low < high) => {
            Err(wrong("a range goes from a finite number up to a larger one"))
        }
        Values::List(list) if list.iter().any(String::is_empty) => Err(wrong("an empty value")),
        _ => Ok(Axis { key: key.trim().to_owned(), values }),
    }
}

/// Parts of a text between commas outside of brackets.
fn parts(text: &str) -> Vec<String> {
    let (mut depth, mut all) = (0, vec![String::new()]);
    for letter in text.chars() {
        depth += i32::from("[{(".contains(letter)) - i32::from("]})".contains(letter));
        match (letter, all.last_mut()) {
            (',', _) if depth == 0 => all.push(String::new()),
            (_, Some(last)) => last.push(letter),
            _ => {}
        }
    }
    all.into_iter().map(|part| part.trim().to_owned()).collect()
}

/// The values of every run, in the order of the axes.
pub(super) fn points(axes: &[Axis], sample: Option<&str>, seed: u64) -> Result<Vec<Vec<String>>> {
    if axes.is_empty() {
        return Err(Error::Usage("a sweep needs --over KEY=VALUES".to_owned()));
    }
    if let Some(sample) = sample {
        let count = sample.strip_prefix("lhs:").and_then(|count| count.parse().ok());
        let count = count.filter(|count| (1..=MOST_RUNS).contains(count));
        let count = count.ok_or_else(|| Error::Usage(format!("--sample {sample}: write lhs:COUNT, as in lhs:50")))?;
        return Ok(latin(axes, count, seed));
    }
    let mut all: Vec<Vec<String>> = vec![Vec::new()];
    for axis in axes {
        let values = match &axis.values {
            Values::List(list) => list.clone(),
            Values::Range { count: 0, .. } => {
                let text = format!("--over {}: a grid wants low:high:count; --sample lhs:50 does without", axis.key);
                return Err(Error::Usage(text));
            }
            Values::Range { low, high, count } => {
                (0..*count).map(|k| short(low + (high - low) * k as f64 / (count - 1) as f64)).collect()
            }
        };
        if all.len().saturating_mul(values.len()) > MOST_RUNS {
            return Err(Error::Usage(format!("a sweep has at most {MOST_RUNS} runs")));
        }
        all = all.iter().flat_map(|one| values.iter().map(|v| [&one[..], std::slice::from_ref(v)].concat())).collect();
    }
    Ok(all)
}

/// A number without what rounding leaves behind its fifteenth digit: 0.15, not 0.15000000000000002.
fn short(number: f64) -> String {
    format!("{:?}", format!("{number:.14e}").parse().unwrap_or(number))
}

/// A Latin hypercube: along each axis, one run in each of `count` equal parts. [McKay, Beckman & Conover 1979]
fn latin(axes: &[Axis], count: usize, seed: u64) -> Vec<Vec<String>> {
    let mut state = seed;
    // [Steele et al. 2014, SplitMix64]
    let mut random = move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut all = vec![Vec::new(); count];
    for axis in axes {
        let mut order: Vec<usize> = (0..count).collect();
        for k in (1..count).rev() {
            order.swap(k, ((k + 1) as f64 * random()) as usize);
        }
        for (one, part) in all.iter_mut().zip(order) {
            let share = (part as f64 + random()) / count as f64;
            one.push(match &axis.values {
                Values::List(list) => list[((share * list.len() as f64) as usize).min(list.len() - 1)].clone(),
                Values::Range { low, high, .. } => format!("{:?}", low + (high - low) * share),
            });
        }
    }
    all
}

/// `3/10`: the third of ten parts, counted from 1.
pub(super) fn shard(text: Option<&str>) -> Result<(usize, usize)> {
    let Some(text) = text else { return Ok((0, 1)) };
    let both = text.split_once('/').and_then(|(own, all)| Some((own.parse().ok()?, all.parse().ok()?)));
    match both {
        Some((own, all)) if (1..=all).contains(&own) => Ok((own - 1, all)),
        _ => Err(Error::Usage(format!("--shard {text}: write PART/PARTS, as in 3/10; parts count from 1"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_of_grids_and_samples() {
        let axes = [axis("a.b=1,[2, 3],x").unwrap(), axis("c=10:20:3").unwrap()];
        let grid = points(&axes, None, 0).unwrap();
        assert_eq!(grid.len(), 9);
        assert_eq!((grid[0].join(" "), grid[5].join(" ")), ("1 10.0".to_owned(), "[2, 3] 20.0".to_owned()));
        let fine = points(&[axis("c=0.05:0.2:4").unwrap()], None, 0).unwrap().concat();
        assert_eq!(fine, ["0.05", "0.1", "0.15", "0.2"]);
        let axes = [axis("c=10:20").unwrap()];
        assert!(points(&axes, None, 0).unwrap_err().to_string().contains("low:high:count"));
        let mut sample: Vec<f64> =
            points(&axes, Some("lhs:50"), 7).unwrap().iter().map(|p| p[0].parse().unwrap()).collect();
        sample.sort_by(f64::total_cmp);
        assert!(sample.iter().enumerate().all(|(k, x)| ((x - 10.0) / 10.0 * 50.0) as usize == k), "{sample:?}");
        for wrong in ["a", "a=2:1:3", "a=1:2:1", "a=1,,2", "a=1:2:3:4", "a=1:2:2.5"] {
            assert!(axis(wrong).unwrap_err().to_string().contains("low:high:count"), "{wrong}");
        }
        assert_eq!((shard(Some("3/10")).unwrap(), shard(None).unwrap()), ((2, 10), (0, 1)));
        assert!(shard(Some("0/10")).is_err() && shard(Some("11/10")).is_err() && shard(Some("x")).is_err());
    }
}
