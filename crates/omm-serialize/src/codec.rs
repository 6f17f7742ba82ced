//! The one place that knows bincode, with one configuration: little-endian, integers at their full width, lengths as u64.
//!
//! Bundles and traces are written with it. `wincode` reads and writes the same bytes, which a test holds us to. Values are decoded one at a time, so that an error has an
//! offset and nothing is reserved because of a length.

use bincode::config::{Configuration, Fixint, LittleEndian};
use bincode::error::DecodeError;
use bincode::{BorrowDecode, Encode};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::usage::MicromapUsage;

use crate::bundle::Source;
use crate::{ReadError, ReadErrorKind};

const CONFIGURATION: Configuration<LittleEndian, Fixint> =
    bincode::config::standard().with_little_endian().with_fixed_int_encoding();

/// Encoded values, read from the front.
#[derive(Clone, Debug)]
pub(crate) struct Input<'a> {
    bytes: &'a [u8],
    position: usize,
}

impl<'a> Input<'a> {
    pub(crate) const fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, position: 0 }
    }

    pub(crate) const fn position(&self) -> u64 {
        self.position as u64
    }

    /// The next value; `size` is the least that its encoding takes.
    pub(crate) fn value<T: BorrowDecode<'a, ()>>(&mut self, field: &'static str, size: u64) -> Result<T, ReadError> {
        let rest = self.bytes.get(self.position..).unwrap_or_default();
        match bincode::borrow_decode_from_slice(rest, CONFIGURATION) {
            Ok((value, taken)) => {
                self.position += taken;
                Ok(value)
            }
            Err(error) => Err(self.error(field, size, &error)),
        }
    }

    fn error(&self, field: &'static str, size: u64, error: &DecodeError) -> ReadError {
        let rest = self.bytes.get(self.position..).unwrap_or_default();
        let available = rest.len() as u64;
        // A list: its length, if that is there, says what is needed.
        let length = rest.first_chunk().map_or(0, |length| u64::from_le_bytes(*length));
        let kind = match error {
            DecodeError::Utf8 { inner } => ReadErrorKind::Unknown {
                found: rest.get(8 + inner.valid_up_to()).copied().unwrap_or_default().into(),
                required: "UTF-8",
            },
            _ if size == 8 && available >= 8 => {
                ReadErrorKind::Truncated { available, required: length.saturating_add(8) }
            }
            _ => ReadErrorKind::Truncated { available, required: size },
        };
        ReadError { field: field.into(), offset: self.position(), kind }
    }

    /// Reads what every file begins with: the magic bytes of its format, and the only version of it that there is, 1.
    pub(crate) fn start(&mut self, required: [u8; 8]) -> Result<(), ReadError> {
        let found = self.value("magic", 8)?;
        if found != required {
            let kind = ReadErrorKind::Magic { found, required };
            return Err(ReadError { field: "magic".into(), offset: 0, kind });
        }
        let version = self.u32("version")?;
        if version != 1 {
            let kind =
                ReadErrorKind::Unknown { found: version.into(), required: "1, the only version this program reads" };
            return Err(ReadError { field: "version".into(), offset: 8, kind });
        }
        Ok(())
    }

    /// Bytes that were not read yet.
    pub(crate) const fn remaining(&self) -> u64 {
        (self.bytes.len() - self.position) as u64
    }

    pub(crate) fn u32(&mut self, field: &'static str) -> Result<u32, ReadError> {
        self.value(field, 4)
    }

    pub(crate) fn u64(&mut self, field: &'static str) -> Result<u64, ReadError> {
        self.value(field, 8)
    }

    /// A list of bytes, in place.
    pub(crate) fn bytes(&mut self, field: &'static str) -> Result<&'a [u8], ReadError> {
        self.value(field, 8)
    }

    /// A list of bytes that are text, in place.
    pub(crate) fn text(&mut self, field: &'static str) -> Result<&'a str, ReadError> {
        self.value(field, 8)
    }

    /// Requires that nothing is left.
    pub(crate) fn finish(&self) -> Result<(), ReadError> {
        let found = self.bytes.len() as u64;
        if self.position() == found {
            return Ok(());
        }
        let kind = ReadErrorKind::NotEqual { found, required: self.position() };
        Err(ReadError { field: "length".into(), offset: self.position(), kind })
    }
}

/// Name, length and digest of the next source.
pub(crate) fn check_source<'a>(input: &mut Input<'a>) -> Result<(&'a str, u64, [u8; 32]), ReadError> {
    Ok((input.text("name")?, input.u64("length")?, input.value("sha256", 32)?))
}

pub(crate) fn source(input: &mut Input<'_>) -> Result<Source, ReadError> {
    let (name, length, sha256) = check_source(input)?;
    Ok(Source { name: name.to_owned(), length, sha256 })
}

/// The usage count that a record holds, if level and format have a meaning.
pub(crate) fn usage(record: &[u8; 12]) -> Option<MicromapUsage> {
    let ((count, level, format), _) =
        bincode::borrow_decode_from_slice::<(u32, u32, u32), _>(record, CONFIGURATION).ok()?;
    Some(MicromapUsage {
        count,
        subdivision_level: SubdivisionLevel::new(level).ok()?,
        format: OpacityMicromapFormat::from_value(format)?,
    })
}

/// Where bytes are appended.
struct Sink<'a>(&'a mut Vec<u8>);

impl bincode::enc::write::Writer for Sink<'_> {
    fn write(&mut self, bytes: &[u8]) -> Result<(), bincode::error::EncodeError> {
        self.0.extend_from_slice(bytes);
        Ok(())
    }
}

/// Appends a value.
pub(crate) fn push(out: &mut Vec<u8>, value: impl Encode) {
    // Neither the sink nor the encoding of numbers and bytes can fail.
    let result = bincode::encode_into_writer(value, Sink(out), CONFIGURATION);
    debug_assert!(result.is_ok());
}

/// Appends a value of the model.
pub(crate) fn push_value(out: &mut Vec<u8>, value: &impl serde::Serialize) {
    // The model has nothing but structures, enums, lists whose length is known, numbers and text, all of which can be encoded.
    let result = bincode::serde::encode_into_writer(value, Sink(out), CONFIGURATION);
    debug_assert!(result.is_ok());
}
