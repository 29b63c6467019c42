//! What has been found out about each cell.
//!
//! A name is a byte. In a small world it counts all obstacles, and every cell has its shelf. In a
//! large one a legend says what it means, and cells get a shelf when a car turns up. Memory is asked
//! for at once, but what no car visits is never touched, and so takes none.

use super::asked::{Asked, ByNames, ByPlace, Names};
use super::beams::{self, Row};
use super::cell::{BINS, SECTORS, Sight, Surroundings};
use super::grid::{Grid, Turned};
use super::kept::Kept;
use super::legends::{Legends, MOST_NAMES, Meanings, Naming};
use super::rounding::Limits;
use super::words::{JOINT, NAME, NAMES, UNKNOWN, Whole, Word, Words, named};
use crate::vector::{ByName, MOST_LANES, Table, Vector, fetch, ones};
use crate::world::Obstacles;
use controller_core::geometry::{Body, Segment};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU16, AtomicU32, AtomicU64, Ordering};

/// Most cells that are remembered in a large world; beyond, all obstacles are asked.
pub(super) const MOST_SHELVES: usize = 1 << 16;

/// Words of every cell.
#[derive(Debug)]
pub(super) struct Shelf {
    surroundings: Surroundings,
    has_discs: bool,
    is_for_beams: bool,
    /// Obstacles as beams meet them.
    edges: Rows,
    /// The same as bodies meet them.
    faces: Rows,
    /// What a beam can meet, by shelf and bin: where among the words; 0 where nobody has been yet.
    seen: Box<[AtomicU16]>,
    /// What the body can touch, by shelf and sector, likewise.
    near: Box<[AtomicU16]>,
    /// A [`Vicinity`] by cell, which mostly is all that is asked.
    vicinities: Box<[AtomicU64]>,
    words: Words,
    /// What words do not say, by shelf; set once the shelf's words are written.
    lists: Box<[OnceLock<Box<Lists>>]>,
    large: Option<Large>,
}

/// Obstacles.
#[derive(Debug)]
struct Rows {
    /// By place, after one that nothing meets.
    all: Box<[Row]>,
    /// By name, in a small world.
    named: Table,
}

impl Rows {
    /// The rows of each lane's name.
    #[inline(always)]
    fn rows<V: Vector>(&self, large: Option<&Large>, names: Names<'_>) -> [V; 4] {
        let Names { halves, byte, .. } = names;
        match large {
            None => V::named(ByName { table: &self.named, names: halves, byte }),
            Some(Large { legends, .. }) => {
                V::rows(ByPlace { table: &self.all, meanings: legends.meanings(), names })
            }
        }
    }
}

/// What a large world has besides.
#[derive(Debug)]
struct Large {
    /// Each cell's shelf and legend, see [`Spot`]; 0 where nobody has been yet.
    spots: Box<[AtomicU64]>,
    /// Shelves given out.
    taken: AtomicU32,
    legends: Legends,
    /// A [`Whole`] by shelf and bin, for beams that pass a wall's end too closely; 0 where there is none.
    wholes: Box<[AtomicU32]>,
    /// What these name, kept apart so that there are numbers enough for both.
    whole_words: Words,
}

/// Where to look for what is known of a cell, and how to read it.
#[derive(Clone, Copy)]
struct Spot {
    shelf: u32,
    legend: u32,
}

impl Spot {
    fn of(bits: u64) -> Self {
        Self { shelf: bits as u32, legend: (bits >> 32) as u32 }
    }

    fn bits(self) -> u64 {
        u64::from(self.legend) << 32 | u64::from(self.shelf)
    }
}

/// What the body can touch from a cell: in which sectors nothing, as bits, and after these the number of a word that
/// names what there is in all others; 0 if these are too many for a word. All is 0 where nobody has been yet.
#[derive(Clone, Copy)]
struct Vicinity(u64);

impl Vicinity {
    fn new(free: u32, number: u16) -> Self {
        Self(u64::from(number) << u32::BITS | u64::from(free))
    }

    /// 1 if nothing can be touched in this sector.
    #[inline(always)]
    fn is_free(self, sector: u32) -> u32 {
        (self.0 as u32) >> sector & 1
    }

    /// The number of the word.
    #[inline(always)]
    fn number(self) -> u16 {
        (self.0 >> u32::BITS) as u16
    }
}

/// Many cells' shelves, and their legends in a large world.
#[derive(Clone, Copy)]
pub(super) struct Shelves {
    shelves: [u32; MOST_LANES],
    legend_starts: [u32; MOST_LANES],
}

