//! Several populations in one run, of which the worse are given up on the way: which of them has luck
//! is worth more than most settings.
//!
//! Islands of an island model (Whitley et al. 1998) without migration, left by successive halving
//! (Jamieson and Talwalkar 2016). All islands are judged on the same drives. Nobody can tell early
//! which of them will be the best, so that all live for more than half of the run; then the worse half of
//! those left leaves again and again, at even distances, until one island has the last part for itself.

use super::ga::settings::require;
use super::ga::{Ga, GaSpec, GaState, Outlook, SettingError};
use super::{Cost, GenomeError, Optimizer, Population, RestoreError, SearchSpace, State};
use crate::seed::RunSeed;
use serde::{Deserialize, Serialize};

/// Genetic algorithms side by side.
#[derive(Clone, Debug)]
pub struct Islands {
    space: SearchSpace,
    outlook: Outlook,
    /// At the beginning.
    count: usize,
    /// Those that are left, in the order of their numbers.
    islands: Vec<Island>,
    /// All of their genomes, island after island.
    together: Population,
}

#[derive(Clone, Debug)]
struct Island {
    number: u32,
    ga: Ga,
    /// How many islands were better, summed over the generations compared since one was last given up.
    behind: u64,
}

/// What a checkpoint keeps of an island.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct IslandState {
    number: u32,
    ga: GaState,
    behind: u64,
}

impl Islands {
    /// So many islands, at least 1, each with a population of this space; island 0 begins with what
    /// a search without islands begins with.
    ///
    /// # Errors
    ///
    /// As [`Ga::with_outlook`]; no islands, or more genomes than have numbers.
    pub fn new(
        count: u32,
        space: SearchSpace,
        spec: GaSpec,
        outlook: Outlook,
        seed: RunSeed,
    ) -> Result<Self, SettingError> {
        let genomes = u64::from(count) * space.population as u64;
        let numbered = (1..=u64::from(u32::MAX)).contains(&genomes);
        require(numbered, "islands", f64::from(count), "at least 1, with fewer than 2³² genomes")?;
        let island = |number| {
            let ga = Ga::on_island(number, space, spec, outlook.clone(), seed)?;
            Ok(Island { number, ga, behind: 0 })
        };
        let islands = (0..count).map(island).collect::<Result<Vec<_>, _>>()?;
        let together = Population::zeros(&space);
        let mut new = Self { space, outlook, count: count as usize, islands, together };
        new.gather();
        Ok(new)
    }

    fn gather(&mut self) {
        self.together.copy_all(self.islands.iter().map(|island| island.ga.ask()));
    }

    /// How many are left for this generation.
    fn left(&self, generation: u32) -> usize {
        // Of `rounds`, number `round` is over at this part of the second half.
        let rounds = self.count.next_power_of_two().ilog2();
        let is_over =
            |round| self.outlook.is_past(generation, (rounds + 1 + round, 2 * (rounds + 1)));
        let over = (1..=rounds).filter(|round| is_over(*round)).count();
        (0..over).fold(self.count, |left, _| left.div_ceil(2))
    }

    /// Whether islands are compared in this generation: in the second half, and if some leave after it.
    fn compares(&self, generation: u32) -> bool {
        self.outlook.is_past(generation, (1, 2))
            || self.left(generation + 1) < self.left(generation)
    }

    /// Counts for each island how many are better in this generation.
    fn compare(&mut self, costs: &[Cost]) {
        let merits: Vec<Cost> = costs.chunks(self.space.population).map(merit).collect();
        for (island, own) in self.islands.iter_mut().zip(&merits) {
            island.behind += merits.iter().filter(|other| *other < own).count() as u64;
        }
    }

    /// Gives up those most behind, of equals the last, until so many are left.
    fn give_up(&mut self, left: usize) {
        if left < self.islands.len() {
            self.islands.sort_by_key(|island| (island.behind, island.number));
            self.islands.truncate(left);
            self.islands.sort_by_key(|island| island.number);
            self.islands.iter_mut().for_each(|island| island.behind = 0);
        }
    }
}

