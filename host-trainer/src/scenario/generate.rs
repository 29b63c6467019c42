//! Random worlds from a seed, made so that the car can get everywhere it could start.
//!
//! Obstacles are placed one by one, and one that would cut the free space in two is left out.
//! Coordinates are multiples of 5 cm, as a person would write them.

mod barn;
mod free_space;
mod rooms;
mod scatter;

use std::fmt;
use std::str::FromStr;

use super::words::listed;
use super::writer::to_toml_beside_paper;
use super::*;
use crate::failure::Failure;
use crate::seed::{Purpose, RunSeed};

/// What random world to make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recipe {
    /// What stands in it.
    pub kind: Kind,
    /// The same seed gives the same world.
    pub seed: RunSeed,
    /// Width and height, metres, each in [`Recipe::SIZE`] (at most [`Recipe::LONGEST_BARN`]
    /// for [`Kind::BarnLike`]).
    pub size: [f32; 2],
    /// Share of the room that is to be solid, in [`Kind::densities`]. Scattered obstacles stop
    /// earlier where no more fit; [`Kind::BarnLike`] smooths its field, which leaves less.
    pub density: f32,
}

/// What stands in a random world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Boxes with sides of 0.5 to 2 m.
    Boxes,
    /// Round pillars with radii of 0.1 to 0.5 m.
    Pillars,
    /// Rooms between thin walls with a door in each.
    Rooms,
    /// A field of thin cylinders between start and goal, grown by a cellular automaton like
    /// the worlds of the BARN benchmark.
    BarnLike,
    /// Thin straight walls of 1 to 4 m, many of which begin at a wall of the room.
    Partitions,
}

impl Kind {
    /// Every kind, in the order they are listed to people.
    pub const ALL: [Self; 5] =
        [Self::Boxes, Self::Pillars, Self::Rooms, Self::BarnLike, Self::Partitions];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Boxes => "boxes",
            Self::Pillars => "pillars",
            Self::Rooms => "rooms",
            Self::BarnLike => "barn-like",
            Self::Partitions => "partitions",
        }
    }

    /// The density that gives a world worth driving in.
    pub fn usual_density(self) -> f32 {
        match self {
            Self::Boxes => 0.12,
            Self::Pillars | Self::Rooms => 0.06,
            Self::BarnLike => 0.28,
            Self::Partitions => 0.08,
        }
    }

    /// The density at which a world of this many square metres has about 240 walls or discs: beyond,
    /// beams take several times as long. For fields of cylinders, with many more, what leaves a way.
    fn quick_density(self, area: f32) -> f32 {
        match self {
            // Of 1.5 m² and four walls each.
            Self::Boxes => 90.0 / area,
            // Of 0.33 m² each.
            Self::Pillars => 80.0 / area,
            // Eight walls for each room of (0.2 m / density)².
            Self::Rooms => (1.2 / area).sqrt(),
            // Nearly every denser field blocks the way.
            Self::BarnLike => 0.3,
            // Of 0.9 m² and four walls each.
            Self::Partitions => 50.0 / area,
        }
    }

    /// Lowest and highest density.
    pub fn densities(self) -> [f32; 2] {
        match self {
            Self::Boxes | Self::Pillars => [0.0, 0.4],
            Self::Partitions => [0.0, 0.3],
            Self::Rooms => [0.01, 0.08],
            Self::BarnLike => [0.1, 0.35],
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Kind {
    type Err = String;

    /// Reads a kind's name; the error lists the names.
    fn from_str(text: &str) -> Result<Self, String> {
        let kind = Self::ALL.into_iter().find(|kind| kind.name() == text);
        let names = || listed(Self::ALL.iter().map(|kind| kind.to_string()));
        kind.ok_or_else(|| format!("no kind `{}`, expected {}", text.escape_debug(), names()))
    }
}

/// Why no world was made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RecipeError {
    /// A side is out of range.
    Size {
        /// What was asked for, metres.
        found: f32,
        /// Longest side of this kind of world, metres.
        longest: f32,
    },
    /// The density is out of range.
    Density {
        /// What was asked for.
        found: f32,
        /// What its limits are for.
        kind: Kind,
    },
    /// Every field that was tried blocks the way.
    Blocked {
        /// How many were tried.
        tries: u32,
    },
}

impl fmt::Display for RecipeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { found, longest } => {
                let shortest = Recipe::SIZE[0];
                write!(f, "--size has {found}, expected sides from {shortest} m to {longest} m")
            }
            Self::Density { found, kind } => {
                let [low, high] = kind.densities();
                write!(f, "--density is {found}, expected a share from {low} to {high} for {kind}")
            }
            Self::Blocked { tries } => write!(
                f,
                "no way through any of {tries} fields was found, expected a lower --density"
            ),
        }
    }
}

