//! The car's beams, ready to be turned by its heading.

use super::cell::BINS;
use super::grid::parts_of_turn;
use controller_core::geometry::Ray;
use controller_core::lane::Lane;
use controller_core::motion::Pose;
use controller_core::observation::{BEAMS, BeamMount};
use controller_core::trig::sin_cos;

/// Bins that are no farther apart lie in one line of the cache, or in two that follow each other.
const BINS_OF_LINE: f32 = 31.0;

/// The beams of a car, and how far they reach.
#[derive(Clone, Debug, PartialEq)]
pub struct Fan {
    beams: [Beam; BEAMS],
    range: f32,
    has_one_origin: bool,
}

/// A beam's mount, with the cosine and sine of its angle.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Beam {
    mount: BeamMount,
    cos: f32,
    sin: f32,
    /// Its angle in bins.
    bins: f32,
    /// Whether what it asks for is fetched: what the beams between those ask for lies in the same lines of the cache.
    is_fetched: bool,
}

impl Fan {
    /// Beams at these mounts that reach `range` metres.
    pub fn new(mounts: &[BeamMount; BEAMS], range: f32) -> Self {
        let mut beams = mounts.map(|mount| {
            let (sin, cos) = sin_cos(mount.angle);
            Beam { mount, cos, sin, bins: parts_of_turn(mount.angle, BINS), is_fetched: false }
        });
        let starts_with_first =
            |mount: &BeamMount| (mount.x, mount.y) == (mounts[0].x, mounts[0].y);
        let has_one_origin = mounts.iter().all(starts_with_first);
        let mut fetched = 0;
        for beam in 0..BEAMS {
            let next = beams.get(beam + 1).map(|next| (next.bins - beams[fetched].bins).abs());
            if !has_one_origin || beam == 0 || next.is_none_or(|apart| apart > BINS_OF_LINE) {
                (beams[beam].is_fetched, fetched) = (true, beam);
            }
        }
        Self { beams, range, has_one_origin }
    }

    /// How far the beams reach, metres.
    pub fn range(&self) -> f32 {
        self.range
    }

    /// Whether all beams start at the same point of the car.
    #[inline(always)]
    pub(super) fn has_one_origin(&self) -> bool {
        self.has_one_origin
    }

    /// How far to the left one beam of a car lies, in bins.
    #[inline(always)]
    pub(super) fn bins(&self, beam: usize) -> f32 {
        self.beams[beam].bins
    }

    /// Whether to fetch what this beam asks for.
    #[inline(always)]
    pub(super) fn is_fetched(&self, beam: usize) -> bool {
        self.beams[beam].is_fetched
    }

    /// The beams of cars at these poses, rightmost first.
    pub fn rays<L: Lane>(&self, pose: &Pose<L>) -> [Ray<L>; BEAMS] {
        let mut rays = Rays::default();
        self.cast(pose, &mut rays);
        std::array::from_fn(|beam| rays.ray(beam))
    }

    /// The same, in place.
    #[inline(always)]
    pub(super) fn cast<L: Lane>(&self, pose: &Pose<L>, rays: &mut Rays<L>) {
        rays.has_one_origin = self.has_one_origin;
        rays.origins[0] = self.beams[0].origin(pose);
        for (beam, mounted) in self.beams.iter().enumerate() {
            if beam > 0 && !self.has_one_origin {
                rays.origins[beam] = mounted.origin(pose);
            }
            rays.directions[beam] = mounted.direction(pose);
        }
    }
}

/// The beams of a car in each lane. Where all start at the same point, it is written down once: vectors take long to write.
#[derive(Clone, Copy, Debug)]
pub struct Rays<L> {
    origins: [(L, L); BEAMS],
    directions: [(L, L); BEAMS],
    has_one_origin: bool,
}

impl<L: Lane> Default for Rays<L> {
    #[inline(always)]
    fn default() -> Self {
        let zero = (L::from(0.0), L::from(0.0));
        Self { origins: [zero; BEAMS], directions: [zero; BEAMS], has_one_origin: true }
    }
}

