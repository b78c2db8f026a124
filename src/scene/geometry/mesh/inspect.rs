//! Whether a surface encloses something, and what is wrong with it otherwise.

use std::collections::HashMap;

use super::read::Problem;
use super::tree::Tree;
use super::{MAX_TRIANGLES, Surface};
use crate::scene::geometry::distance::{cross, dot, length, minus, plus};

/// Corners of open edges this near to each other, over the size of the mesh, are one.
const WELD: f64 = 1e-7;
/// Triangles whose two sides are looked at.
const LOOKS: usize = 2000;
/// How far beside a triangle, over the size of the mesh.
const BESIDE: f64 = 1e-4;
/// Winding numbers this far from 1 and 0 are wrong.
const WRONG: f64 = 0.25;

/// The tree of a surface that is sound, or is to be taken as it is.
pub(super) fn sound(surface: Surface, repair: bool) -> Result<Tree, Problem> {
    let Surface { points, mut triangles } = surface;
    if triangles.len() > MAX_TRIANGLES {
        let help = format!("give at most {MAX_TRIANGLES}; simplify the mesh");
        return Err((format!("{} triangles", triangles.len()), help));
    }
    if let Some(index) = points.iter().position(|point| point.iter().any(|x| !x.is_finite())) {
        return Err((format!("corner {index} is not finite: {:?}", points[index]), "mend the file".to_owned()));
    }
    if let Some(index) = triangles.iter().position(|t| t.iter().any(|k| *k as usize >= points.len())) {
        let message = format!("triangle {index} has a corner that is not there: the mesh has {}", points.len());
        return Err((message, "mend the file".to_owned()));
    }
    join(&mut triangles, &weld(&points));
    if !edges(&triangles).open.is_empty() {
        weld_open(&points, &mut triangles);
    }
    let corner = |k: u32| points[k as usize];
    let corners: Vec<[[f64; 3]; 3]> = triangles.iter().map(|t| t.map(corner)).collect();
    let volume: f64 = corners.iter().map(|[a, b, c]| dot(*a, cross(*b, *c)) / 6.0).sum();
    let Some(tree) = Tree::new(corners) else {
        return Err(("the mesh has no triangles".to_owned(), "give a closed surface".to_owned()));
    };
    let (low, high) = tree.bounds();
    let size = length(minus(high, low));
    if (0..3).any(|d| high[d] - low[d] < 1e-9 * size) || size == 0.0 {
        let message = format!("the mesh is flat: between {low:?} and {high:?}");
        return Err((message, "give a closed surface around a volume".to_owned()));
    }
    if repair {
        return Ok(tree);
    }
    let help =
        "close the surface, or take it as it is with `repair = true`: inside is where the winding number is above 1/2";
    let Edges { open, crowded } = edges(&triangles);
    if !open.is_empty() {
        return Err((open_text(&open, &points), help.to_owned()));
    }
    if crowded > 0 {
        return Err((format!("{crowded} edges belong to more than two triangles"), help.to_owned()));
    }
    if volume.abs() < 1e-12 * size.powi(3) {
        return Err(("the surface encloses no volume".to_owned(), help.to_owned()));
    }
    let (wrong, looks, example) = crossings(&tree, volume.signum(), BESIDE * size);
    if wrong > 0 {
        let message = format!(
            "the surface crosses itself, or parts of it overlap or face inwards: at {wrong} of {looks} places, such as {example:?}"
        );
        return Err((message, help.to_owned()));
    }
    Ok(tree)
}

/// For each point the first one at the same place.
fn weld(points: &[[f64; 3]]) -> Vec<u32> {
    let mut first = HashMap::with_capacity(points.len());
    // -0 and 0 are one place
    let place = |point: &[f64; 3]| point.map(|x| (x + 0.0).to_bits());
    points.iter().enumerate().map(|(k, point)| *first.entry(place(point)).or_insert(k as u32)).collect()
}

/// Gives triangles the corners that theirs are the same as; what has no area any more goes.
fn join(triangles: &mut Vec<[u32; 3]>, same: &[u32]) {
    for triangle in triangles.iter_mut() {
        *triangle = triangle.map(|k| same[k as usize]);
    }
    triangles.retain(|[a, b, c]| a != b && b != c && c != a);
}

