//! Every width against plain `f32`, as bits, over numbers that break shortcuts.

use super::{ByName, Instructions, Kernel, MOST_LANES, RowOfLane, Slots, Table, Vector, ones};
use crate::seed::{Purpose, RunSeed};
use controller_core::lane::Lane;

const SPECIAL: [f32; 12] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MIN_POSITIVE,
    -f32::MIN_POSITIVE,
    1e-42,
    f32::MAX,
    0.1,
];

fn operands() -> Vec<[f32; 2]> {
    let mut pairs: Vec<[f32; 2]> = SPECIAL.iter().flat_map(|a| SPECIAL.map(|b| [*a, b])).collect();
    let mut random = RunSeed(61).stream(Purpose::Episode, 0, 0);
    while !pairs.len().is_multiple_of(32) || pairs.len() < 4096 {
        pairs.push([random.within(-2.0, 2.0), random.within(-2.0, 2.0)]);
    }
    pairs
}

/// All that a lane can do with two numbers.
#[inline(always)]
fn everything<L: Lane>(a: L, b: L) -> [L; 15] {
    let (one, zero) = (L::from(1.0), L::from(0.0));
    let yes = |mask: L::Mask| L::select(mask, one, zero);
    [
        a + b,
        a - b,
        a * b,
        a / b,
        -a,
        a.abs(),
        a.sqrt(),
        a.min(b),
        a.max(b),
        a.held_within(0.5),
        yes(a.lt(b)),
        yes(a.le(b)),
        yes(a.lt(b) & !(b.le(one))),
        yes(a.lt(b) | zero.lt(b)),
        a.map(|x| x + 1.0),
    ]
}

/// Any NaN is as good as another: their bits are the platform's own affair, and no drive has one.
fn bits(number: f32) -> u32 {
    if number.is_nan() { f32::NAN.to_bits() } else { number.to_bits() }
}

struct Compare;

impl Kernel for Compare {
    type Output = (usize, usize);

    #[inline(always)]
    fn run<V: Vector>(self) -> (usize, usize) {
        let mut compared = 0;
        for chunk in operands().chunks_exact(2 * V::WIDTH) {
            let (mut a, mut b) = (Slots::<V, 2>::from(0.0), Slots::<V, 2>::from(0.0));
            for (i, [x, y]) in chunk.iter().enumerate() {
                a.numbers_mut()[i] = *x;
                b.numbers_mut()[i] = *y;
            }
            let wide = everything(a, b);
            for (i, [x, y]) in chunk.iter().enumerate() {
                for (which, (wide, scalar)) in wide.iter().zip(everything(*x, *y)).enumerate() {
                    let found = wide.numbers()[i];
                    assert_eq!(bits(found), bits(scalar), "operation {which} of {x} and {y}");
                    compared += 1;
                }
            }
            for (i, [x, y]) in chunk.iter().enumerate() {
                let (one, other) = (a.0[i / V::WIDTH], b.0[i / V::WIDTH]);
                let found = one.flipped_by(other).lanes()[i % V::WIDTH];
                let expected = if y.is_sign_negative() { -x } else { *x };
                assert_eq!(bits(found), bits(expected), "{x} flipped by {y}");
            }
            let less = Slots::<V, 2>::bits(a.lt(b));
            for (i, [x, y]) in chunk.iter().enumerate() {
                assert_eq!(less[i / V::WIDTH] >> (i % V::WIDTH) & 1 == 1, x < y);
            }
        }
        (V::WIDTH, compared)
    }
}

#[test]
fn every_width_computes_the_bits_of_a_single_number() {
    for set in Instructions::available() {
        assert_eq!(set.run(Compare), (set.width(), 15 * operands().len()), "{set}");
    }
}

/// Row `n` holds `4n`, `4n + 1`, `4n + 2` and `4n + 3`; lane `l` asks for row `9 - l % 7`.
struct Rows([[f32; 4]; 10]);

fn row_of(lane: usize) -> usize {
    9 - lane % 7
}

impl RowOfLane for &Rows {
    #[inline(always)]
    fn row(&self, lane: usize) -> &[f32; 4] {
        &self.0[row_of(lane)]
    }
}

struct Fetch;

impl Kernel for Fetch {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let rows = Rows(std::array::from_fn(|row| {
            std::array::from_fn(|column| (4 * row + column) as f32)
        }));
        let columns = V::rows(&rows);
        for (column, numbers) in columns.iter().enumerate() {
            let expected: Vec<f32> =
                (0..V::WIDTH).map(|lane| (4 * row_of(lane) + column) as f32).collect();
            assert_eq!(numbers.lanes(), expected);
        }
        for (lane, place) in columns[3].places().into_iter().enumerate() {
            let expected = if lane < V::WIDTH { 4 * row_of(lane) + 3 } else { 0 };
            assert_eq!(place as usize, expected, "lane {lane}");
        }
        let mut large = V::from(0.0);
        large.lanes_mut()[V::WIDTH - 1] = 16_777_215.0;
        assert_eq!(large.places()[V::WIDTH - 1], 16_777_215);
    }
}

