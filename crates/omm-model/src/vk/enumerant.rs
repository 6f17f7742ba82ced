//! The two tables that every enumerated and every flag type of this module is written with.

use std::fmt;

/// Names of constants beside their values, in the order of declaration.
pub(super) type Table = &'static [(&'static str, i64)];

/// The first name that a table gives to a value.
pub(super) fn first_name(table: Table, value: i64) -> Option<&'static str> {
    table.iter().find(|(_, found)| *found == value).map(|(name, _)| *name)
}

/// Writes the name of a constant, or the type around the number where the number has no name.
pub(super) fn fmt_constant(f: &mut fmt::Formatter<'_>, type_name: &str, table: Table, value: i64) -> fmt::Result {
    match first_name(table, value) {
        Some(name) => f.write_str(name),
        None => write!(f, "{type_name}({value})"),
    }
}

/// Declares an open enumeration: a newtype around `i32` with one associated constant per enumerant.
///
/// Behind each value stand the names that `vk.xml` has for it, the canonical one first.
macro_rules! open_enum {
    (
        $(#[$meta:meta])*
        pub struct $type:ident {
            $(
                $(#[$constant_meta:meta])*
                $constant:ident = $value:expr, $canonical:literal $(, $alias:literal)*;
            )*
        }
    ) => {
        $(#[$meta])*
        ///
        /// Any `i32` can be held, because an application can pass any; the constants are the values that have a meaning.
        #[derive(Clone, Copy, Default, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
        pub struct $type(pub i32);

        impl $type {
            $(
                $(#[$constant_meta])*
                #[doc(alias = $canonical)]
                $(#[doc(alias = $alias)])*
                pub const $constant: Self = Self($value);
            )*

            /// Every Vulkan name of a value of this type with that value; the names of one value stand together, the
            /// canonical one first.
            pub const NAMES: &'static [(&'static str, i64)] =
                &[$(($canonical, $value), $(($alias, $value),)*)*];

            const CONSTANTS: $crate::vk::enumerant::Table = &[$((stringify!($constant), $value),)*];

            /// The canonical Vulkan name of this value, if it has one.
            pub fn name(self) -> Option<&'static str> {
                $crate::vk::enumerant::first_name(Self::NAMES, i64::from(self.0))
            }
        }

        impl std::fmt::Debug for $type {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                $crate::vk::enumerant::fmt_constant(f, stringify!($type), Self::CONSTANTS, i64::from(self.0))
            }
        }
    };
}

/// Declares a set of flags that keeps bits it has no name for.
///
/// Behind each bit stand the names that `vk.xml` has for it, the canonical one first.
macro_rules! open_flags {
    (
        $(#[$meta:meta])*
        pub struct $type:ident: $bits:ty {
            $(
                $(#[$attribute:ident $($argument:tt)*])*
                $constant:ident = $value:expr, $canonical:literal $(, $alias:literal)*;
            )*
        }
    ) => {
        bitflags::bitflags! {
            $(#[$meta])*
            ///
            /// Bits without a constant are kept, because an application can set any.
            #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
            pub struct $type: $bits {
                $(
                    $(#[$attribute $($argument)*])*
                    #[doc(alias = $canonical)]
                    $(#[doc(alias = $alias)])*
                    const $constant = $value;
                )*
                const _ = !0;
            }
        }

        impl $type {
            /// Every Vulkan name of a bit of this type with that bit; the names of one bit stand together, the canonical
            /// one first.
            pub const NAMES: &'static [(&'static str, i64)] =
                &[$(($canonical, $value), $(($alias, $value),)*)*];
        }
    };
}

pub(super) use {open_enum, open_flags};

#[cfg(test)]
mod tests {
    use crate::vk::{GeometryFlags, OpacityMicromapFormat, OpacityMicromapSpecialIndex};

    #[test]
    fn a_value_shows_the_name_of_its_constant_or_its_number() {
        assert_eq!(format!("{:?}", OpacityMicromapFormat::FOUR_STATE), "FOUR_STATE");
        assert_eq!(format!("{:?}", OpacityMicromapFormat(7)), "OpacityMicromapFormat(7)");
        assert_eq!(format!("{:?}", OpacityMicromapSpecialIndex(-9)), "OpacityMicromapSpecialIndex(-9)");
    }

    #[test]
    fn the_canonical_name_is_not_an_alias() {
        let name = OpacityMicromapFormat::TWO_STATE.name();
        assert_eq!(name, Some("VK_OPACITY_MICROMAP_FORMAT_2_STATE_KHR"));
        assert_eq!(OpacityMicromapFormat(0).name(), None);
    }

    #[test]
    fn flags_keep_bits_that_have_no_name() {
        let flags = GeometryFlags::from_bits_retain(0x8000_0001);
        assert!(flags.contains(GeometryFlags::OPAQUE));
        let text = serde_json::to_string(&flags).unwrap();
        assert_eq!(text, "\"OPAQUE | 0x80000000\"");
        assert_eq!(serde_json::from_str::<GeometryFlags>(&text).unwrap(), flags);
    }
}
