//! Numbers side by side in one register of this very CPU.
//!
//! A [`Vector`] is a [`Lane`] of controller-core whose lanes can be read and written one by
//! one. `f32` is the narrowest; the `x86` types hold 4, 8 and 16 numbers. All do the same IEEE 754
//! operations, none fuses a product, so the lanes of every width hold the bits of the scalar run.
//!
//! Which of them this CPU has is asked once, at run time ([`Instructions::of_this_cpu`]), so that
//! one portable binary is fast everywhere. [`Instructions::run`] then calls a [`Kernel`] in a
//! function that is compiled for those instructions; whatever is to use them must be
//! `#[inline(always)]` down to the arithmetic, without closures around vectors: a function of its
//! own is compiled for the least machine, where each vector instruction becomes a call.
//!
//! Plain arrays that the compiler turns into vectors were measured first: one network step of 80
//! robots took 82 ns per robot with 16 lanes and 38 ns with 8; with these types 19 and 24 ns.

mod slots;
mod table;
#[cfg(target_arch = "x86_64")]
mod x86;

use crate::failure::Failure;
use bytemuck::Pod;
use controller_core::lane::Lane;
use controller_core::motion::Pose;
use std::fmt;
use std::str::FromStr;
use std::sync::OnceLock;

pub use slots::{Slots, Weight};
pub use table::{ByName, Table};

/// Lanes of the widest vector.
pub const MOST_LANES: usize = 16;

/// A [`Lane`] that lies in memory as its numbers do, lane 0 first.
pub trait Vector: Lane + Pod + fmt::Debug {
    /// Numbers side by side.
    const WIDTH: usize;

    /// Whether [`Self::squeezed`] and [`Self::spread`] are an instruction each, and not many.
    const SQUEEZES: bool = false;

    /// The mask as bits, lane 0 lowest.
    fn bits(mask: Self::Mask) -> u32;

    /// Negated where the other number has a sign, be it zero or NaN.
    fn flipped_by(self, other: Self) -> Self;

    /// The lanes as whole numbers; they must be from 0 to 2²⁴. Those past the width are 0.
    fn places(self) -> [u32; MOST_LANES];

    /// The nearest whole number in each lane, counted around `parts`, after `parts` times this lane's base: the
    /// place of one of so many parts. Numbers must be within ±2²²; of two that are as near, the even one is taken.
    ///
    /// `parts` must be a power of two.
    fn places_around(self, parts: u32, bases: &[u32; MOST_LANES]) -> [u32; MOST_LANES];

    /// Each lane's row as four vectors: the rows' first numbers, their second ones and so on.
    fn rows<R: RowOfLane>(rows: R) -> [Self; 4];

    /// The same for rows of a table.
    #[inline(always)]
    fn named(rows: ByName<'_>) -> [Self; 4] {
        Self::rows(rows)
    }

    /// Which lanes' whole numbers have any of these bits, as bits, lane 0 lowest.
    #[inline(always)]
    fn lanes_with(numbers: &[u32; MOST_LANES], bits: u32) -> u32 {
        let mut lanes = 0;
        for (lane, number) in numbers[..Self::WIDTH].iter().enumerate() {
            lanes |= u32::from(number & bits != 0) << lane;
        }
        lanes
    }

    /// The numbers of these lanes one after the other, in the first lanes; those after them hold anything.
    #[inline(always)]
    fn squeezed(mut self, lanes: u32) -> Self {
        let numbers = self.lanes_mut();
        for (to, lane) in ones(lanes).enumerate() {
            numbers[to] = numbers[lane];
        }
        self
    }

    /// The other way round: the first numbers in these lanes, one after the other, and `rest` in all others.
    #[inline(always)]
    fn spread(self, lanes: u32, mut rest: Self) -> Self {
        for (from, lane) in ones(lanes).enumerate() {
            rest.lanes_mut()[lane] = self.lanes()[from];
        }
        rest
    }

