//! The three tanh over a stride of all f32, against tanh in double precision.

use controller_core::activation::digest::{Inputs, of, of_lanes};
use controller_core::activation::{Activation, ActivationKind, Libm, Micromath, Rational, tanh};
use controller_core::lane::Lanes;

/// Every 1021st bit pattern: 4.2 million inputs over all exponents and both signs.
fn stride() -> impl Iterator<Item = f32> {
    (0..=u32::MAX).step_by(1021).map(f32::from_bits)
}

fn apply(kind: ActivationKind, x: f32) -> f32 {
    let mut sums = [x];
    kind.apply(&mut sums);
    sums[0]
}

/// Spacing of f32 around a value.
fn ulp(value: f64) -> f64 {
    let exponent = libm::log2(value.abs().max(f64::from(f32::MIN_POSITIVE))).floor();
    libm::exp2(exponent - 23.0)
}

/// Largest error in ULP of the exact value, and the largest absolute one.
fn worst(kind: ActivationKind) -> (f64, f64) {
    let mut worst = (0.0f64, 0.0f64);
    for x in stride().filter(|x| x.is_finite()) {
        let exact = libm::tanh(f64::from(x));
        let error = (f64::from(apply(kind, x)) - exact).abs();
        worst = (worst.0.max(error / ulp(exact)), worst.1.max(error));
    }
    worst
}

#[test]
fn the_documented_error_bounds_hold() {
    let (ulps, absolute) = worst(ActivationKind::Rational);
    assert!(ulps <= 5.81 && absolute <= 3.5e-7, "rational: {ulps} ULP, {absolute:e}");
    let (ulps, absolute) = worst(ActivationKind::Libm);
    assert!(ulps <= 2.19 && absolute <= 8.5e-8, "libm: {ulps} ULP, {absolute:e}");
    let (_, absolute) = worst(ActivationKind::Micromath);
    assert!(absolute <= 1.1e-3, "micromath: {absolute:e}");
}

#[test]
fn no_tanh_ever_leaves_plus_minus_one_and_nan_stays_nan() {
    for kind in [ActivationKind::Rational, ActivationKind::Libm, ActivationKind::Micromath] {
        for x in stride() {
            let y = apply(kind, x);
            assert_eq!(y.is_nan(), x.is_nan(), "{kind} of {x:e}");
            assert!(y.is_nan() || y.abs() <= 1.0, "{kind} of {x:e} is {y}");
        }
    }
}

#[test]
fn the_default_tanh_is_odd_and_wide_lanes_repeat_it() {
    for x in stride().filter(|x| !x.is_nan()) {
        assert_eq!(tanh(-x).to_bits(), (-tanh(x)).to_bits());
        let wide: Lanes<4> = tanh(Lanes([x, -x, x, 0.5]));
        assert_eq!(
            wide.0.map(f32::to_bits),
            [tanh(x), tanh(-x), tanh(x), tanh(0.5)].map(f32::to_bits)
        );
    }
}

#[test]
fn recorded_bits_of_the_default_tanh() {
    let inputs = [0.0f32, 1e-30, 0.001, 0.1, 0.5, 1.0, 2.5, 8.0, 8.089_648, 1e30];
    let bits = inputs.map(|x| format!("{:08x}", tanh(x).to_bits()));
    insta::assert_compact_debug_snapshot!(bits);
}

#[test]
fn hashes_over_a_sample_are_those_of_every_release_and_the_same_in_lanes() {
    let hashes =
        [of(Rational, Inputs::SAMPLE), of(Libm, Inputs::SAMPLE), of(Micromath, Inputs::SAMPLE)];
    assert_eq!(hashes, [0xd316_49a9_2c70_0a3f, 0xe8cd_c5f6_f016_c0da, 0x7b44_69f5_6a4e_6266]);
    assert_eq!(of_lanes::<16>(Rational, Inputs::SAMPLE), hashes[0]);
}

#[test]
fn parts_of_the_inputs_meet_each_once_and_hash_to_the_same_sum() {
    let inputs = Inputs { first: 5, stride: 0x1000_0001, count: 1000 };
    let whole = of(Rational, inputs);
    for parts in [1, 2, 3, 7] {
        let sum = (0..parts).map(|part| of(Rational, inputs.part(part, parts)));
        assert_eq!(sum.fold(0u64, u64::wrapping_add), whole, "{parts} parts");
        assert_eq!(inputs.part(parts, parts).count, 0);
    }
    let count: u64 = (0..7).map(|part| Inputs::ALL.part(part, 7).count).sum();
    assert_eq!(count, 1 << 32);
}
