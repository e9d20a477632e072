//! What can be wrong with the input. Not converging is a [`crate::Status`], never an error.

use std::f64::consts::SQRT_2;
use std::ops::RangeInclusive;

use thiserror::Error;

/// Why a curve or a setting was refused. `component` and `vertex` count from 0.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// A curve without components.
    #[error("the curve has no vertices")]
    Empty,
    /// A component of one or two vertices is no closed curve.
    #[error("component {component} has {n} vertices; a closed curve needs at least 3")]
    TooFewVertices {
        /// Which component.
        component: usize,
        /// How many vertices it has.
        n: usize,
    },
    /// A coordinate is NaN, infinite, or beyond 1e60.
    #[error(
        "vertex {vertex} of component {component} is not finite, or beyond 1e60; rescale the curve"
    )]
    NotFinite {
        /// Which component.
        component: usize,
        /// Which vertex of it.
        vertex: usize,
    },
    /// Two consecutive vertices coincide, or all but do, so that the edge between them has no direction.
    #[error("vertices {vertex} and {next} of component {component} coincide; remove one of them")]
    Coincident {
        /// Which component.
        component: usize,
        /// The first of the two vertices.
        vertex: usize,
        /// The second of the two vertices.
        next: usize,
    },
    /// Two edges that are not neighbours meet: such a curve has no knot type.
    #[error(
        "the curve crosses itself: the edge after vertex {vertex} of component {component} meets \
         the edge after vertex {other_vertex} of component {other_component}; move one of them"
    )]
    SelfCrossing {
        /// Component of the first edge.
        component: usize,
        /// Vertex at which the first edge starts.
        vertex: usize,
        /// Component of the second edge.
        other_component: usize,
        /// Vertex at which the second edge starts.
        other_vertex: usize,
    },
    /// The rope around the curve is too thin for its length to be filled with beads.
    #[error(
        "the curve comes so close to itself that a rope around it needs over {limit} beads; \
         move its strands apart"
    )]
    TooThin {
        /// The largest number of beads that is tried.
        limit: usize,
    },
    /// A curve with too many crossings, however simple the polygon is made.
    #[error(
        "the curve is so entangled that over {limit} crossings are left when it has been simplified; \
         so many cannot be loosened"
    )]
    TooEntangled {
        /// The most that is tried.
        limit: usize,
    },
    /// Fewer vertices than 3 for each component.
    #[error("n = {n} is too small; 3 vertices for each component make {needed} at least")]
    TooFew {
        /// The number of vertices that was asked for.
        n: usize,
        /// The smallest number that will do.
        needed: usize,
    },
    /// Edges so long that strands would fit between beads.
    #[error(
        "{n} vertices are too few: the edges of this knot would be {dl:.2} R long and must stay \
         below {limit} R, or strands would fit between beads; ask for at least {needed}"
    )]
    TooCoarse {
        /// The number of vertices that was asked for.
        n: usize,
        /// The edge length it leads to.
        dl: f64,
        /// What it must stay below.
        limit: f64,
        /// The smallest number that will do.
        needed: usize,
    },
    /// So few vertices that the straight edges between them would have to pass a strand.
    #[error(
        "{n} vertices are too few: a strand is in the way of the straight edges between them; ask for \
         at least {needed}"
    )]
    Pierced {
        /// The number of vertices that was asked for.
        n: usize,
        /// One that will do.
        needed: usize,
    },
    /// A bend so sharp that no bound is proven: the inscribed arc is too small beside the edges.
    #[error(
        "no bound is proven: R > S/sqrt 2 fails by {:?}, as R is {:?} by the bend at vertex {vertex} \
         of component {component}, and the longest edge is S = {:?}; round this bend off or make the \
         edges shorter, as `sono tighten` does",
        short(needed - r), short(*r), short(needed * SQRT_2)
    )]
    SharpBend {
        /// Component of the vertex.
        component: usize,
        /// The vertex.
        vertex: usize,
        /// The radius R that it allows.
        r: f64,
        /// What R must be above.
        needed: f64,
    },
    /// Two vertices so close that no bound is proven: there is no room for a rope on edges so long.
    #[error(
        "no bound is proven: R > S/sqrt 2 fails by {:?}, as R is {:?}, half the distance of vertex \
         {vertex} of component {component} from vertex {other_vertex} of component {other_component}, and \
         the longest edge is S = {:?}; move them apart or make the edges shorter, as `sono tighten` does",
        short(needed - r), short(*r), short(needed * SQRT_2)
    )]
    ClosePair {
        /// Component of the first vertex.
        component: usize,
        /// The first vertex.
        vertex: usize,
        /// Component of the second vertex.
        other_component: usize,
        /// The second vertex.
        other_vertex: usize,
        /// Half their distance, R.
        r: f64,
        /// What R must be above.
        needed: f64,
    },
    /// A setting lies outside its range.
    #[error("setting {name} = {value} is out of range: {range}")]
    Setting {
        /// Name of the setting.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
}

/// A number as a message has it, to six digits.
fn short(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

/// A [`std::result::Result`] with this crate's [`enum@Error`].
pub type Result<T> = std::result::Result<T, Error>;

/// Refuses a setting that lies outside what it `may` be; `range` says that in words.
pub(crate) fn within(
    name: &'static str,
    value: f64,
    may: RangeInclusive<f64>,
    range: &'static str,
) -> Result<()> {
    if may.contains(&value) { Ok(()) } else { Err(Error::Setting { name, value, range }) }
}