impl std::error::Error for RecipeError {}

impl From<RecipeError> for Failure {
    fn from(error: RecipeError) -> Self {
        Self::bad_input(error.to_string())
    }
}

/// As options of `evosteer scenario generate`.
impl fmt::Display for Recipe {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, seed, size: [width, height], density } = self;
        write!(f, "--kind {kind} --seed {seed} --size {width}x{height} --density {density}")
    }
}

impl Recipe {
    /// Shortest and longest side, metres.
    pub const SIZE: [f32; 2] = [3.0, 50.0];

    /// Longest side of a world like BARN's, metres: it has 20 cylinders per square metre.
    pub const LONGEST_BARN: f32 = 20.0;

    /// A world of this kind with sides in this range, metres, as often up to twice the shortest as
    /// from there to four times that. Its density is from a quarter of the usual one to twice that,
    /// within what its kind can have, or less where beams would find its obstacles slowly.
    pub fn drawn(
        kind: Kind,
        [shortest, longest]: [f32; 2],
        random: &mut crate::seed::Stream,
    ) -> Self {
        let longest =
            if kind == Kind::BarnLike { longest.min(Self::LONGEST_BARN) } else { longest };
        let shortest = shortest.min(longest);
        let size = [(); 2].map(|()| {
            let side = shortest * libm::powf(longest / shortest, random.unit());
            round(side.clamp(shortest, longest))
        });
        let [low, high] = kind.densities();
        let usual = kind.usual_density();
        let low = low.max(usual * 0.25);
        let high = high.min(usual * 2.0).min(kind.quick_density(size[0] * size[1]));
        let density = random.within(low, high.max(low));
        // As short as somebody would type them, to see the world.
        let seed = random.index(1_000_000_000);
        let density = (density * 100.0).round() / 100.0;
        Self { kind, seed: RunSeed(seed as u64), size, density }
    }

    /// Makes the world.
    ///
    /// # Errors
    ///
    /// A size or density out of range, or a density that leaves no way.
    pub fn scenario(&self) -> Result<Scenario, RecipeError> {
        self.check()?;
        let [width, height] = self.size.map(round);
        let mut scenario = Preset::Paper.scenario();
        scenario.name = format!("{}-{}", self.kind, self.seed);
        scenario.world.bounds = Bounds { min: [0.0, 0.0], max: [width, height] };
        scenario.pairs.min_distance = 4_f32.min(round(0.5 * width.min(height)));
        // Twice the way around three sides of the room.
        let farthest = 2.0 * (width + height + width.max(height));
        scenario.episode.step_limit = ((farthest / 0.1) as u32).max(300);
        match self.kind {
            Kind::Boxes => scatter::boxes(&mut scenario, self),
            Kind::Pillars => scatter::pillars(&mut scenario, self),
            Kind::Rooms => rooms::build(&mut scenario, self),
            Kind::BarnLike => barn::grow(&mut scenario, self)?,
            Kind::Partitions => scatter::partitions(&mut scenario, self),
        }
        Ok(scenario)
    }

    /// Makes the world and writes it as a scenario file.
    ///
    /// # Errors
    ///
    /// Those of [`Recipe::scenario`].
    pub fn toml(&self) -> Result<String, RecipeError> {
        let scenario = self.scenario()?;
        Ok(format!("# Made by: evosteer scenario generate {self}\n\n")
            + &to_toml_beside_paper(&scenario))
    }

    fn check(&self) -> Result<(), RecipeError> {
        let longest = if self.kind == Kind::BarnLike { Self::LONGEST_BARN } else { Self::SIZE[1] };
        for found in self.size {
            if !(Self::SIZE[0]..=longest).contains(&found) {
                return Err(RecipeError::Size { found, longest });
            }
        }
        let [low, high] = self.kind.densities();
        if !(low..=high).contains(&self.density) {
            return Err(RecipeError::Density { found: self.density, kind: self.kind });
        }
        Ok(())
    }

    fn stream(&self, attempt: u32) -> crate::seed::Stream {
        self.seed.stream(Purpose::GeneratedWorld, 0, attempt)
    }
}

