//! `sweep`: one scene many times over ranges of its keys, in one process that compiles its kernels once.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Instant;

use serde_json::Value as Json;

use super::args::{Cli, RunOptions, SceneOptions, SweepOptions};
use super::{interrupt, open_device, run};
use crate::export::csv::{Table, Value};
use crate::{Error, Result, input};

/// Runs that one sweep may have.
const MOST_RUNS: usize = 1_000_000;

/// A key and the values that it takes.
#[derive(Clone, Debug, PartialEq)]
struct Axis {
    key: String,
    values: Values,
}

#[derive(Clone, Debug, PartialEq)]
enum Values {
    /// Texts as `--set` takes them.
    List(Vec<String>),
    /// Numbers between two ends, so many of them where a grid is asked for.
    Range { low: f64, high: f64, count: usize },
}

/// Runs a sweep.
///
/// # Errors
/// [`Error::Usage`] if a range makes no sense; [`Error::Io`]; [`Error::Expectation`] if runs failed.
pub(super) fn sweep(options: &SweepOptions, cli: &Cli) -> Result<()> {
    let start = Instant::now();
    let axes: Vec<Axis> = options.over.iter().map(|text| axis(text)).collect::<Result<_>>()?;
    let points = points(&axes, options.sample.as_deref(), options.seed)?;
    let (shard, shards) = shard(options.shard.as_deref())?;
    let chosen: Vec<usize> = (0..points.len()).filter(|number| number % shards == shard).collect();
    interrupt::listen();
    let gpu = open_device(cli)?;
    let mut failed = Vec::new();
    for (done, &number) in chosen.iter().enumerate() {
        let folder = options.out.join(format!("{number:04}"));
        let sets: Vec<String> =
            axes.iter().zip(&points[number]).map(|(axis, value)| format!("{}={value}", axis.key)).collect();
        if !finished(&folder, &sets) {
            let begun = Instant::now();
            let outcome = run::perform_on(&gpu, &one(options, &sets, &folder));
            match outcome {
                Err(Error::Interrupted) => return Err(Error::Interrupted),
                Err(error @ (Error::Scene(_) | Error::Usage(_) | Error::Gpu(_) | Error::NoAdapter(_))) => {
                    return Err(error);
                }
                Err(error) => {
                    tell!("warning: {number:04}: {error}");
                    failed.push(format!("{number:04}"));
                }
                Ok(()) => {}
            }
            note(&folder, &sets)?;
            if !options.quiet {
                let (at, all) = (done + 1, chosen.len());
                tell!("{at} of {all}: {} in {:.2} s", sets.join(" "), begun.elapsed().as_secs_f64());
            }
        }
        table(options, &axes, &points)?;
    }
    if !options.quiet && !cli.json {
        let place = options.out.join("sweep.csv");
        say!("{} runs in {:.1} s; {}", chosen.len(), start.elapsed().as_secs_f64(), place.display());
    }
    if cli.json {
        say!(
            "{}",
            serde_json::json!({ "runs": chosen.len(), "failed": failed, "seconds": start.elapsed().as_secs_f64() })
        );
    }
    if failed.is_empty() { Ok(()) } else { Err(Error::Expectation(format!("runs failed: {}", failed.join(", ")))) }
}

/// The options of one run.
fn one(options: &SweepOptions, sets: &[String], folder: &Path) -> RunOptions {
    let base = &options.scene;
    let scene = SceneOptions { set: base.set.iter().chain(sets).cloned().collect(), ..base.clone() };
    RunOptions {
        scene,
        out: Some(folder.to_owned()),
        until: options.until,
        frames: options.frames,
        export: options.export.clone(),
        no_frames: options.no_frames,
        force: true,
        quiet: true,
        ..RunOptions::default()
    }
}

/// `key=a,b,c` or `key=low:high:count`.
fn axis(text: &str) -> Result<Axis> {
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
fn points(axes: &[Axis], sample: Option<&str>, seed: u64) -> Result<Vec<Vec<String>>> {
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
                (0..*count).map(|k| format!("{:?}", low + (high - low) * k as f64 / (count - 1) as f64)).collect()
            }
        };
        if all.len().saturating_mul(values.len()) > MOST_RUNS {
            return Err(Error::Usage(format!("a sweep has at most {MOST_RUNS} runs")));
        }
        all = all.iter().flat_map(|one| values.iter().map(|v| [&one[..], std::slice::from_ref(v)].concat())).collect();
    }
    Ok(all)
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
fn shard(text: Option<&str>) -> Result<(usize, usize)> {
    let Some(text) = text else { return Ok((0, 1)) };
    let both = text.split_once('/').and_then(|(own, all)| Some((own.parse().ok()?, all.parse().ok()?)));
    match both {
        Some((own, all)) if (1..=all).contains(&own) => Ok((own - 1, all)),
        _ => Err(Error::Usage(format!("--shard {text}: write PART/PARTS, as in 3/10; parts count from 1"))),
    }
}

