//! UF2 family ids: which chips a UF2 file is for.

use std::fmt;
use std::str::FromStr;

use super::placement::{NumberError, parse_number};

/// A UF2 family: a number that a boot loader compares with its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Family(u32);

impl Family {
    /// Raspberry Pi Pico 2 and its relatives: written where the file says.
    ///
    /// The families of programs, such as `rp2350-arm-s`, are moved into a partition when the
    /// chip has any; weights lie at a fixed address.
    pub const ABSOLUTE: Self = Self(0xe48b_ff57);

    /// Names and ids as published in `utils/uf2families.json` of the UF2 repository; those of
    /// Raspberry Pi in the spelling of its datasheets and of picotool.
    pub const NAMES: [(&'static str, u32); 38] = [
        ("absolute", 0xe48b_ff57),
        ("data", 0xe48b_ff58),
        ("rp2040", 0xe48b_ff56),
        ("rp2350-arm-ns", 0xe48b_ff5b),
        ("rp2350-arm-s", 0xe48b_ff59),
        ("rp2350-riscv", 0xe48b_ff5a),
        ("esp32", 0x1c5f_21b0),
        ("esp32c3", 0xd42b_a06c),
        ("esp32c6", 0x540d_df62),
        ("esp32h2", 0x3327_26f6),
        ("esp32p4", 0x3d30_8e94),
        ("esp32s2", 0xbfdd_4eee),
        ("esp32s3", 0xc47e_5767),
        ("kl32l2", 0x7f83_e793),
        ("lpc55", 0x2abc_77ec),
        ("mimxrt10xx", 0x4fb2_d5bd),
        ("nrf52", 0x1b57_745f),
        ("nrf52833", 0x621e_937a),
        ("nrf52840", 0xada5_2840),
        ("samd21", 0x68ed_2b88),
        ("samd51", 0x5511_4460),
        ("saml21", 0x1851_780a),
        ("stm32f0", 0x6478_24b6),
        ("stm32f1", 0x5ee2_1072),
        ("stm32f2", 0x5d1a_0a2e),
        ("stm32f3", 0x6b84_6188),
        ("stm32f4", 0x5775_5a57),
        ("stm32f407", 0x6d09_22fa),
        ("stm32f407vg", 0x8fb0_60fe),
        ("stm32f7", 0x53b8_0f00),
        ("stm32g0", 0x300f_5633),
        ("stm32g4", 0x4c71_240a),
        ("stm32h7", 0x6db6_6082),
        ("stm32l0", 0x202e_3a91),
        ("stm32l1", 0x1e1f_432d),
        ("stm32l4", 0x00ff_6919),
        ("stm32l5", 0x0424_0bdf),
        ("stm32wb", 0x70d1_6653),
    ];

    /// The number in the file.
    pub const fn id(self) -> u32 {
        self.0
    }

    /// The published name, if this program knows it.
    pub fn name(self) -> Option<&'static str> {
        Self::NAMES.iter().find(|(_, id)| *id == self.0).map(|(name, _)| *name)
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.name() {
            Some(name) => write!(f, "{name} ({:#010x})", self.0),
            None => write!(f, "{:#010x}", self.0),
        }
    }
}

/// Text that names no family.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FamilyError {
    /// Starts like a number and is none that fits.
    Number(NumberError),
    /// No known name.
    Unknown {
        /// A known name that looks like it.
        nearest: Option<&'static str>,
    },
}

impl fmt::Display for FamilyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(_) => write!(f, "a number of at most 0xffff_ffff or a name expected"),
            Self::Unknown { nearest: Some(name) } => {
                write!(f, "no such family; did you mean {name}?")
            }
            Self::Unknown { nearest: None } => {
                let names: Vec<_> = Family::NAMES.iter().map(|(name, _)| *name).collect();
                write!(f, "no such family; a number or one of these expected: {}", names.join(", "))
            }
        }
    }
}

impl std::error::Error for FamilyError {}

impl FromStr for Family {
    type Err = FamilyError;

    /// A name in any case, with `_` or `-`, or a number as [`parse_number`] reads it.
    fn from_str(text: &str) -> Result<Self, FamilyError> {
        if text.starts_with(|first: char| first.is_ascii_digit()) {
            return parse_number(text).map(Self).map_err(FamilyError::Number);
        }
        let lower = text.to_ascii_lowercase().replace('_', "-");
        // The published list prefixes what the datasheet does not.
        let wanted = lower.strip_prefix("rp2xxx-").unwrap_or(&lower);
        if let Some((_, id)) = Self::NAMES.iter().find(|(name, _)| *name == wanted) {
            return Ok(Self(*id));
        }
        let (similarity, nearest) = Self::NAMES
            .iter()
            .map(|(name, _)| (strsim::jaro_winkler(wanted, name), *name))
            .fold((0.0, ""), |best, next| if next.0 > best.0 { next } else { best });
        Err(FamilyError::Unknown { nearest: (similarity > 0.8).then_some(nearest) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_are_known_by_name_in_any_spelling_and_by_number() {
        let spellings = [
            ("rp2040", 0xe48b_ff56),
            ("RP2350_ARM_S", 0xe48b_ff59),
            ("rp2350-riscv", 0xe48b_ff5a),
            ("RP2XXX_ABSOLUTE", 0xe48b_ff57),
            ("NRF52840", 0xada5_2840),
            ("stm32f4", 0x5775_5a57),
            ("0xe48bff59", 0xe48b_ff59),
            ("1_234", 1234),
        ];
        for (text, id) in spellings {
            assert_eq!(text.parse::<Family>().map(Family::id), Ok(id), "{text}");
        }
    }

    #[test]
    fn names_and_ids_are_unique_and_every_name_reads_back() {
        for (name, id) in Family::NAMES {
            let family: Family = name.parse().unwrap();
            assert_eq!((family.id(), family.name()), (id, Some(name)));
        }
        assert_eq!(Family::ABSOLUTE.name(), Some("absolute"));
    }

    #[test]
    fn an_unknown_family_is_refused_with_the_nearest_name_or_all() {
        let refusal = |text: &str| text.parse::<Family>().unwrap_err().to_string();
        assert_eq!(refusal("rp2350-arm"), "no such family; did you mean rp2350-arm-s?");
        assert_eq!(refusal("nrf52480"), "no such family; did you mean nrf52840?");
        assert!(refusal("").ends_with("stm32l5, stm32wb"));
        assert_eq!(refusal("0xg"), "a number of at most 0xffff_ffff or a name expected");
        assert_eq!(refusal("0x100000000"), "a number of at most 0xffff_ffff or a name expected");
    }
}
