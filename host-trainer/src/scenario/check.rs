//! What must hold between settings, beyond the range of each: no simulator needed.

use super::problem::Complaint;
use super::schema::FARTHEST;
use super::*;

/// Everything that does not fit together.
pub(super) fn complaints(scenario: &Scenario) -> Vec<Complaint> {
    let mut found = Vec::new();
    room(scenario, &mut found);
    // Whether things lie in the room says nothing if the room makes no sense.
    if found.is_empty() {
        obstacles(&scenario.world, &mut found);
        pairs(scenario, &mut found);
    }
    vehicle(scenario, &mut found);
    sensors(scenario, &mut found);
    if let Err(error) = scenario.training.ga.check() {
        found.push(search(&error));
    }
    other_cars(scenario, &mut found);
    novelty(scenario, &mut found);
    worlds(scenario, &mut found);
    found
}

impl Bounds {
    /// Width and height, metres.
    pub fn size(&self) -> [f32; 2] {
        [self.max[0] - self.min[0], self.max[1] - self.min[1]]
    }

    /// Whether a point lies inside or on the edge.
    pub fn contains(&self, [x, y]: [f32; 2]) -> bool {
        (self.min[0]..=self.max[0]).contains(&x) && (self.min[1]..=self.max[1]).contains(&y)
    }

    /// Whether there is a point in common with a rectangle, edges included.
    pub(super) fn overlaps(&self, min: [f32; 2], max: [f32; 2]) -> bool {
        (0..2).all(|axis| min[axis] <= self.max[axis] && max[axis] >= self.min[axis])
    }
}

fn room(scenario: &Scenario, found: &mut Vec<Complaint>) {
    let Bounds { min, max } = scenario.world.bounds;
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        let (low, high) = (min[axis], max[axis]);
        let size = high - low;
        if !(0.1..=FARTHEST as f32).contains(&size) {
            let detail = format!(
                "found {name} from {low} m to {high} m, expected a size from 0.1 m to {FARTHEST} m"
            );
            let title = "the room has no possible size";
            found.push(Complaint::new("world.max_m", title, detail).or_at("world.min_m"));
        }
    }
    let [width, height] = scenario.world.bounds.size();
    let radius = scenario.world.target_radius;
    if found.is_empty() && 2.0 * radius > width.min(height) {
        let detail = format!(
            "found a radius of {radius} m in a room of {width} m × {height} m, expected a target that fits"
        );
        let title = "the target is larger than the room";
        found.push(Complaint::new("world.target_radius_m", title, detail).or_at("world.max_m"));
    }
}

fn obstacles(world: &WorldSpec, found: &mut Vec<Complaint>) {
    let Bounds { min, max } = world.bounds;
    let mut must_overlap = |key: String, low: [f32; 2], high: [f32; 2]| {
        if !world.bounds.overlaps(low, high) {
            let title = format!("`{key}` lies outside the room");
            let detail = format!(
                "found x from {} m to {} m and y from {} m to {} m, expected a part of it within x {} m to {} m and y {} m to {} m",
                low[0], high[0], low[1], high[1], min[0], max[0], min[1], max[1]
            );
            let help =
                "move the obstacle, or enlarge the room with `world.min_m` and `world.max_m`";
            found.push(Complaint::new(key, title, detail).help(help));
        }
    };
    for (index, [x0, y0, x1, y1]) in world.boxes.iter().copied().enumerate() {
        must_overlap(format!("world.boxes[{index}]"), [x0, y0], [x1, y1]);
    }
    for (index, corners) in world.polygons.iter().enumerate() {
        let (low, high) = extent(corners, 0.0);
        must_overlap(format!("world.polygons[{index}]"), low, high);
    }
    for (index, circle) in world.circles.iter().enumerate() {
        let (low, high) = extent(&[circle.centre], circle.radius);
        must_overlap(format!("world.circles[{index}]"), low, high);
    }
    for (index, wall) in world.walls.iter().enumerate() {
        let (low, high) = extent(&wall.points, wall.thickness / 2.0);
        must_overlap(format!("world.walls[{index}]"), low, high);
    }
    let corners: usize = world.polygons.iter().map(Vec::len).sum::<usize>()
        + world.walls.iter().map(|wall| wall.points.len()).sum::<usize>();
    if corners > shapes::MOST_ITEMS {
        let detail = format!("found {corners}, expected at most {}", shapes::MOST_ITEMS);
        let title = "polygons and walls have too many corners together";
        found.push(Complaint::new("world.polygons", title, detail).or_at("world.walls"));
    }
}

