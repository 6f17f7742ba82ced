//! Bytes that cannot be read: which field, where, what was found and what was required.

use std::borrow::Cow;
use std::fmt;

/// Bytes that do not hold what they should.
///
/// It tells *truncated* input (a later chunk may make it good) from *malformed* input (nothing appended will help): see
/// [`is_truncated`](Self::is_truncated).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{field} at byte {offset}: {kind}")]
pub struct ReadError {
    /// The field, as a path: `geometries[2].primitive_count`.
    pub field: Cow<'static, str>,
    /// Bytes from the start of the outermost input to the field.
    pub offset: u64,
    /// What is wrong with it.
    pub kind: ReadErrorKind,
}

/// What is wrong with a field: the value found and what was required of it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReadErrorKind {
    /// The input ends too early.
    #[error("{required} bytes are needed, {available} are there")]
    Truncated {
        /// Bytes from the field's offset to the end of the input; 0 if the field begins behind it.
        available: u64,
        /// Bytes that the field takes.
        required: u64,
    },
    /// The first bytes are not those of the format, or of another version of it.
    #[error("found \"{}\", required \"{}\"", .found.escape_ascii(), .required.escape_ascii())]
    Magic {
        /// The bytes found.
        found: [u8; 8],
        /// The bytes required.
        required: [u8; 8],
    },
    /// Only one value is right.
    #[error("found {found}, required {required}")]
    NotEqual {
        /// The value found.
        found: u64,
        /// The value required.
        required: u64,
    },
    /// The value is too large.
    #[error("found {found}, required at most {limit}")]
    Above {
        /// The value found.
        found: u64,
        /// The largest that would do.
        limit: u64,
    },
    /// The value is too small.
    #[error("found {found}, required at least {least}")]
    Below {
        /// The value found.
        found: u64,
        /// The smallest that would do.
        least: u64,
    },
    /// The value is no multiple of what it must be a multiple of.
    #[error("found {found}, required a multiple of {of}")]
    NotAMultiple {
        /// The value found.
        found: u64,
        /// The required divisor.
        of: u64,
    },
    /// The value has no meaning.
    #[error("found {found}, required {required}")]
    Unknown {
        /// The value found.
        found: i64,
        /// The values that have one, in words.
        required: &'static str,
    },
    /// The numbers are right, but their most significant bytes come first.
    #[error("the data is big-endian, required little-endian, the order of the simulated device")]
    BigEndian,
}

impl ReadError {
    pub(crate) fn new(field: &'static str, offset: u64, kind: ReadErrorKind) -> Self {
        Self { field: Cow::Borrowed(field), offset, kind }
    }

    /// Whether the input merely ended too early, so that more bytes could help.
    #[must_use]
    pub const fn is_truncated(&self) -> bool {
        matches!(self.kind, ReadErrorKind::Truncated { .. })
    }

    /// The same error where the field lies inside `parent`: `count` becomes `blocks[1].count`.
    #[must_use]
    pub fn within(self, parent: impl fmt::Display) -> Self {
        Self { field: Cow::Owned(format!("{parent}.{}", self.field)), ..self }
    }

    /// The same error where the input read was itself found `base` bytes into an outer input.
    #[must_use]
    pub fn moved_by(self, base: u64) -> Self {
        Self { offset: self.offset.saturating_add(base), ..self }
    }
}

/// A value that its bytes have no room for.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{field}: {kind}")]
pub struct WriteError {
    /// The field, as a path: `instances[2].instance_custom_index`.
    pub field: Cow<'static, str>,
    /// What is wrong with it.
    pub kind: WriteErrorKind,
}

/// What is wrong with a value that was to be written.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum WriteErrorKind {
    /// The value is larger than the field can hold.
    #[error("found {found}, room for at most {limit}")]
    Above {
        /// The value found.
        found: u64,
        /// The largest that fits.
        limit: u64,
    },
    /// The value is too small.
    #[error("found {found}, required at least {least}")]
    Below {
        /// The value found.
        found: u64,
        /// The smallest that would do.
        least: u64,
    },
    /// Only one value is right, a size for example.
    #[error("found {found}, required {required}")]
    NotEqual {
        /// The value found.
        found: u64,
        /// The value required.
        required: u64,
    },
    /// The value means something else in this place: an index that reads as a special index, an unknown state in 2-state data.
    #[error("{found} cannot be told from {instead}")]
    Ambiguous {
        /// The value found.
        found: String,
        /// What a reader would take it for.
        instead: String,
    },
}

impl WriteError {
    pub(crate) fn new(field: impl Into<Cow<'static, str>>, kind: WriteErrorKind) -> Self {
        Self { field: field.into(), kind }
    }

    /// The same error where the field lies inside `parent`: `mask` becomes `instances[1].mask`.
    #[must_use]
    pub fn within(self, parent: impl fmt::Display) -> Self {
        Self { field: Cow::Owned(format!("{parent}.{}", self.field)), ..self }
    }
}

/// Requires a value to be at most `limit`.
pub(crate) fn fits(field: &'static str, found: u64, limit: u64) -> Result<(), WriteError> {
    if found <= limit { Ok(()) } else { Err(WriteError::new(field, WriteErrorKind::Above { found, limit })) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn says_where_and_what() {
        let error = ReadError::new("count", 8, ReadErrorKind::Above { found: 9, limit: 3 });
        let error = error.within(format_args!("blocks[{}]", 1)).moved_by(56);
        assert_eq!(error.to_string(), "blocks[1].count at byte 64: found 9, required at most 3");
        assert!(!error.is_truncated());
        let error = ReadError::new("magic", 0, ReadErrorKind::Truncated { available: 3, required: 8 });
        assert_eq!(error.to_string(), "magic at byte 0: 8 bytes are needed, 3 are there");
        assert!(error.is_truncated());
        let kind = ReadErrorKind::Magic { found: *b"\x7fELF....", required: *b"ommobj02" };
        assert_eq!(kind.to_string(), r#"found "\x7fELF....", required "ommobj02""#);
    }
}
