//! Numbers as people want to read them in a log. The log's format has no precision of its own.

/// The value to so many parts of a unit: `rounded(0.34567, 100.0)` is 0.35. Beyond ±2³¹ parts it is cut to that.
pub(crate) fn rounded(value: f32, parts: f32) -> f32 {
    let half = if value < 0.0 { -0.5 } else { 0.5 };
    (value * parts + half) as i32 as f32 / parts
}

/// Whole degrees of an angle in radians.
pub(crate) fn degrees(radians: f32) -> i32 {
    rounded(radians.to_degrees(), 1.0) as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_is_that_of_the_standard_formatter_away_from_ties() {
        for value in [0.0_f32, 0.344, 0.346, -0.344, -0.346, 12.999, -7.001, 1234.5678] {
            let expected: f32 = format!("{value:.2}").parse().expect("a number");
            assert_eq!(rounded(value, 100.0), expected, "{value}");
            let expected: i32 = format!("{:.0}", value.to_degrees()).parse().expect("a number");
            assert_eq!(degrees(value), expected, "{value}");
        }
        assert_eq!(rounded(f32::MAX, 100.0), (1u32 << 31) as f32 / 100.0);
    }
}