#[test]
fn every_lane_gets_its_own_row_and_whole_number() {
    for set in Instructions::available() {
        set.run(Fetch);
    }
}

/// Rows by name: row `n` holds `4n`, `4n + 1`, `4n + 2` and `4n + 3`, those past the last one what
/// row 0 holds.
struct Named(usize);

impl Kernel for Named {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let row = |name: usize| {
            let row = if name < self.0 { name } else { 0 };
            std::array::from_fn(|column| (4 * row + column) as f32)
        };
        let rows: Vec<[f32; 4]> = (0..self.0).map(row).collect();
        let table = Table::new(&rows);
        // Every name that there is a row for, in every lane and byte, beside other names.
        let most = self.0.min(256);
        for name in 0..most {
            let of = |lane: usize, byte: usize| (name + 3 * lane + 7 * byte) % most;
            let names: [u32; MOST_LANES] = std::array::from_fn(|lane| {
                u32::from_le_bytes(std::array::from_fn(|byte| of(lane, byte) as u8))
            });
            for byte in 0..4 {
                let columns = V::named(ByName { table: &table, names: &names, byte });
                for (column, numbers) in columns.iter().enumerate() {
                    let expected = (0..V::WIDTH).map(|lane| row(of(lane, byte))[column]);
                    assert!(numbers.lanes().iter().copied().eq(expected), "{name} of {}", self.0);
                }
            }
        }
    }
}

#[test]
fn every_byte_names_its_row_in_tables_of_any_size() {
    for set in Instructions::available() {
        for rows in [1, 2, 16, 17, 33, 37, 48, 49, 64, 65, 255, 256] {
            set.run(Named(rows));
        }
    }
}

/// Chooses lanes of numbers that must keep their very bits.
struct Choose;

impl Kernel for Choose {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let bits: [u32; MOST_LANES] = std::array::from_fn(|lane| 0x7f80_0001 + 977 * lane as u32);
        let mut numbers = V::from(0.0);
        for (number, bits) in numbers.lanes_mut().iter_mut().zip(bits) {
            *number = f32::from_bits(bits);
        }
        let as_bits = |numbers: &V| -> Vec<u32> {
            numbers.lanes().iter().map(|number| number.to_bits()).collect()
        };
        let every = 1_u64 << V::WIDTH;
        for lanes in (0..every).step_by(if V::WIDTH > 8 { 37 } else { 1 }).map(|lanes| lanes as u32)
        {
            let chosen: Vec<usize> = ones(lanes).collect();
            let squeezed = numbers.squeezed(lanes);
            let expected: Vec<u32> = chosen.iter().map(|lane| bits[*lane]).collect();
            assert_eq!(as_bits(&squeezed)[..chosen.len()], expected, "{lanes:b}");

            let spread = as_bits(&squeezed.spread(lanes, V::from(1.5)));
            for (lane, found) in spread.into_iter().enumerate() {
                let expected = if chosen.contains(&lane) { bits[lane] } else { 1.5_f32.to_bits() };
                assert_eq!(found, expected, "lane {lane} of {lanes:b}");
            }

            let flags = std::array::from_fn(|lane| 0x8100 | (lanes >> lane & 1) << 9);
            assert_eq!(V::lanes_with(&flags, 0x600), lanes);
        }
    }
}

#[test]
fn chosen_lanes_are_squeezed_together_and_spread_again() {
    for set in Instructions::available() {
        set.run(Choose);
    }
}

/// Places of parts, for numbers around each half and whole one.
struct Around(u32);

impl Kernel for Around {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        let Self(parts) = self;
        let bases: [u32; MOST_LANES] = std::array::from_fn(|lane| 5 * lane as u32);
        for halves in -600_i32..600 {
            let number = |lane: usize| 0.5 * (halves + lane as i32) as f32;
            for beside in [-0.001, 0.0, 0.001] {
                let mut numbers = V::from(0.0);
                for (lane, place) in numbers.lanes_mut().iter_mut().enumerate() {
                    *place = number(lane) + beside;
                }
                let found = numbers.places_around(parts, &bases);
                for (lane, found) in found.into_iter().enumerate().take(V::WIDTH) {
                    let nearest = (number(lane) + beside).round_ties_even() as i32;
                    let part = nearest.rem_euclid(parts.cast_signed()).cast_unsigned();
                    assert_eq!(found, 5 * lane as u32 * parts + part, "{}", number(lane));
                }
            }
        }
    }
}

#[test]
fn every_lane_gets_the_place_of_the_part_that_is_nearest() {
    for set in Instructions::available() {
        set.run(Around(32));
        set.run(Around(128));
    }
}

#[test]
fn a_set_of_instructions_reads_back_as_it_prints() {
    for set in Instructions::available() {
        assert_eq!(set.to_string().parse(), Ok(set));
    }
    let refused = "avx9".parse::<Instructions>().unwrap_err().to_string();
    assert!(refused.starts_with("found \"avx9\", expected what this CPU has: scalar"), "{refused}");
}
