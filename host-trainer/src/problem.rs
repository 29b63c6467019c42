//! What is to be solved: a scenario with its world and car built, ready to judge genomes.

use crate::brain::{self, Brain, NotBuiltIn};
use crate::car::{CarModel, body_of, scaling_of};
use crate::disturbances::Disturbances;
use crate::episode::{self, Outcome, Stage, Trace};
use crate::failure::Failure;
use crate::pairs::PairSampler;
use crate::scenario::{Pair, Scenario, StepLength, words_of};
use crate::seed::{Purpose, RunSeed, Stream};
use crate::world::free_space::FreeSpace;
use crate::world::{Cells, Lookout, World};
use controller_core::activation::ActivationKind;
use controller_core::blob::Header;
use controller_core::controller::Scaling;
use controller_core::network::Topology;
use controller_core::observation::{BEAMS, BeamMount, INPUTS};
use serde::Serialize;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// A scenario, built.
#[derive(Clone, Debug)]
pub struct Problem {
    /// What it was built from.
    pub scenario: Scenario,
    /// Its obstacles.
    pub world: Arc<World>,
    model: CarModel,
    lookout: Arc<Lookout>,
    /// Mapped once, by whichever clone needs it first.
    space: Arc<OnceLock<Arc<FreeSpace>>>,
    scaling: Scaling,
    topology: Topology,
    activation: ActivationKind,
}

impl Problem {
    /// Builds the scenario's world and car.
    ///
    /// # Errors
    ///
    /// A map that cannot be read.
    pub fn new(scenario: Scenario) -> Result<Self, Failure> {
        Self::seen_in(Cells::Fine, scenario)
    }

    /// The same for a world that is soon left: it is known sooner, and drives are a little slower.
    ///
    /// # Errors
    ///
    /// A map that cannot be read.
    pub fn for_a_while(scenario: Scenario) -> Result<Self, Failure> {
        Self::seen_in(Cells::Coarse, scenario)
    }

    fn seen_in(cells: Cells, scenario: Scenario) -> Result<Self, Failure> {
        let world = World::new(&scenario)?;
        let model = CarModel::new(&scenario);
        let largest = scenario.vehicle.padded(scenario.training.footprint_padding);
        Ok(Self {
            lookout: Arc::new(world.lookout_in(cells, model.range(), body_of(&largest))),
            space: Arc::default(),
            world: Arc::new(world),
            model,
            scaling: scaling_of(&scenario),
            topology: topology_of(&scenario),
            activation: scenario.network.activation,
            scenario,
        })
    }

    /// Makes the car imperfect in this way instead of its own. The world stays, and what is
    /// known of it.
    pub fn disturb(&mut self, disturbances: Disturbances) {
        disturbances.put_into(&mut self.scenario);
        self.model = CarModel::new(&self.scenario);
    }

    /// The same problem for a car that is imperfect in this way. It shares the world.
    #[must_use]
    pub fn disturbed(&self, disturbances: Disturbances) -> Self {
        let mut problem = self.clone();
        problem.disturb(disturbances);
        problem
    }

    /// The same problem for the car with a [larger body](crate::scenario::TrainingSpec) that training
    /// lets every other drive have. It shares the world, and what is known of it.
    #[must_use]
    pub fn padded(&self) -> Self {
        let mut problem = self.clone();
        let Scenario { vehicle, training, .. } = &mut problem.scenario;
        *vehicle = vehicle.padded(training.footprint_padding);
        problem.model = CarModel::new(&problem.scenario);
        problem.space = Arc::default();
        problem
    }

    /// The network that is searched for.
    pub fn topology(&self) -> Topology {
        self.topology
    }

    /// How the network's inputs and outputs relate to the car.
    pub fn scaling(&self) -> Scaling {
        self.scaling
    }

    /// Draws pairs. The free space is mapped at the first call.
    pub fn sampler(&self) -> PairSampler<'_> {
        let Self { world, scenario, .. } = self;
        let map = || Arc::new(PairSampler::space_of(world, scenario));
        PairSampler::within(world, scenario, Arc::clone(self.space.get_or_init(map)))
    }

    /// Everything about the car that does not change during a drive.
    pub(crate) fn model(&self) -> &CarModel {
        &self.model
    }

    /// The world as this car and its larger likes in training see and touch it.
    pub(crate) fn lookout(&self) -> &Lookout {
        &self.lookout
    }

    /// The network's tanh.
    pub(crate) fn activation(&self) -> ActivationKind {
        self.activation
    }

    /// The controller over a genome.
    ///
    /// # Errors
    ///
    /// A genome of another length.
    pub fn brain<'a>(&self, genome: &'a [f32]) -> Result<Box<dyn Brain + 'a>, NotBuiltIn> {
        brain::build(self.topology, self.activation, self.scaling, genome)
    }

    /// Drives every pair with one controller. Drive `i` gets the random numbers of `place(i)`.
    pub fn drive_all(
        &self,
        brain: &mut dyn Brain,
        pairs: &[Pair],
        place: impl Fn(u32) -> Stream,
    ) -> Vec<Outcome> {
        let stage = self.stage();
        let drive = |(index, pair): (u32, &Pair)| episode::drive(stage, pair, brain, place(index));
        (0..).zip(pairs).map(drive).collect()
    }

    /// Drives one pair and remembers every step.
    pub fn drive_traced(
        &self,
        brain: &mut dyn Brain,
        pair: &Pair,
        random: Stream,
    ) -> (Outcome, Trace) {
        episode::drive_traced(self.stage(), pair, brain, random)
    }

    fn stage(&self) -> Stage<'_> {
        let Self { world, lookout, model, scenario, .. } = self;
        Stage { world, lookout, model, spec: &scenario.episode }
    }

    /// Whether the same genome always costs the same: nothing about a drive is random, none is
    /// under stress, and every generation drives the same pairs in the same worlds.
    pub fn is_stationary(&self) -> bool {
        use crate::scenario::{PairSource, RandomiseSpec};
        let Scenario { sensors, episode, pairs, training, .. } = &self.scenario;
        let same_pairs = !matches!(pairs.source, PairSource::Drawn { resample: true, .. });
        let fixed_start = episode.start_offset == 0.0 && episode.start_turn == 0.0;
        let fixed_car = episode.randomise == RandomiseSpec::default();
        let exact = sensors.noise == 0.0 && sensors.dropout == 0.0;
        let same_worlds = training.worlds.is_none_or(|worlds| worlds.renew_every == 0);
        let same_drives = same_pairs && same_worlds && fixed_start && fixed_car;
        same_drives && exact && !training.has_stress()
    }
}

