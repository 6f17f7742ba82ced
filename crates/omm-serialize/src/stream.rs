//! Reading serialized data that arrives piece by piece.

use std::io::{self, Read};

use crate::blob::{Head, Step, check_length};
use crate::header::FIXED_SIZE;
use crate::{ByteOrder, ReadError, ReadErrorKind};

/// A reader of serialized data in pieces of any size.
///
/// It keeps the header's bytes and nothing of the payload, which [`push`](Self::push) hands on. Whatever the pieces, the outcome is
/// that of [`Blob::read`](crate::Blob::read) on all of them together: the same header, or an error of the same field, offset and
/// text. A malformed field is refused as soon as it has arrived; that data is too short or too long, only the end can tell.
///
/// ```
/// use omm_serialize::{Blob, ByteOrder, Header, References, StreamReader};
///
/// # fn main() -> Result<(), omm_serialize::ReadError> {
/// let header = Header::for_payload(Default::default(), Default::default(), 4, References::Handles(vec![7]), 4);
/// let bytes = header.write(ByteOrder::Little, b"body");
/// let (mut reader, mut payload) = (StreamReader::new(ByteOrder::Little), Vec::new());
/// for piece in bytes.chunks(3) {
///     payload.extend_from_slice(reader.push(piece)?);
/// }
/// assert_eq!(reader.finish()?.to_header(), header);
/// assert_eq!(payload, b"body");
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct StreamReader {
    order: ByteOrder,
    step: Step,
    /// The bytes of the header that have arrived, and no others.
    header: Vec<u8>,
    /// Where the step begins.
    position: usize,
    payload_size: u64,
    failed: Option<ReadError>,
}

/// A stream that cannot be read, or does not hold serialized data.
#[derive(Debug, thiserror::Error)]
pub enum StreamError {
    /// The stream itself failed.
    #[error("the stream ends after {read} bytes: {source}")]
    Io {
        /// Bytes that had arrived.
        read: u64,
        /// Why no more arrive.
        source: io::Error,
    },
    /// What arrived is not serialized data.
    #[error(transparent)]
    Read(#[from] ReadError),
}

impl StreamReader {
    /// A reader that has seen nothing yet, for data in this byte order.
    ///
    /// [`byte_order::detect_with_length`](crate::byte_order::detect_with_length) tells the order if the length of the data is known.
    #[must_use]
    pub const fn new(order: ByteOrder) -> Self {
        Self { order, step: Step::Prefix, header: Vec::new(), position: 0, payload_size: 0, failed: None }
    }

    /// Takes the next piece and gives back the part of it that belongs to the payload.
    ///
    /// # Errors
    /// The first malformed field, as soon as it is complete, and again on every later call.
    pub fn push<'a>(&mut self, mut piece: &'a [u8]) -> Result<&'a [u8], ReadError> {
        if let Some(error) = &self.failed {
            return Err(error.clone());
        }
        loop {
            if let Step::Payload(_) = self.step {
                self.payload_size = self.payload_size.saturating_add(piece.len() as u64);
                return Ok(piece);
            }
            match self.step.next(&self.header, self.order, &mut self.position) {
                Ok(next) => self.step = next,
                Err(ReadError { offset, kind: ReadErrorKind::Truncated { required, .. }, .. }) => {
                    if piece.is_empty() {
                        return Ok(piece);
                    }
                    // The prefix at once; else just what the step lacks, so that no byte of the payload is taken.
                    let end = if self.step == Step::Prefix { FIXED_SIZE } else { offset.saturating_add(required) };
                    let missing = end.saturating_sub(self.header.len() as u64).max(1);
                    let taken = usize::try_from(missing).map_or(piece.len(), |missing| missing.min(piece.len()));
                    let (taken, rest) = piece.split_at_checked(taken).unwrap_or((piece, &[]));
                    self.header.extend_from_slice(taken);
                    piece = rest;
                }
                Err(error) => {
                    self.failed = Some(error.clone());
                    return Err(error);
                }
            }
        }
    }

    /// The header, once it has arrived. The data behind it may still turn out to be too short or too long.
    #[must_use]
    pub fn head(&self) -> Option<Head<'_>> {
        match self.step {
            Step::Payload(prefix) => {
                let references = self.header.get(FIXED_SIZE as usize..).unwrap_or_default();
                Some(Head::new(self.order, prefix, references))
            }
            _ => None,
        }
    }

    /// Says that no more will come.
    ///
    /// # Errors
    /// As [`Blob::read`](crate::Blob::read) for all that was pushed. It changes nothing: more can still be pushed.
    pub fn finish(&self) -> Result<Head<'_>, ReadError> {
        if let Some(error) = &self.failed {
            return Err(error.clone());
        }
        let (mut step, mut position) = (self.step, self.position);
        loop {
            match step {
                Step::Payload(prefix) => {
                    let start = self.header.len() as u64;
                    check_length(&prefix, start, start.saturating_add(self.payload_size))?;
                    let references = self.header.get(FIXED_SIZE as usize..).unwrap_or_default();
                    return Ok(Head::new(self.order, prefix, references));
                }
                _ => step = step.next(&self.header, self.order, &mut position)?,
            }
        }
    }

    /// Pushes all that `input` holds and gives each piece of the payload to `payload`; then finishes.
    ///
    /// # Errors
    /// The stream fails, or [`push`](Self::push) or [`finish`](Self::finish) does.
    pub fn read_from(
        &mut self,
        mut input: impl Read,
        mut payload: impl FnMut(&[u8]) -> io::Result<()>,
    ) -> Result<Head<'_>, StreamError> {
        let mut buffer = vec![0; 1 << 15];
        let mut read = 0_u64;
        loop {
            let size = match input.read(&mut buffer) {
                Ok(0) => return Ok(self.finish()?),
                Ok(size) => size,
                Err(source) if source.kind() == io::ErrorKind::Interrupted => continue,
                Err(source) => return Err(StreamError::Io { read, source }),
            };
            read = read.saturating_add(size as u64);
            let piece = self.push(buffer.get(..size).unwrap_or_default())?;
            payload(piece).map_err(|source| StreamError::Io { read, source })?;
        }
    }
}
