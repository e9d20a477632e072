//! Closed polygons: the vertices `v_i`, the edges `s_i = v_(i+1) - v_i`, the turning angles.
//!
//! A [`Curve`] has one or more closed components (a link). The vertices of all components lie one
//! after the other in one array; indices into it are called `i` and `j`, a component's share of it
//! is a range.
//!
//! ```
//! use glam::DVec3;
//! let square = [(1., 0.), (0., 1.), (-1., 0.), (0., -1.)].map(|(x, y)| DVec3::new(x, y, 0.));
//! let curve = sono::Curve::new(vec![square.to_vec()])?;
//! assert!((curve.length() - 4. * 2f64.sqrt()).abs() < 1e-15);
//! assert_eq!(curve.index_distance(0, 3), Some(1));
//! # Ok::<(), sono::Error>(())
//! ```

use std::ops::Range;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// Coordinates beyond, and edges below, are refused: their powers must neither over- nor underflow.
const FURTHEST: f64 = 1e60;
const SHORTEST: f64 = 1e-60;
/// Neighbours coincide when they are closer than this share of their component's mean edge: below
/// it rounding decides where the edge between them points.
const COINCIDENT: f64 = 1e-12;

/// One or more closed polygons in space.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    vertices: Vec<DVec3>,
    /// `ends[c]` is one past the last vertex of component `c`.
    ends: Vec<usize>,
}

impl Curve {
    /// A curve from its components' vertices, checked: at least 3 vertices each, all
    /// coordinates within 1e60, all edges at least 1e-60 and 1e-12 of the mean edge long.
    ///
    /// # Errors
    /// [`Error::Empty`], [`Error::TooFewVertices`], [`Error::NotFinite`], [`Error::Coincident`].
    pub fn new(components: Vec<Vec<DVec3>>) -> Result<Self> {
        if components.is_empty() {
            return Err(Error::Empty);
        }
        for (component, vertices) in components.iter().enumerate() {
            check_component(component, vertices)?;
        }
        Ok(Self::from_components(components))
    }

    /// The same without the checks, for vertices that the core itself computed.
    pub(crate) fn from_components(components: Vec<Vec<DVec3>>) -> Self {
        let ends = components
            .iter()
            .scan(0, |end, vertices| {
                *end += vertices.len();
                Some(*end)
            })
            .collect();
        Self { vertices: components.concat(), ends }
    }

    /// Whether a restored curve is one: 3 vertices a component or more, all finite.
    pub(crate) fn is_sound(&self) -> bool {
        let starts = std::iter::once(&0).chain(&self.ends);
        self.ends.last() == Some(&self.vertices.len())
            && starts.zip(&self.ends).all(|(start, end)| start + 3 <= *end)
            && self.vertices.iter().all(|v| v.is_finite())
    }

    /// Number of vertices of all components together.
    pub fn n(&self) -> usize {
        self.vertices.len()
    }

    /// Number of components.
    pub fn components(&self) -> usize {
        self.ends.len()
    }

    /// All vertices, component after component.
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// All vertices, to be moved.
    pub fn vertices_mut(&mut self) -> &mut [DVec3] {
        &mut self.vertices
    }

    /// The indices of component `c`.
    pub fn range(&self, c: usize) -> Range<usize> {
        let start = if c == 0 { 0 } else { self.ends[c - 1] };
        start..self.ends[c]
    }

    /// The indices of each component.
    pub fn ranges(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        (0..self.components()).map(|c| self.range(c))
    }

    /// The vertices of component `c`.
    pub fn component(&self, c: usize) -> &[DVec3] {
        &self.vertices[self.range(c)]
    }

    /// The component that vertex `i` belongs to.
    pub fn component_of(&self, i: usize) -> usize {
        self.ends.partition_point(|&end| end <= i)
    }

    /// The vertex after `i`, round its component.
    pub fn next(&self, i: usize) -> usize {
        let range = self.range(self.component_of(i));
        if i + 1 == range.end { range.start } else { i + 1 }
    }