/// The random numbers of drive `index` in one generation, the same for every individual: all
/// meet the same noise and the same randomised cars, so that selection compares controllers,
/// not luck.
pub fn training_drive(seed: RunSeed, generation: u32, index: u32) -> Stream {
    seed.stream(Purpose::Episode, generation, index)
}

/// The random numbers of drive `index` of an evaluation.
pub fn evaluation_drive(seed: RunSeed, index: u32) -> Stream {
    seed.stream(Purpose::EvaluationDrive, 0, index)
}

/// The random numbers of drive `index` of those that choose the champion.
pub fn validation_drive(seed: RunSeed, index: u32) -> Stream {
    seed.stream(Purpose::ValidationDrive, 0, index)
}

/// The scenario's network.
pub fn topology_of(scenario: &Scenario) -> Topology {
    let outputs = match scenario.vehicle.step {
        StepLength::Constant(_) => 1,
        StepLength::Variable { .. } => 2,
    };
    Topology {
        inputs: INPUTS as u8,
        hidden: scenario.network.hidden,
        outputs,
        recurrence: scenario.network.recurrence,
        biases: scenario.network.biases,
    }
}

/// Something about a scenario's car that a champion replaces by its own.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Replaced {
    /// What it is, such as `beam range`.
    pub what: &'static str,
    /// The champion's value, with its unit: what it drives with.
    pub champion: String,
    /// The scenario's value, with its unit: it does not count.
    pub scenario: String,
}

impl fmt::Display for Replaced {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, champion, scenario } = self;
        write!(f, "{what} {champion}; the scenario's {scenario} does not count")
    }
}

/// Puts the car that a champion was trained with into a scenario: a controller knows its own
/// sensors and limits wherever it drives. Returns what changed.
pub fn adopt_car(scenario: &mut Scenario, header: &Header) -> Vec<Replaced> {
    let mut changes = Vec::new();
    let mut note = |what: &'static str, scenario: String, champion: String| {
        if scenario != champion {
            changes.push(Replaced { what, champion, scenario });
        }
    };
    let Scaling { encoding, range, steer_limit, step_lower, step_upper } = header.scaling;
    let step = if header.topology.outputs == 2 {
        StepLength::Variable { lower: step_lower, upper: step_upper }
    } else {
        StepLength::Constant(step_upper)
    };
    let (vehicle, sensors) = (&mut scenario.vehicle, &mut scenario.sensors);
    note("beam range", format!("{} m", sensors.range), format!("{range} m"));
    note("steer limit", degrees(vehicle.steer_limit), degrees(steer_limit));
    note("step", vehicle.step.to_string(), step.to_string());
    note("wheelbase", format!("{} m", vehicle.wheelbase), format!("{} m", header.wheelbase));
    note("period", format!("{} s", scenario.episode.period), format!("{} s", header.period));
    note("beam mounts", mounts(&sensors.beams), mounts(&header.beams));
    note("encoding", words_of(&sensors.encoding), words_of(&encoding));
    sensors.range = range;
    sensors.encoding = encoding;
    sensors.beams = header.beams;
    vehicle.steer_limit = steer_limit;
    vehicle.step = step;
    vehicle.wheelbase = header.wheelbase;
    scenario.episode.period = header.period;
    scenario.network.hidden = header.topology.hidden;
    scenario.network.recurrence = header.topology.recurrence;
    scenario.network.biases = header.topology.biases;
    scenario.network.activation = header.activation;
    changes
}

fn mounts(beams: &[BeamMount; BEAMS]) -> String {
    let mounts = beams.map(|BeamMount { x, y, angle }| format!("{x} {y} {}", degrees(angle)));
    mounts.join(", ")
}

fn degrees(radians: f32) -> String {
    format!("{:.1}°", f64::from(radians) * 180.0 / std::f64::consts::PI)
}
