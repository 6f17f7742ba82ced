//! Running a trace: each event through validator and device, as a scenario's calls are.

use std::collections::BTreeSet;
use std::fmt;

use omm_device::Device;
use omm_model::call::Output;
use omm_model::vk;
use omm_serialize::trace::{Event, Trace};
use omm_validate::{Report, RuleId, Validator};
use serde::Serialize;

use crate::limits;
use crate::objects::Objects;
use crate::transcript::{CallRecord, Outcome};

/// What came of an event.
pub(crate) enum Done {
    /// A call was looked at and executed, or stopped the device.
    Call(Report, Outcome),
    /// Memory was allocated or written.
    Memory,
    /// The application reaches for memory that is not there, or not where the trace says.
    Fault(String),
}

impl Done {
    /// Whether the device stops here. A call that it merely does not simulate is passed over.
    pub(crate) fn is_stop(&self) -> bool {
        match self {
            Self::Call(_, Outcome::Undefined(undefined)) => !undefined.is_unsupported(),
            Self::Call(..) | Self::Memory => false,
            Self::Fault(_) => true,
        }
    }
}

/// Takes the events through a new validator and a new device, up to the one at which the device stops.
pub(crate) fn play(trace: &Trace, mut seen: impl FnMut(&Event, Done)) {
    let mut device = Device::with_heap_size(trace.profile.clone(), limits::HEAP);
    let mut validator = Validator::new(trace.profile.clone());
    for event in &trace.events {
        let done = one(&mut device, &mut validator, event);
        let stop = done.is_stop();
        seen(event, done);
        if stop {
            break;
        }
    }
}

fn one(device: &mut Device, validator: &mut Validator, event: &Event) -> Done {
    let fault = match event {
        Event::Call(call) => {
            let report = validator.check(call, device);
            let outcome = match device.execute(call) {
                Ok(output) => {
                    validator.track(call, &output);
                    Outcome::Output(output)
                }
                Err(undefined) => {
                    // What has a meaning and is only not simulated is there for the validator.
                    if undefined.is_unsupported() {
                        validator.track(call, &Output::None);
                    }
                    Outcome::Undefined(Box::new(undefined))
                }
            };
            return Done::Call(report, outcome);
        }
        Event::Write { address, bytes } => {
            validator.track_write(vk::DeviceAddressRange { address: *address, size: bytes.len() as u64 });
            device.write(*address, bytes).err().map(|error| error.to_string())
        }
        Event::WriteHost { address, bytes } => device.write_host(*address, bytes).err().map(|error| error.to_string()),
        Event::AllocateHost { address, size } => match device.allocate_host(*size) {
            Some(found) if found == *address => None,
            Some(found) => Some(format!("host memory lies at {:#x}, not at {:#x}", found.0, address.0)),
            None => Some(format!("there are no {size} bytes of host memory")),
        },
    };
    fault.map_or(Done::Memory, Done::Fault)
}

/// The record of a trace's run.
///
/// [`Display`](fmt::Display) writes each event with its number, what the validator reported below it and what the device made of
/// it. `Serialize` writes the same for programs:
///
/// `{"profile", "events": [{"command", "summary", "reports": [{"vuid", "path", "found", "required"}], "outcome", "undefined"}],
/// "reported", "stopped", "not_executed"}`
#[derive(Clone, Debug, Serialize)]
pub struct Replay {
    profile: String,
    events: Vec<CallRecord>,
    reported: Vec<RuleId>,
    stopped: bool,
    not_executed: usize,
}

/// Runs a trace: takes its events through validator and simulated device, up to the one at which the device stops because it
/// leaves its behaviour undefined.
///
/// The same trace gives the same record on every machine. Device addresses follow from the buffers created before, so a trace
/// that was recorded elsewhere needs the addresses of this device in it.
#[must_use]
pub fn replay(trace: &Trace) -> Replay {
    let (mut events, mut reported, mut stopped) = (Vec::new(), BTreeSet::new(), false);
    let objects = Objects::default();
    play(trace, |event, done| {
        stopped = done.is_stop();
        events.push(match (event, &done) {
            (Event::Call(call), Done::Call(report, outcome)) => {
                reported.extend(report.iter().map(|violation| violation.rule));
                let record = CallRecord::new(call, true, report, outcome, &objects);
                CallRecord { is_undefined: stopped, ..record }
            }
            (event, Done::Fault(fault)) => memory_record(event, Some(fault.clone())),
            (event, _) => memory_record(event, None),
        });
    });
    Replay {
        profile: trace.profile.name.clone(),
        not_executed: trace.events.len() - events.len(),
        events,
        reported: reported.into_iter().collect(),
        stopped,
    }
}

/// The record of an event that is no call.
fn memory_record(event: &Event, fault: Option<String>) -> CallRecord {
    let (command, summary) = match event {
        Event::Call(call) => (call.command(), String::new()),
        Event::Write { address, bytes } => ("write", format!("{} bytes to {:#x}", bytes.len(), address.0)),
        Event::AllocateHost { address, size } => ("allocate host memory", format!("{size} bytes at {:#x}", address.0)),
        Event::WriteHost { address, bytes } => {
            ("write host memory", format!("{} bytes to {:#x}", bytes.len(), address.0))
        }
    };
    let is_undefined = fault.is_some();
    CallRecord { command, summary, is_main: true, findings: Vec::new(), outcome: fault, is_undefined, output: None }
}

impl Replay {
    /// The rules that were reported, in the catalog's order.
    #[must_use]
    pub fn reported(&self) -> &[RuleId] {
        &self.reported
    }

    /// Whether the device stopped.
    #[must_use]
    pub const fn stopped(&self) -> bool {
        self.stopped
    }

    /// Whether nothing was reported and the device came to the end.
    #[must_use]
    pub const fn is_clean(&self) -> bool {
        self.reported.is_empty() && !self.stopped
    }
}

impl fmt::Display for Replay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "on {}\n", self.profile)?;
        for (number, event) in self.events.iter().enumerate() {
            writeln!(f, "{number:>5}  {}", event.head())?;
            event.fmt_details(f, 9)?;
        }
        let reports: usize = self.events.iter().map(|event| event.findings.len()).sum();
        writeln!(f, "\n{} events, {reports} reports", self.events.len())?;
        if self.stopped {
            writeln!(f, "the device stopped; {} events after that were not executed", self.not_executed)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
