//! What can be seen and touched from one cell, for each sector of headings.

use super::beams::Edge;
use super::fan::Fan;
use super::grid::SECTORS;
use super::hidden::{Candidate, Cover};
use super::region::Region;
use super::rounding::Rounding;
use super::view::View;
use crate::world::Obstacles;
use crate::world::shape::Rect;
use controller_core::geometry::{Body, Segment};
use std::sync::Arc;

/// Walls a [`Record`] can name.
const NAMES: usize = 15;

/// Most walls in a table: names are bytes.
pub(super) const MAX_ROWS: usize = 1 << u8::BITS;

/// Walls by name: as beams meet them, and as bodies do.
pub(super) type Table = Arc<[(Edge, Segment<f32>)]>;

/// The table of all walls of a small world, by place.
pub(super) fn table_of_all(obstacles: &Obstacles) -> Option<Table> {
    (obstacles.walls().len() <= MAX_ROWS).then(|| obstacles.walls().iter().map(row).collect())
}

fn row(wall: &Segment<f32>) -> (Edge, Segment<f32>) {
    (Edge::from(wall), *wall)
}

/// One cell, all sectors.
#[derive(Debug)]
pub(super) struct Cell {
    /// A beam that passes a wall's end within this asks all obstacles instead, metres; negative
    /// where nothing is hidden.
    pub(super) slack: f32,
    table: Table,
    records: [Record; SECTORS],
    /// Sectors with discs, or with more walls than a record can name.
    long: Box<[View]>,
}

/// The names of the walls that beams can meet, and from the end backwards of those that the
/// body can touch. A wall too many does no harm: it is neither nearest nor touched.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(16))]
struct Record {
    names: [u8; NAMES],
    /// Seen, plus sixteen times near; [`LONG`] if the first name is a place in `long`.
    counts: u8,
}

const LONG: u8 = u8::MAX;

/// The obstacles to test.
pub(super) enum Choice<'a> {
    /// Walls by name.
    Named(Named<'a>),
    /// More walls, or discs.
    Long(&'a View),
}

/// Walls by name.
pub(super) struct Named<'a> {
    table: &'a Table,
    record: &'a Record,
}

impl Cell {
    /// Looks around from a rectangle. `region` gives the poses of a sector, `joint` is how far
    /// apart the ends of walls that meet may lie, metres.
    pub(super) fn new(
        obstacles: &Obstacles,
        regions: &[Region; SECTORS],
        fan: &Fan,
        body: &Body<f32>,
        joint: f64,
        all: Option<&Table>,
    ) -> Self {
        let cones = regions.each_ref().map(|region| region.cones(fan));
        let froms = cones.iter().flatten().map(|cone| cone.from);
        let from = froms.reduce(Rect::joined).unwrap_or(regions[0].cell);
        let candidates = candidates(obstacles, &from, fan.range());
        let cover = Cover::new(from, &candidates, joint);
        let slack = cover.slack;
        let visible = cover.visible();
        let hides = visible.len() < candidates.len();

        let around = regions[0].reach(body).around();
        let mut close = Vec::new();
        obstacles.each_near(&around, 0.0, |id, shape| {
            let margin = Rounding::new(&shape, &around).contact();
            if shape.distance(&around) <= margin {
                close.push((id, shape, margin));
            }
        });
        close.sort_unstable_by_key(|(id, ..)| *id);

        let chosen: [(Vec<u32>, Vec<u32>); SECTORS] = std::array::from_fn(|sector| {
            let meets = |candidate: &Candidate, backwards: bool| {
                cones[sector].iter().any(|cone| {
                    let cone = if backwards { cone.reversed() } else { *cone };
                    // So wide that each wall with an end in doubt is seen.
                    cone.meets(&candidate.shape, candidate.rounding.aside + 2.0 * slack)
                })
            };
            let is_seen = |candidate: &&Candidate| {
                // Rounding can bring a wall behind the car before it only if its distance is
                // that uncertain.
                let uncertain = candidate.rounding.distance >= candidate.distance;
                meets(candidate, false) || (uncertain && meets(candidate, true))
            };
            let seen = visible.iter().map(|index| &candidates[*index]).filter(is_seen);
            let mut seen: Vec<u32> = seen.map(|candidate| candidate.id).collect();
            seen.sort_unstable();
            let reach = regions[sector].reach(body);
            let near = close.iter().filter(|(_, shape, margin)| reach.meets(shape, *margin));
            (seen, near.map(|(id, ..)| *id).collect())
        });
        Self::from_choice(obstacles, &chosen, if hides { (slack * 1.25) as f32 } else { -1.0 }, all)
    }

