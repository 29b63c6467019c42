//! Which pairs of a generation the next one keeps.

use crate::episode::Outcome;
use crate::scenario::Pair;

/// At most a `share` of `pairs`, hardest first: those that the fewest individuals drove clean, the
/// earlier one among equals.
///
/// A pair that nobody drove clean is not kept. It says little about who is better, and one that
/// cannot be driven at all would stay for ever.
pub(super) fn hardest(pairs: &[Pair], drives: &[Outcome], share: f32) -> Vec<Pair> {
    let most = (f64::from(share) * pairs.len() as f64) as usize;
    let clean = |pair: usize| {
        drives.iter().skip(pair).step_by(pairs.len()).filter(|drive| drive.clean()).count()
    };
    let mut driven: Vec<(usize, usize)> =
        (0..pairs.len()).map(|pair| (clean(pair), pair)).filter(|(clean, _)| *clean > 0).collect();
    driven.sort_unstable();
    driven.into_iter().take(most).map(|(_, pair)| pairs[pair]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Five pairs by three individuals; `#` is clean, `!` reached with a collision, `.` neither.
    #[test]
    fn the_hardest_pairs_that_somebody_drove_clean_are_kept() {
        let pairs: [Pair; 5] =
            std::array::from_fn(|i| Pair { start: [i as f32, 0.0, 0.0], goal: [9.0, 9.0] });
        let outcome = |letter| Outcome {
            reached: letter != '.',
            collisions: u32::from(letter == '!'),
            ..Outcome::default()
        };
        let drives: Vec<Outcome> =
            "##!.# ##..! #!.#!".replace(' ', "").chars().map(outcome).collect();
        let kept = |share| -> Vec<f32> {
            hardest(&pairs, &drives, share).iter().map(|pair| pair.start[0]).collect()
        };
        // Driven clean 3, 2, 0, 1 and 1 times.
        assert_eq!(kept(0.9), [3.0, 4.0, 1.0, 0.0]);
        assert_eq!(kept(0.5), [3.0, 4.0]);
        assert_eq!(kept(0.1), [0.0; 0]);
    }
}
