//! Packed elements.

use omm_layout::packed::{self, PackedStates};
use omm_model::format::OpacityMicromapFormat;
use omm_model::opacity::OpacityState;

/// Packed elements unpack and pack to the same bytes, and are those that arithmetic on the bytes finds.
pub fn packed_data(bytes: &[u8]) {
    for format in OpacityMicromapFormat::ALL {
        let per_byte = 8 / format.bits();
        let count = bytes.len() as u64 * u64::from(per_byte);
        let Ok(states) = PackedStates::with_count(bytes, format, count) else {
            panic!("{count} elements do not fit into {} bytes", bytes.len());
        };
        let states: Vec<_> = states.iter().collect();
        let expected = bytes.iter().flat_map(|byte| {
            let element = move |at| byte >> (at * format.bits()) & ((1 << format.bits()) - 1);
            (0..per_byte).map(element).map(OpacityState::from_value)
        });
        assert!(expected.eq(states.iter().copied().map(Some)), "{format:?}");
        assert_eq!(packed::pack(format, &states).as_deref(), Ok(bytes), "{format:?}");
    }
}