/// Marks a folder with the values of its run.
fn note(folder: &Path, sets: &[String]) -> Result<()> {
    crate::export::atomic::write(&folder.join("point.txt"), |out| out.write_all(sets.join("\n").as_bytes()))
}

/// Whether a folder holds the finished run of these values.
fn finished(folder: &Path, sets: &[String]) -> bool {
    let point = input::text(&folder.join("point.txt"), input::MOST_SCENE).unwrap_or_default();
    point == sets.join("\n") && report(folder)["status"] == "finished"
}

fn report(folder: &Path) -> Json {
    let text = input::text(&folder.join("report.json"), input::MOST_REPORT).ok();
    text.and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default()
}

/// Writes sweep.csv of all runs that are there: values, how they ended, expectations, totals, and what probes saw.
fn table(options: &SweepOptions, axes: &[Axis], points: &[Vec<String>]) -> Result<()> {
    let mut rows = Vec::new();
    let mut columns: Vec<String> = Vec::new();
    for (number, point) in points.iter().enumerate() {
        let folder = options.out.join(format!("{number:04}"));
        let report = report(&folder);
        if report["status"].is_null() || report["status"] == "running" {
            continue;
        }
        let measured = measured(&folder, &report);
        columns.extend(measured.keys().filter(|key| !columns.contains(key)).cloned().collect::<Vec<_>>());
        rows.push((number, point, report, measured));
    }
    let head = ["run", "status", "wall_seconds", "steps"].map(str::to_owned);
    let keys = axes.iter().map(|axis| axis.key.clone());
    let names: Vec<String> = head.into_iter().chain(keys).chain(columns.iter().cloned()).collect();
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let mut table = Table::new(&options.out.join("sweep.csv"), &names);
    for (number, point, report, measured) in rows {
        let real = |value: &Json| Value::from(value.as_f64().unwrap_or(f64::NAN));
        let status = Value::from(report["status"].as_str().unwrap_or_default());
        let head = [Value::from(number as u64), status, real(&report["wall_seconds"]), real(&report["steps"])];
        let values = point.iter().map(|value| Value::from(value.as_str()));
        let rest = columns.iter().map(|column| Value::from(measured.get(column).copied().unwrap_or(f64::NAN)));
        table.push(head.into_iter().chain(values).chain(rest));
    }
    table.save()
}

/// Numbers of a run by name.
fn measured(folder: &Path, report: &Json) -> BTreeMap<String, f64> {
    let mut found = BTreeMap::new();
    for check in report["expect"].as_array().into_iter().flatten() {
        if let (Some(name), Some(value)) = (check["name"].as_str(), check["measured"].as_f64()) {
            found.insert(format!("expect_{name}"), value);
        }
    }
    for (name, value) in report["totals"].as_object().into_iter().flatten() {
        found.extend(value.as_f64().map(|value| (name.clone(), value)));
    }
    found.extend(probes(&folder.join("probes.csv")).unwrap_or_default());
    found
}

/// Largest pressure and positive impulse of each probe, over the pressure of its first row.
fn probes(path: &Path) -> Option<BTreeMap<String, f64>> {
    let text = input::text(path, input::MOST_REPORT).ok()?;
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next()?;
    let rows: Vec<Vec<f64>> = lines.map(|row| row.iter().map(|v| v.parse().unwrap_or(f64::NAN)).collect()).collect();
    let mut found = BTreeMap::new();
    for (column, name) in head.iter().enumerate().filter_map(|(k, name)| Some((k, name.strip_suffix("_pressure")?))) {
        let (mut peak, mut impulse) = (f64::NEG_INFINITY, 0.0);
        let first = rows.first()?.get(column)?;
        for pair in rows.windows(2) {
            let over = (pair[1].get(column)? - first).max(0.0);
            peak = peak.max(*pair[1].get(column)?);
            impulse += over * (pair[1].get(1)? - pair[0].get(1)?);
        }
        found.insert(format!("{name}_peak"), peak);
        found.insert(format!("{name}_impulse"), impulse);
    }
    Some(found)
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
