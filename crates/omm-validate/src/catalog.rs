//! The ledger of rules: what each one is about and what we do about it.
//!
//! One file holds the rows of one structure or command, under the name that its checks have in the rooms of rules.

mod build_command;
mod build_host;
mod build_indirect;
mod build_info;
mod build_micromaps;
mod build_sizes;
mod cmd_build_micromaps;
mod cmd_copy_micromap;
mod cmd_micromap_properties;
mod copy;
mod copy_micromap;
mod create_2;
mod create_info;
mod create_info_2;
mod deferred_operation;
mod geometry;
mod instance;
mod micromap_build_info;
mod micromap_compatibility;
mod micromap_copy_info;
mod micromap_create_info;
mod micromap_data;
mod micromap_object;
mod micromap_properties;
mod micromap_sizes;
mod own;
mod physical_device;
mod physical_device_ext;
mod triangles_opacity_micromap;
mod triangles_opacity_micromap_ext;

use serde::Serialize;

use crate::rule::RuleId;

/// One rule's row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Rule {
    /// The rule.
    pub id: RuleId,
    /// The extension or part of the API that it belongs to.
    pub group: Group,
    /// Who wrote it.
    pub kind: Kind,
    /// What we do about it.
    pub status: Status,
    /// What goes wrong when it is broken, and how to mend it. Part of every message.
    pub explanation: &'static str,
    /// How we read the rule where its text is doubtful, and when and how far we look where that is not obvious; empty where there
    /// is nothing to say.
    pub note: &'static str,
}

impl Rule {
    const fn checked(group: Group, id: RuleId, explanation: &'static str) -> Self {
        Self { id, group, kind: Kind::Explicit, status: Status::Checked, explanation, note: "" }
    }

    const fn implicit(mut self) -> Self {
        self.kind = Kind::Implicit;
        self
    }

    const fn structural(mut self, reason: &'static str) -> Self {
        self.status = Status::Structural { reason };
        self
    }

    const fn noted(mut self, note: &'static str) -> Self {
        self.note = note;
        self
    }

    /// The identifier that the specification gives to the rule.
    #[must_use]
    pub const fn vuid(&self) -> &'static str {
        self.id.vuid()
    }

    /// Whether the rule is one of those that the catalog promises to hold without a gap: those of both micromap extensions, of
    /// deferred operations and of acceleration structures on ranges of addresses, and those of `VK_KHR_acceleration_structure`
    /// that speak of micromaps. The others are here because something in scope depends on them, or are our own.
    #[must_use]
    pub const fn is_in_scope(&self) -> bool {
        !matches!(self.kind, Kind::Own) && !matches!(self.id, RuleId::Type03654 | RuleId::Flags03796)
    }

    /// Whether the rule is one of last resort: a general one, looked at only where no other has anything to say of the call.
    #[must_use]
    pub fn is_last_resort(&self) -> bool {
        self.kind == Kind::Own && self.id >= RuleId::Buffer01
    }

    /// The structure or command that the rule belongs to.
    #[must_use]
    pub fn object(&self) -> &'static str {
        self.id.object()
    }
}

/// A part of the API.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Group {
    /// `VK_KHR_opacity_micromap`.
    KhrOpacityMicromap,
    /// `VK_KHR_acceleration_structure`.
    KhrAccelerationStructure,
    /// `VK_EXT_opacity_micromap`.
    ExtOpacityMicromap,
    /// Acceleration structures created on ranges of addresses, a part of `VK_KHR_device_address_commands`.
    #[serde(rename = "create_acceleration_structure_2")]
    CreateAccelerationStructure2,
    /// `VK_KHR_deferred_host_operations`.
    DeferredHostOperations,
}

impl Group {
    /// The part's name in lists of rules, such as `khr_opacity_micromap`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::KhrOpacityMicromap => "khr_opacity_micromap",
            Self::KhrAccelerationStructure => "khr_acceleration_structure",
            Self::ExtOpacityMicromap => "ext_opacity_micromap",
            Self::CreateAccelerationStructure2 => "create_acceleration_structure_2",
            Self::DeferredHostOperations => "deferred_host_operations",
        }
    }
}

/// Who wrote a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Kind {
    /// The authors of the extension.
    Explicit,
    /// Nobody: it follows from the registry's description of the structure or command, as do thousands of its kind.
    Implicit,
    /// We: the specification says it in words, without an identifier.
    Own,
}

impl Kind {
    /// The kind's name in lists of rules.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Explicit => "explicit",
            Self::Implicit => "implicit",
            Self::Own => "own",
        }
    }
}

/// What we do about a rule.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Status {
    /// A function checks it.
    Checked,
    /// It cannot be broken in our [vocabulary](omm_model::call::Call) of calls.
    Structural {
        /// Why not.
        reason: &'static str,
    },
}

impl Status {
    /// The status as a word: `checked` or `structural`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Checked => "checked",
            Self::Structural { .. } => "structural",
        }
    }

    /// Why the rule cannot be broken, where it cannot.
    #[must_use]
    pub const fn reason(self) -> Option<&'static str> {
        match self {
            Self::Checked => None,
            Self::Structural { reason } => Some(reason),
        }
    }
}

const TABLES: [&[Rule]; 30] = [
    build_command::ROWS,
    build_host::ROWS,
    build_indirect::ROWS,
    build_info::ROWS,
    build_micromaps::ROWS,
    build_sizes::ROWS,
    cmd_build_micromaps::ROWS,
    cmd_copy_micromap::ROWS,
    cmd_micromap_properties::ROWS,
    copy::ROWS,
    copy_micromap::ROWS,
    create_2::ROWS,
    create_info::ROWS,
    create_info_2::ROWS,
    deferred_operation::ROWS,
    geometry::ROWS,
    instance::ROWS,
    micromap_build_info::ROWS,
    micromap_compatibility::ROWS,
    micromap_copy_info::ROWS,
    micromap_create_info::ROWS,
    micromap_data::ROWS,
    micromap_object::ROWS,
    micromap_properties::ROWS,
    micromap_sizes::ROWS,
    own::ROWS,
    physical_device::ROWS,
    physical_device_ext::ROWS,
    triangles_opacity_micromap::ROWS,
    triangles_opacity_micromap_ext::ROWS,
];

/// Every rule, structure by structure.
pub const RULES: &[Rule] = &joined::<{ count() }>();

const fn count() -> usize {
    let (mut count, mut table) = (0, 0);
    while table < TABLES.len() {
        count += TABLES[table].len();
        table += 1;
    }
    count
}

/// The rows of all tables; evaluated when the crate is compiled.
const fn joined<const COUNT: usize>() -> [Rule; COUNT] {
    let mut rows = [TABLES[0][0]; COUNT];
    let (mut at, mut table) = (0, 0);
    while table < TABLES.len() {
        let mut row = 0;
        while row < TABLES[table].len() {
            rows[at] = TABLES[table][row];
            at += 1;
            row += 1;
        }
        table += 1;
    }
    rows
}

#[cfg(test)]
mod tests;
