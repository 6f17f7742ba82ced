//! Vertices: the position that a vertex of each format holds, in `f32`.

use omm_model::vk;

use crate::bytes::{f32s, u16_at, u32_at};
use crate::error::{ReadError, ReadErrorKind};

/// How one component is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Component {
    Float32,
    Float16,
    Snorm16,
    Unorm16,
    Snorm8,
    Unorm8,
    /// Three of ten bits in a 32-bit word, x in the lowest.
    Unorm10,
}

/// A vertex format whose positions can be read: the checked form of [`vk::Format`].
///
/// The formats with float, 16-bit signed normalized and two or four components are those that every implementation has for
/// acceleration structures; the others are optional there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VertexFormat {
    raw: vk::Format,
    component: Component,
    /// Components stored: 2, 3 or 4.
    count: usize,
}

impl VertexFormat {
    /// The Vulkan format.
    #[must_use]
    pub const fn raw(self) -> vk::Format {
        self.raw
    }

    /// Bytes of a vertex.
    #[must_use]
    pub const fn size(self) -> usize {
        match self.component {
            Component::Float32 => 4 * self.count,
            Component::Float16 | Component::Snorm16 | Component::Unorm16 => 2 * self.count,
            Component::Snorm8 | Component::Unorm8 => self.count,
            Component::Unorm10 => 4,
        }
    }

    /// Bytes of a component, of which the stride and the address must be multiples; those of the whole word if it is packed.
    #[must_use]
    pub const fn component_size(self) -> usize {
        match self.component {
            Component::Float32 | Component::Unorm10 => 4,
            Component::Float16 | Component::Snorm16 | Component::Unorm16 => 2,
            Component::Snorm8 | Component::Unorm8 => 1,
        }
    }

    /// Whether a component can be NaN, so that a triangle can be inactive.
    #[must_use]
    pub const fn has_nan(self) -> bool {
        matches!(self.component, Component::Float32 | Component::Float16)
    }

    /// Whether any of the vertices in `bytes`, which begin `stride` bytes apart (all in one place if that is 0), has a number as
    /// first component and NaN as another one of its position: neither a vertex nor one that takes its triangle out.
    ///
    /// The same as to read each and look, only faster; a vertex that `bytes` cuts off is passed over.
    #[must_use]
    pub fn any_partly_nan(self, bytes: &[u8], stride: usize) -> bool {
        let (single, half) =
            (|bytes| f32::from_le_bytes(bytes).is_nan(), |bytes| f16_is_nan(u16::from_le_bytes(bytes)));
        match (self.component, self.count) {
            (Component::Float32, 2) => any_vertex::<8>(bytes, stride, |vertex| is_partly_nan(vertex, single)),
            (Component::Float32, _) => any_vertex::<12>(bytes, stride, |vertex| is_partly_nan(vertex, single)),
            (Component::Float16, 2) => any_vertex::<4>(bytes, stride, |vertex| is_partly_nan(vertex, half)),
            (Component::Float16, _) => any_vertex::<6>(bytes, stride, |vertex| is_partly_nan(vertex, half)),
            _ => false,
        }
    }

    /// The position of the vertex at the start of `bytes`; *z* is 0 if only two components are stored, a fourth is left out.
    ///
    /// Floats keep their value, NaN included. A signed normalized value *c* of *n* bits is `c / (2^(n-1) - 1)`, at least -1, an
    /// unsigned one `c / (2^n - 1)`, rounded to `f32` once.
    ///
    /// # Errors
    /// Fewer bytes than a vertex.
    pub fn read(self, bytes: &[u8]) -> Result<[f32; 3], ReadError> {
        let vertex = bytes.get(..self.size()).ok_or_else(|| {
            let kind = ReadErrorKind::Truncated { available: bytes.len() as u64, required: self.size() as u64 };
            ReadError::new("vertex", 0, kind)
        })?;
        let words = |convert: fn(u16) -> f32| {
            let mut position = [0.0; 3];
            for (number, bytes) in position.iter_mut().zip(vertex.as_chunks().0) {
                *number = convert(u16::from_le_bytes(*bytes));
            }
            position
        };
        let octets = |convert: fn(u8) -> f32| {
            let mut position = [0.0; 3];
            for (number, byte) in position.iter_mut().zip(vertex) {
                *number = convert(*byte);
            }
            position
        };
        Ok(match self.component {
            Component::Float32 => f32s(vertex),
            Component::Float16 => words(f16_to_f32),
            Component::Snorm16 => words(|c| (f32::from(c.cast_signed()) / 32767.0).max(-1.0)),
            Component::Unorm16 => words(|c| f32::from(c) / 65535.0),
            Component::Snorm8 => octets(|c| (f32::from(c.cast_signed()) / 127.0).max(-1.0)),
            Component::Unorm8 => octets(|c| f32::from(c) / 255.0),
            Component::Unorm10 => {
                let word = vertex.first_chunk::<4>().map_or(0, u32_at::<0, 4>);
                [0, 10, 20]
                    .map(|shift| u16_at::<0, 4>(&(word >> shift & 0x3ff).to_le_bytes()))
                    .map(|c| f32::from(c) / 1023.0)
            }
        })
    }
}