    /// The vertex before `i`, round its component.
    pub fn prev(&self, i: usize) -> usize {
        let range = self.range(self.component_of(i));
        if i == range.start { range.end - 1 } else { i - 1 }
    }

    /// The paper's ID: how many edges lie between vertices `i` and `j`, the shorter way round;
    /// `None` between components.
    pub fn index_distance(&self, i: usize, j: usize) -> Option<usize> {
        let c = self.component_of(i);
        let apart = i.abs_diff(j);
        (c == self.component_of(j)).then(|| apart.min(self.range(c).len() - apart))
    }

    /// Lengths of component `c`'s edges; edge `i` runs from vertex `i` to the next.
    pub fn edge_lengths(&self, c: usize) -> impl Iterator<Item = f64> + '_ {
        let v = self.component(c);
        (0..v.len()).map(|i| v[i].distance(v[(i + 1) % v.len()]))
    }

    /// Arclength of each vertex from the start of its component.
    pub fn arclengths(&self) -> Vec<f64> {
        let mut arclengths = Vec::with_capacity(self.n());
        for c in 0..self.components() {
            let mut at = 0.;
            arclengths.extend(self.edge_lengths(c).map(|s| {
                at += s;
                at - s
            }));
        }
        arclengths
    }

    /// Turning angles of component `c`, in radians; angle `i` is that between edges `i - 1` and `i`.
    pub fn turning_angles(&self, c: usize) -> impl Iterator<Item = f64> + '_ {
        let v = self.component(c);
        let n = v.len();
        (0..n).map(move |i| turning_angle(v[i] - v[(i + n - 1) % n], v[(i + 1) % n] - v[i]))
    }

    /// Length of component `c`.
    pub fn component_length(&self, c: usize) -> f64 {
        self.edge_lengths(c).sum()
    }

    /// Mean edge length of each component.
    pub fn mean_edges(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.components()).map(|c| self.component_length(c) / self.range(c).len() as f64)
    }

    /// Longest edge of each component.
    pub fn longest_edges(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.components()).map(|c| self.edge_lengths(c).fold(0., f64::max))
    }

    /// Length of all components together.
    pub fn length(&self) -> f64 {
        (0..self.components()).map(|c| self.component_length(c)).sum()
    }

    /// Multiplies every coordinate by `factor`.
    pub fn scale(&mut self, factor: f64) {
        self.vertices.iter_mut().for_each(|v| *v *= factor);
    }

    /// Moves the centre of all vertices to the origin.
    pub fn centre(&mut self) {
        let centre = self.vertices.iter().sum::<DVec3>() / self.n() as f64;
        self.vertices.iter_mut().for_each(|v| *v -= centre);
    }
}

/// Angle between two consecutive edges; atan2 keeps all digits near 0 and near pi.
pub(crate) fn turning_angle(before: DVec3, after: DVec3) -> f64 {
    before.cross(after).length().atan2(before.dot(after))
}

fn check_component(component: usize, vertices: &[DVec3]) -> Result<()> {
    let n = vertices.len();
    if n < 3 {
        return Err(Error::TooFewVertices { component, n });
    }
    let beyond = |v: &DVec3| !v.is_finite() || v.abs().max_element() > FURTHEST;
    if let Some(vertex) = vertices.iter().position(beyond) {
        return Err(Error::NotFinite { component, vertex });
    }
    let next = |i: usize| (i + 1) % n;
    let edges: Vec<_> = (0..n).map(|i| vertices[i].distance(vertices[next(i)])).collect();
    let least = SHORTEST.max(COINCIDENT * edges.iter().sum::<f64>() / n as f64);
    match edges.iter().position(|&edge| edge < least) {
        Some(vertex) => Err(Error::Coincident { component, vertex, next: next(vertex) }),
        None => Ok(()),
    }
}
