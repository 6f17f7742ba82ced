//! Instances of top-level structures with motion: 152 bytes each, 160 apart in an array.
//!
//! A type and eight bytes on, one of three structures: an instance of 64 bytes, or one of 112 or 144 that has two
//! transformations in the place of one.

use omm_model::vk::{self, MotionInstanceData};

use crate::bytes::{Reader, f32s};
use crate::error::{ReadError, ReadErrorKind, WriteError};
use crate::{instance, transform};

/// Bytes of a motion instance.
pub const SIZE: usize = 152;
/// Bytes from one to the next in an array.
pub const STRIDE: u64 = 160;
/// Bytes of the type and the reserved flags before the structure itself.
pub const HEADER: usize = 8;
/// The bits of an entry in an array of pointers that are the type; the structure lies at the address without them.
pub const POINTER_TYPE: u64 = 0xf;

/// Bytes of an SRT transformation.
const SRT_SIZE: usize = 64;

/// Bytes of the structure of a type; `None` if there is no such type.
#[must_use]
pub const fn data_size(ty: vk::MotionInstanceType) -> Option<usize> {
    match ty {
        vk::MotionInstanceType::STATIC => Some(instance::SIZE),
        vk::MotionInstanceType::MATRIX_MOTION => Some(instance::SIZE + transform::SIZE),
        vk::MotionInstanceType::SRT_MOTION => Some(instance::SIZE - transform::SIZE + 2 * SRT_SIZE),
        _ => None,
    }
}

/// Reads the structure of a type at the start of `bytes`.
///
/// # Errors
/// No such type, or fewer bytes than it takes.
pub fn read_data(ty: vk::MotionInstanceType, bytes: &[u8]) -> Result<MotionInstanceData, ReadError> {
    let mut input = Reader::new(bytes);
    Ok(match ty {
        vk::MotionInstanceType::STATIC => MotionInstanceData::StaticInstance(instance::read(bytes)?),
        vk::MotionInstanceType::MATRIX_MOTION => {
            let transform_t0 = transform::decode(input.array("transformT0")?);
            let vk::Instance {
                transform: transform_t1,
                instance_custom_index,
                mask,
                instance_shader_binding_table_record_offset,
                flags,
                acceleration_structure_reference,
            } = instance::decode(input.array("transformT1")?);
            MotionInstanceData::MatrixMotionInstance(vk::MatrixMotionInstance {
                transform_t0,
                transform_t1,
                instance_custom_index,
                mask,
                instance_shader_binding_table_record_offset,
                flags,
                acceleration_structure_reference,
            })
        }
        vk::MotionInstanceType::SRT_MOTION => {
            let transform_t0 = decode_srt(input.array("transformT0")?);
            let transform_t1 = decode_srt(input.array("transformT1")?);
            // An instance's last 16 bytes.
            let mut rest = [0; instance::SIZE];
            let tail: &[u8; instance::SIZE - transform::SIZE] = input.array("instanceCustomIndex")?;
            rest[transform::SIZE..].copy_from_slice(tail);
            let vk::Instance {
                transform: _,
                instance_custom_index,
                mask,
                instance_shader_binding_table_record_offset,
                flags,
                acceleration_structure_reference,
            } = instance::decode(&rest);
            MotionInstanceData::SrtMotionInstance(vk::SrtMotionInstance {
                transform_t0,
                transform_t1,
                instance_custom_index,
                mask,
                instance_shader_binding_table_record_offset,
                flags,
                acceleration_structure_reference,
            })
        }
        vk::MotionInstanceType(found) => {
            let required = "0 (static), 1 (matrix motion) or 2 (SRT motion)";
            return Err(ReadError::new("type", 0, ReadErrorKind::Unknown { found: found.into(), required }));
        }
    })
}

/// Reads the motion instance at the start of `bytes`; the reserved flags mean nothing.
///
/// # Errors
/// No such type, or fewer bytes than the type takes.
pub fn read(bytes: &[u8]) -> Result<MotionInstanceData, ReadError> {
    let mut input = Reader::new(bytes);
    let ty = vk::MotionInstanceType(input.u32("type")?.cast_signed());
    input.u32("flags")?;
    read_data(ty, input.rest())
        .map_err(|error| if error.field == "type" { error } else { error.moved_by(HEADER as u64) })
}

