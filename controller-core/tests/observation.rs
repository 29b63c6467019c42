//! Readings and their encodings against tables worked by hand.

use controller_core::lane::{Lane, Lanes};
use controller_core::observation::{
    DistanceLaw, Echo, Encoding, Reading, ReadingError, STALE_AFTER, Sight, TypeCode,
};
use proptest::prelude::*;
use proptest::sample::select;

const CLEAR: Echo = Echo::Nothing;

fn wall(metres: f32) -> Echo {
    Echo::Wall(metres)
}

fn target(metres: f32) -> Echo {
    Echo::Target(metres)
}

fn reading(echoes: [Echo; 5]) -> Reading {
    Reading::new(echoes.map(Some), 0, 8.0).unwrap()
}

fn inputs(distance: DistanceLaw, types: TypeCode, echoes: [Echo; 5]) -> [f32; 7] {
    Encoding { distance, types }.inputs(&reading(echoes).sight(), 8.0)
}

const CODES: [TypeCode; 5] = [
    TypeCode::Any,
    TypeCode::Nearest,
    TypeCode::Share,
    TypeCode::NearestWallAnyTarget,
    TypeCode::Bearing,
];

#[test]
fn linear_distances_are_shares_of_the_range_and_clear_beams_read_one() {
    let seen = [wall(0.0), wall(2.0), CLEAR, target(4.0), wall(8.0)];
    let [a, b, c, d, e, ..] = inputs(DistanceLaw::Linear, TypeCode::Any, seen);
    assert_eq!([a, b, c, d, e], [0.0, 0.25, 1.0, 0.5, 1.0]);
}

#[test]
fn saturating_distances_are_one_half_at_the_half_distance() {
    let seen = [wall(0.0), wall(2.0), CLEAR, target(6.0), wall(0.5)];
    let law = DistanceLaw::Saturating { half: 2.0 };
    let [a, b, c, d, e, ..] = inputs(law, TypeCode::Any, seen);
    assert_eq!([a, b, c, d, e], [0.0, 0.5, 0.8, 0.75, 0.2]);
}

#[test]
fn hit_types_become_two_inputs_as_the_table_says() {
    // Five beams, rightmost first; then (wall, target) for any, nearest, share, and nearest
    // wall with any target, and (side, target) for bearing.
    let third = 1.0 / 3.0;
    let table = [
        ([CLEAR; 5], [[0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [0.0, 0.0]]),
        ([wall(1.0); 5], [[1.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 0.0]]),
        (
            [wall(3.0), CLEAR, target(2.0), CLEAR, wall(4.0)],
            [[1.0, 1.0], [0.0, 1.0], [0.4, 0.2], [0.0, 1.0], [0.0, 1.0]],
        ),
        (
            [wall(1.0), CLEAR, target(2.0), target(2.5), wall(4.0)],
            [[1.0, 1.0], [1.0, 0.0], [0.4, 0.4], [1.0, 1.0], [third, 1.0]],
        ),
        // Equal distances: the rightmost decides.
        (
            [CLEAR, target(2.0), wall(2.0), CLEAR, CLEAR],
            [[1.0, 1.0], [0.0, 1.0], [0.2, 0.2], [0.0, 1.0], [-third, 1.0]],
        ),
        (
            [CLEAR, wall(2.0), target(2.0), CLEAR, CLEAR],
            [[1.0, 1.0], [1.0, 0.0], [0.2, 0.2], [1.0, 1.0], [0.0, 1.0]],
        ),
        // A hit at the very end of the range, behind a clear beam to its right, loses the tie.
        (
            [CLEAR, CLEAR, CLEAR, CLEAR, wall(8.0)],
            [[1.0, 0.0], [0.0, 0.0], [0.2, 0.0], [0.0, 0.0], [0.0, 0.0]],
        ),
        // Every beam of one side.
        (
            [target(3.0), target(2.0), wall(1.0), CLEAR, CLEAR],
            [[1.0, 1.0], [1.0, 0.0], [0.2, 0.4], [1.0, 1.0], [-1.0, 1.0]],
        ),
    ];
    for (echoes, expected) in table {
        for (code, expected) in CODES.into_iter().zip(expected) {
            let [.., wall, target] = inputs(DistanceLaw::Linear, code, echoes);
            assert_eq!([wall, target], expected, "{code:?} of {echoes:?}");
        }
    }
}

#[test]
fn a_beam_on_the_target_counts_as_free_where_its_bearing_is_an_input() {
    let seen = [wall(2.0), target(2.0), CLEAR, target(8.0), target(0.0)];
    let [distances @ .., _, _] = inputs(DistanceLaw::Linear, TypeCode::Bearing, seen);
    assert_eq!(distances, [0.25, 1.0, 1.0, 1.0, 1.0]);
    let law = DistanceLaw::Saturating { half: 2.0 };
    let [distances @ .., _, _] = inputs(law, TypeCode::Bearing, seen);
    assert_eq!(distances, [0.5, 0.8, 0.8, 0.8, 0.8]);
}

#[test]
fn every_kind_of_bad_distance_is_refused_in_every_beam() {
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.001, 8.000_001, f32::MAX];
    for beam in 0..5 {
        for distance in bad {
            for echo in [wall(distance), target(distance)] {
                let mut echoes = [Some(wall(1.0)); 5];
                echoes[beam] = Some(echo);
                match Reading::new(echoes, 0, 8.0).unwrap_err() {
                    ReadingError::OutOfRange { beam: at, distance: found } => {
                        assert_eq!((at, found.to_bits()), (beam, distance.to_bits()));
                    }
                    other => panic!("beam {beam} at {distance}: {other}"),
                }
            }
        }
        let mut echoes = [Some(CLEAR); 5];
        echoes[beam] = None;
        assert_eq!(Reading::new(echoes, 0, 8.0), Err(ReadingError::Missing { beam }));
    }
}

