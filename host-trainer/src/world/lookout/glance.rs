//! What many cars see at once, and what is written down until they do.

use super::asked::Asked;
use super::beams::Met;
use super::fan::Rays;
use super::later::Later;
use crate::vector::Vector;
use controller_core::observation::BEAMS;

/// What cars see, `N` in each lane; `Q` is `N * BEAMS`.
///
/// To be kept from one control period to the next where cars are many: it is many bytes, and filling them again
/// takes a while. What it holds of cars that were not live in the last [look](super::Lookout::look) means nothing.
pub struct Glance<V, const N: usize, const Q: usize> {
    /// The beams of each car, rightmost first.
    pub rays: [Rays<V>; N],
    /// How far they go, metres: the distance to the nearest obstacle, or infinity if there is none within range.
    pub distances: [[V; BEAMS]; N],
    /// What had to be tested.
    pub(super) asked: Asked<Q>,
    /// What beams have met first, question by question.
    pub(super) first: [Met<V>; Q],
    /// Those that may meet more.
    pub(super) later: Later<V, Q>,
}

impl<V: Vector, const N: usize, const Q: usize> Default for Glance<V, N, Q> {
    /// Nothing is seen yet.
    #[inline(always)]
    fn default() -> Self {
        const { assert!(Q == N * BEAMS) };
        let zero = V::from(0.0);
        Self {
            rays: [Rays::default(); N],
            distances: [[zero; BEAMS]; N],
            asked: Asked::new(),
            first: [Met::nothing(); Q],
            later: Later::new(),
        }
    }
}
