//! What bodies touch.
//!
//! Most bodies are near nothing, and one bit says so. The others stand side by side without gaps, whichever car
//! they are.

use super::Lookout;
use super::asked::Asked;
use super::beams;
use super::cell::SECTORS;
use super::grid::Turned;
use super::shelf::Question;
use crate::vector::{MOST_LANES, Vector, ones, pose_in_lane};
use controller_core::geometry::{Body, Disc, Segment};
use controller_core::motion::Pose;

/// Bodies that may touch something, one in each lane.
struct Close<V> {
    poses: Pose<V>,
    /// Which they are: lane by lane of the first car, then of the next.
    from: [usize; MOST_LANES],
    /// The cell and sector of each, see [`may_touch`](super::shelf::Shelf::may_touch).
    places: [u32; MOST_LANES],
    /// What they may touch.
    asked: Asked<1>,
    count: usize,
}

impl Lookout {
    /// Which of the bodies at these poses touch an obstacle's edge, or lie inside a disc, as
    /// bits; only those whose bit in `live` is set. Exact for every body within the largest.
    #[inline(always)]
    pub fn touches<V: Vector, const N: usize>(
        &self,
        body: &Body<f32>,
        poses: &[Pose<V>; N],
        live: &[u32; N],
    ) -> [u32; N] {
        const { assert!(N * V::WIDTH <= u128::BITS as usize) };
        debug_assert!(is_within(body, &self.largest), "{body:?} reaches beyond {:?}", self.largest);
        let mut places = [[0; MOST_LANES]; N];
        let cars = || (0..N).filter(|car| live[*car] != 0);
        // All of them first: the CPU goes on with the next car before it has the places of one.
        for car in cars() {
            let pose = &poses[car];
            let cells = self.grid.locate((pose.x, pose.y));
            places[car] = Turned::<V, SECTORS>::by(pose.heading).places(&cells.places());
        }
        // Lane by lane of the first car, then of the next.
        let mut close = 0_u128;
        for car in cars() {
            let mut lanes = live[car] & self.shelf.may_touch::<V>(&places[car]);
            if lanes != 0
                && let Some(field) = &self.field
            {
                lanes &= field.may_touch(&poses[car]);
            }
            close |= u128::from(lanes) << (car * V::WIDTH);
        }
        let mut touched = [0; N];
        while close != 0 {
            let row = self.line_up(&mut close, poses, &places);
            let touching = self.touching(body, &row);
            for lane in ones(touching) {
                let from = row.from[lane];
                touched[from / V::WIDTH] |= 1 << (from % V::WIDTH);
            }
        }
        touched
    }

    /// Takes the first of those that are close.
    #[inline(always)]
    fn line_up<V: Vector, const N: usize>(
        &self,
        close: &mut u128,
        poses: &[Pose<V>; N],
        places: &[[u32; MOST_LANES]; N],
    ) -> Close<V> {
        let zero = V::from(0.0);
        let mut row = Close {
            poses: Pose { x: zero, y: zero, heading: zero, cos: zero, sin: zero },
            from: [0; MOST_LANES],
            places: [0; MOST_LANES],
            asked: Asked::new(),
            count: 0,
        };
        while *close != 0 && row.count < V::WIDTH {
            let from = close.trailing_zeros() as usize;
            *close &= *close - 1;
            let (car, lane) = (from / V::WIDTH, from % V::WIDTH);
            let Pose { x, y, heading, cos, sin } = poses[car];
            let to = &mut row.poses;
            let to = [&mut to.x, &mut to.y, &mut to.heading, &mut to.cos, &mut to.sin];
            for (to, from) in to.into_iter().zip([x, y, heading, cos, sin]) {
                to.lanes_mut()[row.count] = from.lanes()[lane];
            }
            let place = places[car][lane];
            self.shelf.answer_near(&mut row.asked, row.count, place);
            (row.from[row.count], row.places[row.count]) = (from, place);
            row.count += 1;
        }
        row
    }

    /// Which of these bodies touch something, as bits.
    #[inline(always)]
    fn touching<V: Vector>(&self, body: &Body<f32>, row: &Close<V>) -> u32 {
        let Close { poses, asked, count, .. } = row;
        let Body { rear, front, half_width } = *body;
        let wide =
            Body { rear: V::from(rear), front: V::from(front), half_width: V::from(half_width) };
        let mut touching = 0;
        for round in 0..asked.longest(0) {
            let [a, b, c, d] = self.shelf.faces(asked.names(0, round));
            let wall = Segment { a: (a, b), b: (c, d) };
            let mut touches = wide.touches_segment(poses, &wall);
            if self.shelf.has_discs() {
                let is_disc = beams::are_discs(&[a, b, c, d]);
                let disc = Disc { centre: (a, b), radius: c };
                let in_disc = wide.touches_disc(poses, &disc);
                touches = (touches & !is_disc) | (in_disc & is_disc);
            }
            touching |= V::bits(touches);
        }
        let all = u32::MAX >> (u32::BITS - *count as u32);
        match asked.unknown::<V>(0) & all {
            0 => touching & all,
            open => touching & all & !open | self.settle_touch(body, row, open),
        }
    }

    #[cold]
    #[inline(never)]
    fn settle_touch<V: Vector>(&self, body: &Body<f32>, row: &Close<V>, open: u32) -> u32 {
        let mut touched = 0;
        for lane in ones(open) {
            let (cell, sector) = (row.places[lane] / SECTORS, row.places[lane] % SECTORS);
            let touches = self.settled_touch(body, &pose_in_lane(&row.poses, lane), cell, sector);
            touched |= u32::from(touches) << lane;
        }
        touched
    }

    fn settled_touch(&self, body: &Body<f32>, pose: &Pose<f32>, cell: u32, sector: u32) -> bool {
        let mut touches = false;
        let question = Question::Near(sector);
        let known = self.shelf.each(&self.grid, &self.obstacles, cell, question, |row| {
            let [a, b, c, d] = *row;
            touches |= if beams::are_discs(row) {
                body.touches_disc(pose, &Disc { centre: (a, b), radius: c })
            } else {
                body.touches_segment(pose, &Segment { a: (a, b), b: (c, d) })
            };
        });
        if known.is_some() { touches } else { self.obstacles.touch(body, pose) }
    }
}

/// Whether a body does not reach beyond another, but for what rounding adds to it, which the margins
/// of contacts allow for.
fn is_within(body: &Body<f32>, largest: &Body<f32>) -> bool {
    let reach = |body: &Body<f32>| [-body.rear, body.front, body.half_width];
    let pairs = reach(body).into_iter().zip(reach(largest));
    pairs.into_iter().all(|(own, most)| own <= most + 1.0e-6)
}
