//! What names mean in a world with more obstacles than names.
//!
//! A legend says which obstacle each name stands for. Where there are few enough obstacles around,
//! all cells of a tile share one, so that neighbours find what they mean in the same few lines of the
//! cache. Where there are more, each cell has its own, of what matters there.

use super::shelf::MOST_SHELVES;
use super::words::NAME;
use crate::world::Obstacles;
use crate::world::shape::Rect;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

/// Names of obstacles; name 0 is that of nothing.
pub(super) const MOST_NAMES: usize = (1 << NAME) - 1;

/// Most legends, one for each shelf; the first is that of cells where nobody has been.
const MOST_LEGENDS: usize = MOST_SHELVES;

/// Each obstacle's place in the world plus 1, by legend and name; 0 is nothing.
#[derive(Debug)]
pub(super) struct Meanings(Box<[AtomicU32; MOST_LEGENDS << NAME]>);

/// All legends.
#[derive(Debug)]
pub(super) struct Legends {
    meanings: Meanings,
    /// Legends given out.
    taken: AtomicU32,
    tiles: Box<[OnceLock<Tile>]>,
    /// How far from a tile an obstacle matters to its cells, metres.
    reach: f64,
}

/// Some cells side by side.
#[derive(Debug)]
enum Tile {
    /// A legend of all obstacles that matter to any of them, which are these, ascending.
    Shared(u32, Box<[u32]>),
    /// There are more of them than names.
    Crowded,
}

/// How one cell names obstacles.
pub(super) enum Naming<'a> {
    /// As the whole tile.
    Shared(&'a [u32]),
    /// By itself, in the order in which they are named.
    Own(Vec<u32>),
}

impl Meanings {
    /// What a name means by the legend that [starts](Self::start) here: a place in the world plus 1.
    #[inline(always)]
    pub(super) fn at(&self, start: u32, name: u8) -> usize {
        self.meaning(start, name).load(Ordering::Relaxed) as usize
    }

    /// Where a legend starts.
    #[inline(always)]
    pub(super) fn start(legend: u32) -> u32 {
        legend << NAME
    }

    fn mean(&self, legend: u32, name: u8, place: u32) {
        self.meaning(Self::start(legend), name).store(place + 1, Ordering::Relaxed);
    }

    #[inline(always)]
    fn meaning(&self, start: u32, name: u8) -> &AtomicU32 {
        // No index is farther out; said so, it needs no test.
        &self.0[(start | u32::from(name)) as usize & ((MOST_LEGENDS << NAME) - 1)]
    }
}

impl Legends {
    /// For so many tiles, to whose cells obstacles matter within `reach` metres.
    pub(super) fn new(tiles: usize, reach: f32) -> Self {
        Self {
            meanings: Meanings(bytemuck::zeroed_box()),
            taken: AtomicU32::new(1),
            tiles: (0..tiles).map(|_| OnceLock::new()).collect(),
            reach: f64::from(reach) * 1.001 + 0.01,
        }
    }

    #[inline(always)]
    pub(super) fn meanings(&self) -> &Meanings {
        &self.meanings
    }

    /// The legend for a cell of this tile, which lies in this rectangle; a new one in a crowd. None
    /// where no legend is left.
    pub(super) fn of(
        &self,
        tile: usize,
        rect: impl Fn() -> Rect,
        obstacles: &Obstacles,
    ) -> Option<u32> {
        match self.tiles[tile].get_or_init(|| self.tile(&rect(), obstacles)) {
            Tile::Shared(legend, _) => Some(*legend),
            Tile::Crowded => self.take(),
        }
    }

    /// How a cell of this tile names obstacles; it has asked for its legend before.
    pub(super) fn naming(&self, tile: usize) -> Naming<'_> {
        match self.tiles[tile].get().expect("a cell has its legend before it names anything") {
            Tile::Shared(_, places) => Naming::Shared(places),
            Tile::Crowded => Naming::Own(Vec::new()),
        }
    }

    /// The name of the obstacle in this place; none if there are too many.
    pub(super) fn name(&self, legend: u32, naming: &mut Naming<'_>, place: u32) -> Option<u8> {
        let own = match naming {
            Naming::Shared(places) => {
                return places.binary_search(&place).ok().map(|at| at as u8 + 1);
            }
            Naming::Own(own) => own,
        };
        let at = own.iter().position(|known| *known == place).unwrap_or_else(|| {
            own.push(place);
            own.len() - 1
        });
        if at >= MOST_NAMES {
            return None;
        }
        let name = at as u8 + 1;
        self.meanings.mean(legend, name, place);
        Some(name)
    }

    fn tile(&self, rect: &Rect, obstacles: &Obstacles) -> Tile {
        let mut places = Vec::new();
        obstacles.each_near(rect, self.reach, |place, shape| {
            if shape.distance(rect) <= self.reach {
                places.push(place);
            }
        });
        if places.len() > MOST_NAMES {
            return Tile::Crowded;
        }
        let Some(legend) = self.take() else { return Tile::Crowded };
        places.sort_unstable();
        for (at, place) in places.iter().enumerate() {
            self.meanings.mean(legend, at as u8 + 1, *place);
        }
        Tile::Shared(legend, places.into())
    }

    fn take(&self) -> Option<u32> {
        if self.taken.load(Ordering::Relaxed) as usize >= MOST_LEGENDS {
            return None;
        }
        let new = self.taken.fetch_add(1, Ordering::Relaxed);
        ((new as usize) < MOST_LEGENDS).then_some(new)
    }

    /// Memory that the legends take, bytes.
    pub(super) fn bytes(&self) -> usize {
        let taken = (self.taken.load(Ordering::Relaxed) as usize).min(MOST_LEGENDS);
        let shared = self.tiles.iter().filter_map(|tile| match tile.get()? {
            Tile::Shared(_, places) => Some(size_of_val(&**places)),
            Tile::Crowded => None,
        });
        (taken << NAME) * size_of::<u32>() + shared.sum::<usize>()
    }
}