/// Joins corners of open edges that lie within [`WELD`] of the mesh's size: what other programs lose when they round.
fn weld_open(points: &[[f64; 3]], triangles: &mut Vec<[u32; 3]>) {
    let corners = || triangles.iter().flatten().map(|k| points[*k as usize]);
    let low: [f64; 3] = std::array::from_fn(|d| corners().map(|p| p[d]).fold(f64::INFINITY, f64::min));
    let high: [f64; 3] = std::array::from_fn(|d| corners().map(|p| p[d]).fold(f64::NEG_INFINITY, f64::max));
    let near = WELD * length(minus(high, low));
    if near <= 0.0 || !near.is_finite() {
        return;
    }
    let mut border: Vec<u32> = edges(triangles).open.into_iter().flatten().collect();
    border.sort_unstable();
    border.dedup();
    let mut same: Vec<u32> = (0..points.len() as u32).collect();
    let place = |point: [f64; 3]| -> [i64; 3] { std::array::from_fn(|d| ((point[d] - low[d]) / near).floor() as i64) };
    let mut seen: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    for k in border {
        let point = points[k as usize];
        let [x, y, z] = place(point);
        let around = (0..27).map(|n| [x + n % 3 - 1, y + n / 3 % 3 - 1, z + n / 9 - 1]);
        let is_near = |other: &u32| length(minus(points[*other as usize], point)) <= near;
        let found = around.filter_map(|cell| seen.get(&cell)?.iter().copied().find(is_near)).next();
        match found {
            Some(first) => same[k as usize] = first,
            None => seen.entry([x, y, z]).or_default().push(k),
        }
    }
    join(triangles, &same);
}

/// Edges that make a surface none.
#[derive(Debug, Default)]
struct Edges {
    /// Those that are not run through equally often in both directions, by their corners.
    open: Vec<[u32; 2]>,
    /// How many belong to more than two triangles.
    crowded: usize,
}

fn edges(triangles: &[[u32; 3]]) -> Edges {
    let mut uses: HashMap<[u32; 2], [u32; 2]> = HashMap::with_capacity(2 * triangles.len());
    for [a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            let direction = usize::from(from > to);
            uses.entry([*from.min(to), *from.max(to)]).or_default()[direction] += 1;
        }
    }
    let open = uses.iter().filter(|(_, [there, back])| there != back).map(|(edge, _)| *edge);
    let mut open: Vec<[u32; 2]> = open.collect();
    open.sort_unstable();
    Edges { open, crowded: uses.values().filter(|[there, back]| there + back > 2).count() }
}

/// How many edges are open, and where.
fn open_text(open: &[[u32; 2]], points: &[[f64; 3]]) -> String {
    let corners = || open.iter().flatten().map(|k| points[*k as usize]);
    let low: [f64; 3] = std::array::from_fn(|d| corners().map(|p| p[d]).fold(f64::INFINITY, f64::min));
    let high: [f64; 3] = std::array::from_fn(|d| corners().map(|p| p[d]).fold(f64::NEG_INFINITY, f64::max));
    let [from, to] = open[0].map(|k| points[k as usize]);
    format!(
        "the surface is open, or its triangles face both ways, at {} edges between {low:?} and {high:?}, such as the one from \
         {from:?} to {to:?}",
        open.len()
    )
}

/// Places at triangles whose winding numbers on both sides are not 1 and 0: how many, of how many, and one of them.
fn crossings(tree: &Tree, sign: f64, beside: f64) -> (usize, usize, [f64; 3]) {
    let step = tree.triangles().len().div_ceil(LOOKS);
    let (mut wrong, mut looks, mut example) = (0, 0, [0.0; 3]);
    for [a, b, c] in tree.triangles().iter().step_by(step) {
        let normal = cross(minus(*b, *a), minus(*c, *a));
        let norm = length(normal);
        if norm == 0.0 {
            continue;
        }
        let middle = plus(plus(*a, *b), *c).map(|x| x / 3.0);
        // stay near the triangle, however small it is
        let reach = beside.min(0.1 * norm.sqrt());
        let side = normal.map(|x| sign * reach * x / norm);
        let (inside, outside) = (sign * tree.winding(minus(middle, side)), sign * tree.winding(plus(middle, side)));
        looks += 1;
        if (inside - 1.0).abs() > WRONG || outside.abs() > WRONG {
            wrong += 1;
            example = middle;
        }
    }
    (wrong, looks, example)
}
