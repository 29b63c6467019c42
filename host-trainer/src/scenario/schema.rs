//! Every setting of a scenario file: its key, what it may be, and where it is kept.
//!
//! One list serves the reader, the writer and the suggestions, so that they cannot disagree.

use super::number::{Number, OrInfinite, Whole};
use super::problem::Problem;
use super::shapes::{self, Area, List, Point, Pose, Unless};
use super::value::Found;
use super::words::{DISTANCE_LAW, Flag, Line, MUTATION, Name, SELECTION, Step, Text, Word};
use super::*;

/// How one value of a file stands for one value of a scenario.
pub(super) trait Codec<T> {
    /// The value meant; none after saying why the file's value means none.
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<T>;

    /// What to write in a file; none to leave the key out.
    fn write(&self, value: &T) -> Option<String>;

    /// What may stand there: goes on after "expected".
    fn expected(&self) -> String;
}

impl<T, C: Codec<T>> Codec<T> for &C {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<T> {
        (*self).read(found, problems)
    }

    fn write(&self, value: &T) -> Option<String> {
        (*self).write(value)
    }

    fn expected(&self) -> String {
        (*self).expected()
    }
}

/// Something that goes through the settings: reads, writes or lists them.
pub(super) trait Visit {
    /// One setting. `about` says what it is, for people.
    fn value<T>(&mut self, key: &'static str, slot: &mut T, codec: impl Codec<T>, about: &str);

    /// Settings under a common key.
    fn section(&mut self, key: &'static str, record: &mut impl Record);

    /// Settings under a common key that may all be absent; `blank` holds their defaults.
    fn optional_section<R: Record>(&mut self, key: &'static str, slot: &mut Option<R>, blank: R);
}

/// Settings that belong together.
pub(super) trait Record {
    /// Keys without a default: absent ones are an error.
    const REQUIRED: &'static [&'static str] = &[];

    /// Shows every setting to the visitor, in the order of the file.
    fn visit(&mut self, v: &mut impl Visit);
}

/// Longest side of a room, and farthest coordinate, metres: 32-bit coordinates still resolve
/// a millimetre there.
pub(super) const FARTHEST: f64 = 10_000.0;

/// Sizes of a body and its parts.
const SIZE: Number = Number::metres(0.001, 100.0);
/// A body's lengths that may vanish.
const SPAN: Number = Number::metres(0.0, 100.0);
/// Shares, probabilities and relative deviations.
const SHARE: Number = Number::share();
/// Weights of the cost.
const COST: Number = Number::plain(0.0, 1e9);
/// The longest drive, control periods: more than two hours at the default period.
const LONGEST_DRIVE: u32 = 100_000;

impl Record for Scenario {
    fn visit(&mut self, v: &mut impl Visit) {
        v.value("name", &mut self.name, Name, "the file's name if left out");
        v.value("description", &mut self.description, Line, "one line for people");
        v.section("world", &mut self.world);
        v.section("vehicle", &mut self.vehicle);
        v.section("sensors", &mut self.sensors);
        v.section("network", &mut self.network);
        v.section("episode", &mut self.episode);
        v.section("fitness", &mut self.fitness);
        v.section("pairs", &mut self.pairs);
        v.section("training", &mut self.training);
    }
}

impl Record for WorldSpec {
    fn visit(&mut self, v: &mut impl Visit) {
        let Bounds { min, max } = &mut self.bounds;
        v.value("min_m", min, Point, "lower left corner of the room");
        v.value("max_m", max, Point, "upper right corner of the room");
        v.value("outer_wall", &mut self.outer_wall, Flag, "whether the room's edge is a wall");
        let radius = Number::metres(0.001, 100.0);
        v.value("target_radius_m", &mut self.target_radius, radius, "the target is a disc");
        v.value("boxes", &mut self.boxes, List(Area), "solid boxes [x0, y0, x1, y1], metres");
        let polygons = List(shapes::Polygon);
        v.value("polygons", &mut self.polygons, polygons, "solid polygons [[x, y], ...], metres");
        v.value(
            "circles",
            &mut self.circles,
            List(shapes::Disc),
            "solid discs [x, y, radius], metres",
        );
        v.value("walls", &mut self.walls, List(shapes::Entry::<Wall>::new()), "walls along lines");
        let blank = MapSpec { yaml: Default::default(), unknown_is_obstacle: true, lethal: 100 };
        v.optional_section("map", &mut self.map, blank);
    }
}

impl Record for Wall {
    const REQUIRED: &'static [&'static str] = &["points"];

    fn visit(&mut self, v: &mut impl Visit) {
        v.value("points", &mut self.points, shapes::Polyline, "the middle of the wall");
        v.value("thickness_m", &mut self.thickness, SPAN, "0 is a sheet");
    }
}

impl Record for MapSpec {
    const REQUIRED: &'static [&'static str] = &["yaml"];

