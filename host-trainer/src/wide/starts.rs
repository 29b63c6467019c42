//! Where drives begin, worked out once for all individuals that drive a pair.

use super::{ENOUGH_INDIVIDUALS, Fleet};
use crate::car::Exemplar;
use crate::episode::start_pose;
use crate::seed::Stream;
use controller_core::motion::Pose;
use std::sync::OnceLock;

/// The start of each of a fleet's pairs, as far as anybody has driven it; or none, and each drive works out its own.
#[derive(Debug)]
pub(super) struct Starts(Vec<OnceLock<Start>>);

/// How the drive of a pair begins, whoever drives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    pub(super) pose: Pose<f32>,
    pub(super) exemplar: Exemplar,
}

impl Starts {
    /// None yet.
    pub(super) fn of(fleet: &Fleet<'_>) -> Self {
        let is_shared = fleet.individuals() >= ENOUGH_INDIVIDUALS;
        let pairs = if is_shared { fleet.pairs.len() } else { 0 };
        Self((0..pairs).map(|_| OnceLock::new()).collect())
    }

    /// The start of this pair, if it is kept.
    #[inline(always)]
    pub(super) fn kept(&self, fleet: &Fleet<'_>, pair: usize) -> Option<&Start> {
        Some(self.0.get(pair)?.get_or_init(|| begin(fleet, pair).0))
    }
}

/// The start of this pair, and the random numbers of what follows.
#[inline(never)]
pub(super) fn begin(fleet: &Fleet<'_>, index: usize) -> (Start, Stream) {
    let (problem, pair) = (fleet.problem, &fleet.pairs[index]);
    let (model, spec) = (problem.model(), &problem.scenario.episode);
    let mut random = (fleet.random)(index as u32);
    let pose = start_pose(&problem.world, model, spec, pair, &mut random);
    let exemplar = model.exemplar(&mut random);
    (Start { pose, exemplar }, random)
}