    /// Runs the part in a function of its own, compiled for this type's instructions, which
    /// keeps a large part from being compiled into every place that calls it.
    fn apart<P: Part<Self>>(part: P) -> P::Output;

    /// The lanes as numbers.
    #[inline(always)]
    fn lanes(&self) -> &[f32] {
        bytemuck::must_cast_slice(std::slice::from_ref(self))
    }

    /// The lanes as numbers, to write.
    #[inline(always)]
    fn lanes_mut(&mut self) -> &mut [f32] {
        bytemuck::must_cast_slice_mut(std::slice::from_mut(self))
    }
}

/// The places of the bits that are set, lowest first.
#[inline(always)]
pub fn ones(mut bits: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let place = bits.trailing_zeros();
        bits &= bits.checked_sub(1)?;
        Some(place as usize)
    })
}

/// The pose of one lane.
pub(crate) fn pose_in_lane<V: Vector>(pose: &Pose<V>, lane: usize) -> Pose<f32> {
    let Pose { x, y, heading, cos, sin } = *pose;
    let [x, y, heading, cos, sin] = [x, y, heading, cos, sin].map(|number| number.lanes()[lane]);
    Pose { x, y, heading, cos, sin }
}

/// Has the CPU fetch what lies at this place, so that it is there when it is read.
#[inline(always)]
pub fn fetch<T>(slice: &[T], place: usize) {
    #[cfg(target_arch = "x86_64")]
    x86::fetch(slice.as_ptr().wrapping_add(place));
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (slice, place);
}

/// Four numbers for each lane, somewhere in memory. (A trait, because a closure would be compiled
/// for the least machine.)
pub trait RowOfLane {
    /// Those of one lane.
    fn row(&self, lane: usize) -> &[f32; 4];
}

/// Applies a scalar function to numbers one by one. A function of its own: it is called for many
/// lanes, and copies of `f` for each of them would take minutes to compile.
#[inline(never)]
fn each(numbers: &mut [f32], f: impl Fn(f32) -> f32) {
    for number in numbers {
        *number = f(*number);
    }
}

impl Vector for f32 {
    const WIDTH: usize = 1;

    #[inline(always)]
    fn bits(mask: bool) -> u32 {
        u32::from(mask)
    }

    #[inline(always)]
    fn flipped_by(self, other: Self) -> Self {
        if other.is_sign_negative() { -self } else { self }
    }

    #[inline(always)]
    fn places(self) -> [u32; MOST_LANES] {
        let mut places = [0; MOST_LANES];
        places[0] = self as u32;
        places
    }

    #[inline(always)]
    fn places_around(self, parts: u32, bases: &[u32; MOST_LANES]) -> [u32; MOST_LANES] {
        /// Adding and taking away 1.5·2²³ rounds to the nearest integer.
        const ROUND: f32 = 12_582_912.0;
        let nearest = ((self + ROUND) - ROUND) as i32;
        let mut places = [0; MOST_LANES];
        places[0] = bases[0] * parts + (nearest.cast_unsigned() & (parts - 1));
        places
    }

    #[inline(always)]
    fn rows<R: RowOfLane>(rows: R) -> [Self; 4] {
        *rows.row(0)
    }

    #[inline(never)]
    fn apart<P: Part<Self>>(part: P) -> P::Output {
        part.run()
    }
}

/// Work that is written once for every width.
pub trait Kernel {
    /// What it answers.
    type Output;

    /// Works with vectors of type `V`. Must be `#[inline(always)]`.
    fn run<V: Vector>(self) -> Self::Output;
}

/// Work with vectors of type `V`.
pub trait Part<V> {
    /// What it answers.
    type Output;

    /// Works. Must be `#[inline(always)]`.
    fn run(self) -> Self::Output;
}

/// A kernel as the part of one width.
struct Whole<K>(K);

impl<V: Vector, K: Kernel> Part<V> for Whole<K> {
    type Output = K::Output;

    #[inline(always)]
    fn run(self) -> K::Output {
        self.0.run::<V>()
    }
}