    fn visit(&mut self, v: &mut impl Visit) {
        v.value("yaml", &mut self.yaml, Text, "a map_server file, relative to this file");
        let unknown = &mut self.unknown_is_obstacle;
        v.value("unknown_is_obstacle", unknown, Flag, "whether unknown cells are solid");
        let percent = Whole { low: 1, high: 100 };
        v.value("lethal", &mut self.lethal, percent, "occupancy from which a cell is solid");
    }
}

impl Record for VehicleSpec {
    fn visit(&mut self, v: &mut impl Visit) {
        v.value("length_m", &mut self.length, SIZE, "body, bumper to bumper");
        v.value("width_m", &mut self.width, SIZE, "body");
        let overhang = &mut self.front_overhang;
        v.value("front_overhang_m", overhang, SPAN, "front axle to front bumper");
        v.value("wheelbase_m", &mut self.wheelbase, SIZE, "axle to axle");
        v.value(
            "step_m",
            &mut self.step,
            Step,
            "per control period; [lower, upper] lets the network choose",
        );
        let steer = Number::degrees(0.0, 90.0).above();
        v.value("steer_limit_deg", &mut self.steer_limit, steer, "to either side");
        let rate = OrInfinite(Number::degrees_per_second(0.0, 1e6).above());
        v.value("servo_rate_deg_per_s", &mut self.servo_rate, rate, "inf: the wheels turn at once");
        let delay = Whole { low: 0, high: Self::MAX_DELAY.into() };
        v.value("delay_periods", &mut self.delay_periods, delay, "from deciding to acting");
    }
}

impl Record for SensorSpec {
    fn visit(&mut self, v: &mut impl Visit) {
        v.value(
            "beams",
            &mut self.beams,
            shapes::Beams,
            "in the front axle's frame, rightmost first",
        );
        let range = Number::metres(0.01, 1000.0);
        v.value("range_m", &mut self.range, range, "longest distance a beam reports");
        let Encoding { distance, types } = &mut self.encoding;
        v.value("distance_law", distance, DISTANCE_LAW, "how distances become inputs");
        v.value("type_code", types, Word(words::TYPE_CODES), "how hits become two inputs");
        let noise = Number::metres(0.0, 1000.0);
        v.value("noise_m", &mut self.noise, noise, "standard deviation of a distance");
        v.value("dropout", &mut self.dropout, SHARE, "probability that a beam sees nothing");
    }
}

impl Record for BeamMount {
    const REQUIRED: &'static [&'static str] = &["angle_deg"];

    fn visit(&mut self, v: &mut impl Visit) {
        let offset = Number::metres(-100.0, 100.0);
        v.value("x_m", &mut self.x, offset, "ahead of the front axle");
        v.value("y_m", &mut self.y, offset, "left of the middle line");
        v.value("angle_deg", &mut self.angle, shapes::BEAM_ANGLE, "left of straight ahead");
    }
}

impl Record for NetworkSpec {
    fn visit(&mut self, v: &mut impl Visit) {
        v.value("hidden", &mut self.hidden, words::Hidden, "neurons in each of two hidden layers");
        let recurrences = Word(words::RECURRENCES);
        v.value("recurrence", &mut self.recurrence, recurrences, "what a hidden neuron remembers");
        v.value("biases", &mut self.biases, Flag, "whether neurons have biases");
        v.value("activation", &mut self.activation, Word(words::ACTIVATIONS), "which tanh");
    }
}

