//! Numbers in a scenario file: their unit, their range, and decimals that read back exactly.

use std::ops::RangeInclusive;

use std::f64::consts::PI;

use toml::de::DeValue;

use super::problem::Problem;
use super::schema::Codec;
use super::value::Found;

/// An `f32` that the file gives as a number in some unit, within a range.
#[derive(Clone, Copy)]
pub(super) struct Number {
    noun: &'static str,
    unit: &'static str,
    /// SI units per unit of the file.
    scale: f64,
    /// Bounds in the file's unit.
    low: f64,
    high: f64,
    /// Whether `low` itself is refused.
    above: bool,
}

impl Number {
    const fn new(noun: &'static str, unit: &'static str, scale: f64, low: f64, high: f64) -> Self {
        Self { noun, unit, scale, low, high, above: false }
    }

    /// Metres from `low` to `high`.
    pub(super) const fn metres(low: f64, high: f64) -> Self {
        Self::new("a length", " m", 1.0, low, high)
    }

    /// Degrees in the file, radians in the scenario.
    pub(super) const fn degrees(low: f64, high: f64) -> Self {
        Self::new("an angle", "°", PI / 180.0, low, high)
    }

    /// Degrees per second in the file, radians per second in the scenario.
    pub(super) const fn degrees_per_second(low: f64, high: f64) -> Self {
        Self::new("a rate", "°/s", PI / 180.0, low, high)
    }

    /// Seconds from `low` to `high`.
    pub(super) const fn seconds(low: f64, high: f64) -> Self {
        Self::new("a time", " s", 1.0, low, high)
    }

    /// A number without unit.
    pub(super) const fn plain(low: f64, high: f64) -> Self {
        Self::new("a number", "", 1.0, low, high)
    }

    /// A part of a whole.
    pub(super) const fn share() -> Self {
        Self::new("a share", "", 1.0, 0.0, 1.0)
    }

    /// Refuses the lower bound itself.
    pub(super) const fn above(self) -> Self {
        Self { above: true, ..self }
    }

    fn holds(&self, raw: f64) -> bool {
        let low = if self.above { self.to_si(raw) > self.to_si(self.low) } else { raw >= self.low };
        low && raw <= self.high
    }

    fn to_si(self, raw: f64) -> f32 {
        // Adding zero turns −0 into 0, which decimals would not keep apart.
        (raw * self.scale) as f32 + 0.0
    }

    /// The number as written: its plain value, before any unit.
    fn raw(found: &Found<'_>) -> Option<f64> {
        match found.node.get_ref() {
            DeValue::Float(number) => number.as_str().parse().ok(),
            DeValue::Integer(number) => Some(whole(number)? as f64),
            _ => None,
        }
    }

    /// The shortest decimal that reads back as the same `f32`.
    fn decimal(&self, value: f32) -> String {
        let exact = f64::from(value) / self.scale;
        (0..12)
            .map(|digits| format!("{exact:.digits$}"))
            .find(|text| text.parse().is_ok_and(|raw| self.to_si(raw) == value))
            .unwrap_or_else(|| format!("{exact:?}"))
    }
}

impl Codec<f32> for Number {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<f32> {
        let Some(raw) = Self::raw(found) else {
            found.wrong_type(&self.expected(), problems);
            return None;
        };
        if !self.holds(raw) {
            found.out_of_range(&self.expected(), problems);
            return None;
        }
        Some(self.to_si(raw))
    }

    fn write(&self, value: &f32) -> Option<String> {
        Some(self.decimal(*value))
    }

    fn expected(&self) -> String {
        let Self { noun, unit, low, high, .. } = self;
        if self.above {
            format!("{noun} above {low}{unit} and at most {high}{unit}")
        } else {
            format!("{noun} from {low}{unit} to {high}{unit}")
        }
    }
}

/// A [`Number`] or `inf`, which means that there is no limit.
#[derive(Clone, Copy)]
pub(super) struct OrInfinite(pub(super) Number);

impl Codec<Option<f32>> for OrInfinite {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<Option<f32>> {
        if Number::raw(found) == Some(f64::INFINITY) {
            return Some(None);
        }
        let mut own = Vec::new();
        let value = self.0.read(found, &mut own);
        for mut problem in own {
            problem.detail.push_str(", or inf");
            problems.push(problem);
        }
        value.map(Some)
    }

    fn write(&self, value: &Option<f32>) -> Option<String> {
        Some(value.map_or("inf".to_owned(), |value| self.0.decimal(value)))
    }

    fn expected(&self) -> String {
        format!("{}, or inf", self.0.expected())
    }
}

/// A whole number within a range.
#[derive(Clone, Copy)]
pub(super) struct Whole {
    pub(super) low: u32,
    pub(super) high: u32,
}

impl Whole {
    pub(super) const fn within(range: RangeInclusive<u32>) -> Self {
        Self { low: *range.start(), high: *range.end() }
    }
}

impl<T: TryFrom<u32> + Copy + Into<u32>> Codec<T> for Whole {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<T> {
        let expected = Codec::<T>::expected(self);
        let DeValue::Integer(number) = found.node.get_ref() else {
            found.wrong_type(&expected, problems);
            return None;
        };
        let fits = |value: &u32| (self.low..=self.high).contains(value);
        let value = whole(number).and_then(|value| u32::try_from(value).ok()).filter(fits);
        let value = value.and_then(|value| T::try_from(value).ok());
        if value.is_none() {
            found.out_of_range(&expected, problems);
        }
        value
    }

    fn write(&self, value: &T) -> Option<String> {
        Some((*value).into().to_string())
    }

    fn expected(&self) -> String {
        format!("a whole number from {} to {}", self.low, self.high)
    }
}

fn whole(number: &toml::de::DeInteger<'_>) -> Option<i128> {
    i128::from_str_radix(number.as_str(), number.radix()).ok()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn read_back(number: &Number, value: f32) -> f32 {
        number.to_si(number.decimal(value).parse().unwrap())
    }

    #[test]
    fn written_decimals_are_as_short_as_a_person_would_write_them() {
        assert_eq!(Number::metres(0.0, 1.0).decimal(0.1), "0.1");
        assert_eq!(Number::metres(0.0, 99.0).decimal(10.0), "10");
        assert_eq!(Number::degrees(0.0, 90.0).decimal(std::f32::consts::FRAC_PI_2), "90");
        assert_eq!(Number::degrees(-90.0, 90.0).decimal((-15_f64).to_radians() as f32), "-15");
    }

    proptest! {
        #[test]
        fn every_finite_number_reads_back_as_the_same_bits(bits in any::<u32>()) {
            let value = f32::from_bits(bits) + 0.0;
            prop_assume!(value.is_finite());
            let metres = Number::metres(0.0, 1.0);
            prop_assert_eq!(read_back(&metres, value).to_bits(), value.to_bits());
        }

        #[test]
        fn every_angle_reads_back_as_the_same_bits(value in -7_f32..7.0) {
            let angle = Number::degrees(0.0, 1.0);
            prop_assert_eq!(read_back(&angle, value).to_bits(), value.to_bits());
        }
    }
}
