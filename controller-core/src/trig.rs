//! Sine and cosine with the same bits everywhere, lane by lane.
//!
//! Used by the simulated car's motion. Error below 7.7e-8 within ±100 radians, measured at three
//! million angles.

use crate::lane::Lane;
use core::f32::consts::{FRAC_2_PI, PI};

/// Adding and taking away 1.5·2²³ rounds an `f32` to the nearest integer, ties to even.
const ROUND: f32 = 12_582_912.0;

/// Sine and cosine of an angle within ±100 radians.
///
/// Cody–Waite reduction by multiples of π/2 in three parts, then the polynomials of
/// Moshier's Cephes `sinf`/`cosf` on ±π/4.
#[inline(always)]
pub fn sin_cos<L: Lane>(angle: L) -> (L, L) {
    let round = L::from(ROUND);
    let quarter = (angle * L::from(FRAC_2_PI) + round) - round;
    // π/2 split so that `quarter` times each of the first two parts is exact.
    let r = angle - quarter * L::from(1.570_312_5);
    let r = r - quarter * L::from(4.837_513e-4);
    let r = r - quarter * L::from(7.549_79e-8);

    let z = r * r;
    let sin = ((L::from(-1.951_529_6e-4) * z + L::from(8.332_161e-3)) * z + L::from(-0.166_666_55))
        * z
        * r
        + r;
    let cos = ((L::from(2.443_315_7e-5) * z + L::from(-1.388_731_6e-3)) * z
        + L::from(4.166_664_6e-2))
        * z
        * z
        - L::from(0.5) * z
        + L::from(1.0);

    // quarter mod 4 as a number in {-2, -1, 0, 1, 2}: which quadrant the angle lies in.
    let turns = (quarter * L::from(0.25) + round) - round;
    let quadrant = quarter - turns * L::from(4.0);
    let swapped = L::from(0.5).lt(quadrant.abs()) & quadrant.abs().lt(L::from(1.5));
    let opposite = L::from(1.5).lt(quadrant.abs());
    let s = L::select(swapped, cos, sin);
    let c = L::select(swapped, sin, cos);
    let sin_negative = opposite | (swapped & quadrant.lt(L::from(0.0)));
    let cos_negative = opposite | (swapped & L::from(0.0).lt(quadrant));
    (L::select(sin_negative, -s, s), L::select(cos_negative, -c, c))
}

/// The same angle within about ±π, for one that is at most one turn outside.
#[inline(always)]
pub fn wrap<L: Lane>(angle: L) -> L {
    let turn = L::from(2.0 * PI);
    let down = L::select(L::from(PI).lt(angle), angle - turn, angle);
    L::select(down.lt(L::from(-PI)), down + turn, down)
}
