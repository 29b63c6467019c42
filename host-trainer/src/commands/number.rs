//! Whole numbers as option values, refused with the range that was expected.

use std::ops::RangeInclusive;

/// A parser for option values within a range.
pub(super) fn whole<N>(range: RangeInclusive<N>) -> impl Fn(&str) -> Result<N, String> + Clone
where
    N: TryFrom<u64> + PartialOrd + std::fmt::Display + Clone + 'static,
{
    move |text| {
        let number = text.parse().ok().and_then(|number: u64| N::try_from(number).ok());
        number.filter(|number| range.contains(number)).ok_or_else(|| {
            format!("expected a whole number from {} to {}", range.start(), range.end())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_within_its_range_or_refused_with_it() {
        let parse = whole(2..=300_u16);
        assert_eq!([parse("2"), parse("300")], [Ok(2), Ok(300)]);
        for text in ["1", "301", "-3", "70000", "1e2", "2.0", "", "many", "18446744073709551616"] {
            let refusal = Err("expected a whole number from 2 to 300".to_owned());
            assert_eq!(parse(text), refusal, "{text}");
        }
    }
}
