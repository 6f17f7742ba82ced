//! Deferred operations: host commands whose work the application's threads do by joining.

use std::collections::BTreeMap;
use std::sync::Mutex;

use omm_model::call::{Call, Output, Timeline};
use omm_model::vk;

use crate::device::Device;
use crate::undefined::{At, Reason, Stop, Undefined};
use crate::work::{Unit, Work, check};

mod join;

use join::{Joined, Lock, State, join};

/// A deferred operation and the command that was deferred on it last.
#[derive(Debug, Default)]
struct Operation {
    pending: Option<Pending>,
}

#[derive(Debug)]
struct Pending {
    call: Call,
    state: Mutex<State<Unit>>,
}

impl Operation {
    /// How many threads can do something useful; 0 if no command is pending.
    fn concurrency(&self) -> usize {
        self.pending.as_ref().map_or(0, |pending| pending.state.with(|state| state.concurrency()))
    }
}

/// All deferred operations of a device.
#[derive(Debug, Default)]
pub(crate) struct Operations {
    by_handle: BTreeMap<vk::DeferredOperation, Operation>,
}

impl Operations {
    fn get(&self, handle: vk::DeferredOperation) -> Result<&Operation, Reason> {
        let unknown = Reason::UnknownHandle { object: "deferred operation", handle: handle.0 };
        self.by_handle.get(&handle).ok_or(unknown)
    }

    /// The operation, if no command is pending on it.
    fn free(&self, handle: vk::DeferredOperation) -> Result<(), Reason> {
        match self.get(handle)?.concurrency() {
            0 => Ok(()),
            _ => Err(Reason::OperationPending { operation: handle.0 }),
        }
    }

    /// `vkCreateDeferredOperationKHR`.
    pub(crate) fn create(&mut self, handle: vk::DeferredOperation) -> Result<Output, Stop> {
        if handle.is_null() || self.by_handle.contains_key(&handle) {
            let why = Reason::HandleTaken { object: "deferred operation", handle: handle.0 };
            return Err(why).at("pDeferredOperation");
        }
        self.by_handle.insert(handle, Operation::default());
        Ok(Output::None)
    }

    /// `vkDestroyDeferredOperationKHR`.
    pub(crate) fn destroy(&mut self, handle: vk::DeferredOperation) -> Result<Output, Stop> {
        if !handle.is_null() {
            self.free(handle).at("operation")?;
            self.by_handle.remove(&handle);
        }
        Ok(Output::None)
    }

    /// `vkGetDeferredOperationMaxConcurrencyKHR`.
    pub(crate) fn max_concurrency(&self, handle: vk::DeferredOperation) -> Result<Output, Stop> {
        let found = self.get(handle).at("operation")?.concurrency();
        Ok(Output::MaxConcurrency(u32::try_from(found).unwrap_or(u32::MAX)))
    }

    /// `vkGetDeferredOperationResultKHR`.
    pub(crate) fn result(&self, handle: vk::DeferredOperation) -> Result<Output, Stop> {
        Ok(match self.get(handle).at("operation")?.concurrency() {
            0 => Output::None,
            _ => Output::Result(vk::Result::NOT_READY),
        })
    }

    /// Leaves a command to the threads that will join.
    fn defer(&mut self, handle: vk::DeferredOperation, call: &Call, units: usize) {
        let pending = Pending { call: call.clone(), state: Mutex::new(State::new(units)) };
        self.by_handle.insert(handle, Operation { pending: Some(pending) });
    }

    /// What completed commands have made and nobody has written.
    fn take_made(&mut self) -> Vec<Unit> {
        let mut made = Vec::new();
        for operation in self.by_handle.values_mut() {
            if let Some(pending) = &operation.pending
                && let Some(units) = pending.state.with(|state| match state {
                    State::Complete(units) => Some(std::mem::take(units)),
                    State::Units { .. } | State::Ending => None,
                })
            {
                made.extend(units);
                operation.pending = None;
            }
        }
        made
    }
}

impl Device {
    /// A host command that writes memory: at once, or on a deferred operation.
    pub(crate) fn host_work(&mut self, call: &Call, work: &Work<'_>) -> Result<Output, Stop> {
        let Some(operation) = call.deferred_operation() else {
            self.perform(work, Timeline::Host)?;
            return Ok(Output::None);
        };
        self.operations.free(operation).at("deferredOperation")?;
        work.check()?;
        let units = work.units();
        if units == 0 {
            return Ok(Output::Result(vk::Result::OPERATION_NOT_DEFERRED));
        }
        self.operations.defer(operation, call, units);
        Ok(Output::Result(vk::Result::OPERATION_DEFERRED))
    }

    /// Lends the calling thread to a deferred command, as [`Call::DeferredOperationJoin`] does; several threads may do so at once.
    ///
    /// What the command makes is in memory once it is complete and [`Device::settle`] or anything else that changes the device
    /// was called; a join by [`Device::execute`] does both.
    ///
    /// # Errors
    /// [`Undefined`] names the deferred command if that could not be executed. It stays pending, as if this thread had not joined.
    pub fn join(&self, operation: vk::DeferredOperation) -> Result<Output, Undefined> {
        let command = "vkDeferredOperationJoinKHR";
        let found = self.operations.get(operation).at("operation").map_err(|stop| stop.of(command))?;
        let Some(pending) = &found.pending else {
            return Ok(Output::None);
        };
        // Nothing but such a command is ever deferred.
        let Some(work) = Work::of(&pending.call) else {
            return Ok(Output::None);
        };
        let joined = join(&pending.state, |index| self.unit(&work, index, Timeline::Host), check);
        match joined.map_err(|stop| stop.of(pending.call.command()))? {
            Joined::Complete => Ok(Output::None),
            Joined::Idle => Ok(Output::Result(vk::Result::THREAD_IDLE)),
            Joined::Done => Ok(Output::Result(vk::Result::THREAD_DONE)),
        }
    }

    /// Puts into memory what deferred commands have made that are complete. [`Device::execute`] and [`Device::write`] begin with
    /// this, so only who reads memory right behind a [`Device::join`] has to ask for it.
    pub fn settle(&mut self) {
        for unit in self.operations.take_made() {
            // Where the memory is gone by now there is nothing to write to.
            let _ = self.memory.write(unit.address, &unit.bytes);
        }
    }
}
