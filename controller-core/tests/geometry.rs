//! Beams and contacts against whole-number arithmetic, where every answer is exact.
//!
//! Coordinates are small whole numbers, so every product and sum fits an `f32` without
//! rounding: the decision must be the exact one, and a distance the exact quotient rounded once.

use controller_core::geometry::{Body, Disc, Ray, Segment};
use controller_core::lane::Lanes;
use controller_core::motion::Pose;
use controller_core::trig::sin_cos;
use proptest::prelude::*;

type Point = (i64, i64);

fn cross(a: Point, b: Point) -> i64 {
    a.0 * b.1 - a.1 * b.0
}

fn minus(a: Point, b: Point) -> Point {
    (a.0 - b.0, a.1 - b.1)
}

fn floats(p: Point) -> (f32, f32) {
    (p.0 as f32, p.1 as f32)
}

/// Coordinates in a small range, so that parallel, touching and degenerate cases are common.
fn point(limit: i64) -> impl Strategy<Value = Point> {
    (-limit..=limit, -limit..=limit)
}

/// Where a ray meets a wall, in lengths of its direction, as a fraction; from the sides on
/// which the wall's ends lie.
fn exact_ray_to_segment(origin: Point, direction: Point, a: Point, b: Point) -> Option<(i64, i64)> {
    let side_a = cross(direction, minus(a, origin));
    let side_b = cross(direction, minus(b, origin));
    if side_a == side_b || side_a.signum() * side_b.signum() > 0 {
        return None;
    }
    // The crossing is a weighed mean of the ends; its projection on the direction is the distance.
    let (weight_a, weight_b) = (side_b.abs(), side_a.abs());
    let forward = |p: Point| {
        let w = minus(p, origin);
        w.0 * direction.0 + w.1 * direction.1
    };
    let numerator = weight_a * forward(a) + weight_b * forward(b);
    let square = direction.0 * direction.0 + direction.1 * direction.1;
    (numerator >= 0).then_some((numerator, (weight_a + weight_b) * square))
}

fn rays_agree(origin: Point, direction: Point, a: Point, b: Point) -> Result<(), TestCaseError> {
    let ray = Ray { origin: floats(origin), direction: floats(direction) };
    let found = ray.to_segment(&Segment { a: floats(a), b: floats(b) });
    let expected = match exact_ray_to_segment(origin, direction, a, b) {
        // A quotient in f64 rounded again to f32 is the quotient rounded once.
        Some((numerator, denominator)) => (numerator as f64 / denominator as f64) as f32,
        None => f32::INFINITY,
    };
    prop_assert_eq!(found, expected, "{:?} {:?} {:?} {:?}", origin, direction, a, b);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20_000, ..ProptestConfig::default() })]

    #[test]
    fn a_ray_meets_a_wall_exactly_where_whole_numbers_say(
        origin in point(400), direction in point(300), a in point(400), b in point(400),
    ) {
        rays_agree(origin, direction, a, b)?;
    }

    #[test]
    fn degenerate_rays_and_walls_are_decided_exactly(
        origin in point(3), direction in point(2), a in point(3), b in point(3),
    ) {
        rays_agree(origin, direction, a, b)?;
    }

    #[test]
    fn the_body_touches_a_wall_exactly_when_whole_numbers_say(
        (rear, length, half_width) in (-6i64..=0, 1i64..=9, 0i64..=4),
        at in point(4), a in point(9), b in point(9),
    ) {
        let front = rear + length;
        let expected = exact_box_meets_segment((rear, front, half_width), minus(a, at), minus(b, at));
        let body = Body { rear: rear as f32, front: front as f32, half_width: half_width as f32 };
        let pose = Pose::new(at.0 as f32, at.1 as f32, 0.0);
        let wall = Segment { a: floats(a), b: floats(b) };
        prop_assert_eq!(body.touches_segment(&pose, &wall), expected);
    }

    #[test]
    fn the_body_touches_a_disc_exactly_when_whole_numbers_say(
        (rear, length, half_width) in (-6i64..=0, 1i64..=9, 0i64..=4),
        at in point(4), centre in point(12), radius in 0i64..=8,
    ) {
        let front = rear + length;
        let c = minus(centre, at);
        let dx = (rear - c.0).max(c.0 - front).max(0);
        let dy = (c.1.abs() - half_width).max(0);
        let body = Body { rear: rear as f32, front: front as f32, half_width: half_width as f32 };
        let pose = Pose::new(at.0 as f32, at.1 as f32, 0.0);
        let disc = Disc { centre: floats(centre), radius: radius as f32 };
        prop_assert_eq!(body.touches_disc(&pose, &disc), dx * dx + dy * dy <= radius * radius);
    }
}