/// Obstacles whose word does not name all there are: too many, or, in a large world, some hidden only
/// from beams that pass no wall's end too closely, and there is no [`Whole`].
#[derive(Debug)]
struct Lists {
    seen: Kept,
    near: Kept,
}

/// How sure is what has been found?
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Sure {
    /// No distance to anything else is computed as less than this, metres.
    Within(f32),
    /// So far as no end of these obstacles is passed too closely.
    UnlessDoubtful,
}

/// What is asked.
#[derive(Clone, Copy, Debug)]
pub(super) enum Question {
    /// What a beam in this bin can meet.
    Seen(u32),
    /// What a body in this sector can touch.
    Near(u32),
}

/// How much a lookout has found out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Survey {
    /// Cells that a car has visited.
    pub cells: usize,
    /// Memory that the visited cells take, bytes.
    pub bytes: usize,
    /// Obstacles that a beam may meet first, for each visited cell and each direction, ascending; none
    /// where beams walk.
    pub seen: Vec<usize>,
    /// Obstacles within the body's reach, for each visited cell and each heading, ascending.
    pub near: Vec<usize>,
}

impl Shelf {
    /// Whether these obstacles are more than there are names.
    pub(super) fn are_many(obstacles: &Obstacles) -> bool {
        obstacles.walls().len() + obstacles.discs().len() > MOST_NAMES
    }

    /// What beams meet is left out if others answer for them.
    pub(super) fn new(
        obstacles: &Obstacles,
        grid: &Grid,
        range: f32,
        body: Body<f32>,
        is_for_beams: bool,
    ) -> Self {
        let (walls, discs) = (obstacles.walls(), obstacles.discs());
        let limits = Limits::new(range, obstacles, grid.diagonal());
        let table = |nothing: Row, wall: fn(&Segment<f32>) -> Row| {
            let mut rows = vec![nothing];
            rows.extend(walls.iter().map(wall));
            rows.extend(discs.iter().map(beams::disc));
            let named = Table::new(&rows[..rows.len().min(1 << NAME)]);
            Rows { all: rows.into(), named }
        };
        let Body { rear, front, half_width } = body;
        let body_reach = libm::hypotf(rear.abs().max(front.abs()), half_width);
        let reach = if is_for_beams { range.max(body_reach) } else { body_reach };
        let is_large = Self::are_many(obstacles) || grid.cells() >= MOST_SHELVES;
        let large = is_large.then(|| Large {
            spots: bytemuck::zeroed_slice_box(grid.cells() + 1),
            taken: AtomicU32::new(1),
            legends: Legends::new(grid.tiles(), reach),
            wholes: bytemuck::zeroed_slice_box(if is_for_beams {
                MOST_SHELVES * BINS as usize
            } else {
                0
            }),
            whole_words: Words::new(),
        });
        let shelves = if large.is_some() { MOST_SHELVES } else { grid.cells() + 1 };
        Self {
            surroundings: Surroundings::new(range, body, limits),
            has_discs: !discs.is_empty(),
            is_for_beams,
            edges: table(beams::NOTHING, beams::edge),
            faces: table(beams::NOTHING_NEAR, beams::face),
            seen: bytemuck::zeroed_slice_box(if is_for_beams {
                shelves * BINS as usize
            } else {
                0
            }),
            near: bytemuck::zeroed_slice_box(shelves * SECTORS as usize),
            vicinities: bytemuck::zeroed_slice_box(grid.cells() + 1),
            words: Words::new(),
            lists: (0..shelves).map(|_| OnceLock::new()).collect(),
            large,
        }
    }

    /// A beam that passes a wall's end within this is not to be trusted, metres.
    pub(super) fn slack(&self) -> f32 {
        (self.surroundings.limits.slack * 1.25) as f32
    }

    /// Whether names mean something else in each place.
    #[inline(always)]
    pub(super) fn is_large(&self) -> bool {
        self.large.is_some()
    }

    #[inline(always)]
    pub(super) fn has_discs(&self) -> bool {
        self.has_discs
    }

    /// Asks what beams can meet that lie so many bins to the left of these headings.
    #[inline(always)]
    pub(super) fn ask_seen<V: Vector, const N: usize>(
        &self,
        asked: &mut Asked<N>,
        question: usize,
        shelves: &Shelves,
        (heading, bins): (Turned<V, BINS>, f32),
    ) {
        let places = heading.places_beside(bins, &shelves.shelves);
        let legend_starts = self.large.as_ref().map(|_| &shelves.legend_starts);
        asked.ask(question, places, legend_starts);
    }

