//! Micromap index buffers: which micromap triangle, or which special index, each triangle of a geometry has.

use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};

use crate::error::{ReadError, ReadErrorKind, WriteError, WriteErrorKind};
use crate::index::{IndexType, Indices};

/// The special index that `value` is in a buffer of `index_type`: one of the four largest values of the type, which are -1 to -4
/// cast to it. Without a buffer there is none.
#[must_use]
pub const fn special_index(index_type: IndexType, value: u32) -> Option<OpacityMicromapSpecialIndex> {
    match index_type {
        IndexType::None => None,
        _ => match index_type.max().checked_sub(value) {
            Some(below @ 0..=3) => OpacityMicromapSpecialIndex::from_value(-1 - below as i32),
            _ => None,
        },
    }
}

/// A micromap index buffer read in place.
#[derive(Clone, Copy, Debug)]
pub struct MicromapIndexBuffer<'a> {
    indices: Indices<'a>,
    index_type: IndexType,
    base_triangle: u32,
}

impl<'a> MicromapIndexBuffer<'a> {
    /// `count` indices, `stride` bytes from one to the next, at the start of `bytes`; of bytes and stride nothing is read if
    /// `index_type` is none, as then triangle *i* has index *i*. `base_triangle` is added to every index that is not special.
    ///
    /// Any stride is taken, 0 and misaligned ones included, as the bytes decide what can be read.
    ///
    /// # Errors
    /// The last index ends behind `bytes`.
    pub fn new(
        bytes: &'a [u8],
        index_type: IndexType,
        stride: u64,
        base_triangle: u32,
        count: u64,
    ) -> Result<Self, ReadError> {
        Ok(Self { indices: Indices::new(bytes, index_type, stride, count)?, index_type, base_triangle })
    }

    /// Number of triangles.
    #[must_use]
    pub const fn len(&self) -> u64 {
        self.indices.len()
    }

    /// Whether there are no triangles.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What triangle `triangle` has, if there are so many.
    ///
    /// # Errors
    /// The index and the base triangle add up to more than `u32::MAX`.
    #[must_use]
    pub fn get(&self, triangle: u64) -> Option<Result<TriangleMap, ReadError>> {
        let value = self.indices.get(triangle)?;
        if let Some(special) = special_index(self.index_type, value) {
            return Some(Ok(TriangleMap::SpecialIndex(special)));
        }
        Some(value.checked_add(self.base_triangle).map(TriangleMap::Triangle).ok_or_else(|| {
            let found = u64::from(value) + u64::from(self.base_triangle);
            let kind = ReadErrorKind::Above { found, limit: u32::MAX.into() };
            let field = format!("indices[{triangle}]");
            ReadError::new("sum_with_base_triangle", self.indices.offset(triangle), kind).within(field)
        }))
    }

    /// What the triangles have, in order.
    pub fn iter(&self) -> impl Iterator<Item = Result<TriangleMap, ReadError>> + Clone + use<'a> {
        let buffer = *self;
        (0..buffer.len()).map_while(move |triangle| buffer.get(triangle))
    }
}

/// The value that stands for `map` in a buffer of `index_type`; `triangle` is its place.
fn value(map: TriangleMap, index_type: IndexType, base_triangle: u32, triangle: u64) -> Result<u32, WriteErrorKind> {
    let index = match map {
        TriangleMap::SpecialIndex(special) if index_type == IndexType::None => {
            let instead = format!("triangle {}", triangle.saturating_add(base_triangle.into()));
            return Err(WriteErrorKind::Ambiguous { found: format!("{special:?}"), instead });
        }
        // -1 is the type's largest value, and so on down.
        TriangleMap::SpecialIndex(special) => {
            return Ok(index_type.max() - special.value().unsigned_abs() + 1);
        }
        TriangleMap::Triangle(index) => index,
    };
    let below = WriteErrorKind::Below { found: index.into(), least: base_triangle.into() };
    let value = index.checked_sub(base_triangle).ok_or(below)?;
    if index_type == IndexType::None && u64::from(value) != triangle {
        return Err(WriteErrorKind::NotEqual { found: value.into(), required: triangle });
    }
    if value > index_type.max() {
        return Err(WriteErrorKind::Above { found: value.into(), limit: index_type.max().into() });
    }
    match special_index(index_type, value) {
        Some(special) => Err(WriteErrorKind::Ambiguous { found: value.to_string(), instead: format!("{special:?}") }),
        None => Ok(value),
    }
}

/// The bytes of a micromap index buffer, tightly packed; none at all if `index_type` is none.
///
/// # Errors
/// The first triangle whose index is below the base triangle, above what the type holds, or reads as a special index; without a
/// buffer, the first one whose index is not its place.
pub fn write(maps: &[TriangleMap], index_type: IndexType, base_triangle: u32) -> Result<Vec<u8>, WriteError> {
    let size = index_type.size() as usize;
    let mut bytes = Vec::with_capacity(maps.len() * size);
    for (map, triangle) in maps.iter().zip(0_u64..) {
        let value = value(*map, index_type, base_triangle, triangle)
            .map_err(|kind| WriteError::new(format!("indices[{triangle}]"), kind))?;
        bytes.extend_from_slice(value.to_le_bytes().get(..size).unwrap_or_default());
    }
    Ok(bytes)
}