/// The structure of an instance, [`data_size`] bytes: what an array of pointers points to.
///
/// # Errors
/// A field that has no room; see [`instance::encode`].
pub fn encode_data(data: &MotionInstanceData) -> Result<Vec<u8>, WriteError> {
    let tail = |transform: vk::TransformMatrix| instance::encode(&vk::Instance { transform, ..data.at_rest() });
    Ok(match data {
        MotionInstanceData::StaticInstance(found) => instance::encode(found)?.to_vec(),
        MotionInstanceData::MatrixMotionInstance(found) => {
            [transform::encode(&found.transform_t0).as_slice(), &tail(found.transform_t1)?].concat()
        }
        MotionInstanceData::SrtMotionInstance(found) => {
            let tail = tail(vk::TransformMatrix::default())?;
            [&encode_srt(&found.transform_t0)[..], &encode_srt(&found.transform_t1), &tail[transform::SIZE..]].concat()
        }
    })
}

/// The 152 bytes of a motion instance; what its type has no use for is zero.
///
/// # Errors
/// A field that has no room; see [`instance::encode`].
pub fn encode(data: &MotionInstanceData) -> Result<[u8; SIZE], WriteError> {
    let mut bytes = [0; SIZE];
    bytes[..4].copy_from_slice(&data.ty().0.to_le_bytes());
    for (slot, byte) in bytes.iter_mut().skip(HEADER).zip(encode_data(data)?) {
        *slot = byte;
    }
    Ok(bytes)
}

fn decode_srt(bytes: &[u8; SRT_SIZE]) -> vk::SrtData {
    let [sx, a, b, pvx, sy, c, pvy, sz, pvz, qx, qy, qz, qw, tx, ty, tz] = f32s(bytes);
    vk::SrtData { sx, a, b, pvx, sy, c, pvy, sz, pvz, qx, qy, qz, qw, tx, ty, tz }
}

fn encode_srt(data: &vk::SrtData) -> [u8; SRT_SIZE] {
    let vk::SrtData { sx, a, b, pvx, sy, c, pvy, sz, pvz, qx, qy, qz, qw, tx, ty, tz } = *data;
    let mut bytes = [0; SRT_SIZE];
    let numbers = [sx, a, b, pvx, sy, c, pvy, sz, pvz, qx, qy, qz, qw, tx, ty, tz];
    for (bytes, number) in bytes.as_chunks_mut().0.iter_mut().zip(numbers) {
        *bytes = number.to_le_bytes();
    }
    bytes
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn any_bytes_of_a_known_type_are_an_instance(ty in 0_i32..3, bytes: [u8; SIZE - HEADER]) {
            let ty = vk::MotionInstanceType(ty);
            let data = read_data(ty, &bytes).unwrap();
            prop_assert_eq!(data.ty(), ty);
            let size = data_size(ty).unwrap();
            prop_assert_eq!(encode_data(&data).unwrap(), &bytes[..size]);
            let whole = encode(&data).unwrap();
            prop_assert_eq!(encode(&read(&whole).unwrap()).unwrap(), whole);
            prop_assert!(read_data(ty, &bytes[..size - 1]).unwrap_err().is_truncated());
            let other = data.with_reference(7);
            prop_assert_eq!((other.acceleration_structure_reference(), other.at_rest().mask), (7, data.at_rest().mask));
        }
    }

    #[test]
    fn fields_lie_where_the_chapter_puts_them() {
        let transform_t0 = vk::SrtData { sx: 1.0, tz: 2.0, ..Default::default() };
        let instance = vk::SrtMotionInstance {
            transform_t0,
            transform_t1: vk::SrtData::default(),
            instance_custom_index: 0x12_3456,
            mask: 0x78,
            instance_shader_binding_table_record_offset: 0x9a_bcde,
            flags: vk::GeometryInstanceFlags::FORCE_OPAQUE,
            acceleration_structure_reference: 9,
        };
        let bytes = encode(&MotionInstanceData::SrtMotionInstance(instance)).unwrap();
        assert_eq!(
            (bytes[0], bytes[8..12].to_vec(), bytes[68..72].to_vec()),
            (2, 1.0_f32.to_le_bytes().to_vec(), 2.0_f32.to_le_bytes().to_vec())
        );
        assert_eq!(bytes[136..145], [0x56, 0x34, 0x12, 0x78, 0xde, 0xbc, 0x9a, 0x04, 9]);
    }

    #[test]
    fn other_types_are_refused() {
        let error = read(&[3, 0, 0, 0, 0, 0, 0, 0]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "type at byte 0: found 3, required 0 (static), 1 (matrix motion) or 2 (SRT motion)"
        );
        assert!(read(&[0; 71]).unwrap_err().is_truncated());
        assert_eq!(data_size(vk::MotionInstanceType(-1)), None);
    }
}
