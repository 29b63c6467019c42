//! What sensors misread, drawn once for all individuals that drive a pair.
//!
//! The drives of one pair have the same random numbers, whoever drives, and in each period a car
//! draws as many, whatever it sees. So what its sensors misread is kept on a *tape* of the pair,
//! which the first car to get so far extends and every other reads.

use super::{ENOUGH_INDIVIDUALS, Fleet};
use crate::car::{CarModel, Misreading};
use crate::seed::Stream;
use crate::vector::ones;
use controller_core::observation::BEAMS;
use std::slice::Iter;
use std::sync::{Mutex, OnceLock, PoisonError};

/// Most bytes that a fleet's tapes may come to.
const MOST_BYTES: usize = 256 << 20;

/// Control periods of a piece of tape. Fewer would be asked for more often; of more, more would be
/// drawn that nobody comes to need.
const PERIODS: usize = 64;

type Piece = [Misreading<f32>; PERIODS];

/// A tape for each of a fleet's pairs; or none, and each car draws for itself.
///
/// There are none where nothing is misread, where fewer than [`ENOUGH_INDIVIDUALS`] individuals
/// would share one, and where all tapes in their full length, 20 bytes for each pair and control
/// period and some hundred for each pair, would not fit into [`MOST_BYTES`], 256 MiB.
#[derive(Debug)]
pub(super) struct Tapes(Vec<Tape>);

/// What is misread in the drives of one pair, from their first period on, as far as anybody has
/// come.
#[derive(Debug)]
pub(super) struct Tape {
    /// Past the pieces that are there.
    random: OnceLock<Mutex<Stream>>,
    pieces: Box<[OnceLock<Box<Piece>>]>,
}

impl Tapes {
    /// Empty tapes, if there are to be any.
    pub(super) fn of(fleet: &Fleet<'_>) -> Self {
        let problem = fleet.problem;
        let pieces = (problem.scenario.episode.step_limit as usize).div_ceil(PERIODS);
        let bytes =
            size_of::<Tape>() + pieces * (size_of::<OnceLock<Box<Piece>>>() + size_of::<Piece>());
        let fits = fleet.pairs.len().saturating_mul(bytes) <= MOST_BYTES;
        let shared = fleet.individuals() >= ENOUGH_INDIVIDUALS;
        let taped = problem.model().is_disturbed() && shared && fits;
        Self(if taped {
            fleet.pairs.iter().map(|_| Tape::new(pieces)).collect()
        } else {
            Vec::new()
        })
    }

    /// Whether cars read tapes.
    #[cfg(test)]
    pub(super) fn are_used(&self) -> bool {
        !self.0.is_empty()
    }

    /// Misreadings for as many cars of this model as there are lanes.
    pub(super) fn source(&self, model: &CarModel, lanes: usize) -> Source<'_> {
        if !model.is_disturbed() {
            Source::Nothing
        } else if self.0.is_empty() {
            Source::Streams((0..lanes).map(|_| None).collect())
        } else {
            Source::Tapes(&self.0, vec![Reader::default(); lanes])
        }
    }
}

impl Tape {
    fn new(pieces: usize) -> Self {
        let pieces = (0..pieces).map(|_| OnceLock::new()).collect();
        Self { random: OnceLock::new(), pieces }
    }

    /// A piece, which is drawn if nobody has come so far. To be asked for in order: the piece
    /// before it has to be there.
    fn piece(&self, index: usize, model: &CarModel) -> &Piece {
        let piece = &self.pieces[index];
        if let Some(drawn) = piece.get() {
            return drawn;
        }
        let random = self.random.get().expect("a drive begins before it goes on");
        let mut random = random.lock().unwrap_or_else(PoisonError::into_inner);
        // Somebody may have drawn it while this thread waited.
        piece.get_or_init(|| Box::new(std::array::from_fn(|_| model.misreading(&mut random))))
    }
}

/// Where the cars of a slot have their misreadings from, lane by lane.
#[derive(Debug)]
pub(super) enum Source<'a> {
    /// Nothing is misread.
    Nothing,
    /// Each car draws for itself.
    Streams(Vec<Option<Stream>>),
    /// Cars read the tape of their pair.
    Tapes(&'a [Tape], Vec<Reader<'a>>),
}

/// Where on its tape a car has got to.
#[derive(Clone, Debug, Default)]
pub(super) struct Reader<'a> {
    tape: Option<&'a Tape>,
    /// Pieces begun.
    begun: usize,
    /// The rest of the last one.
    rest: Iter<'a, Misreading<f32>>,
}

impl Source<'_> {
    /// The car in this lane begins to drive that pair, with these random numbers, if it needs any.
    pub(super) fn begin(&mut self, lane: usize, pair: usize, random: impl FnOnce() -> Stream) {
        match self {
            Self::Nothing => {}
            Self::Streams(streams) => streams[lane] = Some(random()),
            Self::Tapes(tapes, readers) => {
                let tape = &tapes[pair];
                // Whoever comes first; everybody has the same numbers.
                tape.random.get_or_init(|| Mutex::new(random()));
                readers[lane] = Reader { tape: Some(tape), ..Reader::default() };
            }
        }
    }

    /// The car in this lane goes on in a lane of another source of the same tapes.
    pub(super) fn shift(&mut self, lane: usize, others: &mut Self, to: usize) {
        match (self, others) {
            (Self::Streams(from), Self::Streams(streams)) => streams[to] = from[lane].take(),
            (Self::Tapes(_, from), Self::Tapes(_, readers)) => readers[to] = from[lane].clone(),
            _ => {}
        }
    }

    /// Gives each of the lanes in `live` its misreading of the next control period.
    #[inline(always)]
    pub(super) fn next(
        &mut self,
        live: u32,
        model: &CarModel,
        mut give: impl FnMut(usize, &Misreading<f32>),
    ) {
        match self {
            Self::Nothing => {}
            Self::Streams(streams) => {
                for lane in ones(live) {
                    let Some(random) = &mut streams[lane] else { continue };
                    give(lane, &model.misreading(random));
                }
            }
            Self::Tapes(_, readers) => {
                for lane in ones(live) {
                    give(lane, readers[lane].next(model));
                }
            }
        }
    }
}

impl<'a> Reader<'a> {
    #[inline(always)]
    fn next(&mut self, model: &CarModel) -> &'a Misreading<f32> {
        match self.rest.next() {
            Some(misreading) => misreading,
            None => self.go_on(model),
        }
    }

    /// The first misreading of the next piece.
    #[cold]
    #[inline(never)]
    fn go_on(&mut self, model: &CarModel) -> &'a Misreading<f32> {
        const NOTHING: &Misreading<f32> = &Misreading { error: [0.0; BEAMS] };
        let Some(tape) = self.tape else { return NOTHING };
        let [first, rest @ ..] = tape.piece(self.begun, model);
        self.begun += 1;
        self.rest = rest.iter();
        first
    }
}