/// A set of vector instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Instructions {
    /// None: one number at a time.
    Scalar,
    /// What every 64-bit x86 has: 4 lanes.
    Sse2,
    /// 8 lanes. Needs `bmi1`, `bmi2`, `lzcnt` and `popcnt` too, which a virtual machine may hide.
    Avx2,
    /// 16 lanes. Needs what [`Self::Avx2`] does, and AVX-512 F, DQ, VL and BW.
    Avx512,
}

impl Instructions {
    /// Every set, narrowest first.
    pub const ALL: [Self; 4] = [Self::Scalar, Self::Sse2, Self::Avx2, Self::Avx512];

    /// Lanes of its vectors.
    pub fn width(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Sse2 => 4,
            Self::Avx2 => 8,
            Self::Avx512 => 16,
        }
    }

    /// The sets that this CPU has, narrowest first.
    pub fn available() -> impl Iterator<Item = Self> {
        Self::ALL.into_iter().filter(|set| set.is_available())
    }

    /// The widest that this CPU has.
    pub fn of_this_cpu() -> Self {
        Self::available().last().unwrap_or(Self::Scalar)
    }

    /// Whether this CPU has them.
    #[cfg(target_arch = "x86_64")]
    pub fn is_available(self) -> bool {
        match self {
            Self::Scalar | Self::Sse2 => true,
            Self::Avx2 => x86::has_avx2(),
            Self::Avx512 => x86::has_avx512(),
        }
    }

    /// Whether this CPU has them.
    #[cfg(not(target_arch = "x86_64"))]
    pub fn is_available(self) -> bool {
        self == Self::Scalar
    }

    /// Runs the kernel with these instructions, or with the widest below that this CPU has.
    pub fn run<K: Kernel>(self, kernel: K) -> K::Output {
        let known = self.min(Self::of_this_cpu());
        #[cfg(target_arch = "x86_64")]
        return x86::run(known, kernel);
        #[cfg(not(target_arch = "x86_64"))]
        {
            let Self::Scalar = known else { unreachable!("no other set is available here") };
            f32::apart(Whole(kernel))
        }
    }
}

/// Overrides which instructions the simulation uses, for tests and comparisons.
pub const OVERRIDE: &str = "EVOSTEER_INSTRUCTIONS";

static IN_USE: OnceLock<Instructions> = OnceLock::new();

impl Instructions {
    /// What the simulation uses: the widest that this CPU has, unless [`choose`](Self::choose)
    /// was called before.
    pub fn in_use() -> Self {
        *IN_USE.get_or_init(Self::of_this_cpu)
    }

    /// Uses what the environment variable [`OVERRIDE`] names, if it is set. To be called once,
    /// at the start of the program.
    ///
    /// # Errors
    ///
    /// A word that names no instructions of this CPU.
    pub fn choose() -> Result<(), Failure> {
        let Some(word) = std::env::var_os(OVERRIDE) else { return Ok(()) };
        let named = word.to_string_lossy().parse();
        let named: Self =
            named.map_err(|error: NotHere| Failure::bad_input(format!("{OVERRIDE}: {error}")))?;
        IN_USE.get_or_init(|| named);
        Ok(())
    }
}

impl fmt::Display for Instructions {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Scalar => "scalar",
            Self::Sse2 => "sse2",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        })
    }
}

/// A word that names no set of instructions, or one that this CPU does not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotHere {
    /// The word.
    pub found: String,
}

impl fmt::Display for NotHere {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let here: Vec<String> = Instructions::available().map(|set| set.to_string()).collect();
        write!(f, "found {:?}, expected what this CPU has: {}", self.found, here.join(", "))
    }
}

impl std::error::Error for NotHere {}

impl FromStr for Instructions {
    type Err = NotHere;

    fn from_str(text: &str) -> Result<Self, NotHere> {
        let named = Self::available().find(|set| set.to_string() == text);
        named.ok_or_else(|| NotHere { found: text.to_owned() })
    }
}

#[cfg(test)]
mod tests;
