//! An observer that holds every call of an application against the rules.

use omm_device::app::Observer;
use omm_model::call::{Call, Output};
use omm_model::memory::MemoryView;
use omm_model::profile::DeviceProfile;
use omm_validate::{Validator, Violation};

/// Looks at every call with the validator.
pub(crate) struct Watch {
    validator: Validator,
    /// API calls seen.
    pub(crate) calls: u64,
    /// What the validator found.
    pub(crate) violations: Vec<Violation>,
}

impl Watch {
    /// Rules for a device of that profile.
    pub(crate) fn new(profile: DeviceProfile) -> Self {
        Self { validator: Validator::new(profile), calls: 0, violations: Vec::new() }
    }
}

impl Observer for Watch {
    fn before(&mut self, call: &Call, memory: &dyn MemoryView) {
        self.calls += 1;
        self.violations.extend(self.validator.check(call, memory));
    }

    fn after(&mut self, call: &Call, output: &Output) {
        self.validator.track(call, output);
    }
}
