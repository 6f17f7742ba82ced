//! Index buffers that `omm bake` wrote.

use std::path::Path;

use omm_layout::index::IndexType;
use omm_layout::index_buffer::MicromapIndexBuffer;
use omm_model::special_index::TriangleMap;

use crate::error::CliError;
use crate::output;

/// The name of a type in files.
pub(crate) const fn name(index_type: IndexType) -> &'static str {
    match index_type {
        IndexType::None => "none",
        IndexType::Uint8 => "uint8",
        IndexType::Uint16 => "uint16",
        IndexType::Uint32 => "uint32",
    }
}

/// The type of a name.
pub(crate) fn named(text: &str) -> Option<IndexType> {
    [IndexType::Uint8, IndexType::Uint16, IndexType::Uint32].into_iter().find(|index_type| name(*index_type) == text)
}

/// The indices in the file at `path`, special ones as -1 to -4.
pub(crate) fn read(path: &Path, index_type: IndexType) -> Result<Vec<i32>, CliError> {
    let bytes = output::read(path)?;
    let (size, unit) = (bytes.len() as u64, u64::from(index_type.size()));
    let cut_short = || CliError::CutShort { path: path.into(), size, unit };
    if !size.is_multiple_of(unit) {
        return Err(cut_short());
    }
    let maps = MicromapIndexBuffer::new(&bytes, index_type, unit, 0, size / unit).map_err(|_| cut_short())?;
    let index = |map| match map {
        TriangleMap::SpecialIndex(special) => special.value(),
        TriangleMap::Triangle(index) => index.cast_signed(),
    };
    // Without a base triangle no sum is too large.
    Ok(maps.iter().flatten().map(index).collect())
}
