//! Making a trace smaller until every part of it is needed for what is to be kept.

use std::collections::BTreeSet;
use std::mem::{Discriminant, discriminant};

use omm_device::Reason;
use omm_model::call::Call;
use omm_serialize::trace::{Event, Trace};
use omm_validate::RuleId;

use crate::replay::{Done, play};
use crate::transcript::Outcome;
use crate::tree::Tree;

mod shrink;

use shrink::{keep_elements, length_of_list, shrink};

/// Pieces in which bytes are looked at, at most.
const PIECES: usize = 256;

/// What a smaller trace must still do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keep {
    /// Break this rule.
    Rule(RuleId),
    /// Stop the device, at the same command and for the same kind of reason.
    Undefined,
}

/// How far a minimization has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MinimizeProgress {
    /// Events that are left.
    pub events: usize,
    /// Bytes that are left to be written into memory.
    pub bytes: usize,
    /// Traces that were tried so far.
    pub runs: u64,
}

/// Why a trace cannot be minimized.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MinimizeError {
    /// The trace does not do what is to be kept.
    #[error("the trace does not break {0}")]
    NotBroken(RuleId),
    /// Nothing is reported and the device does not stop.
    #[error("there is nothing to keep: the trace breaks no rule and the device does not stop")]
    Clean,
    /// The device does not stop.
    #[error("the device does not stop")]
    NotStopped,
}

/// What a trace does, as far as it matters here.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Verdict {
    reported: BTreeSet<RuleId>,
    /// The rule of the first report.
    first: Option<RuleId>,
    stop: Option<Stop>,
}

/// Where and why the device stopped; nothing but that it did where the application reached for memory that is not there.
type Stop = Option<(&'static str, Discriminant<Reason>)>;

fn judge(trace: &Trace) -> Verdict {
    let mut verdict = Verdict { reported: BTreeSet::new(), first: None, stop: None };
    play(trace, |_, done| {
        let stops = done.is_stop();
        let mut stop = None;
        if let Done::Call(report, outcome) = done {
            let rules = || report.iter().map(|violation| violation.rule);
            verdict.first = verdict.first.or_else(|| rules().next());
            verdict.reported.extend(rules());
            if let Outcome::Undefined(undefined) = outcome {
                stop = Some((undefined.command, discriminant(&undefined.why)));
            }
        }
        verdict.stop = stops.then_some(stop);
    });
    verdict
}

/// Makes a trace smaller, as long as it does what is to be kept, breaks no rule that it did not break before, and stops the device
/// only if it did before.
///
/// Without a wish, the rule of the first report is kept, or else the device's stop. Events go first, in large pieces and then one
/// by one; then elements of the lists that calls are given, and bytes that are written. What is left has no event and no element
/// that could go by itself. The same trace gives the same result on every machine.
///
/// A buffer's address follows from the sizes of the buffers created before it; these stay where an address matters.
///
/// # Errors
/// The trace does not do what is to be kept.
pub fn minimize(
    trace: &Trace,
    keep: Option<Keep>,
    progress: &mut dyn FnMut(MinimizeProgress),
) -> Result<Trace, MinimizeError> {
    let original = judge(trace);
    let keep = match (keep, original.first) {
        (Some(keep), _) => keep,
        (None, Some(rule)) => Keep::Rule(rule),
        (None, None) if original.stop.is_some() => Keep::Undefined,
        (None, None) => return Err(MinimizeError::Clean),
    };
    match keep {
        Keep::Rule(rule) if !original.reported.contains(&rule) => return Err(MinimizeError::NotBroken(rule)),
        Keep::Undefined if original.stop.is_none() => return Err(MinimizeError::NotStopped),
        _ => {}
    }
    let mut search = Search { trace: trace.clone(), keep, original, runs: 0, progress };
    loop {
        let events = search.events();
        let values = search.values();
        if !events && !values {
            return Ok(search.trace);
        }
    }
}

struct Search<'a> {
    trace: Trace,
    keep: Keep,
    original: Verdict,
    runs: u64,
    progress: &'a mut dyn FnMut(MinimizeProgress),
}