/// The nearest multiple of 5 cm.
fn round(length: f32) -> f32 {
    (length * 20.0).round() / 20.0
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::pairs::PairSampler;
    use crate::world::World;

    fn recipe(kind: Kind, seed: u64) -> Recipe {
        let size = [[10.0, 10.0], [4.0, 7.0], [20.0, 12.0]][seed as usize % 3];
        Recipe { kind, seed: RunSeed(seed), size, density: kind.usual_density() }
    }

    #[test]
    fn a_generated_file_loads_as_the_generated_scenario() {
        for kind in Kind::ALL {
            for seed in 0..12 {
                let recipe = recipe(kind, seed);
                let text = recipe.toml().unwrap();
                let source = Source::new("made.toml", text.clone(), Path::new(""));
                let loaded = load(&source, None, &[]).unwrap_or_else(|e| panic!("{e}\n{text}"));
                assert_eq!(loaded, recipe.scenario().unwrap());
            }
        }
    }

    /// The oracle is the simulator, whose test for a way shares no code with the generator.
    #[test]
    fn the_simulator_finds_a_way_between_any_start_and_goal_of_a_generated_world() {
        for kind in Kind::ALL {
            for seed in 0..12 {
                let scenario = recipe(kind, seed).scenario().unwrap();
                let world = World::new(&scenario).unwrap();
                assert_eq!(world.impossibilities(&scenario), [], "{}", scenario.name);
                let sampler = PairSampler::new(&world, &scenario);
                assert!(sampler.unseen(RunSeed(1), 20).is_ok(), "{}", scenario.name);
            }
        }
    }

    #[test]
    fn a_seed_makes_the_same_world_and_another_seed_another() {
        for kind in Kind::ALL {
            let worlds = [3, 3, 6].map(|seed| recipe(kind, seed).scenario().unwrap().world);
            assert_eq!(worlds[0], worlds[1]);
            assert_ne!(worlds[0], worlds[2]);
        }
    }

    #[test]
    fn the_solid_share_is_near_the_density_asked_for() {
        let cases = [
            (Kind::Boxes, 0.05),
            (Kind::Boxes, 0.15),
            (Kind::Pillars, 0.05),
            (Kind::Partitions, 0.08),
        ];
        for (kind, density) in cases {
            let recipe = Recipe { kind, seed: RunSeed(4), size: [20.0, 20.0], density };
            let world = recipe.scenario().unwrap().world;
            let boxes: f32 = world.boxes.iter().map(|[x0, y0, x1, y1]| (x1 - x0) * (y1 - y0)).sum();
            let discs: f32 = world
                .circles
                .iter()
                .map(|disc| std::f32::consts::PI * disc.radius * disc.radius)
                .sum();
            let share = (boxes + discs) / 400.0;
            assert!((share - density).abs() < 0.012, "{kind}: {share} instead of {density}");
        }
    }

    #[test]
    fn impossible_recipes_are_refused_with_the_option_and_the_range() {
        let usual = recipe(Kind::Boxes, 0);
        let texts = [
            Recipe { size: [2.0, 10.0], ..usual },
            Recipe { size: [10.0, f32::NAN], ..usual },
            Recipe { density: 0.5, ..usual },
            Recipe { kind: Kind::BarnLike, size: [30.0, 10.0], ..usual },
        ]
        .map(|recipe| recipe.scenario().unwrap_err().to_string());
        assert_eq!(
            texts,
            [
                "--size has 2, expected sides from 3 m to 50 m",
                "--size has NaN, expected sides from 3 m to 50 m",
                "--density is 0.5, expected a share from 0 to 0.4 for boxes",
                "--size has 30, expected sides from 3 m to 20 m",
            ]
        );
        assert_eq!(
            "box".parse::<Kind>().unwrap_err(),
            "no kind `box`, expected boxes, pillars, rooms, barn-like or partitions"
        );
    }

    /// What a seed means in every release.
    #[test]
    fn the_worlds_that_a_run_makes_for_itself_are_these() {
        let drawn = Kind::ALL.map(|kind| {
            let mut random = RunSeed(1).stream(Purpose::TrainingWorld, 0, kind as u32);
            Recipe::drawn(kind, [8.0, 30.0], &mut random).to_string()
        });
        insta::assert_snapshot!("drawn", drawn.join("\n"));
    }

    #[test]
    fn a_drawn_world_of_any_kind_and_size_can_be_made() {
        for index in 0..40 {
            for kind in Kind::ALL {
                let mut random = RunSeed(7).stream(Purpose::TrainingWorld, 0, index);
                let recipe = Recipe::drawn(kind, [5.0, 30.0], &mut random);
                recipe.scenario().unwrap_or_else(|error| panic!("{recipe}: {error}"));
            }
        }
    }

    #[test]
    fn a_generated_file_is_short_and_says_how_it_was_made() {
        let recipe = Recipe { density: 0.05, ..recipe(Kind::Boxes, 0) };
        insta::assert_snapshot!("boxes", recipe.toml().unwrap());
        let recipe = Recipe { seed: RunSeed(2), ..recipe };
        let rooms = Recipe { kind: Kind::Rooms, ..recipe };
        insta::assert_snapshot!("rooms", rooms.toml().unwrap());
        let partitions = Recipe { kind: Kind::Partitions, ..recipe };
        insta::assert_snapshot!("partitions", partitions.toml().unwrap());
    }
}