/// Clips the segment against the box, as fractions with a common sign: Liang and Barsky.
fn exact_box_meets_segment((rear, front, half_width): (i64, i64, i64), a: Point, b: Point) -> bool {
    let e = minus(b, a);
    // The segment is inside while `p·t ≤ q`, for each of the box's four sides.
    let sides =
        [(-e.0, a.0 - rear), (e.0, front - a.0), (-e.1, a.1 + half_width), (e.1, half_width - a.1)];
    let (mut enters, mut leaves) = ((0, 1), (1, 1));
    for (p, q) in sides {
        match p {
            0 if q < 0 => return false,
            0 => {}
            // t = q/p with a positive denominator.
            p if p < 0 && -q * enters.1 > enters.0 * -p => enters = (-q, -p),
            p if p > 0 && q * leaves.1 < leaves.0 * p => leaves = (q, p),
            _ => {}
        }
    }
    enters.0 * leaves.1 <= leaves.0 * enters.1
}

#[test]
fn touching_counts_and_missing_by_a_hair_does_not() {
    let body = Body { rear: -0.375f32, front: 0.125, half_width: 0.125 };
    let pose = Pose::new(1.0, 1.0, 0.0);
    let wall_at = |x: f32| Segment { a: (x, 0.0), b: (x, 2.0) };
    assert!(body.touches_segment(&pose, &wall_at(1.125)));
    assert!(!body.touches_segment(&pose, &wall_at(1.125f32.next_up())));
    assert!(body.touches_segment(&pose, &wall_at(0.625)));
    assert!(!body.touches_segment(&pose, &wall_at(0.625f32.next_down())));
    // A corner on the diagonal wall x + y = 2.25, and one just outside it.
    let diagonal = |sum: f32| Segment { a: (sum - 1.0, 1.0), b: (1.0, sum - 1.0) };
    assert!(body.touches_segment(&pose, &diagonal(2.25)));
    assert!(!body.touches_segment(&pose, &diagonal(2.250_001)));
    // A wall inside the body, and one that is a point.
    assert!(body.touches_segment(&pose, &Segment { a: (0.9, 1.0), b: (0.95, 1.01) }));
    assert!(body.touches_segment(&pose, &Segment { a: (1.125, 1.125), b: (1.125, 1.125) }));
    let disc = |x: f32| Disc { centre: (x, 1.0), radius: 0.5 };
    assert!(body.touches_disc(&pose, &disc(1.625)));
    assert!(!body.touches_disc(&pose, &disc(1.625f32.next_up())));
}

#[test]
fn a_ray_sees_a_disc_from_outside_only_and_a_tangent_counts() {
    let from = |x: f32, y: f32| Ray { origin: (x, y), direction: (1.0, 0.0) };
    let disc = Disc { centre: (5.0f32, 2.0), radius: 0.5 };
    assert_eq!(from(0.0, 2.0).to_disc(&disc), 4.5);
    assert_eq!(from(0.0, 2.5).to_disc(&disc), 5.0);
    assert_eq!(from(0.0, 1.5).to_disc(&disc), 5.0);
    assert_eq!(from(0.0, 2.5f32.next_up()).to_disc(&disc), f32::INFINITY);
    // From the rim inward, from inside, from the rim outward, from behind.
    assert_eq!(from(4.5, 2.0).to_disc(&disc), 0.0);
    assert_eq!(from(4.75, 2.0).to_disc(&disc), f32::INFINITY);
    assert_eq!(from(5.5, 2.0).to_disc(&disc), f32::INFINITY);
    assert_eq!(from(9.0, 2.0).to_disc(&disc), f32::INFINITY);
    // 3-4-5: aside 3, half chord 4.
    let disc = Disc { centre: (10.0, 3.0), radius: 5.0 };
    assert_eq!(from(0.0, 0.0).to_disc(&disc), 6.0);
}

/// Random numbers in `0.0..1.0` from a Weyl sequence.
struct Numbers(u32);

impl Numbers {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        let mixed = (self.0 ^ self.0 >> 16).wrapping_mul(0x85eb_ca6b);
        ((mixed ^ mixed >> 13) >> 8) as f32 / 16_777_216.0
    }

    fn within(&mut self, limit: f32) -> f32 {
        (2.0 * self.next() - 1.0) * limit
    }
}

