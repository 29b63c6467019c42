//! The simulator against oracles from elsewhere: parry2d, exact circles, hand-made worlds.

mod barn;
mod beams;
mod contacts;
mod corners;
mod drivable;
mod driving;
mod episodes;
mod fingerprint;
mod lookout;
mod pairs;
mod parry;
mod training;
mod worlds;
