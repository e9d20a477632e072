//! The crossings of a projection, decided exactly.

use glam::DVec3;
use robust::{Coord, orient2d};

use crate::geometry::curve::Curve;
use crate::geometry::sticks::volume;

/// A crossing, seen along the z axis from above.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Places of the upper and of the lower strand, counted in edges from the first vertex.
    pub over: f64,
    /// See `over`.
    pub under: f64,
    /// Whether the crossing is right-handed.
    pub right: bool,
}

/// The crossings of a polygon no two vertices of which are seen in one place, as after
/// [`crate::simplified`]; of more than `most`, only some.
pub fn crossings(curve: &Curve, most: usize) -> Vec<Crossing> {
    let v = curve.vertices();
    let edges: Vec<_> = (0..curve.n()).map(|i| (i, curve.next(i))).collect();
    let mut order: Vec<_> = (0..edges.len()).collect();
    let low = |i: usize| v[edges[i].0].x.min(v[edges[i].1].x);
    let high = |i: usize| v[edges[i].0].x.max(v[edges[i].1].x);
    order.sort_unstable_by(|&i, &j| low(i).total_cmp(&low(j)));
    let mut found = vec![];
    for (k, &i) in order.iter().enumerate() {
        if found.len() > most {
            break;
        }
        for &j in order[k + 1..].iter().take_while(|&&j| low(j) <= high(i)) {
            let (i, j) = (i.min(j), i.max(j));
            let [(a, b), (c, d)] = [edges[i], edges[j]];
            if b != c && d != a {
                found.extend(crossing([v[a], v[b]], [v[c], v[d]], [i, j]));
            }
        }
    }
    found.sort_unstable_by(|a, b| a.over.total_cmp(&b.over));
    found
}

/// The crossing of two edges, if they cross.
fn crossing(one: [DVec3; 2], other: [DVec3; 2], numbers: [usize; 2]) -> Option<Crossing> {
    let sides = |[a, b]: [DVec3; 2], ends: [DVec3; 2]| ends.map(|p| area(a, b, p));
    let across = |[s, t]: [f64; 2]| (s > 0.) != (t > 0.);
    let (of_other, of_one) = (sides(one, other), sides(other, one));
    if !across(of_other) || !across(of_one) {
        return None;
    }
    let place = |number: usize, [s, t]: [f64; 2]| number as f64 + (s / (s - t)).clamp(0., 1.);
    let [i, j] = [place(numbers[0], of_one), place(numbers[1], of_other)];
    // The volume is negative where the second strand runs to the left below the first.
    let left = of_other[1] > 0.;
    let first_is_over = (volume(one[0], one[1], other[0], other[1]) < 0.) == left;
    let (over, under) = if first_is_over { (i, j) } else { (j, i) };
    Some(Crossing { over, under, right: first_is_over == left })
}

fn area(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let [a, b, c] = [a, b, c].map(|p| Coord { x: p.x, y: p.y });
    orient2d(a, b, c)
}

/// The number of crossings seen along that axis from which there are fewest; more than `most` are
/// not counted.
pub fn fewest_crossings(curve: &Curve, most: usize) -> usize {
    let turned = |turns: usize| {
        let mut curve = curve.clone();
        curve.vertices_mut().iter_mut().for_each(|v| {
            *v = DVec3::from_array(std::array::from_fn(|axis| v[(axis + turns) % 3]));
        });
        crossings(&curve, most).len()
    };
    (0..3).map(turned).min().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(points: &[[f64; 3]]) -> Curve {
        Curve::new(vec![points.iter().map(|&p| DVec3::from(p)).collect()]).unwrap()
    }

    #[test]
    fn a_kink_has_the_crossing_that_is_seen() {
        // The first edge runs along x below the third, which crosses it to the right.
        let kink = curve(&[[-1., 0., 0.], [1., 0., 0.], [0., 1., 1.], [0., -1., 1.]]);
        let [crossing] = crossings(&kink, 9)[..] else { panic!("not one crossing") };
        assert_eq!((crossing.over, crossing.under, crossing.right), (2.5, 0.5, true));
        let above = curve(&[[-1., 0., 2.], [1., 0., 2.], [0., 1., 1.], [0., -1., 1.]]);
        let [crossing] = crossings(&above, 9)[..] else { panic!("not one crossing") };
        assert_eq!((crossing.over, crossing.under, crossing.right), (0.5, 2.5, false));
    }

    #[test]
    fn strands_one_bit_apart_are_told_apart() {
        for (z, over) in [(f64::EPSILON, 2.5), (-f64::EPSILON, 0.5)] {
            let near = curve(&[[-1., 0., 1.], [1., 0., 1.], [0., 1., 1. + z], [0., -1., 1. + z]]);
            assert_eq!(crossings(&near, 9)[0].over, over);
        }
    }

    #[test]
    fn the_view_with_fewest_crossings_counts() {
        let kink = curve(&[[-1., 0., 0.], [1., 0., 0.], [0., 1., 1.], [0.1, -1., 1.2]]);
        assert_eq!((crossings(&kink, 9).len(), fewest_crossings(&kink, 9)), (1, 0));
    }
}