/// The smallest rectangle around discs of one radius.
fn extent(points: &[[f32; 2]], radius: f32) -> ([f32; 2], [f32; 2]) {
    let mut low = [f32::INFINITY; 2];
    let mut high = [f32::NEG_INFINITY; 2];
    for point in points {
        for axis in 0..2 {
            low[axis] = low[axis].min(point[axis] - radius);
            high[axis] = high[axis].max(point[axis] + radius);
        }
    }
    (low, high)
}

fn vehicle(scenario: &Scenario, found: &mut Vec<Complaint>) {
    let VehicleSpec { length, width, front_overhang, wheelbase, step, .. } = scenario.vehicle;
    if front_overhang > length {
        let detail = format!(
            "found {front_overhang} m with a body of {length} m, expected the front axle under the body"
        );
        let title = "the front overhang is longer than the body";
        let complaint = Complaint::new("vehicle.front_overhang_m", title, detail);
        found.push(complaint.or_at("vehicle.length_m"));
    } else if front_overhang + wheelbase > length * (1.0 + f32::EPSILON * 4.0) {
        let detail = format!(
            "found {front_overhang} m front overhang and {wheelbase} m wheelbase with a body of {length} m, expected both wheels under the body"
        );
        let title = "the rear axle lies behind the body";
        let complaint = Complaint::new("vehicle.wheelbase_m", title, detail)
            .or_at("vehicle.length_m")
            .or_at("vehicle.front_overhang_m")
            .help("all three are metres; the length is from bumper to bumper");
        found.push(complaint);
    }
    let (StepLength::Constant(step) | StepLength::Variable { upper: step, .. }) = step;
    let longest = step * (1.0 + scenario.episode.randomise.step);
    let smaller = length.min(width);
    if longest > smaller {
        let detail = format!(
            "found up to {longest} m per step, expected at most {smaller} m, the body's smaller side"
        );
        let complaint =
            Complaint::new("vehicle.step_m", "the car could jump through a wall", detail)
                .or_at("episode.randomise.step")
                .or_at("vehicle.width_m")
                .or_at("vehicle.length_m")
                .help("shorten the step (and the period), or describe a larger body");
        found.push(complaint);
    }
    // Up to about a quarter turn, the body after a step overlaps the body before it, so that no
    // wall fits between them. (Headings are wrapped once per step: half a turn at most.)
    let shortest = wheelbase * (1.0 - scenario.episode.randomise.wheelbase);
    if longest > shortest * 1.5 {
        let detail = format!(
            "found {shortest} m with steps of up to {longest} m, expected at least two thirds of the step"
        );
        let title = "the car could turn more than a quarter turn in one step";
        let complaint = Complaint::new("vehicle.wheelbase_m", title, detail);
        found.push(complaint.or_at("episode.randomise.wheelbase").or_at("vehicle.step_m"));
    }
}

fn sensors(scenario: &Scenario, found: &mut Vec<Complaint>) {
    let SensorSpec { range, noise, .. } = scenario.sensors;
    if noise > range {
        let detail = format!("found {noise} m, expected at most the range, {range} m");
        let title = "the noise is larger than the beams' range";
        found.push(Complaint::new("sensors.noise_m", title, detail).or_at("sensors.range_m"));
    }
}

fn pairs(scenario: &Scenario, found: &mut Vec<Complaint>) {
    let bounds = &scenario.world.bounds;
    match &scenario.pairs.source {
        PairSource::Drawn { .. } => {
            let radius = scenario.world.target_radius;
            let [width, height] = bounds.size();
            let (width, height) =
                (width.max(2.0 * radius) - radius, height.max(2.0 * radius) - radius);
            let longest = (width * width + height * height).sqrt();
            let distance = scenario.pairs.min_distance;
            if distance > longest {
                let detail = format!(
                    "found {distance} m, expected less than {longest:.1} m, the farthest that a start and a target fit into the room"
                );
                let title = "no start and goal can be so far apart";
                let complaint = Complaint::new("pairs.min_distance_m", title, detail);
                found.push(complaint.or_at("world.max_m").or_at("world.min_m"));
            }
            changing(&scenario.pairs, found);
        }
        PairSource::Listed(list) => {
            for (index, pair) in list.iter().enumerate() {
                pair_in_room(scenario, index, pair, found);
            }
        }
    }
}

