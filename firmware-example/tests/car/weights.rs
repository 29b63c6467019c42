//! What lies in the weights region, and what the car says to it.

use controller_core::activation::{Activation, ActivationKind, Libm, Micromath, Rational};
use controller_core::blob::{Blob, Header};
use controller_core::control_loop::Decide;
use controller_core::controller::Controller;
use controller_core::network::{Elman, Feedforward, Recurrence, SelfLoop, State};
use controller_core::observation::{Echo, Reading};
use firmware_example::brain::Brain;
use firmware_example::weights::{self, Refusal};

use crate::blobs::{self, RANGE};
use crate::hardware::calibration;

fn load(region: &blobs::Region) -> Result<Brain<'_, 12, 1>, Refusal> {
    weights::load(&region.0, &calibration())
}

fn refusal(region: &blobs::Region) -> String {
    load(region).expect_err("not to be driven with").to_string()
}

/// What a car says to weights whose header was changed like this.
fn misfit(change: impl FnOnce(&mut Header)) -> String {
    let mut header = blobs::header(blobs::topology::<Feedforward>());
    change(&mut header);
    refusal(&blobs::region(&header))
}

#[test]
fn erased_flash_is_called_erased() {
    assert_eq!(refusal(&blobs::erased()), "no blob here: the flash is erased");
}

#[test]
fn a_damaged_weight_is_noticed() {
    let mut region = blobs::region(&blobs::header(blobs::topology::<Elman>()));
    region.0[300] ^= 1;
    assert!(refusal(&region).starts_with("damaged: check "), "{}", refusal(&region));
}

#[test]
fn a_network_of_another_size_is_refused_with_both_sizes() {
    let mut topology = blobs::topology::<Feedforward>();
    topology.hidden = 16;
    let said = refusal(&blobs::region(&blobs::header(topology)));
    assert!(said.contains("7-16-16-1") && said.contains("7-12-12-1"), "{said}");
}

#[test]
fn weights_of_another_car_are_refused_with_the_difference() {
    let differences = [
        misfit(|header| header.period = 0.3),
        misfit(|header| header.period = 0.01),
        misfit(|header| header.scaling.steer_limit = 1.5),
        misfit(|header| header.scaling.step_upper = 0.1),
        misfit(|header| header.scaling.range = 10.0),
        misfit(|header| header.wheelbase = 0.26),
        misfit(|header| header.beams[4].x = 0.06),
        misfit(|header| header.beams[0].angle = -0.4),
    ];
    let expected = [
        "a control period of 0.3 s, 0.02 to 0.2 s expected",
        "a control period of 0.01 s, 0.02 to 0.2 s expected",
        "it steers to 1.5 rad, this one to 0.5 rad",
        "it drives at 2 m/s, this one at 1 m/s at most",
        "it sees 10 m far, this one 1.2 m",
        "its wheelbase is 0.26 m, this one's 0.3 m",
        "its beam 4 starts at (0.06, 0) m, this one's at (0, 0) m",
        "its beam 0 points to -0.4 rad, this one's to -0.5235988 rad",
    ];
    assert_eq!(differences, expected.map(|said| format!("trained for another car: {said}")));
}

#[test]
fn slower_gentler_shorter_sighted_weights_fit() {
    let mut header = blobs::header(blobs::topology::<Feedforward>());
    header.scaling.steer_limit = 0.3;
    header.scaling.step_upper = 0.03;
    header.scaling.range = 0.8;
    header.wheelbase = 0.32;
    header.beams[1].angle += 0.05;
    assert!(load(&blobs::region(&header)).is_ok());
}

fn bits(state: &State<f32, 12>) -> [[u32; 12]; 2] {
    [state.first, state.second].map(|layer| layer.map(f32::to_bits))
}

/// Ten steps through the brain and through a controller built by hand, compared as bits.
fn drives_like<R: Recurrence>(activation: impl Activation) {
    let mut header = blobs::header(blobs::topology::<R>());
    header.activation = activation.kind();
    let region = blobs::region(&header);
    let mut brain = load(&region).expect("good weights");
    let blob = Blob::parse_prefix(&region.0).expect("a blob");
    let network = blob.network::<R, 12, 1>().expect("this topology");
    let mut by_hand = Controller::new(network, activation, blob.scaling());
    for _ in 0..2 {
        for step in 0..10 {
            let echoes = [0.2, 0.4, 0.6, 0.8, 1.0].map(|far| Some(Echo::Wall(far / step as f32)));
            let echoes = if step == 0 { [Some(Echo::Nothing); 5] } else { echoes };
            let reading = Reading::new(echoes, 0, RANGE).expect("a good reading");
            let (found, expected) = (brain.decide(Ok(&reading)), by_hand.decide(Ok(&reading)));
            assert_eq!(found.steer.radians().to_bits(), expected.steer.radians().to_bits());
            assert_eq!(found.step.metres().to_bits(), expected.step.metres().to_bits());
            assert_eq!(brain.outputs().map(f32::to_bits), by_hand.outputs().map(f32::to_bits));
            assert_eq!(bits(brain.state()), bits(by_hand.state()));
        }
        brain.reset();
        by_hand.reset();
    }
}

#[test]
fn every_recurrence_with_every_tanh_drives_as_core_says() {
    drives_like::<Feedforward>(Rational);
    drives_like::<Feedforward>(Libm);
    drives_like::<Feedforward>(Micromath);
    drives_like::<SelfLoop>(Rational);
    drives_like::<SelfLoop>(Libm);
    drives_like::<SelfLoop>(Micromath);
    drives_like::<Elman>(Rational);
    drives_like::<Elman>(Libm);
    drives_like::<Elman>(Micromath);
}

#[test]
fn a_brain_knows_its_period_and_the_name_of_its_weights() {
    let mut header = blobs::header(blobs::topology::<SelfLoop>());
    header.period = 0.1;
    header.activation = ActivationKind::Libm;
    let region = blobs::region(&header);
    let blob = Blob::parse_prefix(&region.0).expect("a blob");
    let brain = load(&region).expect("good weights");
    assert_eq!((brain.period(), brain.check()), (100_000, blob.check()));
}
