//! Which objects live, and whose they are.

use std::sync::Arc;

use omm_model::vk;

use super::State;
use crate::location::Object;

/// What is known of a handle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Liveness {
    /// Its object was created and not destroyed.
    Live,
    /// Its object was destroyed.
    Destroyed,
    /// No creation of it was seen, although that of another object of the kind was.
    NeverCreated,
    /// No creation of any object of the kind was seen: nothing can be said.
    Unknown,
}

impl Liveness {
    /// Whether the handle is known to name no object.
    #[must_use]
    pub const fn is_invalid(self) -> bool {
        matches!(self, Self::Destroyed | Self::NeverCreated)
    }
}

/// What is kept of every object.
#[derive(Clone, Copy, Debug)]
pub(super) struct ObjectState {
    device: Option<vk::Device>,
    destroyed: bool,
}

impl ObjectState {
    pub(super) const fn device(&self) -> Option<vk::Device> {
        self.device
    }
}

impl State {
    /// Whether a handle of that kind names an object.
    #[must_use]
    pub fn liveness(&self, object: Object) -> Liveness {
        match self.objects.get(&object) {
            Some(ObjectState { destroyed: false, .. }) => Liveness::Live,
            Some(_) => Liveness::Destroyed,
            None if self.seen.contains(&object.0) => Liveness::NeverCreated,
            None => Liveness::Unknown,
        }
    }

    /// The device that a living object was created on; `None` if the object is not known to live.
    #[must_use]
    pub fn parent(&self, object: Object) -> Option<vk::Device> {
        self.objects.get(&object).filter(|state| !state.destroyed)?.device
    }

    pub(super) fn created(&mut self, object: Object, device: Option<vk::Device>) {
        self.seen.insert(object.0);
        Arc::make_mut(&mut self.objects).insert(object, ObjectState { device, destroyed: false });
    }

    pub(super) fn destroyed(&mut self, object: Object) {
        if let Some(state) = Arc::make_mut(&mut self.objects).get_mut(&object) {
            state.destroyed = true;
        }
        self.invalidate(object);
    }

    /// A device that a call names, though its creation was not seen, lives: also once another one is created.
    pub(super) fn adopt_device(&mut self, device: vk::Device) {
        let object = (vk::Device::OBJECT_TYPE, device.0);
        if !device.is_null() && self.liveness(object) == Liveness::Unknown {
            Arc::make_mut(&mut self.objects).insert(object, ObjectState { device: None, destroyed: false });
        }
    }
}
