//! How much arithmetic one step is: counted by a number that counts what is done with it.
//!
//! All arithmetic of a step is generic over [`Lane`]. `Counting` is a lane like any other,
//! and so the very functions that drive a car say what they cost, whatever they are compiled to.

use crate::problem::Problem;
use controller_core::activation::Rational;
use controller_core::geometry::{Body, Disc, Ray, Segment};
use controller_core::lane::Lane;
use controller_core::motion::Pose;
use controller_core::network::{Elman, Network, State};
use controller_core::observation::{BEAMS, INPUTS, Sight};
use std::cell::Cell;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

use super::workload;

/// Operations on lanes, by kind. Constants, loads and stores are not counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Sums and differences.
    pub add: u64,
    /// Products.
    pub mul: u64,
    /// Quotients.
    pub div: u64,
    /// Square roots.
    pub sqrt: u64,
    /// Comparisons, smaller and larger of two.
    pub compare: u64,
    /// Selections, signs, and masks joined.
    pub select: u64,
}

impl Operations {
    /// Everything but quotients and square roots: what a CPU does at one or more per cycle.
    pub fn simple(&self) -> u64 {
        self.add + self.mul + self.compare + self.select
    }

    /// Those that count as floating-point operations.
    pub fn flops(&self) -> u64 {
        self.add + self.mul + self.div + self.sqrt
    }

    /// The same `times` over.
    #[must_use]
    pub fn times(self, times: u64) -> Self {
        let Self { add, mul, div, sqrt, compare, select } = self;
        Self {
            add: add * times,
            mul: mul * times,
            div: div * times,
            sqrt: sqrt * times,
            compare: compare * times,
            select: select * times,
        }
    }
}

impl AddAssign for Operations {
    fn add_assign(&mut self, other: Self) {
        self.add += other.add;
        self.mul += other.mul;
        self.div += other.div;
        self.sqrt += other.sqrt;
        self.compare += other.compare;
        self.select += other.select;
    }
}

/// What one step of one car consists of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    /// The network: 7-12-12-1, Elman.
    pub network: Operations,
    /// Everything else that does not depend on the number of walls: beams' directions, the
    /// target, inputs, command, motion, arrival.
    pub car: Operations,
    /// One beam against one wall.
    pub beam_and_wall: Operations,
    /// The body against one wall.
    pub body_and_wall: Operations,
}

thread_local! {
    static DONE: Cell<Operations> = const {
        Cell::new(Operations { add: 0, mul: 0, div: 0, sqrt: 0, compare: 0, select: 0 })
    };
}

/// What a piece of work consists of.
fn count<T>(work: impl FnOnce() -> T) -> Operations {
    DONE.set(Operations::default());
    std::hint::black_box(work());
    DONE.take()
}

fn did(what: impl FnOnce(&mut Operations)) {
    let mut done = DONE.get();
    what(&mut done);
    DONE.set(done);
}

/// Counts the parts of the workload's step.
pub fn of_a_step(problem: &Problem) -> Parts {
    let number = Counting::from;
    let genome = workload::population(1);
    let network = Network::<Elman, f32, INPUTS, 12, 1>::new(&genome, true);
    let network = network.expect("the workload's topology");
    let (model, scaling) = (problem.model(), problem.scaling());
    let pose = Pose { x: 5.0, y: 3.4, heading: 0.0, cos: 1.0, sin: 0.0 };
    let wide = Pose {
        x: number(pose.x),
        y: number(pose.y),
        heading: number(pose.heading),
        cos: number(pose.cos),
        sin: number(pose.sin),
    };
    let target = Disc { centre: (number(5.0), number(9.2)), radius: number(0.3) };
    let wall = Segment { a: (number(4.0), number(1.0)), b: (number(5.0), number(2.0)) };
    let ray = Ray { origin: (wide.x, wide.y), direction: (wide.cos, wide.sin) };
    let Body { rear, front, half_width } = *model.body();
    let body = Body { rear: number(rear), front: number(front), half_width: number(half_width) };

    let car = || {
        let (zero, one) = (number(0.0), number(1.0));
        let mut sight =
            Sight { distance: [zero; BEAMS], wall: [zero; BEAMS], target: [zero; BEAMS] };
        for (beam, ray) in model.fan().rays(&wide).iter().enumerate() {
            let target = ray.to_disc(&target);
            let hit = model.hit(number(2.0), target);
            sight.distance[beam] = hit.distance;
            sight.wall[beam] = Counting::select(hit.wall, one, zero);
            sight.target[beam] = Counting::select(hit.target, one, zero);
        }
        let inputs = scaling.encoding.inputs(&sight, scaling.range);
        let (steer, step) = scaling.commands(&[inputs[0]]);
        let moved = wide.driven(steer, step, number(0.3));
        model.touches_target(&moved, &target)
    };
    Parts {
        network: count(|| {
            network.step(Rational, &mut State::<Counting, 12>::reset(), &[number(0.5); INPUTS])
        }),
        car: count(car),
        beam_and_wall: count(|| ray.to_segment(&wall)),
        body_and_wall: count(|| body.touches_segment(&wide, &wall)),
    }
}