impl Record for EpisodeSpec {
    fn visit(&mut self, v: &mut impl Visit) {
        let steps = Whole { low: 1, high: LONGEST_DRIVE };
        v.value("step_limit", &mut self.step_limit, steps, "control periods");
        v.value("period_s", &mut self.period, Number::seconds(0.001, 10.0), "control period");
        let collisions = Word(words::COLLISIONS);
        v.value("on_collision", &mut self.on_collision, collisions, "what a collision does");
        let touches = Word(words::TOUCHES);
        v.value("reached_by", &mut self.reached_by, touches, "what must touch the target");
        let offset = &mut self.start_offset;
        v.value("start_offset_m", offset, SPAN, "largest random shift of a start");
        let turn = Number::degrees(0.0, 180.0);
        v.value("start_turn_deg", &mut self.start_turn, turn, "largest random turn of a start");
        v.section("randomise", &mut self.randomise);
    }
}

impl Record for RandomiseSpec {
    fn visit(&mut self, v: &mut impl Visit) {
        let deviation = Number::plain(0.0, 0.99);
        v.value("wheelbase", &mut self.wheelbase, deviation, "largest relative deviation");
        v.value("step", &mut self.step, deviation, "largest relative deviation");
        let angle = Number::degrees(0.0, 90.0);
        v.value("steer_offset_deg", &mut self.steer_offset, angle, "largest steering error");
    }
}

impl Record for FitnessSpec {
    fn visit(&mut self, v: &mut impl Visit) {
        let kinds = Word(words::FITNESS_KINDS);
        v.value("kind", &mut self.kind, kinds, "which cost, with the weights that it has");
        v.value("distance", &mut self.distance, COST, "c1, per metre to the target at the end");
        v.value("length", &mut self.length, COST, "c2, per metre driven");
        v.value("collision", &mut self.collision, COST, "c3, per collision");
        v.value("bonus", &mut self.bonus, COST, "B, taken off when the target is reached");
        let half = Number::plain(0.0, 0.5);
        v.value("time", &mut self.time, half, "reached-first: for all of the step limit");
        v.value("progress", &mut self.progress, half, "reached-first: for all of the way");
    }
}

impl Record for PairSpec {
    fn visit(&mut self, v: &mut impl Visit) {
        let (mut count, mut resample, mut list) = match &mut self.source {
            PairSource::Drawn { count, resample } => (Some(*count), Some(*resample), Vec::new()),
            PairSource::Listed(list) => (None, None, std::mem::take(list)),
        };
        let counts = shapes::Maybe(Whole { low: 1, high: 100_000 });
        v.value("count", &mut count, counts, "pairs drawn from the run's seed");
        v.value("resample", &mut resample, shapes::Maybe(Flag), "draw new ones each generation");
        let lengths = Number::metres(0.0, FARTHEST);
        v.value("min_distance_m", &mut self.min_distance, lengths, "start to goal of a drawn pair");
        v.value(
            "list",
            &mut list,
            List(shapes::Entry::<Pair>::new()),
            "pairs instead of drawn ones",
        );
        let ends = shapes::Maybe(Whole { low: 1, high: 100_000 });
        v.value("count_end", &mut self.count_end, ends, "pairs in the last generation");
        let mut mine = count.map(|_| self.mine);
        let shares = shapes::Maybe(Number::plain(0.0, 0.9));
        v.value("mine", &mut mine, shares, "share kept for the next generation, hardest first");
        self.mine = mine.unwrap_or(0.0);
        if !list.is_empty() {
            (self.count_end, self.mine) = (None, 0.0);
        }
        self.source = if list.is_empty() {
            PairSource::Drawn {
                count: count.unwrap_or(Self::DRAWN),
                resample: resample.unwrap_or(false),
            }
        } else {
            PairSource::Listed(list)
        };
    }
}

impl Record for Pair {
    const REQUIRED: &'static [&'static str] = &["start", "goal"];

    fn visit(&mut self, v: &mut impl Visit) {
        v.value("start", &mut self.start, Pose, "[x, y, heading], metres and degrees");
        v.value("goal", &mut self.goal, Point, "[x, y], metres");
    }
}

