//! Mazes with the rules they are driven by, and what the literature says of them.

use super::method::MazeMethod;
use crate::scenario::OnCollision;
use serde::{Deserialize, Serialize};

/// A maze and what happens where the car touches a wall of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Course {
    /// The medium maze of Lehman and Stanley; a wall holds the car, as it holds their robot.
    MediumMaze,
    /// The same maze; the drive ends at a wall.
    MediumMazeClean,
    /// A longer maze of our own; a wall holds the car.
    SwitchbackMaze,
    /// That maze; the drive ends at a wall.
    SwitchbackMazeClean,
}

/// What a publication says of one method in one maze.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Published {
    /// What was told to the search.
    pub method: MazeMethod,
    /// Runs in which the goal was reached.
    pub solved: u32,
    /// All runs.
    pub runs: u32,
    /// Evaluations of the runs that reached it, on average.
    pub mean: f64,
    /// Their standard deviation, where it is given.
    pub deviation: Option<f64>,
}

/// Where [`Course::published`] is from.
pub const SOURCE: &str = "J. Lehman and K. O. Stanley, Abandoning Objectives: Evolution Through the \
    Search for Novelty Alone, Evolutionary Computation 19(2), 2011";

impl Course {
    /// Every course, the literature's own first.
    pub const ALL: [Self; 4] =
        [Self::MediumMaze, Self::MediumMazeClean, Self::SwitchbackMaze, Self::SwitchbackMazeClean];

    /// Its name, also in the names of files.
    pub fn name(self) -> &'static str {
        match self {
            Self::MediumMaze => "medium-maze",
            Self::MediumMazeClean => "medium-maze-clean",
            Self::SwitchbackMaze => "switchback-maze",
            Self::SwitchbackMazeClean => "switchback-maze-clean",
        }
    }

    /// The shipped scenario with its walls, its start and its goal.
    pub fn scenario(self) -> &'static str {
        match self {
            Self::MediumMaze | Self::MediumMazeClean => "medium_maze",
            Self::SwitchbackMaze | Self::SwitchbackMazeClean => "switchback_maze",
        }
    }

    /// What a wall does to the car.
    pub fn on_collision(self) -> OnCollision {
        match self {
            Self::MediumMaze | Self::SwitchbackMaze => OnCollision::Hold,
            Self::MediumMazeClean | Self::SwitchbackMazeClean => OnCollision::Stop,
        }
    }

    /// The same in words.
    pub fn rule(self) -> &'static str {
        match self.on_collision() {
            OnCollision::Hold => "a wall holds the car",
            OnCollision::Stop => "the drive ends at a wall",
        }
    }

    /// What [`SOURCE`] says of this maze under this rule: its robot, network and search are others.
    pub fn published(self) -> &'static [Published] {
        match self {
            Self::MediumMaze => &MEDIUM,
            Self::MediumMazeClean | Self::SwitchbackMaze | Self::SwitchbackMazeClean => &[],
        }
    }
}

const MEDIUM: [Published; 2] = [
    Published {
        method: MazeMethod::Novelty,
        solved: 40,
        runs: 40,
        mean: 18_274.0,
        deviation: Some(20_447.0),
    },
    Published {
        method: MazeMethod::Distance,
        solved: 39,
        runs: 40,
        mean: 56_334.0,
        deviation: None,
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{self, Pair, PairSource, Preset, Scenario};

    fn scenario_of(course: Course) -> Scenario {
        let source = scenario::find(course.scenario()).unwrap();
        scenario::load(&source, Some(Preset::Novelty), &[]).unwrap()
    }

    #[test]
    fn every_course_is_a_shipped_maze_with_one_pair_of_its_own() {
        for course in Course::ALL {
            let pairs = scenario_of(course).pairs;
            assert!(
                matches!(&pairs.source, PairSource::Listed(list) if list.len() == 1),
                "{course:?}"
            );
        }
    }

    /// Expected: the first author's own file, 5 cm to a unit.
    #[test]
    fn the_medium_maze_is_driven_from_its_own_start_to_its_own_goal() {
        let file = include_str!("../../../../scenarios/worlds/novelty_search/medium_maze.txt");
        let point = |line: usize| -> [f32; 2] {
            let numbers = file.lines().nth(line).unwrap().split_whitespace();
            let metres: Vec<f32> = numbers.map(|n| n.parse::<f32>().unwrap() / 20.0).collect();
            metres.try_into().unwrap()
        };
        let ([x, y], goal) = (point(3), point(5));
        let expected = PairSource::Listed(vec![Pair { start: [x, y, 0.0], goal }]);
        assert_eq!(scenario_of(Course::MediumMaze).pairs.source, expected);
    }
}
