//! Usage counts: 12 bytes each — u32 count, u32 level, 32 bits of format.
//!
//! `VkMicromapUsageKHR` and `VkMicromapUsageEXT` differ in the type of `format` only, not in their bytes.

use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::usage::MicromapUsage;
use omm_model::vk;

use crate::bytes::u32_at;
use crate::error::{ReadError, ReadErrorKind};
use crate::strided::Strided;

/// Bytes of a usage count.
pub const SIZE: usize = 12;

/// The usage count that 12 bytes hold. Any bytes hold one.
#[must_use]
pub fn decode(bytes: &[u8; SIZE]) -> vk::MicromapUsage {
    vk::MicromapUsage {
        count: u32_at::<0, SIZE>(bytes),
        subdivision_level: u32_at::<4, SIZE>(bytes),
        format: vk::OpacityMicromapFormat(u32_at::<8, SIZE>(bytes).cast_signed()),
    }
}

/// The 12 bytes of a usage count.
#[must_use]
pub fn encode(usage: &vk::MicromapUsage) -> [u8; SIZE] {
    let vk::MicromapUsage { count, subdivision_level, format } = *usage;
    let mut bytes = [0; SIZE];
    bytes[0..4].copy_from_slice(&count.to_le_bytes());
    bytes[4..8].copy_from_slice(&subdivision_level.to_le_bytes());
    bytes[8..12].copy_from_slice(&format.0.to_le_bytes());
    bytes
}

/// Reads `count` usage counts at the start of `bytes`, as they are stored.
///
/// # Errors
/// The last one ends behind `bytes`.
pub fn read(bytes: &[u8], count: u64) -> Result<impl Iterator<Item = vk::MicromapUsage> + Clone, ReadError> {
    Ok(Strided::<SIZE>::new(bytes, SIZE as u64, count, "usages")?.iter().map(decode))
}

/// Reads `count` usage counts at the start of `bytes` and requires each to have a meaning.
///
/// # Errors
/// The last one ends behind `bytes`, or a level or format has no meaning.
pub fn read_checked(bytes: &[u8], count: u64) -> Result<Vec<MicromapUsage>, ReadError> {
    let checked = |(raw, index): (vk::MicromapUsage, u64)| {
        check(raw).map_err(|error| error.moved_by(index * SIZE as u64).within(format_args!("usages[{index}]")))
    };
    read(bytes, count)?.zip(0..).map(checked).collect()
}

fn check(raw: vk::MicromapUsage) -> Result<MicromapUsage, ReadError> {
    let vk::MicromapUsage { count, subdivision_level: level, format } = raw;
    let subdivision_level = SubdivisionLevel::new(level).map_err(|_| {
        let limit = SubdivisionLevel::MAX.get().into();
        ReadError::new("subdivision_level", 4, ReadErrorKind::Above { found: level.into(), limit })
    })?;
    let format = OpacityMicromapFormat::try_from(format).map_err(|found| {
        let kind = ReadErrorKind::Unknown { found: found.0.into(), required: "1 (2-state) or 2 (4-state)" };
        ReadError::new("format", 8, kind)
    })?;
    Ok(MicromapUsage { count, subdivision_level, format })
}

/// The bytes of usage counts, tightly packed.
pub fn write(usages: impl IntoIterator<Item = vk::MicromapUsage>) -> Vec<u8> {
    usages.into_iter().flat_map(|usage| encode(&usage)).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn bytes_round_trip(bytes: Vec<[u8; SIZE]>) {
            let flat = bytes.as_flattened();
            let usages: Vec<_> = read(flat, bytes.len() as u64).unwrap().collect();
            prop_assert_eq!(write(usages.iter().copied()), flat);
            prop_assert!(read(flat, bytes.len() as u64 + 1).is_err());
        }

        #[test]
        fn usages_with_a_meaning_stay(usages in prop::collection::vec((any::<u32>(), 0..=12_u32, 0..2_usize), 0..9)) {
            let usages: Vec<_> = usages.into_iter().map(|(count, level, format)| MicromapUsage {
                count,
                subdivision_level: SubdivisionLevel::new(level).unwrap(),
                format: OpacityMicromapFormat::ALL[format],
            }).collect();
            let bytes = write(usages.iter().map(|usage| vk::MicromapUsage::from(*usage)));
            prop_assert_eq!(read_checked(&bytes, usages.len() as u64), Ok(usages));
        }
    }

    #[test]
    fn usages_without_a_meaning_are_named() {
        let usage = |subdivision_level, format| vk::MicromapUsage {
            count: 1,
            subdivision_level,
            format: vk::OpacityMicromapFormat(format),
        };
        let text = |raw| read_checked(&write([usage(0, 1), raw]), 2).unwrap_err().to_string();
        assert_eq!(text(usage(99, 1)), "usages[1].subdivision_level at byte 16: found 99, required at most 12");
        assert_eq!(text(usage(3, -1)), "usages[1].format at byte 20: found -1, required 1 (2-state) or 2 (4-state)");
        let error = read_checked(&[0; 23], 2).unwrap_err();
        assert_eq!(error.to_string(), "usages at byte 0: 24 bytes are needed, 23 are there");
    }
}