impl Record for TrainingSpec {
    fn visit(&mut self, v: &mut impl Visit) {
        let population = Whole::within(Self::POPULATION);
        v.value("population", &mut self.population, population, "individuals");
        let islands = Unless(1, Whole::within(Self::ISLANDS));
        let about = "populations side by side, of which one is left in the end; one if left out";
        v.value("islands", &mut self.islands, islands, about);
        let generations = Whole::within(Self::GENERATIONS);
        v.value("generations", &mut self.generations, generations, "");
        let bound = Number::plain(0.0, 1000.0).above();
        v.value("weight_bound", &mut self.weight_bound, bound, "weights stay within ± this");
        let pairs = Whole { low: 0, high: 100_000 };
        let validation = &mut self.validation_pairs;
        v.value("validation_pairs", validation, pairs, "choose the champion; 0: the last best");
        let share = &mut self.stressed_share;
        let about = "drives under stress in the last generation; none if left out";
        v.value("stressed_share", share, Unless(0.0, SHARE), about);
        let share = &mut self.stressed_share_start;
        let about = "drives under stress in the first generation; none if left out";
        v.value("stressed_share_start", share, Unless(0.0, SHARE), about);
        let about = "of drives under stress, half lack dead time or slow servo; off if left out";
        v.value("stress_in_turns", &mut self.stress_in_turns, Unless(false, Flag), about);
        let metres = Unless(0.0, Number::metres(0.0, 1.0));
        let about = "how much larger every other car is, on every side; no larger if left out";
        v.value("footprint_padding_m", &mut self.footprint_padding, metres, about);
        let until_reached = &mut self.until_reached;
        let about = "end when somebody reaches all targets; off if left out";
        v.value("until_reached", until_reached, Unless(false, Flag), about);
        v.optional_section("worlds", &mut self.worlds, WorldsSpec::NONE);
        v.section("ga", &mut self.ga);
        v.optional_section("novelty", &mut self.novelty, NoveltySpec::USUAL);
    }
}

impl Record for WorldsSpec {
    fn visit(&mut self, v: &mut impl Visit) {
        let count = Whole { low: 0, high: Self::MOST };
        v.value("boxes", &mut self.boxes, count, "worlds with scattered boxes");
        v.value("pillars", &mut self.pillars, count, "worlds with round pillars");
        v.value("rooms", &mut self.rooms, count, "worlds with rooms and doors");
        v.value("barn_like", &mut self.barn_like, count, "fields of cylinders, like BARN's");
        let about = "worlds with thin walls that make dead ends; none if left out";
        v.value("partitions", &mut self.partitions, Unless(0, count), about);
        v.value("side_m", &mut self.side, shapes::Sides, "[shortest, longest] side of a world");
        let generations = Unless(0, Whole { low: 0, high: *TrainingSpec::GENERATIONS.end() });
        let about = "generations after which one is replaced; none is if left out";
        v.value("renew_every", &mut self.renew_every, generations, about);
        let times = Unless(0, Whole { low: 0, high: Self::MOST });
        let about = "times as many others choose among the last generation; none if left out";
        v.value("held_out", &mut self.held_out, times, about);
    }
}

impl Record for GaSpec {
    fn visit(&mut self, v: &mut impl Visit) {
        v.value("crossover_share", &mut self.crossover_share, SHARE, "P1, crossed over");
        v.value("mutation_share", &mut self.mutation_share, SHARE, "P2, mutated");
        v.value("ranking_share", &mut self.ranking_share, SHARE, "P3, the best, copied");
        v.value("random_share", &mut self.random_share, SHARE, "P4, copied at random");
        v.value("selection", &mut self.selection, SELECTION, "of P1 and P2");
        v.value(
            "mutation_rate",
            &mut self.mutation_rate,
            SHARE,
            "toolbox rate: half of it changes on average",
        );
        v.value("mutation", &mut self.mutation, MUTATION, "what a changed gene becomes");
        let sigma = shapes::Maybe(Number::plain(0.0, 2000.0).above());
        v.value("sigma_end", &mut self.sigma_end, sigma, "sigma in the last generation");
        v.value("initial", &mut self.initial, words::INITIAL, "how the first genes are drawn");
        v.value("fan_in", &mut self.fan_in, Flag, "sigmas are for 3 inputs; more, smaller steps");
    }
}

impl Record for NoveltySpec {
    fn visit(&mut self, v: &mut impl Visit) {
        let most = *TrainingSpec::POPULATION.end();
        let neighbours = Whole { low: 1, high: most };
        v.value("neighbours", &mut self.neighbours, neighbours, "k, the nearest that count");
        let growth = Whole { low: 0, high: most };
        v.value("archive_growth", &mut self.archive_growth, growth, "kept of each generation");
    }
}