/// What changes from generation to generation needs pairs that do.
fn changing(pairs: &PairSpec, found: &mut Vec<Complaint>) {
    if matches!(pairs.source, PairSource::Drawn { resample: true, .. }) {
        return;
    }
    let (grows, mines) = (pairs.count_end.is_some(), pairs.mine > 0.0);
    for (asked, key) in [(grows, "pairs.count_end"), (mines, "pairs.mine")] {
        if asked {
            let title = format!("`{key}` needs new pairs in each generation");
            let detail = "found pairs that stay the same, expected pairs.resample = true";
            found.push(Complaint::new(key, title, detail));
        }
    }
}

fn pair_in_room(scenario: &Scenario, index: usize, pair: &Pair, found: &mut Vec<Complaint>) {
    let Bounds { min, max } = scenario.world.bounds;
    let [x, y, heading] = pair.start;
    for (name, point) in [("start", [x, y]), ("goal", pair.goal)] {
        if !scenario.world.bounds.contains(point) {
            let key = format!("pairs.list[{index}].{name}");
            let title = format!("`{key}` lies outside the room");
            let detail = format!(
                "found ({}, {}), expected x from {} m to {} m and y from {} m to {} m",
                point[0], point[1], min[0], max[0], min[1], max[1]
            );
            found.push(Complaint::new(key, title, detail));
            return;
        }
    }
    let (sin, cos) = (libm::sinf(heading), libm::cosf(heading));
    let offset = [pair.goal[0] - x, pair.goal[1] - y];
    let ahead = offset[0] * cos + offset[1] * sin;
    let left = offset[1] * cos - offset[0] * sin;
    let distance = match scenario.episode.reached_by {
        ReachedBy::ReferencePoint => libm::hypotf(ahead, left),
        ReachedBy::Body => {
            let VehicleSpec { length, width, front_overhang, .. } = scenario.vehicle;
            let beyond_front = (ahead - front_overhang).max(front_overhang - length - ahead);
            let beyond_side = left.abs() - width / 2.0;
            libm::hypotf(beyond_front.max(0.0), beyond_side.max(0.0))
        }
    };
    let radius = scenario.world.target_radius;
    if distance <= radius {
        let key = format!("pairs.list[{index}].goal");
        let detail = format!(
            "found {distance:.2} m between car and goal, expected more than the target's radius, {radius} m"
        );
        found.push(Complaint::new(key, "the target is reached before the car moves", detail));
    }
}

/// A run ends with its targets reached only if it is the car as described that drives, first and
/// last.
fn other_cars(scenario: &Scenario, found: &mut Vec<Complaint>) {
    let TrainingSpec { stressed_share, stressed_share_start, footprint_padding, .. } =
        scenario.training;
    let under_stress = "of them under stress, expected none";
    let ways = [
        (stressed_share, "training.stressed_share", under_stress),
        (stressed_share_start, "training.stressed_share_start", under_stress),
        (footprint_padding, "training.footprint_padding_m", "m of padding, expected none"),
    ];
    for (value, key, what) in ways {
        if value > 0.0 && scenario.training.until_reached {
            let title = "`training.until_reached` needs drives with the car as it is described";
            let detail = format!("found {value} {what}");
            found.push(Complaint::new(key, title, detail).or_at("training.until_reached"));
        }
    }
}

/// Where drives end says how alike they were only if they had the same tasks.
fn novelty(scenario: &Scenario, found: &mut Vec<Complaint>) {
    let TrainingSpec { population, islands, novelty, until_reached, .. } = scenario.training;
    let changing = matches!(scenario.pairs.source, PairSource::Drawn { resample: true, .. });
    for (asked, key) in
        [(novelty.is_some(), "training.novelty"), (until_reached, "training.until_reached")]
    {
        if asked && changing {
            let title = format!("`{key}` needs the same pairs in each generation");
            let detail = "found new pairs each time, expected pairs.resample = false";
            found.push(Complaint::new("pairs.resample", title, detail).or_at(key));
        }
    }
    if novelty.is_some() && islands > 1 {
        let title = "a search by novelty has one population";
        let detail = format!("found {islands} islands, expected 1");
        found.push(Complaint::new("training.islands", title, detail).or_at("training.novelty"));
    }
    if let Some(Err(error)) = novelty.map(|novelty| novelty.check(population)) {
        let (value, expected) = (error.found, error.expected);
        let detail = format!("found {value} for {population} individuals, expected {expected}");
        let key = format!("training.novelty.{}", error.setting);
        let title = "the settings of the novelty search do not fit together";
        found.push(Complaint::new(key, title, detail).or_at("training.population"));
    }
}

