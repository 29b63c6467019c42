//! Lists of obstacles for some parts of a turn, in one piece of memory.

/// For some of up to 128 parts of a turn, a list of places in the world and a distance.
#[derive(Debug)]
pub(super) struct Kept {
    /// Which parts have one, as bits.
    which: u128,
    /// Of each list, in order: where it ends among the places, and its distance.
    ends: Box<[(u32, f32)]>,
    places: Box<[u32]>,
}

/// Lists being written.
pub(super) struct Builder {
    which: u128,
    ends: Vec<(u32, f32)>,
    places: Vec<u32>,
}

impl Kept {
    pub(super) fn builder() -> Builder {
        Builder { which: 0, ends: Vec::new(), places: Vec::new() }
    }

    /// The list of this part and its distance, if it has any.
    pub(super) fn of(&self, part: u32) -> Option<(&[u32], f32)> {
        if self.which >> part & 1 == 0 {
            return None;
        }
        let before = (self.which & ((1 << part) - 1)).count_ones() as usize;
        let first = before.checked_sub(1).map_or(0, |previous| self.ends[previous].0);
        let (end, distance) = self.ends[before];
        Some((&self.places[first as usize..end as usize], distance))
    }

    /// Memory it takes beyond itself, bytes.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(&*self.ends) + size_of_val(&*self.places)
    }
}

impl Builder {
    /// Keeps a list; parts come in ascending order.
    pub(super) fn keep(&mut self, part: u32, places: &[u32], distance: f32) {
        debug_assert!(self.which >> part == 0, "part {part} comes after a later one");
        self.which |= 1 << part;
        self.places.extend(places);
        self.ends.push((self.places.len() as u32, distance));
    }

    pub(super) fn done(self) -> Kept {
        let Self { which, ends, places } = self;
        Kept { which, ends: ends.into(), places: places.into() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_part_has_the_list_that_was_kept_for_it() {
        let mut lists = Kept::builder();
        lists.keep(0, &[5, 6], 1.0);
        lists.keep(7, &[], 2.0);
        lists.keep(127, &[9], 3.0);
        let kept = lists.done();
        assert_eq!(kept.of(0), Some((&[5, 6][..], 1.0)));
        assert_eq!(kept.of(7), Some((&[][..], 2.0)));
        assert_eq!(kept.of(127), Some((&[9][..], 3.0)));
        assert_eq!(kept.of(1), None);
        assert_eq!(kept.of(126), None);
    }
}
