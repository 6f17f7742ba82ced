//! Instances, the entries of an instance buffer: 64 bytes each.

use omm_model::vk;

use crate::bytes::{Reader, u32_at, u64_at};
use crate::error::{ReadError, WriteError, fits};
use crate::transform;

/// Bytes of an instance.
pub const SIZE: usize = 64;
/// The largest value of a 24-bit field.
const LIMIT_24: u64 = (1 << 24) - 1;

/// The instance that 64 bytes hold. Any bytes hold one.
#[must_use]
pub fn decode(bytes: &[u8; SIZE]) -> vk::Instance {
    let (index_and_mask, offset_and_flags) = (u32_at::<48, SIZE>(bytes), u32_at::<52, SIZE>(bytes));
    let [.., mask] = index_and_mask.to_le_bytes();
    let low_24 = |word: u32| word & 0x00ff_ffff;
    vk::Instance {
        transform: transform::leading(bytes),
        instance_custom_index: low_24(index_and_mask),
        mask,
        instance_shader_binding_table_record_offset: low_24(offset_and_flags),
        flags: vk::GeometryInstanceFlags::from_bits_retain(offset_and_flags >> 24),
        acceleration_structure_reference: u64_at::<56, SIZE>(bytes),
    }
}

/// Reads the instance at the start of `bytes`.
///
/// # Errors
/// Fewer than 64 bytes.
pub fn read(bytes: &[u8]) -> Result<vk::Instance, ReadError> {
    Reader::new(bytes).array("instance").map(decode)
}

/// The 64 bytes of an instance.
///
/// # Errors
/// A custom index or record offset above 2<sup>24</sup> - 1, or flags above 255.
pub fn encode(instance: &vk::Instance) -> Result<[u8; SIZE], WriteError> {
    let vk::Instance {
        transform,
        instance_custom_index,
        mask,
        instance_shader_binding_table_record_offset,
        flags,
        acceleration_structure_reference,
    } = *instance;
    fits("instance_custom_index", instance_custom_index.into(), LIMIT_24)?;
    let offset = instance_shader_binding_table_record_offset;
    fits("instance_shader_binding_table_record_offset", offset.into(), LIMIT_24)?;
    fits("flags", flags.bits().into(), u8::MAX.into())?;
    let mut bytes = [0; SIZE];
    bytes[..48].copy_from_slice(&transform::encode(&transform));
    bytes[48..52].copy_from_slice(&(instance_custom_index | u32::from(mask) << 24).to_le_bytes());
    bytes[52..56].copy_from_slice(&(offset | flags.bits() << 24).to_le_bytes());
    bytes[56..].copy_from_slice(&acceleration_structure_reference.to_le_bytes());
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn any_bytes_are_an_instance(bytes: [u8; SIZE]) {
            prop_assert_eq!(encode(&decode(&bytes)), Ok(bytes));
        }
    }

    #[test]
    fn fields_lie_where_the_chapter_puts_them() {
        let instance = vk::Instance {
            transform: vk::TransformMatrix::IDENTITY,
            instance_custom_index: 0x12_3456,
            mask: 0x78,
            instance_shader_binding_table_record_offset: 0x9a_bcde,
            flags: vk::GeometryInstanceFlags::FORCE_OPAQUE,
            acceleration_structure_reference: 0x0102_0304_0506_0708,
        };
        let bytes = encode(&instance).unwrap();
        assert_eq!(bytes[48..56], [0x56, 0x34, 0x12, 0x78, 0xde, 0xbc, 0x9a, 0x04]);
        assert_eq!(bytes[56..], [8, 7, 6, 5, 4, 3, 2, 1]);
        assert_eq!(read(&bytes), Ok(instance));
        let error = read(&bytes[..63]).unwrap_err();
        assert_eq!(error.to_string(), "instance at byte 0: 64 bytes are needed, 63 are there");
    }

    #[test]
    fn what_has_no_room_is_refused() {
        let text = |instance: vk::Instance| encode(&instance).unwrap_err().to_string();
        let default = vk::Instance::default();
        assert_eq!(
            text(vk::Instance { instance_custom_index: 1 << 24, ..default }),
            "instance_custom_index: found 16777216, room for at most 16777215"
        );
        let instance_shader_binding_table_record_offset = u32::MAX;
        assert_eq!(
            text(vk::Instance { instance_shader_binding_table_record_offset, ..default }),
            "instance_shader_binding_table_record_offset: found 4294967295, room for at most 16777215"
        );
        let flags = vk::GeometryInstanceFlags::from_bits_retain(0x100);
        assert_eq!(text(vk::Instance { flags, ..default }), "flags: found 256, room for at most 255");
    }
}