    /// Has what the question asks for fetched.
    #[inline(always)]
    pub(super) fn fetch_seen<V: Vector, const N: usize>(&self, asked: &Asked<N>, question: usize) {
        asked.fetch::<V>(question, &self.seen);
    }

    /// Which bodies may touch something, as bits. A body's place is that of its sector, among those of all cells.
    #[inline(always)]
    pub(super) fn may_touch<V: Vector>(&self, places: &[u32; MOST_LANES]) -> u32 {
        let mut free = 0;
        for place in places[..V::WIDTH].iter().rev() {
            free = free << 1 | self.vicinity(*place).is_free(place % SECTORS);
        }
        !free & (u32::MAX >> (u32::BITS - V::WIDTH as u32))
    }

    /// Answers what the body in such a place can touch, in one lane of the only question.
    #[inline(always)]
    pub(super) fn answer_near(&self, asked: &mut Asked<1>, lane: usize, place: u32) {
        let (cell, sector) = (place / SECTORS, place % SECTORS);
        // Before the spot: whoever sees the number also sees the legend that its word is to be read by.
        let number = self.vicinity(place).number();
        let Spot { shelf, legend } = match &self.large {
            None => Spot { shelf: cell, legend: 0 },
            Some(large) => Spot::of(large.spots[cell as usize].load(Ordering::Relaxed)),
        };
        let mut word = self.words.all().of_number(number);
        if word & UNKNOWN != 0 {
            word = self.words.all().of(&self.near[(shelf * SECTORS + sector) as usize]);
        }
        asked.put(lane, word, Meanings::start(legend));
    }

    /// What is near the cell of a body's place.
    #[inline(always)]
    fn vicinity(&self, place: u32) -> Vicinity {
        Vicinity(self.vicinities[(place / SECTORS) as usize].load(Ordering::Acquire))
    }

    /// Answers what beams can meet, for cars with any lane in `live`.
    #[inline(always)]
    pub(super) fn answer_seen<V: Vector, const N: usize>(
        &self,
        asked: &mut Asked<N>,
        live: &[u32],
    ) -> ByNames {
        asked.answer::<V>(&self.seen, self.words.all(), live, self.is_large())
    }

    /// Closes what beams ask where nobody in `live` does, and where an answer is sure.
    #[inline(always)]
    pub(super) fn close_seen<const N: usize>(
        &self,
        asked: &mut Asked<N>,
        question: usize,
        live: u32,
    ) {
        asked.close(question, &self.seen, self.words.all(), live);
    }

    /// Has fetched what says where these cells' shelves are.
    #[inline(always)]
    pub(super) fn fetch_shelves<V: Vector>(&self, cells: V) {
        if let Some(large) = &self.large {
            for cell in &cells.places()[..V::WIDTH] {
                fetch(&large.spots, *cell as usize);
            }
        }
    }

    /// The shelves of these cells.
    #[inline(always)]
    pub(super) fn shelves<V: Vector>(&self, cells: V) -> Shelves {
        let mut all = Shelves { shelves: cells.places(), legend_starts: [0; MOST_LANES] };
        if let Some(large) = &self.large {
            let lanes = all.shelves[..V::WIDTH].iter_mut().zip(&mut all.legend_starts);
            for (shelf, start) in lanes {
                let spot = Spot::of(large.spots[*shelf as usize].load(Ordering::Relaxed));
                *shelf = spot.shelf;
                *start = Meanings::start(spot.legend);
            }
        }
        all
    }

    /// The obstacles of each lane's name, as beams meet them. Whether the world [is large](Self::is_large), the
    /// caller says.
    #[inline(always)]
    pub(super) fn edges<V: Vector, const IS_LARGE: bool>(&self, names: Names<'_>) -> [V; 4] {
        self.edges.rows(if IS_LARGE { self.large.as_ref() } else { None }, names)
    }

    /// The same as bodies meet them.
    #[inline(always)]
    pub(super) fn faces<V: Vector>(&self, names: Names<'_>) -> [V; 4] {
        self.faces.rows(self.large.as_ref(), names)
    }

    /// Has the [`Whole`] of a question fetched wherever it is open.
    #[inline(always)]
    pub(super) fn fetch_whole<const N: usize>(&self, asked: &Asked<N>, question: usize) {
        if let Some(large) = &self.large {
            for lane in ones(asked.open(question)) {
                fetch(&large.wholes, asked.places(question)[lane] as usize);
            }
        }
    }

