//! Whether a list of corners is a simple polygon.
//!
//! The orientation of three points decides everything. It is computed in `f64` from `f32`
//! corners, where only nearly straight triples are uncertain; those count as straight.

use std::cmp::Ordering;

/// Why corners make no polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Flaw {
    /// A corner equals the one before it.
    Repeated {
        /// Its index.
        corner: usize,
    },
    /// Two edges have a point in common that is no common corner.
    Crossing {
        /// The edges, by their first corners.
        edges: [usize; 2],
    },
    /// All corners lie on a line.
    Flat {
        /// In square metres.
        area: f64,
    },
}

/// Smallest area of a polygon, square metres.
const SMALLEST_AREA: f64 = 1e-6;

/// The first flaw of a closed polygon; none if it is simple.
pub(super) fn flaw(corners: &[[f32; 2]]) -> Option<Flaw> {
    let n = corners.len();
    let next = |index: usize| if index + 1 == n { 0 } else { index + 1 };
    if let Some(corner) = (0..n).find(|&index| corners[index] == corners[next(index)]) {
        return Some(Flaw::Repeated { corner: next(corner) });
    }
    let area = area(corners).abs();
    // Said before looking for crossings: a line runs back over itself, but that is not its point.
    if corners.iter().all(|corner| cross(corners[0], corners[1], *corner).abs() < SMALLEST_AREA) {
        return Some(Flaw::Flat { area });
    }

    let ends = |edge: usize| [corners[edge], corners[next(edge)]];
    let left = |edge: usize| ends(edge)[0][0].min(ends(edge)[1][0]);
    let right = |edge: usize| ends(edge)[0][0].max(ends(edge)[1][0]);
    // Sorted by their left ends, only edges that overlap in x are compared.
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| left(a).total_cmp(&left(b)));
    for (rank, &first) in order.iter().enumerate() {
        for &second in order[rank + 1..].iter().take_while(|&&other| left(other) <= right(first)) {
            let (a, b) = (first.min(second), first.max(second));
            let bad = if next(a) == b {
                folds_back(ends(a), corners[next(b)])
            } else if next(b) == a {
                folds_back(ends(b), corners[next(a)])
            } else {
                meet(ends(a), ends(b))
            };
            if bad {
                return Some(Flaw::Crossing { edges: [a, b] });
            }
        }
    }
    (area < SMALLEST_AREA).then_some(Flaw::Flat { area })
}

/// Area inside, positive if the corners run counter-clockwise, square metres.
fn area(corners: &[[f32; 2]]) -> f64 {
    let Some(&origin) = corners.first() else { return 0.0 };
    corners.windows(2).map(|edge| cross(origin, edge[0], edge[1])).sum::<f64>() / 2.0
}

/// Twice the signed area of a triangle.
fn cross(a: [f32; 2], b: [f32; 2], c: [f32; 2]) -> f64 {
    let [ax, ay] = a.map(f64::from);
    let [bx, by] = b.map(f64::from);
    let [cx, cy] = c.map(f64::from);
    (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
}

fn side(a: [f32; 2], b: [f32; 2], c: [f32; 2]) -> Ordering {
    cross(a, b, c).total_cmp(&0.0)
}

/// Whether the edge after `edge` runs back along it.
fn folds_back(edge: [[f32; 2]; 2], after: [f32; 2]) -> bool {
    let [a, b] = edge;
    let along: f64 = (0..2)
        .map(|axis| {
            let (a, b, c) = (f64::from(a[axis]), f64::from(b[axis]), f64::from(after[axis]));
            (b - a) * (c - b)
        })
        .sum();
    cross(a, b, after) == 0.0 && along < 0.0
}

/// Whether two edges have a point in common, their ends included.
fn meet([a, b]: [[f32; 2]; 2], [c, d]: [[f32; 2]; 2]) -> bool {
    let sides = [side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)];
    if sides[0] != sides[1] && sides[2] != sides[3] && !sides.contains(&Ordering::Equal) {
        return true;
    }
    let lies_on = |[a, b]: [[f32; 2]; 2], point: [f32; 2], side: Ordering| {
        side == Ordering::Equal
            && (0..2).all(|axis| {
                let (low, high) = (a[axis].min(b[axis]), a[axis].max(b[axis]));
                (low..=high).contains(&point[axis])
            })
    };
    lies_on([a, b], c, sides[0])
        || lies_on([a, b], d, sides[1])
        || lies_on([c, d], a, sides[2])
        || lies_on([c, d], b, sides[3])
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn simple_polygons_have_no_flaw_in_either_orientation() {
        let arrow = [[0.0, 0.0], [4.0, 0.0], [2.0, 1.0], [4.0, 2.0], [0.0, 2.0]];
        let straight_corner = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0]];
        for corners in [arrow.to_vec(), straight_corner.to_vec()] {
            assert_eq!(flaw(&corners), None);
            let reversed: Vec<_> = corners.into_iter().rev().collect();
            assert_eq!(flaw(&reversed), None);
        }
    }

    #[test]
    fn crossing_touching_and_folded_edges_are_found() {
        let bow = [[0.0, 0.0], [3.0, 2.0], [3.0, 0.0], [0.0, 1.0]];
        assert_eq!(flaw(&bow), Some(Flaw::Crossing { edges: [0, 2] }));
        let touching = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [2.0, 0.0], [0.0, 3.0]];
        assert!(matches!(flaw(&touching), Some(Flaw::Crossing { .. })));
        let spike = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [2.0, 3.0], [2.0, 1.0], [0.0, 1.0]];
        assert!(matches!(flaw(&spike), Some(Flaw::Crossing { .. })));
        let eight = [[0.0, 0.0], [2.0, 0.0], [1.0, 1.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0]];
        assert!(matches!(flaw(&eight), Some(Flaw::Crossing { .. })));
    }

    #[test]
    fn repeated_corners_and_flat_polygons_are_found() {
        let closed_twice = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]];
        assert_eq!(flaw(&closed_twice), Some(Flaw::Repeated { corner: 0 }));
        let line = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]];
        assert_eq!(flaw(&line), Some(Flaw::Flat { area: 0.0 }));
    }

    proptest! {
        /// Corners on growing angles around a point make a star-shaped, hence simple, polygon.
        #[test]
        fn star_shaped_polygons_have_no_flaw(radii in prop::collection::vec(0.5_f32..4.0, 3..40)) {
            let n = radii.len() as f32;
            let corners: Vec<[f32; 2]> = radii.iter().enumerate().map(|(index, radius)| {
                let angle = index as f32 / n * std::f32::consts::TAU;
                [radius * libm::cosf(angle), radius * libm::sinf(angle)]
            }).collect();
            prop_assert_eq!(flaw(&corners), None);
        }

        /// Swapping two neighbours of a convex polygon crosses two edges.
        #[test]
        fn a_convex_polygon_with_two_corners_swapped_crosses_itself(n in 4_usize..50, at in 0_usize..50) {
            let mut corners: Vec<[f32; 2]> = (0..n).map(|index| {
                let angle = index as f32 / n as f32 * std::f32::consts::TAU;
                [libm::cosf(angle), libm::sinf(angle)]
            }).collect();
            let at = at % n;
            corners.swap(at, (at + 1) % n);
            let crossing = matches!(flaw(&corners), Some(Flaw::Crossing { .. }));
            prop_assert!(crossing);
        }
    }
}
