//! What has been found out about each cell.
//!
//! A name is a byte. In a small world it counts all obstacles, and every cell has its shelf. In a
//! large one it counts those of its cell, which are listed beside the words, and cells get a
//! shelf when a car turns up. Memory is asked for at once, but what no car visits is never
//! touched, and so takes none.

use super::asked::{Asked, ByPlace, place};
use super::beams::{self, Row};
use super::cell::{BINS, SECTORS, Surroundings};
use super::grid::Grid;
use super::rounding::Limits;
use super::words::{JOINT, NAME, NAMES, UNKNOWN, Word, Words};
use crate::vector::{ByName, Table, Vector, fetch};
use crate::world::Obstacles;
use controller_core::geometry::{Body, Segment};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU16, AtomicU32, Ordering};

/// Names of obstacles; name 0 is that of nothing.
const MOST: usize = u8::MAX as usize;

/// Most cells that are remembered in a large world; beyond, all obstacles are asked.
const MOST_SHELVES: usize = 1 << 16;

/// Words of every cell.
#[derive(Debug)]
pub(super) struct Shelf {
    surroundings: Surroundings,
    has_discs: bool,
    /// Obstacles as beams meet them.
    edges: Rows,
    /// The same as bodies meet them.
    faces: Rows,
    /// What a beam can meet, by shelf and bin: where among the words; 0 where nobody has been yet.
    seen: Box<[AtomicU16]>,
    /// What the body can touch, by shelf and sector, likewise.
    near: Box<[AtomicU16]>,
    words: Words,
    /// Lists that do not fit into a word, by shelf; set once the shelf's words are written.
    lists: Box<[OnceLock<Lists>]>,
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

/// What a large world has besides.
#[derive(Debug)]
struct Large {
    /// Each cell's shelf; 0 where nobody has been yet.
    shelves: Box<[AtomicU32]>,
    /// Shelves given out.
    taken: AtomicU32,
    /// What the names of a shelf mean.
    places: Box<[AtomicU32]>,
}

/// Lists of places that do not fit into a word, and whether they rely on walls that meet.
type Lists = Box<[(Box<[u32]>, bool)]>;

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
    /// Obstacles that a beam may meet first, for each visited cell and each direction, ascending.
    pub seen: Vec<usize>,
    /// Obstacles within the body's reach, for each visited cell and each heading, ascending.
    pub near: Vec<usize>,
}

impl Shelf {
    /// Whether these obstacles are more than there are names.
    pub(super) fn are_many(obstacles: &Obstacles) -> bool {
        obstacles.walls().len() + obstacles.discs().len() > MOST
    }

    pub(super) fn new(obstacles: &Obstacles, grid: &Grid, range: f32, body: Body<f32>) -> Self {
        let (walls, discs) = (obstacles.walls(), obstacles.discs());
        let limits =
            Limits::new(range, obstacles.largest(), grid.diagonal(), obstacles.joint(range));
        let table = |nothing: Row, wall: fn(&Segment<f32>) -> Row| {
            let mut rows = vec![nothing];
            rows.extend(walls.iter().map(wall));
            rows.extend(discs.iter().map(beams::disc));
            let named = Table::new(&rows[..rows.len().min(1 << NAME)]);
            Rows { all: rows.into(), named }
        };
        let is_large = Self::are_many(obstacles) || grid.cells() >= MOST_SHELVES;
        let large = is_large.then(|| Large {
            shelves: bytemuck::zeroed_slice_box(grid.cells() + 1),
            taken: AtomicU32::new(1),
            places: bytemuck::zeroed_slice_box(MOST_SHELVES << NAME),
        });
        let shelves = if large.is_some() { MOST_SHELVES } else { grid.cells() + 1 };
        Self {
            surroundings: Surroundings::new(range, body, limits),
            has_discs: !discs.is_empty(),
            edges: table(beams::NOTHING, beams::edge),
            faces: table(beams::NOTHING_NEAR, beams::face),
            seen: bytemuck::zeroed_slice_box(shelves * BINS as usize),
            near: bytemuck::zeroed_slice_box(shelves * SECTORS as usize),
            words: Words::new(),
            lists: (0..shelves).map(|_| OnceLock::new()).collect(),
            large,
        }
    }

    /// A beam that passes a wall's end within this is not to be trusted, metres.
    pub(super) fn slack(&self) -> f32 {
        (self.surroundings.limits.slack * 1.25) as f32
    }

    #[inline(always)]
    pub(super) fn has_discs(&self) -> bool {
        self.has_discs
    }

