//! The permanent names of the rules.

use std::fmt;

use crate::catalog::{self, Rule};

// Each file hands its part of the table, behind that of the files before it, on to the next macro that is named.
#[macro_use]
mod khr_opacity_micromap;
#[macro_use]
mod khr_acceleration_structure;
#[macro_use]
mod create_acceleration_structure_2;
#[macro_use]
mod deferred_host_operations;
#[macro_use]
mod ext_objects;
#[macro_use]
mod ext_commands;
#[macro_use]
mod own;

macro_rules! rule_ids {
    (; $($id:ident = $vuid:literal;)*) => {
        /// A rule of the specification. A variant ends in the number that its identifier ends in, if that has one.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum RuleId {
            $(#[doc = concat!("`", $vuid, "`")] $id,)*
        }

        impl RuleId {
            /// Every rule.
            pub const ALL: &'static [Self] = &[$(Self::$id,)*];

            /// The identifier that the specification gives to the rule.
            #[must_use]
            pub const fn vuid(self) -> &'static str {
                match self {
                    $(Self::$id => $vuid,)*
                }
            }
        }
    };
}

khr_opacity_micromap_ids! { khr_acceleration_structure_ids create_acceleration_structure_2_ids deferred_host_operations_ids ext_objects_ids ext_commands_ids own_ids rule_ids; }

impl RuleId {
    /// The rule of that identifier, if it is one of ours.
    #[must_use]
    pub fn from_vuid(vuid: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|id| id.vuid() == vuid)
    }

    /// The structure or command that the rule belongs to.
    #[must_use]
    pub fn object(self) -> &'static str {
        match self {
            // The identifier names the opposite command; the rule stands with this one and is about it.
            Self::SrcAddress11700 => "vkCmdCopyMemoryToAccelerationStructureKHR",
            _ => self.vuid().split('-').nth(1).unwrap_or_default(),
        }
    }

    /// The rule's row in the catalog. Every rule has one.
    #[must_use]
    pub fn rule(self) -> Option<&'static Rule> {
        catalog::RULES.iter().find(|rule| rule.id == self)
    }

    /// What goes wrong when the rule is broken, and how to mend it.
    #[must_use]
    pub fn explanation(self) -> &'static str {
        self.rule().map_or("", |rule| rule.explanation)
    }

    /// The rule's place in the reference pages.
    #[must_use]
    pub fn url(self) -> String {
        let (object, vuid) = (self.object(), self.vuid());
        if vuid.starts_with("OMM-") {
            return "https://docs.vulkan.org/spec/latest/chapters/accelstructures.html".to_owned();
        }
        format!("https://docs.vulkan.org/refpages/latest/refpages/source/{object}.html#{vuid}")
    }
}

/// The identifier that the specification gives to the rule.
impl fmt::Display for RuleId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.vuid())
    }
}

impl serde::Serialize for RuleId {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.vuid())
    }
}