impl<L: Lane> Rays<L> {
    /// One beam, counted from the rightmost.
    #[inline(always)]
    pub fn ray(&self, beam: usize) -> Ray<L> {
        let origin = self.origins[if self.has_one_origin { 0 } else { beam }];
        Ray { origin, direction: self.directions[beam] }
    }
}

impl Beam {
    #[inline(always)]
    fn origin<L: Lane>(&self, pose: &Pose<L>) -> (L, L) {
        pose.to_world(L::from(self.mount.x), L::from(self.mount.y))
    }

    #[inline(always)]
    fn direction<L: Lane>(&self, pose: &Pose<L>) -> (L, L) {
        let (cos, sin) = (L::from(self.cos), L::from(self.sin));
        (pose.cos * cos - pose.sin * sin, pose.sin * cos + pose.cos * sin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{Instructions, Kernel, Vector};

    /// Casts the beams of fans in turn, in the same place.
    struct Cast<'a>(&'a [Fan]);

    impl Kernel for Cast<'_> {
        type Output = ();

        #[inline(always)]
        fn run<V: Vector>(self) {
            let mut rays = Rays::default();
            for (turn, fan) in self.0.iter().enumerate() {
                let pose = Pose::new(1.5 + turn as f32, -0.5, 0.3 * turn as f32);
                let Pose { x, y, heading, cos, sin } = pose;
                let [x, y, heading, cos, sin] = [x, y, heading, cos, sin].map(V::from);
                fan.cast(&Pose { x, y, heading, cos, sin }, &mut rays);
                for (beam, Beam { mount, .. }) in fan.beams.iter().enumerate() {
                    let Ray { origin, direction } = rays.ray(beam);
                    let expected = pose.to_world(mount.x, mount.y);
                    let (sin, cos) = sin_cos(pose.heading + mount.angle);
                    for lane in 0..V::WIDTH {
                        let origin = (origin.0.lanes()[lane], origin.1.lanes()[lane]);
                        assert_eq!(origin, expected, "beam {beam} in turn {turn}");
                        let [x, y] = [direction.0.lanes()[lane], direction.1.lanes()[lane]];
                        assert!((x - cos).abs() + (y - sin).abs() < 1e-5, "{beam} in {turn}");
                    }
                }
            }
        }
    }

    #[test]
    fn beams_start_where_they_are_mounted_whoever_cast_theirs_before() {
        let fan = |origins: [[f32; 2]; BEAMS]| {
            let mut angle = -0.6;
            let mounts = origins.map(|[x, y]| {
                angle += 0.2;
                BeamMount { x, y, angle }
            });
            Fan::new(&mounts, 10.0)
        };
        let one = fan([[0.2, 0.1]; BEAMS]);
        let other = fan([[-0.1, 0.0]; BEAMS]);
        let many = fan([[0.0, 0.1], [0.1, 0.1], [0.2, 0.0], [0.1, -0.1], [0.0, -0.1]]);
        let fans = [one.clone(), many.clone(), other, many, one];
        for set in Instructions::available() {
            set.run(Cast(&fans));
        }
    }

    fn fetched(degrees: [f32; BEAMS], x: f32) -> [bool; BEAMS] {
        let mut mounts =
            degrees.map(|angle| BeamMount { x: 0.0, y: 0.0, angle: angle.to_radians() });
        mounts[2].x = x;
        let fan = Fan::new(&mounts, 10.0);
        std::array::from_fn(|beam| fan.is_fetched(beam))
    }

    #[test]
    fn of_beams_that_ask_in_the_same_lines_of_the_cache_the_outer_ones_are_fetched() {
        let outer = [true, false, false, false, true];
        assert_eq!(fetched([-30.0, -15.0, 0.0, 15.0, 30.0], 0.0), outer);
        assert_eq!(fetched([-90.0, -45.0, 0.0, 45.0, 90.0], 0.0), [true, true, true, true, true]);
        assert_eq!(fetched([-80.0, -40.0, 0.0, 40.0, 80.0], 0.0), [true, false, true, false, true]);
        assert_eq!(fetched([0.0; BEAMS], 0.0), outer);
        assert_eq!(fetched([-30.0, -15.0, 0.0, 15.0, 30.0], 0.1), [true; BEAMS], "other cells");
    }
}