    /// Calls `f` with every obstacle that the [`Whole`] of a question names in a lane; returns how far it is sure,
    /// metres, as [`Sure::Within`]. None where there is none.
    pub(super) fn each_of_whole<const N: usize>(
        &self,
        asked: &Asked<N>,
        question: usize,
        lane: usize,
        f: impl FnMut(&Row),
    ) -> Option<f32> {
        let (place, start) = (asked.places(question)[lane], asked.legend_starts(question)[lane]);
        self.each_of_whole_at(place, start, f)
    }

    /// The same of the [`Whole`] in this place, by the legend that starts there.
    fn each_of_whole_at(&self, place: u32, start: u32, f: impl FnMut(&Row)) -> Option<f32> {
        let large = self.large.as_ref()?;
        let whole = Whole::in_place(&large.wholes[place as usize])?;
        let word = large.whole_words.all().of_number(whole.number());
        self.each_named(&self.edges, start, word, f);
        Some(whole.beyond(self.surroundings.range))
    }

    /// Calls `f` with every obstacle that is asked for, after looking around from its cell if nobody
    /// has. Returns how sure it is that no other counts; none where there is no such cell, or no room
    /// to remember it.
    pub(super) fn each(
        &self,
        grid: &Grid,
        obstacles: &Obstacles,
        cell: u32,
        question: Question,
        mut f: impl FnMut(&Row),
    ) -> Option<Sure> {
        let spot @ Spot { shelf, legend } = self.spot(grid, obstacles, cell)?;
        let lists = self.lists[shelf as usize]
            .get_or_init(|| Box::new(self.look_around(grid, obstacles, cell, spot)));
        let start = Meanings::start(legend);
        if let Question::Seen(bin) = question
            && let Some(beyond) = self.each_of_whole_at(shelf * BINS + bin, start, &mut f)
        {
            return Some(Sure::Within(beyond));
        }
        let (kept, part, numbers, table, at) = match question {
            Question::Seen(bin) => (&lists.seen, bin, &self.seen, &self.edges, shelf * BINS + bin),
            Question::Near(sector) => {
                (&lists.near, sector, &self.near, &self.faces, shelf * SECTORS + sector)
            }
        };
        if let Some((places, beyond)) = kept.of(part) {
            places.iter().for_each(|place| f(&table.all[*place as usize + 1]));
            return Some(Sure::Within(beyond));
        }
        let word = self.words.all().of(&numbers[at as usize]);
        if word & UNKNOWN != 0 {
            return None;
        }
        self.each_named(table, start, word, f);
        Some(if word & JOINT != 0 { Sure::UnlessDoubtful } else { Sure::Within(f32::INFINITY) })
    }

    /// Calls `f` with the obstacle of every name in a word, by the legend that starts there.
    fn each_named(&self, table: &Rows, start: u32, word: Word, f: impl FnMut(&Row)) {
        let row = |name: u8| match &self.large {
            None => usize::from(name),
            Some(large) => large.legends.meanings().at(start, name),
        };
        named(word).map(|name| &table.all[row(name)]).for_each(f);
    }

    /// The shelf and legend of a cell; takes one if it has none yet.
    fn spot(&self, grid: &Grid, obstacles: &Obstacles, cell: u32) -> Option<Spot> {
        if cell as usize >= grid.cells() {
            return None;
        }
        let Some(large) = &self.large else { return Some(Spot { shelf: cell, legend: 0 }) };
        let mine = &large.spots[cell as usize];
        let known = mine.load(Ordering::Acquire);
        if known != 0 {
            return Some(Spot::of(known));
        }
        if large.taken.load(Ordering::Relaxed) as usize >= MOST_SHELVES {
            return None;
        }
        let new = large.taken.fetch_add(1, Ordering::Relaxed);
        if new as usize >= MOST_SHELVES {
            return None;
        }
        let tile = grid.tile(cell as usize);
        let legend = large.legends.of(tile, || grid.tile_rect(tile), obstacles)?;
        let new = Spot { shelf: new, legend };
        // Another thread may have been faster; then this shelf stays empty.
        match mine.compare_exchange(0, new.bits(), Ordering::AcqRel, Ordering::Acquire) {
            Ok(_) => Some(new),
            Err(theirs) => Some(Spot::of(theirs)),
        }
    }