    /// Asks what beams in these bins can meet.
    #[inline(always)]
    pub(super) fn ask_seen<V: Vector, const N: usize>(
        &self,
        asked: &mut Asked<N>,
        question: usize,
        shelves: V,
        bins: V,
    ) {
        self.ask(asked, question, shelves, bins, BINS);
    }

    /// Has what the question asks for fetched.
    #[inline(always)]
    pub(super) fn fetch_seen<V: Vector, const N: usize>(&self, asked: &Asked<N>, question: usize) {
        asked.fetch::<V>(question, &self.seen);
    }

    /// Asks what bodies in these sectors can touch, and has it fetched.
    #[inline(always)]
    pub(super) fn ask_near<V: Vector, const N: usize>(
        &self,
        asked: &mut Asked<N>,
        question: usize,
        shelves: V,
        sectors: V,
    ) {
        self.ask(asked, question, shelves, sectors, SECTORS);
        asked.fetch::<V>(question, &self.near);
    }

    #[inline(always)]
    fn ask<V: Vector, const N: usize>(
        &self,
        asked: &mut Asked<N>,
        question: usize,
        shelves: V,
        part: V,
        parts: u32,
    ) {
        let places = shelves * V::from(parts as f32) + part;
        let shelves = self.large.is_some().then(|| shelves.places());
        asked.ask(question, places, shelves);
    }

    /// Answers what beams can meet.
    #[inline(always)]
    pub(super) fn answer_seen<V: Vector, const N: usize>(&self, asked: &mut Asked<N>) {
        asked.answer::<V>(&self.seen, self.words.all());
    }

    /// Answers what bodies can touch.
    #[inline(always)]
    pub(super) fn answer_near<V: Vector, const N: usize>(&self, asked: &mut Asked<N>) {
        asked.answer::<V>(&self.near, self.words.all());
    }

    /// The shelves of these cells.
    #[inline(always)]
    pub(super) fn shelves<V: Vector>(&self, cells: V) -> V {
        let Some(large) = &self.large else { return cells };
        let cells = cells.places();
        let mut shelves = V::from(0.0);
        for (shelf, cell) in shelves.lanes_mut().iter_mut().zip(cells) {
            let taken = large.shelves[cell as usize].load(Ordering::Relaxed);
            // What most of its names mean.
            for name in (0..48).step_by(16) {
                fetch(&large.places, place(taken, name));
            }
            *shelf = taken as f32;
        }
        shelves
    }

    /// The obstacles of each word's name in this round, as beams meet them.
    #[inline(always)]
    pub(super) fn edges<V: Vector, const N: usize>(
        &self,
        asked: &Asked<N>,
        question: usize,
        round: usize,
    ) -> [V; 4] {
        self.rows(&self.edges, asked, question, round)
    }

    /// The same as bodies meet them.
    #[inline(always)]
    pub(super) fn faces<V: Vector, const N: usize>(
        &self,
        asked: &Asked<N>,
        question: usize,
        round: usize,
    ) -> [V; 4] {
        self.rows(&self.faces, asked, question, round)
    }

    #[inline(always)]
    fn rows<V: Vector, const N: usize>(
        &self,
        table: &Rows,
        asked: &Asked<N>,
        question: usize,
        round: usize,
    ) -> [V; 4] {
        let words = asked.words(question);
        match &self.large {
            None => V::named(ByName { table: &table.named, words, byte: round }),
            Some(Large { places, .. }) => {
                let shelves = asked.shelves(question);
                V::rows(ByPlace { table: &table.all, places, words, shelves, round })
            }
        }
    }

    /// Calls `f` with every obstacle that is asked for, after looking around from its cell if nobody
    /// has. Returns whether what is left out stands behind walls that meet; none where there is no
    /// such cell, or no room to remember it.
    pub(super) fn each(
        &self,
        grid: &Grid,
        obstacles: &Obstacles,
        cell: u32,
        question: Question,
        mut f: impl FnMut(&Row),
    ) -> Option<bool> {
        let shelf = self.shelf(grid, cell)?;
        let lists = self.lists[shelf as usize]
            .get_or_init(|| self.look_around(grid, obstacles, cell, shelf));
        let (numbers, table, at) = match question {
            Question::Seen(bin) => (&self.seen, &self.edges, shelf * BINS + bin),
            Question::Near(sector) => (&self.near, &self.faces, shelf * SECTORS + sector),
        };
        let word = self.words.all().of(&numbers[at as usize]);
        if word & UNKNOWN != 0 {
            let number = (word & !UNKNOWN) as usize;
            let (list, joint) = lists.get(number.checked_sub(1)?)?;
            list.iter().for_each(|place| f(&table.all[*place as usize + 1]));
            return Some(*joint);
        }
        let names = word.to_le_bytes();
        for name in names[..NAMES].iter().take_while(|name| **name != 0) {
            f(&table.all[self.row(shelf, *name)]);
        }
        Some(word & JOINT != 0)
    }

