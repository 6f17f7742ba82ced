//! Where the contents of an object come from.

use std::fmt;

/// How an object got its contents, or why it has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Origin {
    /// There is no object.
    Nothing,
    /// It was created, and has no contents.
    NotBuilt,
    /// It was built.
    Built,
    /// It was built as something else than a micromap.
    NotMicromap,
    /// It was deserialized from what another object held.
    Other,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Nothing => "where no structure is",
            Self::NotBuilt => "which is not built",
            Self::Built => "which was built anew",
            Self::NotMicromap => "which is no micromap",
            Self::Other => "which was deserialized from the data of another",
        })
    }
}
