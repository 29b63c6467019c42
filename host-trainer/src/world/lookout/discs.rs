//! Discs that touch, and hide what is farther off as walls do that meet.
//!
//! From beyond one side of all beams to beyond the other a line leads through their middles, inside
//! of them but for gaps no wider than a joint. A beam crosses it ahead of its start, inside a disc or
//! in a gap. If it does not graze a disc beside a gap, it is so deep in both neighbours that it has
//! met one before the gap. One that grazes a listed disc within [`Limits::slack`] gets its answer
//! from all obstacles, as one does that passes the end of a wall; across a single disc no beam can
//! graze it, since its edges lie farther than that beyond all beams.

use super::candidate::Candidate;
use super::cone::Cone;
use super::rounding::Limits;
use crate::world::shape::{Shape, left, length, minus};

/// Most discs looked at, the nearest.
const MOST: usize = 64;

/// Discs that touch each other.
struct Group {
    /// Their places among the candidates.
    discs: Vec<usize>,
    /// How far a beam goes at most that crosses the line through their middles.
    farthest: f64,
    /// Whether the line begins left of all beams, and ends right of them.
    sides: [bool; 2],
}

impl Group {
    fn join(&mut self, other: &Self) {
        self.discs.extend(&other.discs);
        self.farthest = self.farthest.max(other.farthest);
        self.sides = [self.sides[0] || other.sides[0], self.sides[1] || other.sides[1]];
    }
}

impl Cone<'_> {
    /// How far a beam goes at most that crosses such a line, if all beams do and it is less than
    /// `nearest`, and the places in the world of its discs, none of a single one. Discs are added
    /// by their distance until some make such a line.
    pub(super) fn behind_discs(&self, met: &[&Candidate], nearest: f64) -> Option<(f64, Vec<u32>)> {
        let mut groups: Vec<Group> = Vec::new();
        let within = met.iter().enumerate().take_while(|(_, disc)| disc.distance < nearest);
        for (place, disc) in
            within.filter(|(_, disc)| disc.shape.radius > 0.0 && disc.hides).take(MOST)
        {
            let Some(mut mine) = self.alone(place, disc) else { continue };
            if mine.sides != [true; 2] {
                groups.retain(|group| {
                    let touches = group.discs.iter().any(|other| self.touch(met[*other], disc));
                    if touches {
                        mine.join(group);
                    }
                    !touches
                });
            }
            if mine.sides == [true; 2] {
                let behind = mine.farthest + self.limits.slack;
                let ids = match &mine.discs[..] {
                    [_] => Vec::new(),
                    several => several.iter().map(|place| met[*place].id).collect(),
                };
                return (behind < nearest).then_some((behind, ids));
            }
            groups.push(mine);
        }
        None
    }

    /// A disc with the line across it, from its left to its right; none if that is not ahead of
    /// all beams, or a beam may start inside.
    fn alone(&self, place: usize, candidate: &Candidate) -> Option<Group> {
        let Shape { ends: [middle, _], radius, .. } = candidate.shape;
        if candidate.distance <= self.limits.slack {
            return None;
        }
        let [[rx, ry], [lx, ly]] = self.arc.edges;
        let across = left([rx + lx, ry + ly]);
        let scale = radius / length(across);
        let at = |side: f64| [middle[0] + across[0] * side, middle[1] + across[1] * side];
        let line = [at(scale), middle, at(-scale)];
        let farthest = line.map(|point| self.farthest(point)).into_iter().fold(0.0, f64::max);
        let group = Group {
            discs: vec![place],
            farthest: farthest + candidate.rounding.distance,
            sides: [self.side(line[0]) > 0.0, self.side(line[2]) < 0.0],
        };
        line.iter().all(|point| self.is_ahead(*point)).then_some(group)
    }

    /// Whether no beam passes between two discs, but for what the slack covers.
    fn touch(&self, a: &Candidate, b: &Candidate) -> bool {
        let Limits { joint, .. } = *self.limits;
        let apart = length(minus(a.shape.ends[0], b.shape.ends[0]));
        apart <= a.shape.radius + b.shape.radius + joint
    }
}