    /// Where in the tables a name's obstacle is.
    fn row(&self, shelf: u32, name: u8) -> usize {
        match &self.large {
            None => usize::from(name),
            Some(large) => large.places[place(shelf, name)].load(Ordering::Relaxed) as usize,
        }
    }

    /// The shelf of a cell; takes one if it has none yet.
    fn shelf(&self, grid: &Grid, cell: u32) -> Option<u32> {
        if cell as usize >= grid.cells() {
            return None;
        }
        let Some(large) = &self.large else { return Some(cell) };
        let mine = &large.shelves[cell as usize];
        let known = mine.load(Ordering::Relaxed);
        if known != 0 {
            return Some(known);
        }
        if large.taken.load(Ordering::Relaxed) as usize >= MOST_SHELVES {
            return None;
        }
        let new = large.taken.fetch_add(1, Ordering::Relaxed);
        if new as usize >= MOST_SHELVES {
            return None;
        }
        // Another thread may have been faster; then this shelf stays empty.
        match mine.compare_exchange(0, new, Ordering::Relaxed, Ordering::Relaxed) {
            Ok(_) => Some(new),
            Err(theirs) => Some(theirs),
        }
    }

    /// Writes a cell's words; returns its lists that are too long for one.
    fn look_around(&self, grid: &Grid, obstacles: &Obstacles, cell: u32, shelf: u32) -> Lists {
        let rect = grid.rect(cell as usize);
        let mut long: Vec<(Box<[u32]>, bool)> = Vec::new();
        let mut named: Vec<u32> = Vec::new();
        let mut write = |at: u32, is_near: bool, places: &[u32], joint: bool| {
            let names = places.iter().map(|place| self.name(shelf, *place, &mut named));
            let flags = if joint { JOINT } else { 0 };
            let all = (places.len() <= NAMES).then_some(flags);
            let word = names
                .zip(0..)
                .fold(all, |word, (name, n)| Some(word? | Word::from(name?) << (n * NAME)));
            let word = word.unwrap_or_else(|| {
                long.push((places.into(), joint));
                long.len() as Word | UNKNOWN
            });
            // Without a number, all obstacles are asked.
            let number = self.words.number(word).unwrap_or(0);
            let numbers = if is_near { &self.near } else { &self.seen };
            numbers[at as usize].store(number, Ordering::Release);
        };
        self.surroundings.seen(obstacles, &rect, |bin, places, joint| {
            write(shelf * BINS + bin, false, places, joint);
        });
        self.surroundings.near(obstacles, &rect, |sector, places| {
            write(shelf * SECTORS + sector, true, places, false);
        });
        long.into()
    }

    /// The name of the obstacle in this place; none if there are too many.
    fn name(&self, shelf: u32, obstacle: u32, named: &mut Vec<u32>) -> Option<u8> {
        let Some(large) = &self.large else { return u8::try_from(obstacle + 1).ok() };
        let known = named.iter().position(|known| *known == obstacle);
        let index = known.unwrap_or_else(|| {
            named.push(obstacle);
            named.len() - 1
        });
        if index >= MOST {
            return None;
        }
        let name = index as u8 + 1;
        large.places[place(shelf, name)].store(obstacle + 1, Ordering::Relaxed);
        Some(name)
    }

    /// The cells visited so far.
    pub(super) fn survey(&self, grid: &Grid, obstacles: &Obstacles) -> Survey {
        let is_visited = |cell: &u32| {
            let shelf = match &self.large {
                None => *cell,
                Some(large) => large.shelves[*cell as usize].load(Ordering::Relaxed),
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
        let names = if self.large.is_some() { size_of::<u32>() << NAME } else { 0 };
        let words = (BINS + SECTORS) as usize * size_of::<u16>() + names;
        let lists = self.lists.iter().filter_map(OnceLock::get).flatten();
        let long: usize = lists.map(|(list, _)| size_of_val(&**list)).sum();
        Survey {
            cells: cells.len(),
            bytes: cells.len() * words + long,
            seen: counts(BINS, Question::Seen),
            near: counts(SECTORS, Question::Near),
        }
    }
}