    /// Writes a cell's words; returns what they do not say.
    fn look_around(&self, grid: &Grid, obstacles: &Obstacles, cell: u32, spot: Spot) -> Lists {
        let (rect, Spot { shelf, legend }) = (grid.rect(cell as usize), spot);
        let mut naming = match &self.large {
            None => Naming::Own(Vec::new()),
            Some(large) => large.legends.naming(grid.tile(cell as usize)),
        };
        // In a crowd names are few: they are for what beams can meet first.
        let has_wholes = matches!(naming, Naming::Shared(_));
        // The number of a word that names all of these places, if there is one.
        let mut number_of = |words: &Words, places: &[u32], flags: Word| {
            let mut names = [0; size_of::<Word>()];
            let named = names[..NAMES].get_mut(..places.len())?;
            for (name, place) in named.iter_mut().zip(places) {
                *name = self.name(legend, &mut naming, *place)?;
            }
            // In whatever order they were found: so there are fewer words.
            named.sort_unstable();
            words.number(flags | Word::from_le_bytes(names))
        };
        // The first word says that nothing is known.
        let write = |to: &AtomicU16, number: Option<u16>| {
            to.store(number.unwrap_or(0), Ordering::Release);
            number.is_some()
        };
        let (mut seen, mut near) = (Kept::builder(), Kept::builder());
        let see = |bin: u32, sight: &Sight<'_>| {
            let Sight { first, all, beyond, joint } = *sight;
            let at = (shelf * BINS + bin) as usize;
            let flags = if joint { JOINT } else { 0 };
            let whole = self.large.as_ref().filter(|_| joint && has_wholes).and_then(|large| {
                let number = number_of(&large.whole_words, all, 0)?;
                let whole = Whole::new(number, beyond, self.surroundings.range);
                whole.put(&large.wholes[at]);
                Some(whole)
            });
            let is_named = write(&self.seen[at], number_of(&self.words, first, flags));
            // In a small world it is quicker to ask all obstacles.
            if whole.is_none() && (!is_named || (joint && self.large.is_some())) {
                seen.keep(bin, all, beyond);
            }
        };
        if self.is_for_beams {
            self.surroundings.seen(obstacles, &rect, see);
        }
        let (mut free, mut close) = (0, Vec::new());
        self.surroundings.near(obstacles, &rect, |sector, places| {
            free |= u32::from(places.is_empty()) << sector;
            close.extend(places);
            let at = (shelf * SECTORS + sector) as usize;
            if !write(&self.near[at], number_of(&self.words, places, 0)) {
                near.keep(sector, places, f32::INFINITY);
            }
        });
        close.sort_unstable();
        close.dedup();
        let number = number_of(&self.words, &close, 0).unwrap_or(0);
        self.vicinities[cell as usize].store(Vicinity::new(free, number).0, Ordering::Release);
        Lists { seen: seen.done(), near: near.done() }
    }

    /// The name of the obstacle in this place; none if there are too many.
    fn name(&self, legend: u32, naming: &mut Naming<'_>, place: u32) -> Option<u8> {
        match &self.large {
            None => u8::try_from(place + 1).ok(),
            Some(large) => large.legends.name(legend, naming, place),
        }
    }

    /// The cells visited so far.
    pub(super) fn survey(&self, grid: &Grid, obstacles: &Obstacles) -> Survey {
        let is_visited = |cell: &u32| {
            let shelf = match &self.large {
                None => *cell,
                Some(large) => Spot::of(large.spots[*cell as usize].load(Ordering::Relaxed)).shelf,
            };
            self.lists[shelf as usize].get().is_some()
        };
        let cells: Vec<u32> = (0..grid.cells() as u32).filter(is_visited).collect();
        let counts = |parts: u32, question: fn(u32) -> Question| {
            let mut counts = Vec::new();
            for cell in &cells {
                for part in 0..parts {
                    let mut count = 0;
                    self.each(grid, obstacles, *cell, question(part), |_| count += 1);
                    counts.push(count);
                }
            }
            counts.sort_unstable();
            counts
        };
        let legends = self.large.as_ref().map_or(0, |large| large.legends.bytes());
        let of_bin = size_of::<u16>() + self.large.as_ref().map_or(0, |_| size_of::<Whole>());
        let bins = if self.is_for_beams { BINS as usize * of_bin } else { 0 };
        let words = bins + SECTORS as usize * size_of::<u16>() + size_of::<Vicinity>();
        let lists = self.lists.iter().filter_map(OnceLock::get);
        let long: usize = lists.map(|lists| lists.seen.bytes() + lists.near.bytes()).sum();
        Survey {
            cells: cells.len(),
            bytes: cells.len() * words + legends + long,
            seen: if self.is_for_beams { counts(BINS, Question::Seen) } else { Vec::new() },
            near: counts(SECTORS, Question::Near),
        }
    }
}