#[test]
fn clear_beams_of_an_impossible_range_are_refused_too() {
    for range in [f32::NAN, f32::INFINITY, -1.0] {
        let refused = Reading::new([Some(CLEAR); 5], 0, range);
        assert!(matches!(refused, Err(ReadingError::OutOfRange { beam: 0, .. })), "{range}");
    }
}

#[test]
fn a_reading_is_stale_after_three_periods() {
    let echoes = [Some(wall(1.0)); 5];
    for age in 0..=STALE_AFTER {
        assert!(Reading::new(echoes, age, 8.0).is_ok());
    }
    for age in [STALE_AFTER + 1, u32::MAX] {
        assert_eq!(Reading::new(echoes, age, 8.0), Err(ReadingError::Stale { age }));
    }
}

#[test]
fn refusals_say_which_beam_and_what_it_reported() {
    let sentences = [
        ReadingError::Missing { beam: 4 },
        ReadingError::OutOfRange { beam: 0, distance: -1.5 },
        ReadingError::Stale { age: 9 },
    ]
    .map(|error| error.to_string());
    assert_eq!(
        sentences,
        [
            "beam 4 did not answer",
            "beam 0 reported -1.5 m, outside its range",
            "the reading is 9 periods old, 3 are allowed"
        ]
    );
}

fn echoes() -> impl Strategy<Value = [Echo; 5]> {
    prop::array::uniform5(prop_oneof![
        Just(CLEAR),
        (0.0f32..=8.0).prop_map(wall),
        (0.0f32..=8.0).prop_map(target),
        // Ties are what the codes differ in.
        select(vec![wall(2.0), target(2.0), wall(0.0), target(8.0)]),
    ])
}

fn encodings() -> impl Strategy<Value = Encoding> {
    let laws = prop_oneof![
        Just(DistanceLaw::Linear),
        (0.01f32..20.0).prop_map(|half| DistanceLaw::Saturating { half })
    ];
    (laws, select(CODES.to_vec())).prop_map(|(distance, types)| Encoding { distance, types })
}

proptest! {
    #[test]
    fn four_robots_in_lanes_get_the_inputs_each_would_get_alone(
        robots in prop::array::uniform4(echoes()),
        encoding in encodings(),
    ) {
        let alone = robots.map(|echoes| reading(echoes).sight());
        let side_by_side = |of: fn(&Sight<f32>) -> &[f32; 5]| -> [Lanes<4>; 5] {
            std::array::from_fn(|beam| Lanes(alone.map(|sight| of(&sight)[beam])))
        };
        let wide = Sight {
            distance: side_by_side(|sight| &sight.distance),
            wall: side_by_side(|sight| &sight.wall),
            target: side_by_side(|sight| &sight.target),
        };
        let wide = encoding.inputs(&wide, 8.0);
        for (lane, sight) in alone.iter().enumerate() {
            let scalar = encoding.inputs(sight, 8.0).map(f32::to_bits);
            prop_assert_eq!(wide.map(|input| input.0[lane].to_bits()), scalar);
        }
    }

    #[test]
    fn a_nearer_wall_never_reads_as_farther(near in 0.0f32..8.0, far in 0.0f32..8.0, encoding in encodings()) {
        let (near, far) = (near.min(far), near.max(far));
        let read = |metres: f32| encoding.inputs(&reading([wall(metres); 5]).sight(), 8.0)[0];
        prop_assert!(read(near) <= read(far));
    }
}

#[test]
fn lane_minimum_and_limit_answer_the_other_number_for_nan() {
    assert_eq!(Lane::min(f32::NAN, 1.0), 1.0);
    assert_eq!(Lane::max(f32::NAN, 1.0), 1.0);
    assert!(f32::NAN.held_within(1.0).is_nan());
    assert_eq!((-7.0f32).held_within(2.0), -2.0);
}
