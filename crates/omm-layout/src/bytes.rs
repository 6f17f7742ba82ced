//! Reading and writing little-endian numbers with bounds and names.

use byteorder::{ByteOrder, LittleEndian};

use crate::error::{ReadError, ReadErrorKind};

/// A position in some bytes that only moves forwards; every read names its field.
#[derive(Clone, Debug)]
pub(crate) struct Reader<'a> {
    bytes: &'a [u8],
    position: usize,
}

impl<'a> Reader<'a> {
    pub(crate) const fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, position: 0 }
    }

    /// Bytes from the start to the next read.
    pub(crate) const fn position(&self) -> u64 {
        self.position as u64
    }

    /// All that was not read yet.
    pub(crate) fn rest(&self) -> &'a [u8] {
        self.bytes.get(self.position..).unwrap_or_default()
    }

    /// The next `count` items of `N` bytes each.
    pub(crate) fn items<const N: usize>(
        &mut self,
        count: u64,
        field: &'static str,
    ) -> Result<&'a [[u8; N]], ReadError> {
        let rest = self.rest();
        let required = count.saturating_mul(N as u64);
        let size = usize::try_from(required).ok().filter(|&size| size <= rest.len());
        let taken = size.and_then(|size| rest.get(..size)).ok_or_else(|| {
            let kind = ReadErrorKind::Truncated { available: rest.len() as u64, required };
            ReadError::new(field, self.position(), kind)
        })?;
        self.position += taken.len();
        Ok(taken.as_chunks().0)
    }

    /// The next `N` bytes.
    pub(crate) fn array<const N: usize>(&mut self, field: &'static str) -> Result<&'a [u8; N], ReadError> {
        let items = self.items(1, field)?;
        let kind = ReadErrorKind::Truncated { available: 0, required: N as u64 };
        items.first().ok_or_else(|| ReadError::new(field, self.position(), kind))
    }

    pub(crate) fn u32(&mut self, field: &'static str) -> Result<u32, ReadError> {
        self.array::<4>(field).map(|bytes| u32::from_le_bytes(*bytes))
    }

    pub(crate) fn u64(&mut self, field: &'static str) -> Result<u64, ReadError> {
        self.array::<8>(field).map(|bytes| u64::from_le_bytes(*bytes))
    }

    /// A field that must be zero.
    pub(crate) fn reserved_u32(&mut self, field: &'static str) -> Result<(), ReadError> {
        let offset = self.position();
        equal(field, offset, self.u32(field)?.into(), 0)
    }
}

/// Requires one value of a field.
pub(crate) fn equal(field: &'static str, offset: u64, found: u64, required: u64) -> Result<(), ReadError> {
    if found == required {
        Ok(())
    } else {
        Err(ReadError::new(field, offset, ReadErrorKind::NotEqual { found, required }))
    }
}

/// Requires every byte to be zero and names the first that is not.
pub(crate) fn zeros(field: &'static str, offset: u64, bytes: &[u8]) -> Result<(), ReadError> {
    match bytes.iter().zip(0_u64..).find(|(byte, _)| **byte != 0) {
        None => Ok(()),
        Some((&byte, at)) => equal(field, offset.saturating_add(at), byte.into(), 0),
    }
}

/// The `N` numbers that `4 * N` bytes hold.
pub(crate) fn f32s<const N: usize>(bytes: &[u8]) -> [f32; N] {
    let mut numbers = [0.0; N];
    for (number, bytes) in numbers.iter_mut().zip(bytes.as_chunks().0) {
        *number = f32::from_le_bytes(*bytes);
    }
    numbers
}

/// Appends numbers.
pub(crate) fn push_f32s(out: &mut Vec<u8>, numbers: impl IntoIterator<Item = f32>) {
    for number in numbers {
        out.extend_from_slice(&number.to_le_bytes());
    }
}

/// The number at a constant place of a record; `AT + 4` is at most the record's size.
pub(crate) fn u32_at<const AT: usize, const N: usize>(record: &[u8; N]) -> u32 {
    const { assert!(AT + 4 <= N) };
    LittleEndian::read_u32(&record[AT..AT + 4])
}

/// The number at a constant place of a record; `AT + 8` is at most the record's size.
pub(crate) fn u64_at<const AT: usize, const N: usize>(record: &[u8; N]) -> u64 {
    const { assert!(AT + 8 <= N) };
    LittleEndian::read_u64(&record[AT..AT + 8])
}

/// The number at a constant place of a record; `AT + 2` is at most the record's size.
pub(crate) fn u16_at<const AT: usize, const N: usize>(record: &[u8; N]) -> u16 {
    const { assert!(AT + 2 <= N) };
    LittleEndian::read_u16(&record[AT..AT + 2])
}