impl TryFrom<vk::Format> for VertexFormat {
    type Error = vk::Format;
    /// The raw value itself is the error when positions of that format cannot be read.
    fn try_from(raw: vk::Format) -> Result<Self, Self::Error> {
        let (component, count) = match raw {
            vk::Format::R32G32_SFLOAT => (Component::Float32, 2),
            vk::Format::R32G32B32_SFLOAT => (Component::Float32, 3),
            vk::Format::R32G32B32A32_SFLOAT => (Component::Float32, 4),
            vk::Format::R16G16_SFLOAT => (Component::Float16, 2),
            vk::Format::R16G16B16A16_SFLOAT => (Component::Float16, 4),
            vk::Format::R16G16_SNORM => (Component::Snorm16, 2),
            vk::Format::R16G16B16A16_SNORM => (Component::Snorm16, 4),
            vk::Format::R16G16_UNORM => (Component::Unorm16, 2),
            vk::Format::R16G16B16A16_UNORM => (Component::Unorm16, 4),
            vk::Format::R8G8_SNORM => (Component::Snorm8, 2),
            vk::Format::R8G8B8A8_SNORM => (Component::Snorm8, 4),
            vk::Format::R8G8_UNORM => (Component::Unorm8, 2),
            vk::Format::R8G8B8A8_UNORM => (Component::Unorm8, 4),
            vk::Format::A2B10G10R10_UNORM_PACK32 => (Component::Unorm10, 3),
            other => return Err(other),
        };
        Ok(Self { raw, component, count })
    }
}

/// Whether `wrong` holds for the `N` bytes at the start of any vertex. Blocks of vertices that lie side by side are looked at as a
/// whole, which a compiler turns into wide instructions.
fn any_vertex<const N: usize>(bytes: &[u8], stride: usize, wrong: impl Fn(&[u8; N]) -> bool) -> bool {
    if stride == N {
        let block = |vertices: &[[u8; N]]| vertices.iter().fold(false, |any, vertex| any | wrong(vertex));
        return bytes.as_chunks().0.chunks(256).any(block);
    }
    let mut vertices = bytes.chunks(if stride == 0 { bytes.len().max(1) } else { stride });
    vertices.any(|vertex| vertex.first_chunk().is_some_and(&wrong))
}

/// Whether the first component is a number and another is not. Nothing is skipped, as that would be slower.
fn is_partly_nan<const N: usize, const SIZE: usize>(vertex: &[u8; N], is_nan: fn([u8; SIZE]) -> bool) -> bool {
    let (components, _) = vertex.as_chunks();
    let Some((first, others)) = components.split_first() else { return false };
    !is_nan(*first) & others.iter().fold(false, |any, component| any | is_nan(*component))
}

fn f16_is_nan(half: u16) -> bool {
    half & 0x7fff > 0x7c00
}

/// The same number, or a NaN with the same sign and the payload in the high bits.
fn f16_to_f32(half: u16) -> f32 {
    let sign = u32::from(half >> 15) << 31;
    let (exponent, fraction) = (u32::from(half >> 10 & 0x1f), u32::from(half & 0x3ff));
    match exponent {
        // Zero and subnormal: fraction * 2^-24, exactly.
        0 => {
            let magnitude = fraction as f32 * (1.0 / 16_777_216.0);
            f32::from_bits(magnitude.to_bits() | sign)
        }
        0x1f => f32::from_bits(sign | 0x7f80_0000 | fraction << 13),
        _ => f32::from_bits(sign | (exponent + 112) << 23 | fraction << 13),
    }
}

/// Whether a triangle is active: the first component of each vertex is a number.
#[must_use]
pub fn is_active(vertices: &[[f32; 3]; 3]) -> bool {
    vertices.iter().all(|[x, ..]| !x.is_nan())
}

#[cfg(test)]
mod tests {
    use super::*;

    const FORMATS: [vk::Format; 14] = [
        vk::Format::R32G32_SFLOAT,
        vk::Format::R32G32B32_SFLOAT,
        vk::Format::R32G32B32A32_SFLOAT,
        vk::Format::R16G16_SFLOAT,
        vk::Format::R16G16B16A16_SFLOAT,
        vk::Format::R16G16_SNORM,
        vk::Format::R16G16B16A16_SNORM,
        vk::Format::R16G16_UNORM,
        vk::Format::R16G16B16A16_UNORM,
        vk::Format::R8G8_SNORM,
        vk::Format::R8G8B8A8_SNORM,
        vk::Format::R8G8_UNORM,
        vk::Format::R8G8B8A8_UNORM,
        vk::Format::A2B10G10R10_UNORM_PACK32,
    ];

    fn read(format: vk::Format, bytes: &[u8]) -> [f32; 3] {
        VertexFormat::try_from(format).unwrap().read(bytes).unwrap()
    }

    fn halves(halves: &[u16]) -> Vec<u8> {
        halves.iter().flat_map(|half| half.to_le_bytes()).collect()
    }