/// What an island is judged by in a generation: the least cost but for the best tenth, rounded down,
/// who may be the luckiest.
fn merit(costs: &[Cost]) -> Cost {
    let mut costs = costs.to_vec();
    let place = costs.len() / 10;
    *costs.select_nth_unstable(place).1
}

impl Optimizer for Islands {
    fn name(&self) -> &'static str {
        "islands"
    }

    fn generation(&self) -> u32 {
        self.islands[0].ga.generation()
    }

    fn ask(&self) -> &Population {
        &self.together
    }

    fn tell(&mut self, costs: &[Cost]) {
        assert_eq!(costs.len(), self.together.size(), "one cost per genome");
        if self.compares(self.generation()) {
            self.compare(costs);
        }
        for (island, costs) in self.islands.iter_mut().zip(costs.chunks(self.space.population)) {
            island.ga.tell(costs);
        }
        self.give_up(self.left(self.generation()));
        self.gather();
    }

    fn begin_with(&mut self, genome: &[f32]) -> Result<(), GenomeError> {
        for island in &mut self.islands {
            island.ga.begin_with(genome)?;
        }
        self.gather();
        Ok(())
    }

    fn save(&self) -> State {
        let state = |island: &Island| {
            let Island { number, ref ga, behind } = *island;
            IslandState { number, ga: ga.state(), behind }
        };
        State::Islands(self.islands.iter().map(state).collect())
    }

    fn restore(&mut self, state: State) -> Result<(), RestoreError> {
        let State::Islands(states) = state else { return Err(RestoreError::Method) };
        let mut islands: Vec<Island> = Vec::with_capacity(states.len());
        for IslandState { number, ga: saved, behind } in states {
            let mut ga = self.islands[0].ga.clone().moved_to(number);
            ga.restore(State::Ga(saved))?;
            let follows = islands
                .last()
                .is_none_or(|last| last.number < number && last.ga.generation() == ga.generation());
            let most_behind = self.count as u64 * u64::from(ga.generation());
            if !follows || number as usize >= self.count || behind > most_behind {
                return Err(RestoreError::Island { number });
            }
            islands.push(Island { number, ga, behind });
        }
        let found = islands.len();
        let expected = islands.first().map_or(1, |island| self.left(island.ga.generation()));
        if found != expected {
            return Err(RestoreError::Islands { found, expected });
        }
        self.islands = islands;
        self.gather();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::ga::{Initial, Mutation, Selection};
    use super::*;

    const SPACE: SearchSpace = SearchSpace { population: 20, genome_len: 3, bound: 5.0 };
    const SPEC: GaSpec = GaSpec {
        selection: Selection::Truncation { share: 0.3 },
        mutation: Mutation::EveryGene { sigma: 0.1 },
        initial: Initial::Uniform,
        ..GaSpec::PAPER
    };

    fn outlook(generations: u32) -> Outlook {
        Outlook { generations, ..Outlook::none(SPACE.genome_len) }
    }

    fn islands(count: u32, generations: u32) -> Islands {
        Islands::new(count, SPACE, SPEC, outlook(generations), RunSeed(3)).unwrap()
    }

    fn numbers(islands: &Islands) -> Vec<u32> {
        islands.islands.iter().map(|island| island.number).collect()
    }

    fn sphere(genome: &[f32]) -> Cost {
        Cost::new(genome.iter().map(|&gene| f64::from(gene * gene)).sum())
    }

    fn tell_spheres(method: &mut dyn Optimizer) {
        let costs: Vec<Cost> = method.ask().genomes().map(sphere).collect();
        method.tell(&costs);
    }

    /// Each individual costs what this says of its island and of its place there.
    fn tell(islands: &mut Islands, cost: impl Fn(u32, usize) -> f64) {
        let numbers = numbers(islands);
        let costs = numbers.iter().flat_map(|number| (0..SPACE.population).map(|n| (*number, n)));
        let costs: Vec<Cost> = costs.map(|(number, n)| Cost::new(cost(number, n))).collect();
        islands.tell(&costs);
    }

    /// Islands in this order, best first, all others alike behind them.
    fn tell_order(islands: &mut Islands, order: &[u32]) {
        tell(islands, |number, _| {
            order.iter().position(|one| *one == number).unwrap_or(order.len()) as f64
        });
    }

    #[test]
    fn half_of_the_islands_leave_at_even_distances_in_the_second_half() {
        let left = |count| -> Vec<usize> {
            let islands = islands(count, 801);
            (0..=800).step_by(50).map(|generation| islands.left(generation)).collect()
        };
        assert_eq!(left(1), [1; 17]);
        assert_eq!(left(2), [[2; 12].as_slice(), &[1; 5]].concat());
        assert_eq!(left(6), [[6; 10].as_slice(), &[3; 2], &[2; 2], &[1; 3]].concat());
        assert_eq!(left(8), [[8; 10].as_slice(), &[4; 2], &[2; 2], &[1; 3]].concat());
        let exactly = islands(32, 13);
        let left: Vec<usize> = (5..=13).map(|generation| exactly.left(generation)).collect();
        assert_eq!(left, [32, 32, 16, 8, 4, 2, 1, 1, 1]);
    }

    /// However short the run, nobody leaves uncompared.
    #[test]
    fn the_best_island_is_left_in_the_end() {
        for count in [2, 3, 6, 9, 33] {
            for generations in 2..40 {
                let mut islands = islands(count, generations);
                for _ in 0..generations {
                    tell(&mut islands, |number, _| -f64::from(number));
                }
                assert_eq!(numbers(&islands), [count - 1], "{count}, {generations}");
            }
        }
    }

    #[test]
    fn those_leave_that_have_most_islands_before_them_since_one_last_left() {
        let mut islands = islands(6, 801);
        while islands.generation() < 500 {
            assert_eq!(numbers(&islands), [0, 1, 2, 3, 4, 5]);
            // The first half does not count, nor what happens now and then.
            let early = islands.generation() < 400;
            let now_and_then = islands.generation().is_multiple_of(5);
            let order = if early || now_and_then { [0, 5, 3] } else { [1, 4, 2] };
            tell_order(&mut islands, &order);
        }
        assert_eq!(numbers(&islands), [1, 2, 4]);
        assert_eq!(islands.ask().size(), 3 * SPACE.population);
        // By little: island 1 was far ahead before.
        while islands.generation() < 600 {
            let order = if islands.generation() < 530 { [1, 2, 4] } else { [4, 2, 1] };
            tell_order(&mut islands, &order);
        }
        assert_eq!(numbers(&islands), [2, 4]);
        while islands.generation() < 700 {
            tell_order(&mut islands, &[4]);
        }
        assert_eq!(numbers(&islands), [4]);
    }

    #[test]
    fn of_equal_islands_the_first_stay() {
        let mut islands = islands(6, 20);
        while !islands.outlook.is_past(islands.generation(), (3, 4)) {
            tell(&mut islands, |_, _| 1.0);
        }
        assert_eq!(numbers(&islands), [0, 1]);
    }

    #[test]
    fn a_few_good_individuals_do_not_make_a_good_island() {
        let mut islands = islands(2, 20);
        for _ in 0..20 {
            // Of twenty, two are left out.
            tell(&mut islands, |number, n| {
                [[0.0, 9.0], [5.0, 6.0]][number as usize][usize::from(n > 1)]
            });
        }
        assert_eq!(numbers(&islands), [1]);
    }

    /// Oracle: searches without islands that are told the same.
    #[test]
    fn an_island_knows_nothing_of_the_others() {
        let alone = |number| Ga::on_island(number, SPACE, SPEC, outlook(40), RunSeed(3)).unwrap();
        let mut alone = [alone(0), alone(1), alone(2)];
        let mut islands = islands(3, 40);
        for _ in 0..40 {
            let left = numbers(&islands);
            let asked = islands.ask().genes().chunks(SPACE.population * SPACE.genome_len);
            assert_eq!(asked.len(), left.len());
            for (genes, number) in asked.zip(left) {
                assert_eq!(genes, alone[number as usize].ask().genes(), "island {number}");
            }
            tell_spheres(&mut islands);
            alone.iter_mut().for_each(|ga| tell_spheres(ga));
        }
        assert_eq!(numbers(&islands).len(), 1);
    }

    #[test]
    fn one_island_is_a_search_without_islands() {
        let mut ga = Ga::with_outlook(SPACE, SPEC, outlook(12), RunSeed(3)).unwrap();
        let mut island = islands(1, 12);
        for _ in 0..12 {
            assert_eq!(island.ask(), ga.ask());
            tell_spheres(&mut ga);
            tell_spheres(&mut island);
        }
    }

    #[test]
    fn what_an_island_breeds_is_its_own() {
        let first = Ga::on_island(1, SPACE, SPEC, outlook(12), RunSeed(3)).unwrap();
        let mut twins = [first.clone(), first.clone().moved_to(2)];
        assert_eq!(twins[0].ask(), twins[1].ask());
        twins.iter_mut().for_each(|ga| tell_spheres(ga));
        assert_ne!(twins[0].ask(), twins[1].ask());
    }

    #[test]
    fn islands_can_begin_with_one_genome_and_mutants_of_their_own() {
        let genome = [0.5, -0.5, 1.0];
        let mut islands = islands(3, 40);
        islands.begin_with(&genome).unwrap();
        let firsts: Vec<&[f32]> = islands.ask().genomes().step_by(SPACE.population).collect();
        assert_eq!(firsts, [genome; 3]);
        let seconds: Vec<&[f32]> = islands.ask().genomes().skip(1).step_by(20).collect();
        assert!(seconds[0] != seconds[1] && seconds[1] != seconds[2]);
    }

    #[test]
    fn who_is_behind_is_saved() {
        let mut first = islands(2, 41);
        while first.generation() < 28 {
            tell_order(&mut first, &[1, 0]);
        }
        let mut resumed = islands(2, 41);
        resumed.restore(first.save()).unwrap();
        for islands in [&mut first, &mut resumed] {
            while islands.generation() < 30 {
                tell_order(islands, &[0, 1]);
            }
            assert_eq!(numbers(islands), [1]);
        }
    }

    #[test]
    fn a_state_that_no_run_comes_to_is_refused() {
        let mut run = islands(6, 801);
        while run.generation() < 500 {
            tell_order(&mut run, &[1, 4, 2]);
        }
        let State::Islands(saved) = run.save() else { panic!() };
        let fresh = || islands(6, 801).islands[0].ga.state();
        let refusal = |change: &dyn Fn(&mut Vec<IslandState>)| {
            let mut state = saved.clone();
            change(&mut state);
            islands(6, 801).restore(State::Islands(state)).err()
        };
        let number = |number| Some(RestoreError::Island { number });
        let count = |found, expected| Some(RestoreError::Islands { found, expected });
        assert_eq!(refusal(&|_| ()), None);
        assert_eq!(refusal(&|state| state.swap(0, 1)), number(1));
        assert_eq!(refusal(&|state| state[1].number = 1), number(1));
        assert_eq!(refusal(&|state| state[2].number = 6), number(6));
        assert_eq!(refusal(&|state| state[1].ga = fresh()), number(2));
        assert_eq!(refusal(&|state| state[2].behind = 3001), number(4));
        assert_eq!(refusal(&|state| drop(state.pop())), count(2, 3));
        assert_eq!(refusal(&Vec::clear), count(0, 1));
        let early = |state: &mut Vec<IslandState>| {
            state.iter_mut().for_each(|island| island.ga = fresh());
        };
        assert_eq!(refusal(&early), count(3, 6));
    }

    #[test]
    fn a_senseless_number_of_islands_is_refused_by_name() {
        for count in [0, u32::MAX] {
            let refused = Islands::new(count, SPACE, SPEC, outlook(12), RunSeed(3)).unwrap_err();
            assert_eq!(refused.setting, "islands", "{count}");
        }
    }
}
