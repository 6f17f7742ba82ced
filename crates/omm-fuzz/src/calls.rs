//! Two readings of the specification held against each other: what the validator says nothing about, the device can do.

use arbitrary::Unstructured;
use omm_device::{Device, Reason, Undefined};
use omm_model::call::Call;
use omm_model::profile::DeviceProfile;
use omm_validate::Validator;

mod program;
mod recorder;
mod spoil;

use program::{HEAP, programs};
use recorder::{Step, put_host};

/// What came of a sequence of calls.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Outcome {
    /// Calls that the device executed.
    pub calls: usize,
    /// How many of them were submissions and host commands that did work.
    pub executed: usize,
    /// How many reports the validator had.
    pub reports: usize,
    /// Where the device stopped, and on which call, if it did. Where it does not simulate what was asked, it did not.
    pub undefined: Option<(Undefined, Box<Call>)>,
}

impl Outcome {
    /// Whether the validator said nothing from beginning to end.
    #[must_use]
    pub const fn is_silent(&self) -> bool {
        self.reports == 0
    }

    /// Whether the device stopped at something that the validator said nothing about.
    #[must_use]
    pub const fn is_disagreement(&self) -> bool {
        self.is_silent() && self.undefined.is_some()
    }
}

/// Takes a program without a mistake, spoils it as the bytes say, and shows it to validator and device.
///
/// # Panics
/// If the validator said nothing and the device stopped all the same.
pub fn calls(bytes: &[u8]) -> Outcome {
    let outcome = run(bytes);
    if let (true, Some((undefined, call))) = (outcome.is_silent(), &outcome.undefined) {
        panic!("nothing was reported, and the device stopped: {undefined}\n{call:#?}");
    }
    outcome
}

/// The same, but leaves the judgement to the caller.
#[must_use]
pub fn run(bytes: &[u8]) -> Outcome {
    let mut choices = Unstructured::new(bytes);
    let program = choices.choose_index(programs().len()).unwrap_or_default();
    let mut steps = programs()[program].clone();
    // One mistake more often than several, and sometimes none.
    let spoils = choices.choose(&[0, 1, 1, 1, 2, 2, 3, 6]).copied().unwrap_or_default();
    for _ in 0..spoils {
        // Without bytes left the program stays as it is.
        if steps.is_empty() || spoil::spoil(&mut steps, &mut choices).is_err() {
            break;
        }
    }
    execute(&steps)
}

fn execute(steps: &[Step]) -> Outcome {
    let profile = DeviceProfile::reference();
    let (mut device, mut validator) = (Device::with_heap_size(profile.clone(), HEAP), Validator::new(profile));
    let mut outcome = Outcome::default();
    for step in steps {
        match step {
            Step::Write(address, bytes) => drop(device.write(*address, bytes)),
            Step::Host(address, bytes) => drop(put_host(&mut device, *address, bytes)),
            Step::Call(call) => {
                outcome.reports += validator.check(call, &device).len();
                match device.execute(call) {
                    Ok(output) => {
                        outcome.calls += 1;
                        outcome.executed += usize::from(does_work(call));
                        validator.track(call, &output);
                    }
                    // No driver would have given these handles to the program, or the device cannot do it.
                    Err(Undefined { why: Reason::HandleTaken { .. } | Reason::Unsupported { .. }, .. }) => {
                        return outcome;
                    }
                    Err(undefined) => {
                        outcome.undefined = Some((undefined, call.clone()));
                        return outcome;
                    }
                }
            }
        }
    }
    outcome
}

/// Whether a call executes something now.
fn does_work(call: &Call) -> bool {
    match call {
        Call::QueueSubmit { command_buffers, .. } => !command_buffers.is_empty(),
        Call::BuildAccelerationStructures { .. }
        | Call::BuildMicromaps { .. }
        | Call::CopyMicromap { .. }
        | Call::CopyMicromapToMemory { .. }
        | Call::CopyMemoryToMicromap { .. }
        | Call::DeferredOperationJoin { .. } => true,
        _ => false,
    }
}