    #[test]
    fn each_format_has_its_size() {
        let sizes = FORMATS.map(|format| VertexFormat::try_from(format).unwrap().size());
        assert_eq!(sizes, [8, 12, 16, 4, 8, 4, 8, 4, 8, 2, 4, 2, 4, 4]);
        for format in FORMATS {
            let format = VertexFormat::try_from(format).unwrap();
            let bytes = vec![0; format.size()];
            assert_eq!(format.read(&bytes), Ok([0.0; 3]));
            assert!(format.read(&bytes[1..]).unwrap_err().is_truncated());
            assert_eq!(format.has_nan(), format.read(&[0xff; 16]).unwrap()[0].is_nan());
        }
        assert_eq!(VertexFormat::try_from(vk::Format::UNDEFINED), Err(vk::Format::UNDEFINED));
    }

    #[test]
    fn a_third_component_is_read_and_a_fourth_is_not() {
        let floats: Vec<u8> = [1.0_f32, 2.0, 3.0, 4.0].into_iter().flat_map(f32::to_le_bytes).collect();
        assert_eq!(read(vk::Format::R32G32_SFLOAT, &floats), [1.0, 2.0, 0.0]);
        assert_eq!(read(vk::Format::R32G32B32_SFLOAT, &floats), [1.0, 2.0, 3.0]);
        assert_eq!(read(vk::Format::R32G32B32A32_SFLOAT, &floats), [1.0, 2.0, 3.0]);
        let normalized = halves(&[0x7fff, 0x8000, 0x8001, 0x1234]);
        assert_eq!(read(vk::Format::R16G16_SNORM, &normalized), [1.0, -1.0, 0.0]);
        assert_eq!(read(vk::Format::R16G16B16A16_SNORM, &normalized), [1.0, -1.0, -1.0]);
        assert_eq!(read(vk::Format::R16G16B16A16_UNORM, &halves(&[0xffff, 0, 1, 9])), [1.0, 0.0, 1.0 / 65535.0]);
        assert_eq!(read(vk::Format::R8G8B8A8_SNORM, &[0x7f, 0x80, 0x01, 9]), [1.0, -1.0, 1.0 / 127.0]);
        assert_eq!(read(vk::Format::R8G8_UNORM, &[0xff, 0x33]), [1.0, 0.2, 0.0]);
        let packed = (0x3ff_u32 | 0x155 << 10 | 1 << 20 | 3 << 30).to_le_bytes();
        assert_eq!(read(vk::Format::A2B10G10R10_UNORM_PACK32, &packed), [1.0, 341.0 / 1023.0, 1.0 / 1023.0]);
    }

    #[test]
    fn every_half_keeps_its_value() {
        for half in 0..=u16::MAX {
            let [found, ..] = read(vk::Format::R16G16_SFLOAT, &halves(&[half, 0]));
            let (exponent, fraction) = (i32::from(half >> 10 & 0x1f), f64::from(half & 0x3ff));
            let magnitude = match exponent {
                0 => fraction * 2_f64.powi(-24),
                31 if half & 0x3ff == 0 => f64::INFINITY,
                31 => f64::NAN,
                _ => (1024.0 + fraction) * 2_f64.powi(exponent - 25),
            };
            assert_eq!(found.is_nan(), magnitude.is_nan(), "{half:#x}");
            assert_eq!(found.is_sign_negative(), half >> 15 == 1, "{half:#x}");
            if !magnitude.is_nan() {
                assert_eq!(f64::from(found.abs()), magnitude, "{half:#x}");
            }
        }
    }

    #[test]
    fn a_nan_behind_a_number_is_found_wherever_it_stands() {
        for format in
            FORMATS.map(|format| VertexFormat::try_from(format).unwrap()).into_iter().filter(|it| it.has_nan())
        {
            for stride in [0, format.size(), format.size() + 4, 3 * format.size()] {
                // Some 300 vertices: more than a block.
                let count = 300;
                let mut bytes = vec![0x3c; stride * (count - 1) + format.size()];
                assert!(!format.any_partly_nan(&bytes, stride), "{format:?}, {stride}");
                for place in 0..bytes.len() / format.component_size() {
                    let component = place * format.component_size()..(place + 1) * format.component_size();
                    bytes[component.clone()].fill(0xff);
                    let mut vertices = (0..count).map(|vertex| format.read(&bytes[vertex * stride..]).unwrap());
                    let expected = vertices.any(|[x, y, z]| !x.is_nan() && (y.is_nan() || z.is_nan()));
                    assert_eq!(format.any_partly_nan(&bytes, stride), expected, "{format:?}, {stride}, {place}");
                    bytes[component].fill(0x3c);
                }
            }
            assert!(!format.any_partly_nan(&[], 0) && !format.any_partly_nan(&[0xff; 3], 3));
        }
    }

    #[test]
    fn a_triangle_with_a_nan_x_is_inactive() {
        let mut vertices = [[0.0, f32::NAN, 1.0]; 3];
        assert!(is_active(&vertices));
        vertices[2][0] = -f32::NAN;
        assert!(!is_active(&vertices));
    }
}
