//! The validator: rules over calls, and what earlier calls left behind.

use omm_model::call::{Call, Output};
use omm_model::memory::MemoryView;
use omm_model::profile::DeviceProfile;
use omm_model::vk;

use crate::context::micromap_ext::each_micromap_build;
use crate::context::{command_at, each_build};
use crate::report::Report;
use crate::state::{Age, State};
use crate::{content, implicit, own, stateless, tracked};

/// Checks the calls of one device against the rules of valid usage.
///
/// For each call, in the order of the program: [`check`](Self::check) it before it is carried out, then [`track`](Self::track) it
/// with what it returned. A call that is only checked leaves no trace; one that is only tracked is not judged.
#[derive(Clone, Debug)]
pub struct Validator {
    profile: DeviceProfile,
    state: State,
}

impl Validator {
    /// A validator for a device of these limits and features, on which nothing was created yet.
    #[must_use]
    pub fn new(profile: DeviceProfile) -> Self {
        let state = State::new(&profile);
        Self { profile, state }
    }

    /// The device's limits and features.
    #[must_use]
    pub const fn profile(&self) -> &DeviceProfile {
        &self.profile
    }

    /// What the calls tracked so far have made.
    #[must_use]
    pub const fn state(&self) -> &State {
        &self.state
    }

    /// The rules that `call` breaks, given what was tracked before.
    ///
    /// Rules on contents look at `memory` as it is now. For a command that is recorded this is the moment of recording: fill
    /// buffers before you record builds that read them, or check the call again when it is submitted. Memory that cannot be read
    /// is passed over without a word; with [`NoMemory`](omm_model::memory::NoMemory) no rule on contents is checked.
    ///
    /// Any call can be checked, however wrong; where nothing is wrong nothing is allocated. A submission is different: it is
    /// judged on a copy of what was tracked, on which its commands are carried out.
    #[must_use]
    pub fn check(&self, call: &Call, memory: &dyn MemoryView) -> Report {
        let mut report = Report::default();
        let (limits, features) = (&self.profile.limits, self.state.features_for(call));
        stateless::check_call(call, &command_at(call), features, &mut report);
        each_build(call, limits, features, |build| stateless::check_build(build, &mut report));
        each_micromap_build(call, limits, |build| stateless::check_micromap_build(build, &mut report));
        tracked::check_call(call, &command_at(call), &self.state, &mut report);
        each_build(call, limits, features, |build| tracked::check_build(build, &self.state, &mut report));
        each_micromap_build(call, limits, |build| tracked::check_micromap_build(build, &self.state, &mut report));
        each_build(call, limits, features, |build| {
            content::check_build(build, &self.state, memory, &mut report);
        });
        each_micromap_build(call, limits, |build| {
            content::check_micromap_build(build, &self.state, memory, &mut report);
        });
        content::check_call(call, &command_at(call), &self.state, memory, &mut report);
        self.state.each_executed(call, &mut |state, executed| {
            tracked::check_executed(executed, state, &mut report);
            content::check_executed(executed, state, memory, &mut report);
        });
        implicit::check(call, &self.state, &mut report);
        if report.is_empty() {
            own::check(call, &self.state, &mut report);
        }
        if report.is_empty() {
            self.check_again(call, memory, &mut report);
        }
        report
    }

    /// Looks at what `call` causes to execute with the state and the memory that it finds now.
    ///
    /// What was recorded was checked when it was recorded. If nothing has changed since, what was found then is found again, and is
    /// not told twice.
    fn check_again(&self, call: &Call, memory: &dyn MemoryView, report: &mut Report) {
        self.state.each_execution(call, &mut |state, executed, age| {
            if !report.is_empty() {
                return;
            }
            if age != Age::New {
                let mut again = Report::default();
                self.check_recorded(executed, state, memory, &mut again);
                if !again.is_empty() {
                    if age == Age::Changed {
                        *report = again;
                    }
                    return;
                }
            }
            own::check_executed(executed, state, memory, report);
        });
    }

    /// All that can be said of a recorded command but for where it is recorded.
    fn check_recorded(&self, call: &Call, state: &State, memory: &dyn MemoryView, report: &mut Report) {
        let (limits, features, command) = (&self.profile.limits, state.features_for(call), &command_at(call));
        stateless::check_call(call, command, features, report);
        tracked::check_call(call, command, state, report);
        each_build(call, limits, features, |build| {
            stateless::check_build(build, report);
            tracked::check_build(build, state, report);
            content::check_build(build, state, memory, report);
        });
        each_micromap_build(call, limits, |build| {
            stateless::check_micromap_build(build, report);
            tracked::check_micromap_build(build, state, report);
            content::check_micromap_build(build, state, memory, report);
        });
        if !state.was_just_written() {
            content::check_call(call, command, state, memory, report);
        }
        implicit::check_values(call, state, report);
    }

    /// Records that the program wrote memory through its mapping. Whatever was built there is gone, and what was recorded is looked
    /// at again when it is submitted.
    pub fn track_write(&mut self, range: vk::DeviceAddressRange) {
        self.state.written(range);
    }

    /// Records what `call` did, given what it returned.
    ///
    /// A command that returned an error did nothing. What a command buffer holds takes effect when it is submitted; within the
    /// command buffer, later commands see it already.
    pub fn track(&mut self, call: &Call, output: &Output) {
        self.state.track(call, output);
    }

    /// Checks `call` and records what it did: for programs that look at a call after it returned.
    pub fn check_and_track(&mut self, call: &Call, output: &Output, memory: &dyn MemoryView) -> Report {
        let report = self.check(call, memory);
        self.track(call, output);
        report
    }
}