/// The first of `candidates` that can hold all of `maps`.
#[must_use]
pub fn fitting_type(maps: &[TriangleMap], base_triangle: u32, candidates: &[IndexType]) -> Option<IndexType> {
    let fits = |index_type: &IndexType| {
        maps.iter().zip(0..).all(|(map, triangle)| value(*map, *index_type, base_triangle, triangle).is_ok())
    };
    candidates.iter().copied().find(fits)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const TYPES: [IndexType; 3] = [IndexType::Uint8, IndexType::Uint16, IndexType::Uint32];

    fn maps(bytes: &[u8], index_type: IndexType, base_triangle: u32, count: u64) -> Vec<Result<TriangleMap, String>> {
        let stride = index_type.size().into();
        let buffer = MicromapIndexBuffer::new(bytes, index_type, stride, base_triangle, count).unwrap();
        buffer.iter().map(|map| map.map_err(|error| error.to_string())).collect()
    }

    #[test]
    fn the_four_largest_values_are_special() {
        use OpacityMicromapSpecialIndex as Special;
        for index_type in TYPES {
            let max = index_type.max();
            let found = [max, max - 1, max - 2, max - 3, max - 4].map(|value| special_index(index_type, value));
            let [a, b, c, d] = Special::ALL.map(Some);
            assert_eq!(found, [a, b, c, d, None]);
        }
        assert_eq!(special_index(IndexType::None, u32::MAX), None);
        assert_eq!(special_index(IndexType::Uint8, 0xffff), None);
    }

    #[test]
    fn base_triangle_moves_indices_but_not_special_ones() {
        let special = |value| TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::from_value(value).unwrap());
        let found = maps(&[0, 251, 252, 255], IndexType::Uint8, 10, 4);
        assert_eq!(
            found,
            [Ok(TriangleMap::Triangle(10)), Ok(TriangleMap::Triangle(261)), Ok(special(-4)), Ok(special(-1))]
        );
        let found = maps(&[], IndexType::None, u32::MAX, 2);
        let error = "indices[1].sum_with_base_triangle at byte 0: found 4294967296, required at most 4294967295";
        assert_eq!(found, [Ok(TriangleMap::Triangle(u32::MAX)), Err(error.into())]);
        let found = maps(&[0, 0, 1, 0], IndexType::Uint16, u32::MAX, 2);
        assert_eq!(found[1], Err(error.replace("byte 0", "byte 2")));
    }

    #[test]
    fn what_the_type_cannot_say_is_refused() {
        let text = |map, index_type, base| write(&[map], index_type, base).unwrap_err().to_string();
        let triangle = TriangleMap::Triangle;
        assert_eq!(text(triangle(256), IndexType::Uint8, 0), "indices[0]: found 256, room for at most 255");
        assert_eq!(text(triangle(4), IndexType::Uint8, 5), "indices[0]: found 4, required at least 5");
        assert_eq!(
            text(triangle(253), IndexType::Uint8, 0),
            "indices[0]: 253 cannot be told from FullyUnknownTransparent"
        );
        assert_eq!(text(triangle(6), IndexType::None, 5), "indices[0]: found 1, required 0");
        let special = TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::FullyOpaque);
        assert_eq!(text(special, IndexType::None, 5), "indices[0]: FullyOpaque cannot be told from triangle 5");
        assert_eq!(fitting_type(&[triangle(251)], 0, &TYPES), Some(IndexType::Uint8));
        assert_eq!(fitting_type(&[triangle(252)], 0, &TYPES), Some(IndexType::Uint16));
        assert_eq!(fitting_type(&[triangle(252)], 1, &TYPES), Some(IndexType::Uint8));
        assert_eq!(fitting_type(&[triangle(u32::MAX)], 0, &TYPES), None);
        assert_eq!(fitting_type(&[special], 0, &[IndexType::None, IndexType::Uint16]), Some(IndexType::Uint16));
    }

    fn any_map() -> impl Strategy<Value = TriangleMap> {
        let special = (0..4_usize).prop_map(|at| TriangleMap::SpecialIndex(OpacityMicromapSpecialIndex::ALL[at]));
        prop_oneof![
            special,
            (0..70_000_u32).prop_map(TriangleMap::Triangle),
            any::<u32>().prop_map(TriangleMap::Triangle)
        ]
    }

    proptest! {
        #[test]
        fn written_buffers_read_back(maps in prop::collection::vec(any_map(), 0..20), base in 0..300_u32) {
            for index_type in TYPES {
                if let Ok(bytes) = write(&maps, index_type, base) {
                    let read: Vec<_> = super::tests::maps(&bytes, index_type, base, maps.len() as u64);
                    prop_assert_eq!(read, maps.iter().copied().map(Ok).collect::<Vec<_>>());
                }
            }
        }

        #[test]
        fn read_buffers_write_back(bytes: Vec<u8>, base in 0..300_u32, at in 0..3_usize) {
            let index_type = TYPES[at];
            let count = bytes.len() as u64 / u64::from(index_type.size());
            let read: Result<Vec<_>, _> = super::tests::maps(&bytes, index_type, base, count).into_iter().collect();
            if let Ok(maps) = read {
                let used = count as usize * index_type.size() as usize;
                prop_assert_eq!(write(&maps, index_type, base).unwrap(), bytes[..used].to_vec());
            }
        }

        #[test]
        fn strides_step_over_bytes(bytes: Vec<u8>, stride in 0..9_u64) {
            let count = (bytes.len() as u64).saturating_sub(2).checked_div(stride).unwrap_or(0) + 1;
            match MicromapIndexBuffer::new(&bytes, IndexType::Uint16, stride, 0, count) {
                Err(error) => prop_assert!(error.is_truncated() && bytes.len() < 2),
                Ok(buffer) => for (at, map) in buffer.iter().enumerate() {
                    let start = at * stride as usize;
                    let value = u16::from_le_bytes([bytes[start], bytes[start + 1]]).into();
                    let special = special_index(IndexType::Uint16, value).map(TriangleMap::SpecialIndex);
                    prop_assert_eq!(map, Ok(special.unwrap_or(TriangleMap::Triangle(value))));
                },
            }
        }
    }
}
