//! Loops of known length: the counter has to find their instructions exactly.
#![expect(unsafe_code, reason = "only assembly has a length that no compiler changes")]

use crate::counter::Counter;

/// Rounds of the loops.
const ROUNDS: [u32; 3] = [1_000, 3_500, 100_000];

/// Two instructions a round.
#[inline(never)]
fn turn(rounds: u32) {
    // SAFETY: it changes nothing but its own register and the flags.
    unsafe {
        core::arch::asm!("2: subs {0}, #1", "bne 2b", inout(reg) rounds => _, options(nomem, nostack));
    }
}

/// The first loop that is counted wrong: rounds, instructions found and expected.
pub(crate) fn first_miscount(counter: &Counter) -> Option<(u32, u32, u32)> {
    let count = |rounds| counter.count(&mut || turn(core::hint::black_box(rounds)));
    let one = count(1);
    ROUNDS.into_iter().find_map(|rounds| {
        let (found, expected) = (count(rounds).wrapping_sub(one), 2 * (rounds - 1));
        (found != expected).then_some((rounds, found, expected))
    })
}