impl Search<'_> {
    /// Whether other events still do what is to be kept.
    fn still(&mut self, events: Vec<Event>) -> bool {
        let candidate = Trace { profile: self.trace.profile.clone(), events };
        self.runs += 1;
        let verdict = judge(&candidate);
        let kept = match self.keep {
            Keep::Rule(rule) => verdict.reported.contains(&rule),
            Keep::Undefined => verdict.stop == self.original.stop,
        };
        let nothing_new = verdict.reported.is_subset(&self.original.reported)
            && (verdict.stop.is_none() || verdict.stop == self.original.stop);
        if kept && nothing_new {
            self.trace = candidate;
            let bytes = self.trace.events.iter().map(written).sum();
            (self.progress)(MinimizeProgress { events: self.trace.events.len(), bytes, runs: self.runs });
        }
        kept && nothing_new
    }

    /// Whether another event in the place of one still does.
    fn still_with(&mut self, at: usize, event: Event) -> bool {
        let mut events = self.trace.events.clone();
        match events.get_mut(at) {
            Some(place) => *place = event,
            None => return false,
        }
        self.still(events)
    }

    /// Removes events. Tells whether any could go.
    fn events(&mut self) -> bool {
        let before = self.trace.events.len();
        shrink(self.trace.events.clone(), &mut |events| self.still(events.to_vec()));
        self.trace.events.len() < before
    }

    /// Removes elements from the lists of calls, and bytes from what is written. Tells whether any could go.
    fn values(&mut self) -> bool {
        let mut changed = false;
        for at in 0..self.trace.events.len() {
            changed |= match self.trace.events.get(at).cloned() {
                Some(Event::Call(call)) => self.call(at, &call),
                Some(Event::Write { address, bytes }) => {
                    self.bytes(at, bytes, &|bytes| Event::Write { address, bytes })
                }
                Some(Event::WriteHost { address, bytes }) => {
                    self.bytes(at, bytes, &|bytes| Event::WriteHost { address, bytes })
                }
                Some(Event::AllocateHost { .. }) | None => false,
            };
        }
        changed
    }

    /// Removes elements from the lists of a call: from all lists of one length together, as they often belong to each other, and
    /// from each alone.
    fn call(&mut self, at: usize, call: &Call) -> bool {
        let Ok(mut tree) = Tree::of(call) else { return false };
        let (mut changed, mut number) = (false, 0);
        while let Some(length) = length_of_list(&mut tree, number) {
            for together in [Some(length), None] {
                let shrunk = |kept: &[usize]| {
                    let mut candidate = tree.clone();
                    keep_elements(&mut candidate, number, together, kept);
                    candidate
                };
                let kept = shrink((0..length).collect(), &mut |kept| {
                    shrunk(kept).to::<Call>().is_ok_and(|call| self.still_with(at, call.into()))
                });
                if kept.len() < length {
                    changed = true;
                    tree = shrunk(&kept);
                    break;
                }
            }
            number += 1;
        }
        changed
    }

    /// Makes bytes zero that need not be anything else, and leaves out zeros at the end, which memory begins with.
    fn bytes(&mut self, at: usize, bytes: Vec<u8>, event: &dyn Fn(Vec<u8>) -> Event) -> bool {
        let positions: Vec<usize> = (0..bytes.len()).filter(|&at| bytes.get(at) != Some(&0)).collect();
        let with = |kept: &[&[usize]]| {
            let mut zeroed = vec![0; bytes.len()];
            for &position in kept.iter().copied().flatten() {
                if let (Some(target), Some(byte)) = (zeroed.get_mut(position), bytes.get(position)) {
                    *target = *byte;
                }
            }
            zeroed
        };
        let pieces: Vec<&[usize]> = positions.chunks(positions.len().div_ceil(PIECES).max(1)).collect();
        let kept = shrink(pieces.clone(), &mut |kept| self.still_with(at, event(with(kept))));
        let mut left = with(&kept);
        left.truncate(left.iter().rposition(|byte| *byte != 0).map_or(0, |last| last + 1));
        let shorter = left.len() < bytes.len() && self.still_with(at, event(left));
        shorter || kept.len() < pieces.len()
    }
}

/// Bytes that an event writes.
fn written(event: &Event) -> usize {
    match event {
        Event::Write { bytes, .. } | Event::WriteHost { bytes, .. } => bytes.len(),
        Event::Call(_) | Event::AllocateHost { .. } => 0,
    }
}

#[cfg(test)]
mod tests;
