//! A room with boxes and a target, and what a car with five beams sees in it.
//!
//! It is made of `controller-core`'s arithmetic only, so every machine, and every lane of a wide one, sees the
//! same bits.

use controller_core::controller::Command;
use controller_core::geometry::{Body, Disc, Ray, Segment};
use controller_core::lane::Lane;
use controller_core::motion::Pose;
use controller_core::observation::{BEAMS, BeamMount, Echo};
use controller_core::trig::sin_cos;

/// Longest distance a beam reports, metres; short enough that some beams see nothing.
pub const RANGE: f32 = 4.0;

/// Wheelbase of the car, metres.
pub const WHEELBASE: f32 = 0.3;

/// The car's body: 0.40 m long, 0.20 m wide, the front axle 0.05 m behind the bumper.
const BODY: Body<f32> = Body { rear: -0.35, front: 0.05, half_width: 0.1 };

/// The room's walls, then its boxes, each `x0 y0 x1 y1` in metres.
const RECTANGLES: [[f32; 4]; 4] =
    [[0.0, 0.0, 10.0, 10.0], [2.0, 2.0, 3.0, 4.0], [5.0, 1.0, 6.0, 3.0], [7.0, 5.0, 9.0, 6.0]];

/// The target.
pub const TARGET: Disc<f32> = Disc { centre: (4.0, 7.0), radius: 0.4 };

/// Steps after which the car is put elsewhere, so that a circling one still sees the room.
pub const STEPS_PER_START: u32 = 40;

/// Where the car is put in turn on a tour: metres, metres, radians.
const STARTS: [(f32, f32, f32); 5] =
    [(1.0, 1.0, 0.8), (8.5, 8.5, -2.4), (1.0, 8.0, -0.3), (8.5, 2.0, 2.0), (4.2, 4.8, 1.5)];

/// Where a tour puts the car before this step, if it is put anywhere.
pub fn start(step: u32) -> Option<Pose<f32>> {
    let turn = step.is_multiple_of(STEPS_PER_START).then_some(step / STEPS_PER_START)?;
    let (x, y, heading) = *STARTS.get(turn as usize % STARTS.len())?;
    Some(Pose::new(x, y, heading))
}

/// The fan of beams: −30 to +30°, rightmost first.
pub fn mounts() -> [BeamMount; BEAMS] {
    [-30.0f32, -15.0, 0.0, 15.0, 30.0].map(|degrees| BeamMount {
        x: 0.0,
        y: 0.0,
        angle: degrees.to_radians(),
    })
}

/// What beams of this range in metres report at this pose.
pub fn look(pose: &Pose<f32>, mounts: &[BeamMount; BEAMS], range: f32) -> [Option<Echo>; BEAMS] {
    distances(pose, mounts).map(|(wall, target)| Some(echo(wall, target, range)))
}

/// How far each beam goes to the nearest wall and to the target, metres; infinity where there is none.
pub fn distances<L: Lane>(pose: &Pose<L>, mounts: &[BeamMount; BEAMS]) -> [(L, L); BEAMS] {
    mounts.map(|mount| {
        let (sin, cos) = sin_cos(pose.heading + L::from(mount.angle));
        let origin = pose.to_world(L::from(mount.x), L::from(mount.y));
        let ray = Ray { origin, direction: (cos, sin) };
        let mut nearest = L::from(f32::INFINITY);
        for wall in walls() {
            nearest = ray.to_segment(&wall).min(nearest);
        }
        let (x, y) = TARGET.centre;
        let target = Disc { centre: (L::from(x), L::from(y)), radius: L::from(TARGET.radius) };
        (nearest, ray.to_disc(&target))
    })
}

/// What a beam of this range reports that meets a wall and the target at these distances, metres.
pub fn echo(wall: f32, target: f32, range: f32) -> Echo {
    match (wall, target) {
        _ if range < wall && range < target => Echo::Nothing,
        _ if target < wall => Echo::Target(target),
        _ => Echo::Wall(wall),
    }
}

/// Where the car is after one step; a blocked car turns but does not move.
pub fn drive(pose: &Pose<f32>, command: Command, wheelbase: f32) -> Pose<f32> {
    drive_lanes(pose, command.steer.radians(), command.step.metres(), wheelbase)
}

/// The same for every lane: steer angles in radians, steps and wheelbase in metres.
pub fn drive_lanes<L: Lane>(pose: &Pose<L>, steer: L, step: L, wheelbase: f32) -> Pose<L> {
    let next = pose.driven(steer, step, L::from(wheelbase));
    let body = Body {
        rear: L::from(BODY.rear),
        front: L::from(BODY.front),
        half_width: L::from(BODY.half_width),
    };
    let mut blocked = L::from(0.0).lt(L::from(0.0));
    for wall in walls() {
        blocked = blocked | body.touches_segment(&next, &wall);
    }
    let (x, y) = (L::select(blocked, pose.x, next.x), L::select(blocked, pose.y, next.y));
    Pose { x, y, ..next }
}

fn walls<L: Lane>() -> impl Iterator<Item = Segment<L>> {
    RECTANGLES.into_iter().flat_map(|[x0, y0, x1, y1]| {
        let [x0, y0, x1, y1] = [x0, y0, x1, y1].map(L::from);
        let (a, b, c, d) = ((x0, y0), (x1, y0), (x1, y1), (x0, y1));
        [(a, b), (b, c), (c, d), (d, a)].map(|(a, b)| Segment { a, b })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn look(pose: &Pose<f32>) -> [Option<Echo>; BEAMS] {
        super::look(pose, &mounts(), RANGE)
    }

    #[test]
    fn the_fan_sees_the_wall_ahead_the_target_and_free_space() {
        // 1 m from the east wall: cos 30° and cos 15° stretch the outer beams.
        let facing_a_wall = look(&Pose::new(9.0, 8.0, 0.0));
        let expected = [1.1547, 1.0353, 1.0, 1.0353, 1.1547];
        for (echo, expected) in facing_a_wall.iter().zip(expected) {
            assert!(matches!(echo, Some(Echo::Wall(d)) if (d - expected).abs() < 1e-3), "{echo:?}");
        }
        let facing_the_target = look(&Pose::new(2.0, 7.0, 0.0));
        assert!(matches!(facing_the_target[2], Some(Echo::Target(d)) if (d - 1.6).abs() < 1e-3));
        assert_eq!(look(&Pose::new(1.0, 5.0, 0.0))[2], Some(Echo::Nothing));
    }
}
