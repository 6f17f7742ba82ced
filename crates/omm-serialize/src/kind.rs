//! What serialized data is, as far as it shows.
//!
//! The header has no field that tells. Handles are found in top-level structures only, and blocks in bottom-level ones only;
//! without either the data may be of any kind, unless the payload is ours and says so itself.

use omm_layout::object::{MAGIC, ObjectHeader, ObjectKind};
use serde::{Serialize, Serializer};

use crate::Blob;
use crate::blob::Count;

/// How sure a [`KindGuess`] is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Certainty {
    /// It follows from the format.
    Certain,
    /// It is what the data looks like.
    Likely,
    /// Every candidate is as good as another.
    Unknown,
}

/// The kinds that serialized data may be of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KindGuess {
    /// The kinds that the bytes allow, at least one; exactly one unless the certainty is unknown.
    pub candidates: &'static [ObjectKind],
    /// How sure it is.
    pub certainty: Certainty,
    /// What was decided by.
    pub why: &'static str,
}

impl KindGuess {
    /// The kind, if it is certain or likely.
    #[must_use]
    pub const fn kind(&self) -> Option<ObjectKind> {
        match self.candidates {
            [kind] => Some(*kind),
            _ => None,
        }
    }

    /// The kind's short name, or `unknown`.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self.kind() {
            Some(kind) => name(kind),
            None => "unknown",
        }
    }
}

/// The short name of a kind: `micromap`, `blas` or `tlas`.
#[must_use]
pub const fn name(kind: ObjectKind) -> &'static str {
    match kind {
        ObjectKind::Micromap => "micromap",
        ObjectKind::BottomLevel => "blas",
        ObjectKind::TopLevel => "tlas",
    }
}

/// Serialized as `name`, `certainty`, `why` and the names of all `candidates`.
impl Serialize for KindGuess {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        use serde::ser::SerializeStruct;
        let candidates: Vec<_> = self.candidates.iter().copied().map(name).collect();
        let mut fields = serializer.serialize_struct("KindGuess", 4)?;
        fields.serialize_field("name", self.name())?;
        fields.serialize_field("certainty", &self.certainty)?;
        fields.serialize_field("why", self.why)?;
        fields.serialize_field("candidates", &candidates)?;
        fields.end()
    }
}

impl Blob<'_> {
    /// What the data may be.
    #[must_use]
    pub fn kind(&self) -> KindGuess {
        let certain = |candidates, why| KindGuess { candidates, certainty: Certainty::Certain, why };
        match self.prefix().count {
            Count::Blocks(_) => {
                certain(&[ObjectKind::BottomLevel], "the header has blocks, which only bottom-level structures have")
            }
            Count::Handles(1..) => {
                certain(&[ObjectKind::TopLevel], "the header has handles, which only top-level structures have")
            }
            Count::Handles(0) => self.kind_of_payload(),
        }
    }

    /// What the data may be if there are neither handles nor blocks.
    fn kind_of_payload(&self) -> KindGuess {
        let only = |kind: ObjectKind| match kind {
            ObjectKind::Micromap => &[ObjectKind::Micromap][..],
            ObjectKind::BottomLevel => &[ObjectKind::BottomLevel],
            ObjectKind::TopLevel => &[ObjectKind::TopLevel],
        };
        let payload = self.payload();
        if !payload.starts_with(&MAGIC) {
            return KindGuess {
                candidates: &[ObjectKind::BottomLevel, ObjectKind::Micromap, ObjectKind::TopLevel],
                certainty: Certainty::Unknown,
                why: "the header has neither handles nor blocks: a bottom-level structure without micromaps, a micromap, or a \
                      top-level structure without instances",
            };
        }
        let kind = payload.get(8..).and_then(<[u8]>::first_chunk).map(|bytes| u32::from_le_bytes(*bytes));
        match (ObjectHeader::read(payload), kind.and_then(ObjectKind::from_value)) {
            (Ok(header), _) => KindGuess {
                candidates: only(header.kind),
                certainty: Certainty::Certain,
                why: "the payload is that of the simulated device and names its kind",
            },
            (Err(_), Some(kind)) => KindGuess {
                candidates: only(kind),
                certainty: Certainty::Likely,
                why: "the payload begins as that of the simulated device, but its header is malformed",
            },
            (Err(_), None) => KindGuess {
                candidates: &[ObjectKind::BottomLevel, ObjectKind::Micromap, ObjectKind::TopLevel],
                certainty: Certainty::Unknown,
                why: "the payload begins as that of the simulated device, but names no kind",
            },
        }
    }
}