    fn from_choice(
        obstacles: &Obstacles,
        chosen: &[(Vec<u32>, Vec<u32>); SECTORS],
        slack: f32,
        all: Option<&Table>,
    ) -> Self {
        let walls = obstacles.walls();
        let mut own = Vec::new();
        let mut name = |place: u32| {
            if place as usize >= walls.len() {
                return None;
            }
            if all.is_some() {
                return u8::try_from(place).ok();
            }
            let known = own.iter().position(|known| *known == place);
            let index = known.unwrap_or_else(|| {
                own.push(place);
                own.len() - 1
            });
            u8::try_from(index).ok()
        };
        let mut long = Vec::new();
        let records = chosen.each_ref().map(|(seen, near)| {
            let mut record = Record::default();
            let seen_names: Option<Vec<u8>> = seen.iter().map(|place| name(*place)).collect();
            let near_names: Option<Vec<u8>> = near.iter().map(|place| name(*place)).collect();
            match (seen_names, near_names) {
                (Some(seen), Some(near)) if seen.len() + near.len() <= NAMES => {
                    record.names[..seen.len()].copy_from_slice(&seen);
                    record.names[NAMES - near.len()..].copy_from_slice(&near);
                    record.counts = (seen.len() + 16 * near.len()) as u8;
                }
                _ if long.len() < SECTORS => {
                    record.names[0] = long.len() as u8;
                    record.counts = LONG;
                    long.push(View::new(obstacles, seen, near));
                }
                _ => {}
            }
            record
        });
        let table = all.cloned().unwrap_or_else(|| {
            own.iter().take(MAX_ROWS).map(|place| row(&walls[*place as usize])).collect()
        });
        Self { slack, table, records, long: long.into() }
    }

    /// What to test in one sector.
    #[inline(always)]
    pub(super) fn choice(&self, sector: usize) -> Choice<'_> {
        let record = &self.records[sector % SECTORS];
        if record.counts == LONG {
            Choice::Long(&self.long[usize::from(record.names[0])])
        } else {
            Choice::Named(Named { table: &self.table, record })
        }
    }

    /// How many obstacles are seen and near, by sector.
    pub(super) fn counts(&self) -> impl Iterator<Item = (usize, usize)> {
        (0..SECTORS).map(|sector| match self.choice(sector) {
            Choice::Long(view) => view.counts(),
            Choice::Named(Named { record, .. }) => {
                (usize::from(record.counts % 16), usize::from(record.counts / 16))
            }
        })
    }

    /// Bytes it takes; a table that all cells share counts nowhere.
    pub(super) fn bytes(&self, shares_table: bool) -> usize {
        let table = if shares_table { 0 } else { size_of_val(&*self.table) };
        size_of::<Self>() + table + self.long.iter().map(View::bytes).sum::<usize>()
    }
}

impl<'a> Named<'a> {
    /// Walls that beams can meet.
    #[inline(always)]
    pub(super) fn seen(&self) -> impl Iterator<Item = &'a Edge> {
        let names = &self.record.names[..usize::from(self.record.counts % 16)];
        let table = &**self.table;
        names.iter().filter_map(|name| table.get(usize::from(*name)).map(|(edge, _)| edge))
    }

    /// Walls that the body can touch.
    #[inline(always)]
    pub(super) fn near(&self) -> impl Iterator<Item = &'a Segment<f32>> {
        let names = &self.record.names[NAMES - usize::from(self.record.counts / 16)..];
        let table = &**self.table;
        names.iter().filter_map(|name| table.get(usize::from(*name)).map(|(_, wall)| wall))
    }
}

/// Everything that beams from a rectangle may meet, in any direction; the nearest first.
fn candidates(obstacles: &Obstacles, from: &Rect, range: f32) -> Vec<Candidate> {
    let range = f64::from(range) * (1.0 + 1.0e-6);
    let mut candidates = Vec::new();
    obstacles.each_near(from, range, |id, shape| {
        let distance = shape.distance(from);
        let rounding = Rounding::new(&shape, from);
        if distance <= range + rounding.distance {
            let (side, farthest) = (shape.side(from), shape.farthest(from));
            candidates.push(Candidate { id, shape, rounding, side, distance, farthest });
        }
    });
    candidates.sort_by(|a, b| {
        let by_distance = a.distance.total_cmp(&b.distance);
        by_distance.then(a.farthest.total_cmp(&b.farthest)).then(a.id.cmp(&b.id))
    });
    candidates
}
