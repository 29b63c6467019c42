//! What is measured: functions that a board's program calls, through pointers, so that none is changed
//! by where it is called from.

use controller_core::activation::{Activation, ActivationKind, Libm, Micromath, Rational};
use controller_core::blob::Blob;
use controller_core::control_loop::Decide;
use controller_core::controller::{Command, Controller};
use controller_core::network::{Network, Recurrence, RecurrenceKind, State};
use controller_core::observation::{BEAMS, Echo, INPUTS, Reading};
use core::hint::black_box;
use firmware_example::brain::{HIDDEN, OUTPUTS};
use firmware_example::recorded;

use crate::counter::Counter;
use crate::inputs::Inputs;
use crate::measurement::{self, Measurement, measure};

type Net<'a, R> = Network<'a, R, f32, INPUTS, HIDDEN, OUTPUTS>;
type Memory = State<f32, HIDDEN>;
type Step<'a, R, A> = fn(&Net<'a, R>, A, &mut Memory, &[f32; INPUTS]) -> [f32; OUTPUTS];
type Car<'a, R, A> = Controller<'a, R, A, HIDDEN, OUTPUTS>;
type Control<'a, R, A> = fn(&mut Car<'a, R, A>, &[Option<Echo>; BEAMS]) -> Command;

/// One recurrence with every tanh, by the weights of a recorded drive.
///
/// # Errors
///
/// There is no such drive with this recurrence, or a stack was too deep.
pub(crate) fn steps<R: Recurrence>(counter: &Counter, drive: &str) -> Result<(), &'static str> {
    let drive = recorded::ALL.iter().find(|recorded| recorded.name == drive);
    let blob = Blob::parse(drive.ok_or("no such recorded drive")?.blob);
    let blob = blob.map_err(|_| "a recorded blob is damaged")?;
    let network = blob.network::<R, HIDDEN, OUTPUTS>();
    let network = network.map_err(|_| "a recorded blob has another topology than expected")?;
    step_and_control(counter, &blob, network, Rational)?;
    step_and_control(counter, &blob, network, Libm)?;
    step_and_control(counter, &blob, network, Micromath)
}

fn step_and_control<'a, R: Recurrence, A: Activation>(
    counter: &Counter,
    blob: &Blob<'a>,
    network: Net<'a, R>,
    activation: A,
) -> Result<(), &'static str> {
    let functions: [Step<'a, R, A>; 2] = [Net::step_alone, |_, _, _, _| [0.0]];
    let [step, empty] = black_box(functions);
    let (network, mut state, mut other) = black_box((network, Memory::reset(), Memory::reset()));
    let mut inputs = Inputs::new();
    let found = measure(
        counter,
        || inputs.network(),
        |input| _ = black_box(step(&network, activation, &mut state, input)),
        |input| _ = black_box(empty(&network, activation, &mut other, input)),
    )?;
    let weights = size_of_val(blob.weights());
    report("network", name(R::KIND), activation, &found, step as usize, weights);

    let functions: [Control<'a, R, A>; 2] = [control_step, |_, _| Command::STOP];
    let [control, empty] = black_box(functions);
    let car = Controller::new(network, activation, blob.scaling());
    let (mut car, mut other) = black_box((car.clone(), car));
    let mut inputs = Inputs::new();
    let range = blob.scaling().range;
    let found = measure(
        counter,
        || inputs.echoes(range),
        |echoes| _ = black_box(control(&mut car, echoes)),
        |echoes| _ = black_box(empty(&mut other, echoes)),
    )?;
    report("control", name(R::KIND), activation, &found, control as usize, weights);
    Ok(())
}

/// From what the beams report to the command: what [`tick`](controller_core::control_loop::tick) does
/// besides moving the hardware.
#[inline(never)]
fn control_step<R: Recurrence, A: Activation>(
    car: &mut Car<'_, R, A>,
    echoes: &[Option<Echo>; BEAMS],
) -> Command {
    let reading = Reading::new(*echoes, 0, car.scaling().range);
    car.decide(reading.as_ref().map_err(|error| *error))
}

/// A tanh of one number between -4 and 4.
///
/// # Errors
///
/// A stack was too deep.
pub(crate) fn tanh<A: Activation>(counter: &Counter, activation: A) -> Result<(), &'static str> {
    let functions: [fn(A, &mut [f32; 1]); 2] = [A::apply, |_, _| ()];
    let [apply, empty] = black_box(functions);
    let run = |function: fn(A, &mut [f32; 1]), input: &f32| {
        let mut value = [*input];
        function(activation, &mut value);
        black_box(value);
    };
    let mut inputs = Inputs::new();
    let found = measure(
        counter,
        || 4.0 * inputs.within_one(),
        |input| run(apply, input),
        |input| run(empty, input),
    )?;
    report("tanh", "-", activation, &found, apply as usize, 0);
    Ok(())
}

fn name(recurrence: RecurrenceKind) -> &'static str {
    match recurrence {
        RecurrenceKind::Feedforward => "feedforward",
        RecurrenceKind::SelfLoop => "self",
        RecurrenceKind::Elman => "elman",
    }
}

fn report(
    what: &str,
    recurrence: &str,
    activation: impl Activation,
    found: &Measurement,
    code: usize,
    weights: usize,
) {
    let Measurement { min, max, sum, stack } = found;
    let tanh_name = match activation.kind() {
        ActivationKind::Rational => "rational",
        ActivationKind::Libm => "libm",
        ActivationKind::Micromath => "micromath",
    };
    defmt::info!(
        "{=str} {=str} {=str} min={=u32} max={=u32} sum={=u32} inputs={=u32} stack={=u32} code={=usize} state={=usize} weights={=usize}",
        what,
        recurrence,
        tanh_name,
        *min,
        *max,
        *sum,
        measurement::INPUTS,
        *stack,
        // Its lowest bit says that it is Thumb code.
        code & !1,
        size_of::<Memory>(),
        weights
    );
}
