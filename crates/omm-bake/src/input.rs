//! Texture coordinates and triangles from the bytes of vertex and index buffers.
//!
//! A shader sees `f32` texture coordinates whatever they are stored as, so that is what is baked: a half float keeps its value,
//! and a normalized integer *c* is `c / 65535` rounded to `f32` once.

use omm_layout::vertex::VertexFormat;
use omm_model::vk;
use serde::{Deserialize, Serialize};

/// How a vertex's texture coordinates are stored: (u, v), little-endian.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum UvFormat {
    /// Two `f32`: `VK_FORMAT_R32G32_SFLOAT`.
    #[default]
    Float32,
    /// Two half floats: `VK_FORMAT_R16G16_SFLOAT`.
    Float16,
    /// Two 16-bit integers, 65535 standing for 1: `VK_FORMAT_R16G16_UNORM`.
    Unorm16,
}

/// How a vertex index is stored, little-endian.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum IndexFormat {
    /// `VK_INDEX_TYPE_UINT8`.
    Uint8,
    /// `VK_INDEX_TYPE_UINT16`.
    Uint16,
    /// `VK_INDEX_TYPE_UINT32`.
    #[default]
    Uint32,
}

/// Bytes that are no whole number of vertices or triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InputError {
    /// Vertices overlap.
    #[error("a stride of {stride} bytes is less than the {size} bytes of a vertex's texture coordinates")]
    Stride {
        /// The stride given.
        stride: usize,
        /// Bytes of a pair of coordinates.
        size: usize,
    },
    /// The last vertex is cut short.
    #[error("{found} bytes of texture coordinates end within one: vertices of {size} bytes are {stride} bytes apart")]
    PartialVertex {
        /// Bytes given.
        found: usize,
        /// Bytes of a pair of coordinates.
        size: usize,
        /// From one to the next.
        stride: usize,
    },
    /// The last triangle is cut short.
    #[error("{found} bytes of indices are not a multiple of {triangle}, the bytes of a triangle")]
    PartialTriangle {
        /// Bytes given.
        found: usize,
        /// Bytes of three indices.
        triangle: usize,
    },
}

impl UvFormat {
    /// Bytes of a pair of coordinates.
    #[must_use]
    pub const fn size(self) -> usize {
        match self {
            Self::Float32 => 8,
            Self::Float16 | Self::Unorm16 => 4,
        }
    }

    const fn raw(self) -> vk::Format {
        match self {
            Self::Float32 => vk::Format::R32G32_SFLOAT,
            Self::Float16 => vk::Format::R16G16_SFLOAT,
            Self::Unorm16 => vk::Format::R16G16_UNORM,
        }
    }
}

impl IndexFormat {
    /// Bytes of an index.
    #[must_use]
    pub const fn size(self) -> usize {
        match self {
            Self::Uint8 => 1,
            Self::Uint16 => 2,
            Self::Uint32 => 4,
        }
    }
}

/// The texture coordinates of all vertices in `bytes`, `stride` bytes from the start of one to the start of the next; 0 if nothing
/// lies between them. The last may end with its coordinates or with its stride.
///
/// # Errors
/// [`InputError`] if vertices overlap or the last is cut short.
pub fn read_uvs(bytes: &[u8], format: UvFormat, stride: usize) -> Result<Vec<[f32; 2]>, InputError> {
    let size = format.size();
    let stride = if stride == 0 { size } else { stride };
    if stride < size {
        return Err(InputError::Stride { stride, size });
    }
    if !bytes.is_empty() && (bytes.len() - 1) % stride + 1 < size {
        return Err(InputError::PartialVertex { found: bytes.len(), size, stride });
    }
    // All three are formats of vertices, so none is lost.
    let format = VertexFormat::try_from(format.raw()).ok();
    let uv = |vertex: &[u8]| format?.read(vertex).ok().map(|[u, v, _]| [u, v]);
    Ok(bytes.chunks(stride).filter_map(uv).collect())
}

/// The triangles in `bytes`, three indices each.
///
/// # Errors
/// [`InputError`] if the last triangle is cut short.
pub fn read_triangles(bytes: &[u8], format: IndexFormat) -> Result<Vec<[u32; 3]>, InputError> {
    let triangle = 3 * format.size();
    if !bytes.len().is_multiple_of(triangle) {
        return Err(InputError::PartialTriangle { found: bytes.len(), triangle });
    }
    Ok(match format {
        IndexFormat::Uint8 => bytes.as_chunks::<3>().0.iter().map(|triangle| triangle.map(u32::from)).collect(),
        IndexFormat::Uint16 => {
            let words = bytes.as_chunks::<2>().0.as_chunks::<3>().0;
            words.iter().map(|triangle| triangle.map(|word| u16::from_le_bytes(word).into())).collect()
        }
        IndexFormat::Uint32 => {
            let words = bytes.as_chunks::<4>().0.as_chunks::<3>().0;
            words.iter().map(|triangle| triangle.map(u32::from_le_bytes)).collect()
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_and_strides() {
        let floats: Vec<u8> = [0.5_f32, -2.0, 9.0, 1.0, 0.25].iter().flat_map(|x| x.to_le_bytes()).collect();
        let read = |bytes: &[u8], format, stride| read_uvs(bytes, format, stride);
        assert_eq!(read(&floats[..16], UvFormat::Float32, 0), Ok(vec![[0.5, -2.0], [9.0, 1.0]]));
        assert_eq!(read(&floats, UvFormat::Float32, 12), Ok(vec![[0.5, -2.0], [1.0, 0.25]]));
        // 0.5, -2, the least subnormal 2^-24 and infinity.
        let halves = [0x00, 0x38, 0x00, 0xc0, 0x01, 0x00, 0x00, 0x7c];
        let expected = vec![[0.5, -2.0], [f32::from_bits(103 << 23), f32::INFINITY]];
        assert_eq!(read(&halves, UvFormat::Float16, 4), Ok(expected));
        let unorm = [0xff, 0xff, 0x33, 0x33, 0xee, 0x01, 0x00, 0x00, 0x00];
        assert_eq!(read(&unorm, UvFormat::Unorm16, 5), Ok(vec![[1.0, 0.2], [1.0 / 65535.0, 0.0]]));
        assert_eq!(read(&[], UvFormat::Unorm16, 5), Ok(vec![]));
        assert_eq!(read(&floats, UvFormat::Float32, 7), Err(InputError::Stride { stride: 7, size: 8 }));
        for (length, stride) in [(4, 8), (15, 8), (19, 12), (21, 10)] {
            let found = read(&[0; 32][..length], UvFormat::Float32, stride);
            assert_eq!(found, Err(InputError::PartialVertex { found: length, size: 8, stride }));
        }
    }

    #[test]
    fn indices_of_all_sizes() {
        let bytes = [1, 0, 0, 0, 2, 0, 0, 0, 3, 0, 1, 0];
        assert_eq!(read_triangles(&bytes, IndexFormat::Uint32), Ok(vec![[1, 2, 0x1_0003]]));
        assert_eq!(read_triangles(&bytes, IndexFormat::Uint16), Ok(vec![[1, 0, 2], [0, 3, 1]]));
        assert_eq!(read_triangles(&bytes[..6], IndexFormat::Uint8), Ok(vec![[1, 0, 0], [0, 2, 0]]));
        for (format, triangle) in [(IndexFormat::Uint8, 3), (IndexFormat::Uint16, 6), (IndexFormat::Uint32, 12)] {
            let error = InputError::PartialTriangle { found: triangle + 1, triangle };
            assert_eq!(read_triangles(&[0; 13][..=triangle], format), Err(error));
        }
    }
}