/// Each world has its pairs in each generation, and they stay in it.
fn worlds(scenario: &Scenario, found: &mut Vec<Complaint>) {
    let Some(worlds) = scenario.training.worlds else { return };
    let total = worlds.total();
    if total == 0 {
        let title = "there is no world to train in";
        let detail = "found 0 of each kind, expected 1 or more of some kind";
        found.push(Complaint::new("training.worlds.boxes", title, detail).or_at("training.worlds"));
    }
    let all = total.saturating_mul(worlds.held_out.saturating_add(1));
    if all > WorldsSpec::MOST {
        let title = "there are too many worlds to train in and to choose the champion in";
        let detail = format!("found {all}, expected at most {}", WorldsSpec::MOST);
        found.push(Complaint::new("training.worlds", title, detail));
    }
    let title = "`training.worlds` draws pairs in each world";
    let (validation, choosing) = (scenario.training.validation_pairs, worlds.choosing());
    if validation > 0 && worlds.renew_every > 0 && worlds.held_out == 0 {
        let title = "worlds that make way for new ones cannot choose the champion";
        let detail = format!(
            "found a new world every {} generations, expected 1 or more for `held_out`, or 0 for \
             `training.validation_pairs`",
            worlds.renew_every
        );
        let complaint = Complaint::new("training.worlds.renew_every", title, detail);
        found.push(complaint.or_at("training.validation_pairs"));
    }
    if validation == 0 && worlds.held_out > 0 {
        let title = "no pairs would lie in the worlds that are to choose the champion";
        let detail = format!("found 0 pairs for {choosing} worlds, expected {choosing} or more");
        let complaint = Complaint::new("training.validation_pairs", title, detail);
        found.push(complaint.or_at("training.worlds.held_out"));
    }
    if validation > 0 && validation < choosing {
        let detail = format!(
            "found {validation} pairs for {choosing} worlds, expected 0 or {choosing} or more"
        );
        let complaint = Complaint::new("training.validation_pairs", title, detail);
        found.push(complaint.or_at("training.worlds"));
    }
    match scenario.pairs.source {
        PairSource::Listed(_) => {
            let detail = "found pairs listed for the scenario's own world, expected drawn ones";
            found.push(Complaint::new("pairs.list", title, detail).or_at("training.worlds"));
        }
        PairSource::Drawn { count, .. } => {
            for (key, count) in [("count", Some(count)), ("count_end", scenario.pairs.count_end)] {
                if let Some(count) = count.filter(|count| *count < total) {
                    let detail =
                        format!("found {count} pairs for {total} worlds, expected {total} or more");
                    let complaint = Complaint::new(format!("pairs.{key}"), title, detail);
                    found.push(complaint.or_at("training.worlds"));
                }
            }
        }
    }
    let mine = scenario.pairs.mine;
    if mine > 0.0 {
        let title = "pairs that are kept would lie in another world";
        let detail = format!("found a share of {mine}, expected 0 with `training.worlds`");
        found.push(Complaint::new("pairs.mine", title, detail).or_at("training.worlds"));
    }
}

/// A refused setting of the search; each number alone was in its range already.
fn search(error: &crate::evolve::ga::SettingError) -> Complaint {
    // Sums of shares end in digits that nobody wrote.
    let found = (error.found * 1e4).round() / 1e4;
    let detail = format!("found {found}, expected {}", error.expected);
    let title = "the settings of the genetic algorithm do not fit together";
    match error.setting {
        "shares" => {
            ["crossover_share", "mutation_share", "ranking_share", "random_share"].into_iter().fold(
                Complaint { keys: Vec::new(), title: title.to_owned(), detail, help: None },
                |complaint, key| complaint.or_at(format!("training.ga.{key}")),
            )
        }
        setting => Complaint::new(format!("training.ga.{setting}"), title, detail),
    }
}