/// A number that counts what is done with it.
#[derive(Clone, Copy, Debug)]
struct Counting(f32);

/// An answer that counts what is done with it.
#[derive(Clone, Copy, Debug)]
struct Answer(bool);

impl From<f32> for Counting {
    fn from(number: f32) -> Self {
        Self(number)
    }
}

macro_rules! counted {
    ($($trait:ident :: $method:ident $field:ident),*) => {$(
        impl $trait for Counting {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                did(|done| done.$field += 1);
                Self(self.0.$method(other.0))
            }
        }
    )*};
}
counted!(Add::add add, Sub::sub add, Mul::mul mul, Div::div div);

macro_rules! counted_answer {
    ($($trait:ident :: $method:ident),*) => {$(
        impl $trait for Answer {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                did(|done| done.select += 1);
                Self(self.0.$method(other.0))
            }
        }
    )*};
}
counted_answer!(BitAnd::bitand, BitOr::bitor);

impl Neg for Counting {
    type Output = Self;
    fn neg(self) -> Self {
        did(|done| done.select += 1);
        Self(-self.0)
    }
}

impl Not for Answer {
    type Output = Self;
    fn not(self) -> Self {
        did(|done| done.select += 1);
        Self(!self.0)
    }
}

impl Lane for Counting {
    type Mask = Answer;

    fn lt(self, other: Self) -> Answer {
        did(|done| done.compare += 1);
        Answer(self.0 < other.0)
    }

    fn le(self, other: Self) -> Answer {
        did(|done| done.compare += 1);
        Answer(self.0 <= other.0)
    }

    fn select(mask: Answer, yes: Self, no: Self) -> Self {
        did(|done| done.select += 1);
        if mask.0 { yes } else { no }
    }

    fn abs(self) -> Self {
        did(|done| done.select += 1);
        Self(self.0.abs())
    }

    fn sqrt(self) -> Self {
        did(|done| done.sqrt += 1);
        Self(Lane::sqrt(self.0))
    }

    fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self(f(self.0))
    }

    /// One instruction, as on an x86.
    fn min(self, other: Self) -> Self {
        did(|done| done.compare += 1);
        Self(Lane::min(self.0, other.0))
    }

    /// One instruction, as on an x86.
    fn max(self, other: Self) -> Self {
        did(|done| done.compare += 1);
        Self(Lane::max(self.0, other.0))
    }

    /// Two instructions, as on an x86.
    fn held_within(self, limit: f32) -> Self {
        did(|done| done.compare += 2);
        Self(self.0.held_within(limit))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_this_much_arithmetic() {
        let parts = of_a_step(&workload::problem().unwrap());
        // 84 + 144 + 144 + 144 + 12 weights that multiply; each tanh has 10 products, 8 sums, a
        // quotient and two limits.
        let network = Operations {
            add: 528 + 25 * 8,
            mul: 528 + 25 * 10,
            div: 25,
            compare: 50,
            ..Operations::default()
        };
        assert_eq!(parts.network, network);
        let beam = Operations { add: 7, mul: 6, div: 1, sqrt: 0, compare: 5, select: 9 };
        assert_eq!(parts.beam_and_wall, beam);
        insta::assert_debug_snapshot!((parts.car, parts.body_and_wall));
    }
}
