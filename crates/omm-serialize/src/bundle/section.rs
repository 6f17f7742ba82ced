//! Sections: a kind, the micromap that they belong to, a checksum and bytes.

use super::{Checksums, MAGIC};
use crate::codec::{self, Input};
use crate::{ReadError, ReadErrorKind};

/// Where the number of sections stands.
pub(super) const COUNT_AT: u64 = 12;

/// What a section holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SectionKind {
    /// 1: the micromap's name, UTF-8.
    Name,
    /// 2: packed elements.
    Array,
    /// 3: triangles, 8 bytes each.
    Triangles,
    /// 4: indices, 4 bytes each.
    Indices,
    /// 5: usage counts, 12 bytes each.
    UsageCounts,
    /// 6: index usage counts, 12 bytes each.
    IndexUsageCounts,
    /// 7: how it was baked, UTF-8.
    Settings,
    /// 8: what it was baked from.
    Sources,
    /// 9: what was counted, UTF-8.
    Statistics,
}

impl SectionKind {
    /// All kinds in the order of their numbers, which is their order in a file.
    pub const ALL: [Self; 9] = [
        Self::Name,
        Self::Array,
        Self::Triangles,
        Self::Indices,
        Self::UsageCounts,
        Self::IndexUsageCounts,
        Self::Settings,
        Self::Sources,
        Self::Statistics,
    ];

    /// The number in the file.
    #[must_use]
    pub const fn value(self) -> u32 {
        match self {
            Self::Name => 1,
            Self::Array => 2,
            Self::Triangles => 3,
            Self::Indices => 4,
            Self::UsageCounts => 5,
            Self::IndexUsageCounts => 6,
            Self::Settings => 7,
            Self::Sources => 8,
            Self::Statistics => 9,
        }
    }

    /// The name in errors and lists.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Name => "name",
            Self::Array => "array",
            Self::Triangles => "triangles",
            Self::Indices => "indices",
            Self::UsageCounts => "usage_counts",
            Self::IndexUsageCounts => "index_usage_counts",
            Self::Settings => "settings",
            Self::Sources => "sources",
            Self::Statistics => "statistics",
        }
    }
}

/// The contents of a section, and where they lie in the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contents<'a> {
    kind: SectionKind,
    pub(super) bytes: &'a [u8],
    pub(super) offset: u64,
}

/// The checksum of a section.
pub(super) fn checksum(kind: u32, micromap: u32, contents: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&kind.to_le_bytes());
    hasher.update(&micromap.to_le_bytes());
    hasher.update(contents);
    hasher.finalize()
}

/// Reads magic, version and the number of sections.
pub(super) fn read_start(input: &mut Input<'_>) -> Result<u64, ReadError> {
    input.start(MAGIC)?;
    input.u64("sections")
}

/// Reads the next section, which must be that one.
pub(super) fn read<'a>(
    input: &mut Input<'a>,
    kind: SectionKind,
    micromap: u64,
    checksums: Checksums,
) -> Result<Contents<'a>, ReadError> {
    let mut read = || {
        let at = input.position();
        let found = input.u32("kind")?;
        equal("kind", at, found.into(), kind.value().into())?;
        let owner = input.u32("micromap")?;
        equal("micromap", at + 4, owner.into(), micromap)?;
        let claimed = input.u32("checksum")?;
        let bytes = input.bytes("contents")?;
        if checksums == Checksums::Verify {
            equal("checksum", at + 8, claimed.into(), checksum(found, owner, bytes).into())?;
        }
        Ok(Contents { kind, bytes, offset: at + 20 })
    };
    read().map_err(|error: ReadError| error.within(kind.name()))
}

fn equal(field: &'static str, offset: u64, found: u64, required: u64) -> Result<(), ReadError> {
    if found == required {
        return Ok(());
    }
    Err(ReadError { field: field.into(), offset, kind: ReadErrorKind::NotEqual { found, required } })
}

impl<'a> Contents<'a> {
    fn error(&self, offset: u64, kind: ReadErrorKind) -> ReadError {
        ReadError { field: self.kind.name().into(), offset: self.offset.saturating_add(offset), kind }
    }

    /// The contents as text.
    pub(super) fn text(&self) -> Result<&'a str, ReadError> {
        std::str::from_utf8(self.bytes).map_err(|error| {
            let at = error.valid_up_to();
            let found = self.bytes.get(at).copied().unwrap_or_default().into();
            self.error(at as u64, ReadErrorKind::Unknown { found, required: "UTF-8" })
        })
    }

    /// The contents as records of `N` bytes, nothing left over.
    pub(super) fn records<const N: usize>(&self) -> Result<&'a [[u8; N]], ReadError> {
        match self.bytes.as_chunks() {
            (records, []) => Ok(records),
            _ => {
                let (found, of) = (self.bytes.len() as u64, N as u64);
                // The length stands in the 8 bytes before the contents.
                Err(ReadError { offset: self.offset - 8, ..self.error(0, ReadErrorKind::NotAMultiple { found, of }) })
            }
        }
    }

    /// Proves that the contents are sources and nothing more.
    pub(super) fn check_sources(&self) -> Result<(), ReadError> {
        let check = || {
            let mut input = Input::new(self.bytes);
            for index in 0..input.u64("count")? {
                let source = codec::check_source(&mut input);
                source.map_err(|error: ReadError| error.within(format_args!("[{index}]")))?;
            }
            input.finish()
        };
        check().map_err(|error| error.within(self.kind.name()).moved_by(self.offset))
    }
}
