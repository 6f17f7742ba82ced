//! Deferred operations.

use std::sync::Arc;

use omm_model::call::{Call, Output};
use omm_model::vk;

use super::State;

/// A deferred operation.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct DeferredOperationState {
    /// The command that was deferred on it and is not complete.
    pub pending: Option<Arc<Call>>,
    /// When it was deferred.
    pub(super) deferred_at: u64,
}

impl State {
    /// Whether a command that was deferred on the operation is not complete yet.
    #[must_use]
    pub fn is_pending(&self, operation: vk::DeferredOperation) -> bool {
        self.deferred_operation(operation).is_some_and(|operation| operation.pending.is_some())
    }

    /// A host command returned: it was deferred, or its work is done.
    pub(super) fn host_command(&mut self, call: &Call, output: &Output) {
        match (call.deferred_operation(), output) {
            (Some(operation), Output::Result(vk::Result::OPERATION_DEFERRED)) => {
                let pending = Some(Arc::new(call.clone()));
                self.operations.insert(operation, DeferredOperationState { pending, deferred_at: self.serial });
            }
            _ => self.execute(call),
        }
    }

    /// What is known of the deferred command after a join or a question for its result.
    pub(super) fn deferred_result(&mut self, operation: vk::DeferredOperation, output: &Output) {
        let still_running = [vk::Result::NOT_READY, vk::Result::THREAD_IDLE, vk::Result::THREAD_DONE];
        let complete = match output {
            Output::Result(result) => !still_running.contains(result),
            _ => true,
        };
        let state = self.operations.get_mut(&operation).filter(|_| complete);
        let Some(call) = state.and_then(|operation| operation.pending.take()) else { return };
        if !matches!(output, Output::Result(result) if result.is_error()) {
            self.execute(&call);
        }
    }
}
