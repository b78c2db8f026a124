//! A tree of boxes around triangles: nearest triangle, and winding numbers with a dipole for what is far away. [Barill et al. 2018]

use std::f64::consts::PI;

use crate::scene::geometry::distance::{cross, dot, length, minus, plus};

type Point = [f64; 3];

/// Triangles in a leaf at most.
const LEAF: usize = 6;
/// A node is a dipole from this many of its radii on.
const FAR: f64 = 3.0;

/// Triangles in an order in which every node holds a range.
#[derive(Debug)]
pub(super) struct Tree {
    triangles: Vec<[Point; 3]>,
    nodes: Vec<Node>,
}

#[derive(Clone, Debug)]
struct Node {
    low: Point,
    high: Point,
    first: u32,
    count: u32,
    /// The second child; the first one follows its parent. 0 for leaves.
    second: u32,
    /// Mean place, weighted by area.
    center: Point,
    /// Sum of areas times normals.
    normal: Point,
    /// Largest distance of a corner from the centre.
    radius: f64,
}

impl Tree {
    /// Of triangles; none if there are none.
    pub(super) fn new(mut triangles: Vec<[Point; 3]>) -> Option<Self> {
        let mut nodes = Vec::new();
        if triangles.is_empty() {
            return None;
        }
        build(&mut triangles, 0, &mut nodes);
        Some(Self { triangles, nodes })
    }

    pub(super) fn triangles(&self) -> &[[Point; 3]] {
        &self.triangles
    }

    pub(super) fn bounds(&self) -> (Point, Point) {
        (self.nodes[0].low, self.nodes[0].high)
    }

    /// Distance to the surface, negative inside.
    pub(super) fn distance(&self, point: Point) -> f64 {
        let gap = self.nearest(point).sqrt();
        let (low, high) = self.bounds();
        let beyond = (0..3).any(|d| point[d] < low[d] || point[d] > high[d]);
        if !beyond && self.winding(point).abs() > 0.5 { -gap } else { gap }
    }

    /// Square of the distance to the nearest triangle.
    fn nearest(&self, point: Point) -> f64 {
        let mut best = f64::INFINITY;
        let mut stack = vec![(self.nodes[0].gap(point), 0usize)];
        while let Some((gap, index)) = stack.pop() {
            if gap >= best {
                continue;
            }
            let node = &self.nodes[index];
            if node.second == 0 {
                for triangle in self.own(node) {
                    best = best.min(square_distance(point, triangle));
                }
                continue;
            }
            let children = [index + 1, node.second as usize].map(|child| (self.nodes[child].gap(point), child));
            let [near, far] = if children[0].0 <= children[1].0 { children } else { [children[1], children[0]] };
            stack.push(far);
            stack.push(near);
        }
        best
    }

    /// Solid angle of the surface seen from a point, over that of a sphere: 1 inside a surface that faces outwards, 0 outside.
    pub(super) fn winding(&self, point: Point) -> f64 {
        let mut sum = 0.0;
        let mut stack = vec![0usize];
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index];
            let arm = minus(node.center, point);
            let reach = length(arm);
            if reach > FAR * node.radius {
                sum += dot(arm, node.normal) / (reach * reach * reach);
            } else if node.second == 0 {
                sum += self.own(node).iter().map(|triangle| solid_angle(point, triangle)).sum::<f64>();
            } else {
                stack.extend([index + 1, node.second as usize]);
            }
        }
        sum / (4.0 * PI)
    }

    fn own(&self, node: &Node) -> &[[Point; 3]] {
        &self.triangles[node.first as usize..(node.first + node.count) as usize]
    }
}

impl Node {
    /// Square of the distance to the box.
    fn gap(&self, point: Point) -> f64 {
        (0..3).map(|d| (self.low[d] - point[d]).max(point[d] - self.high[d]).max(0.0).powi(2)).sum()
    }
}

fn middle(triangle: &[Point; 3]) -> Point {
    let [a, b, c] = *triangle;
    plus(plus(a, b), c).map(|x| x / 3.0)
}

/// Adds the node of `triangles`, whose first one is number `first`, and those below it.
fn build(triangles: &mut [[Point; 3]], first: usize, nodes: &mut Vec<Node>) {
    let corners = || triangles.iter().flatten();
    let low: Point = std::array::from_fn(|d| corners().map(|p| p[d]).fold(f64::INFINITY, f64::min));
    let high: Point = std::array::from_fn(|d| corners().map(|p| p[d]).fold(f64::NEG_INFINITY, f64::max));
    let (mut normal, mut center, mut area) = ([0.0; 3], [0.0; 3], 0.0);
    for triangle in triangles.iter() {
        let own = cross(minus(triangle[1], triangle[0]), minus(triangle[2], triangle[0])).map(|x| 0.5 * x);
        let size = length(own);
        normal = plus(normal, own);
        center = plus(center, middle(triangle).map(|x| x * size));
        area += size;
    }
    let center = if area > 0.0 { center.map(|x| x / area) } else { plus(low, high).map(|x| 0.5 * x) };
    let radius = corners().map(|corner| length(minus(*corner, center))).fold(0.0, f64::max);
    let index = nodes.len();
    let count = triangles.len();
    nodes.push(Node { low, high, first: first as u32, count: count as u32, second: 0, center, normal, radius });
    if count <= LEAF {
        return;
    }
    let longest = (0..3).max_by(|&a, &b| (high[a] - low[a]).total_cmp(&(high[b] - low[b]))).unwrap_or(0);
    triangles.select_nth_unstable_by(count / 2, |a, b| middle(a)[longest].total_cmp(&middle(b)[longest]));
    let (left, right) = triangles.split_at_mut(count / 2);
    build(left, first, nodes);
    nodes[index].second = nodes.len() as u32;
    build(right, first + count / 2, nodes);
}

/// Solid angle of a triangle. [van Oosterom and Strackee 1983]
fn solid_angle(point: Point, triangle: &[Point; 3]) -> f64 {
    let [a, b, c] = triangle.map(|corner| minus(corner, point));
    let [la, lb, lc] = [a, b, c].map(length);
    let above = dot(a, cross(b, c));
    let below = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
    2.0 * above.atan2(below)
}

/// Square of the distance to a triangle. [Ericson, Real-Time Collision Detection, 5.1.5]
fn square_distance(point: Point, [a, b, c]: &[Point; 3]) -> f64 {
    let (ab, ac, ap) = (minus(*b, *a), minus(*c, *a), minus(point, *a));
    let along = |from: Point, edge: Point, t: f64| {
        let gap = minus(point, plus(from, edge.map(|x| x * t)));
        dot(gap, gap)
    };
    let (d1, d2) = (dot(ab, ap), dot(ac, ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return along(*a, ab, 0.0);
    }
    let bp = minus(point, *b);
    let (d3, d4) = (dot(ab, bp), dot(ac, bp));
    if d3 >= 0.0 && d4 <= d3 {
        return along(*b, ab, 0.0);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return along(*a, ab, d1 / (d1 - d3));
    }
    let cp = minus(point, *c);
    let (d5, d6) = (dot(ab, cp), dot(ac, cp));
    if d6 >= 0.0 && d5 <= d6 {
        return along(*c, ab, 0.0);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return along(*a, ac, d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return along(*b, minus(*c, *b), (d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let normal = cross(ab, ac);
    dot(ap, normal).powi(2) / dot(normal, normal)
}
