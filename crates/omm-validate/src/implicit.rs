//! Rules that follow from the registry's description of structures and commands, and so come by the dozen: one check for each
//! kind of them, over [tables](table) that say where it applies.
//!
//! | check | looks at |
//! |---|---|
//! | `s_type` | the type that a structure claims to have |
//! | `chain` | what a `pNext` chain holds |
//! | `enumerant`, `flags` | whether a value has a meaning |
//! | `array` | whether an array is long enough |
//! | `handle` | whether an object lives |
//! | `parent` | whether objects are of one device |
//! | `recording` | whether a command may be recorded there |

mod array;
mod chain;
mod enumerant;
mod flags;
mod handle;
mod parent;
mod recording;
mod s_type;
mod table;
mod walk;

use omm_model::call::Call;
use omm_model::vk;

use crate::context::command_at;
use crate::report::Report;
use crate::state::State;
use walk::Item;

/// Checks all of a call.
pub(crate) fn check(call: &Call, state: &State, report: &mut Report) {
    let command = command_at(call);
    if let Some(row) = table::command::COMMANDS.iter().find(|row| row.name == call.command()) {
        handle::check_command(row, call, &command, state, report);
        parent::check_command(row, call, &command, state, report);
        recording::check(row, call, &command, state, report);
    }
    check_values(call, state, report);
}

/// Checks the values of a call: all but the command that it is.
pub(crate) fn check_values(call: &Call, state: &State, report: &mut Report) {
    let command = command_at(call);
    // With a device all that was created on it is gone, and one report is enough.
    let is_dead =
        |device: vk::Device| !device.is_null() && state.liveness((vk::Device::OBJECT_TYPE, device.0)).is_invalid();
    let has_device = !call.device().is_some_and(is_dead);
    walk::each_item(call, &command, &mut |at, owner, item| match item {
        Item::Structure { s_type, required, next } => {
            if let Some(row) = table::structure::STRUCTURES.iter().find(|row| row.name == owner) {
                s_type::check(row, at, s_type, required, report);
                chain::check(row, at, next, report);
            }
        }
        Item::Enumerant { member, value } => enumerant::check(owner, member, at, value, report),
        Item::Flags { member, found, known } => flags::check(owner, member, at, found, known, report),
        Item::Count { member, found } => array::check(owner, member, at, found, report),
        Item::Handle { member, object } if has_device => {
            handle::check(owner, member, at, object, state, report);
            parent::check(owner, member, at, object, call, state, report);
        }
        Item::Handle { .. } => {}
    });
    parent::check_common(call, &command, state, report);
}