#[test]
fn at_any_angle_distances_stay_within_a_few_micrometres_of_double_precision() {
    let mut numbers = Numbers(7);
    let (mut walls, mut discs, mut worst) = (0, 0, 0.0f64);
    for _ in 0..200_000 {
        let (sin, cos) = sin_cos(numbers.within(3.1));
        let ray = Ray { origin: (numbers.within(5.0), numbers.within(5.0)), direction: (cos, sin) };
        let (d, o) = ((f64::from(cos), f64::from(sin)), ray.origin);
        let wide =
            |p: (f32, f32)| (f64::from(p.0) - f64::from(o.0), f64::from(p.1) - f64::from(o.1));

        let a = (numbers.within(5.0), numbers.within(5.0));
        let b = (numbers.within(5.0), numbers.within(5.0));
        let found = ray.to_segment(&Segment { a, b });
        let (wa, wb) = (wide(a), wide(b));
        let e = (wb.0 - wa.0, wb.1 - wa.1);
        let den = d.0 * e.1 - d.1 * e.0;
        let along = (wa.0 * d.1 - wa.1 * d.0) / den;
        let t = (wa.0 * e.1 - wa.1 * e.0) / den;
        // A ray at more than a few degrees to the wall, away from its ends: a clear case.
        if den.abs() > 0.1 && (along.min(1.0 - along)).abs() > 1e-4 && t.abs() > 1e-4 {
            if (0.0..=1.0).contains(&along) && t > 0.0 {
                walls += 1;
                worst = worst.max((f64::from(found) - t).abs() / (1.0 + 1.0 / den.abs()));
            } else {
                assert_eq!(found, f32::INFINITY);
            }
        }

        let (centre, radius) = ((numbers.within(5.0), numbers.within(5.0)), 0.1 + numbers.next());
        let found = ray.to_disc(&Disc { centre, radius });
        let w = wide(centre);
        let (middle, aside) = (w.0 * d.0 + w.1 * d.1, w.0 * d.1 - w.1 * d.0);
        let root = f64::from(radius) * f64::from(radius) - aside * aside;
        let t = middle - libm::sqrt(root.max(0.0));
        if root.abs() > 1e-2 && t.abs() > 1e-4 {
            if root > 0.0 && t > 0.0 {
                discs += 1;
                worst = worst.max((f64::from(found) - t).abs());
            } else {
                assert_eq!(found, f32::INFINITY);
            }
        }
    }
    println!("{walls} walls and {discs} discs seen, worst {worst:e} m");
    assert!(walls > 10_000 && discs > 5_000 && worst < 2e-5, "{walls}, {discs}, {worst:e}");
}

#[test]
fn at_any_heading_a_body_a_little_larger_or_smaller_decides_like_double_precision() {
    let mut numbers = Numbers(11);
    let body = Body { rear: -0.35f32, front: 0.05, half_width: 0.1 };
    let (mut touched, mut clear) = (0, 0);
    for _ in 0..200_000 {
        let pose = Pose::new(numbers.within(5.0), numbers.within(5.0), numbers.within(3.1));
        let mut near = || (pose.x + numbers.within(0.8), pose.y + numbers.within(0.8));
        let wall = Segment { a: near(), b: near() };
        let (sin, cos) = libm::sincos(f64::from(pose.heading));
        let in_body = |p: (f32, f32)| {
            let (dx, dy) = (f64::from(p.0) - f64::from(pose.x), f64::from(p.1) - f64::from(pose.y));
            (cos * dx + sin * dy, cos * dy - sin * dx)
        };
        let (a, b) = (in_body(wall.a), in_body(wall.b));
        let found = body.touches_segment(&pose, &wall);
        if box_meets_segment(-0.35 + 5e-6, 0.05 - 5e-6, 0.1 - 5e-6, a, b) {
            assert!(found, "{pose:?} {wall:?}");
            touched += 1;
        }
        if !box_meets_segment(-0.35 - 5e-6, 0.05 + 5e-6, 0.1 + 5e-6, a, b) {
            assert!(!found, "{pose:?} {wall:?}");
            clear += 1;
        }
    }
    assert!(touched > 20_000 && clear > 20_000, "{touched} touched, {clear} clear");
}

