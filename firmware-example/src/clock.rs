//! Time since boot, and who keeps it.

/// A moment, in microseconds since boot; never runs backwards.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Micros(pub u64);

impl Micros {
    /// Microseconds from `earlier` to here; 0 if that has not passed yet.
    pub fn since(self, earlier: Self) -> u64 {
        self.0.saturating_sub(earlier.0)
    }

    /// The moment this many microseconds later.
    pub fn after(self, microseconds: u64) -> Self {
        Self(self.0.saturating_add(microseconds))
    }
}

/// A clock that only runs forwards.
pub trait Clock {
    /// The present moment.
    fn now(&mut self) -> Micros;

    /// Sleeps until `due`, or not at all if that has passed, and returns the present moment.
    fn wait_until(&mut self, due: Micros) -> Micros;
}

/// The timer that resets the board unless it is fed.
pub trait Watchdog {
    /// Starts it: the board is reset this many microseconds after the last feed.
    fn start(&mut self, timeout: u64);

    /// Puts the reset off by the whole timeout.
    fn feed(&mut self);
}