fn box_meets_segment(rear: f64, front: f64, half: f64, a: (f64, f64), b: (f64, f64)) -> bool {
    let e = (b.0 - a.0, b.1 - a.1);
    let sides = [(-e.0, a.0 - rear), (e.0, front - a.0), (-e.1, a.1 + half), (e.1, half - a.1)];
    let (mut enters, mut leaves) = (0.0f64, 1.0f64);
    for (p, q) in sides {
        if p < 0.0 {
            enters = enters.max(q / p);
        } else if p > 0.0 {
            leaves = leaves.min(q / p);
        } else if q < 0.0 {
            return false;
        }
    }
    enters <= leaves
}

/// How many rays aimed exactly at the corners of a closed room see no wall at all, when each
/// wall is longer than its side by this much at both ends.
fn leaks(longer: f32) -> usize {
    let mut numbers = Numbers(3);
    let corners: Vec<(f32, f32)> = (0..18)
        .map(|i| {
            let (sin, cos) = sin_cos(i as f32 * (std::f32::consts::TAU / 18.0));
            let radius = 3.0 + numbers.next();
            (radius * cos, radius * sin)
        })
        .collect();
    let walls: Vec<Segment<f32>> = (0..18)
        .map(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % 18]);
            let length = libm::hypotf(b.0 - a.0, b.1 - a.1);
            let (ux, uy) = ((b.0 - a.0) / length * longer, (b.1 - a.1) / length * longer);
            Segment { a: (a.0 - ux, a.1 - uy), b: (b.0 + ux, b.1 + uy) }
        })
        .collect();
    (0..20_000)
        .filter(|i| {
            let origin = (numbers.within(1.5), numbers.within(1.5));
            let corner = corners[i % 18];
            let (dx, dy) = (corner.0 - origin.0, corner.1 - origin.1);
            let length = libm::hypotf(dx, dy);
            let ray = Ray { origin, direction: (dx / length, dy / length) };
            walls.iter().all(|wall| ray.to_segment(wall) == f32::INFINITY)
        })
        .count()
}

#[test]
fn no_ray_slips_through_the_corners_of_a_room_whose_walls_are_ten_micrometres_longer() {
    println!("{} of 20000 rays slip through walls that only meet", leaks(0.0));
    assert_eq!(leaks(1e-5), 0);
}

proptest! {
    #[test]
    fn four_robots_in_lanes_feel_what_each_would_feel_alone(
        poses in prop::array::uniform4((-2.0f32..2.0, -2.0f32..2.0, -3.1f32..3.1)),
        shapes in prop::array::uniform4((-2.0f32..2.0, -2.0f32..2.0, -2.0f32..2.0, -2.0f32..2.0)),
        radius in 0.0f32..1.5,
    ) {
        let lanes = |of: &dyn Fn(usize) -> f32| Lanes::<4>(std::array::from_fn(of));
        let (x, y) = (lanes(&|i| poses[i].0), lanes(&|i| poses[i].1));
        let wide_pose = Pose::new(x, y, lanes(&|i| poses[i].2));
        let wide_ray = Ray { origin: (x, y), direction: (wide_pose.cos, wide_pose.sin) };
        let a = (lanes(&|i| shapes[i].0), lanes(&|i| shapes[i].1));
        let b = (lanes(&|i| shapes[i].2), lanes(&|i| shapes[i].3));
        let wide_wall = Segment { a, b };
        let wide_disc = Disc { centre: a, radius: Lanes::from(radius) };
        let (rear, front, half_width) = (-0.35f32, 0.05f32, 0.1f32);
        let wide_body =
            Body { rear: Lanes::from(rear), front: front.into(), half_width: half_width.into() };
        let seen = (wide_ray.to_segment(&wide_wall), wide_ray.to_disc(&wide_disc));
        let felt = (
            wide_body.touches_segment(&wide_pose, &wide_wall),
            wide_body.touches_disc(&wide_pose, &wide_disc),
        );
        for i in 0..4 {
            let (x, y, heading) = poses[i];
            let pose = Pose::new(x, y, heading);
            let ray = Ray { origin: (x, y), direction: (pose.cos, pose.sin) };
            let (ax, ay, bx, by) = shapes[i];
            let wall = Segment { a: (ax, ay), b: (bx, by) };
            let disc = Disc { centre: (ax, ay), radius };
            let body = Body { rear, front, half_width };
            prop_assert_eq!(seen.0.0[i].to_bits(), ray.to_segment(&wall).to_bits());
            prop_assert_eq!(seen.1.0[i].to_bits(), ray.to_disc(&disc).to_bits());
            prop_assert_eq!(felt.0.lane(i), body.touches_segment(&pose, &wall));
            prop_assert_eq!(felt.1.lane(i), body.touches_disc(&pose, &disc));
        }
    }
}
