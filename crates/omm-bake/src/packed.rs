//! States that are packed already: combined, renamed, counted and made coarser without being taken apart.
//!
//! An element of 4-state data has its side in the low bit (0 transparent, 1 opaque) and whether it is unknown in the high bit. So
//! what follows are operations on bits.

use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;

use crate::promotion::UnknownStatePromotion;
use crate::statistics::StateCounts;

/// The low bits of the elements of a byte of 4-state data.
const SIDES: u8 = 0x55;
/// The high bits.
const UNKNOWN: u8 = 0xaa;

/// The bits with a 0 between each two.
pub(crate) const fn spread(bits: u16) -> u32 {
    let bits = bits as u32;
    let bits = (bits | bits << 8) & 0x00ff_00ff;
    let bits = (bits | bits << 4) & 0x0f0f_0f0f;
    let bits = (bits | bits << 2) & 0x3333_3333;
    (bits | bits << 1) & 0x5555_5555
}

/// Every other bit, from the first on.
pub(crate) const fn gather(bits: u32) -> u16 {
    let bits = bits & 0x5555_5555;
    let bits = (bits | bits >> 1) & 0x3333_3333;
    let bits = (bits | bits >> 2) & 0x0f0f_0f0f;
    let bits = (bits | bits >> 4) & 0x00ff_00ff;
    (bits | bits >> 8) as u16
}

/// Makes unknown what `other`, 4-state data of the same length, does not know to have the same state. The side stays.
pub(crate) fn combine(data: &mut [u8], other: &[u8]) {
    for (byte, &other) in data.iter_mut().zip(other) {
        *byte |= (other & UNKNOWN) | ((*byte ^ other) & SIDES) << 1;
    }
}

/// Gives the unknown elements of 4-state data the side that `promotion` forces, if it does.
pub(crate) fn settle(data: &mut [u8], promotion: UnknownStatePromotion) {
    let sides = |byte: u8| (byte & UNKNOWN) >> 1;
    match promotion {
        UnknownStatePromotion::Nearest => {}
        UnknownStatePromotion::ForceOpaque => data.iter_mut().for_each(|byte| *byte |= sides(*byte)),
        UnknownStatePromotion::ForceTransparent => data.iter_mut().for_each(|byte| *byte &= !sides(*byte)),
    }
}

/// Replaces each of the elements of 4-state data of `level` by `states[value]`.
pub(crate) fn rename(data: &mut [u8], level: SubdivisionLevel, states: [OpacityState; 4]) {
    let table: [u8; 256] = std::array::from_fn(|byte| {
        (0..8).step_by(2).fold(0, |renamed, shift| renamed | states[byte >> shift & 3].value() << shift)
    });
    data.iter_mut().for_each(|byte| *byte = table[usize::from(*byte)]);
    clear_padding(data, OpacityMicromapFormat::FourState, level);
}

/// Clears the bits of a last byte that no element has.
fn clear_padding(data: &mut [u8], format: OpacityMicromapFormat, level: SubdivisionLevel) {
    let bits = level.microtriangles() * format.bits();
    if let ([byte], true) = (data, bits < 8) {
        *byte &= (1 << bits) - 1;
    }
}

/// The sides of 4-state data, as 2-state data.
pub(crate) fn to_two_state(data: &[u8]) -> Vec<u8> {
    let nibble = |byte: u8| (0..4).fold(0, |nibble, k| nibble | (byte >> (2 * k) & 1) << k);
    let table: [u8; 256] = std::array::from_fn(|byte| nibble(byte as u8));
    data.chunks(2).map(|pair| pair.iter().rev().fold(0, |two, &byte| two << 4 | table[usize::from(byte)])).collect()
}

/// 2-state data of `level` as 4-state data: everything is known.
pub(crate) fn to_four_state(data: &[u8], level: SubdivisionLevel) -> Vec<u8> {
    let spread = |nibble: u8| (0..4).fold(0, |byte, k| byte | (nibble >> k & 1) << (2 * k));
    let table: [u8; 16] = std::array::from_fn(|nibble| spread(nibble as u8));
    let bytes = data.iter().flat_map(|byte| [table[usize::from(byte & 0xf)], table[usize::from(byte >> 4)]]);
    bytes.take(OpacityMicromapFormat::FourState.data_size(level) as usize).collect()
}

/// How many of the elements of `data`, of this format and level, have each state.
pub(crate) fn count(data: &[u8], format: OpacityMicromapFormat, level: SubdivisionLevel) -> StateCounts {
    let per_word = u64::BITS / format.bits();
    let total = level.microtriangles();
    let (words, rest) = data.as_chunks::<8>();
    let rest = rest.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte));
    let mut counts = count_word(rest, format, total % per_word);
    for word in words {
        counts.add_all(count_word(u64::from_le_bytes(*word), format, per_word), 1);
    }
    counts
}

/// How many of the first `total` elements of a word have each state; all other bits are 0.
#[inline]
pub(crate) fn count_word(word: u64, format: OpacityMicromapFormat, total: u32) -> StateCounts {
    const LOW: u64 = 0x5555_5555_5555_5555;
    let (sides, unknown) = match format {
        OpacityMicromapFormat::TwoState => (word, 0),
        OpacityMicromapFormat::FourState => (word & LOW, word >> 1 & LOW),
    };
    let (opaque, unknown_opaque) = ((sides & !unknown).count_ones(), (sides & unknown).count_ones());
    let unknown_transparent = unknown.count_ones() - unknown_opaque;
    let [opaque, unknown_transparent, unknown_opaque] = [opaque, unknown_transparent, unknown_opaque].map(u64::from);
    let transparent = u64::from(total) - (opaque + unknown_transparent + unknown_opaque).min(total.into());
    StateCounts { transparent, opaque, unknown_transparent, unknown_opaque }
}

/// The data one level up: each element is what its four children have in common, or, if they differ, unknown with the side that
/// `promotion` chooses. 2-state data keeps only that side.
///
/// [`Nearest`](UnknownStatePromotion::Nearest) chooses opaque if at least two of the children have that side. `level` is above 0.
pub(crate) fn coarser(
    data: &[u8],
    format: OpacityMicromapFormat,
    level: SubdivisionLevel,
    promotion: UnknownStatePromotion,
) -> Vec<u8> {
    let side = |opaque: u32| match promotion {
        UnknownStatePromotion::Nearest => u8::from(opaque >= 2),
        UnknownStatePromotion::ForceOpaque => 1,
        UnknownStatePromotion::ForceTransparent => 0,
    };
    let four_state = |byte: u8| match byte {
        0x00 => 0,
        0x55 => 1,
        _ => 2 | side((byte & SIDES).count_ones()),
    };
    let two_state = |nibble: u8| match nibble {
        0x0 => 0,
        0xf => 1,
        _ => side(nibble.count_ones()),
    };
    match format {
        OpacityMicromapFormat::FourState => {
            let table: [u8; 256] = std::array::from_fn(|byte| four_state(byte as u8));
            let join = |bytes: &[u8]| bytes.iter().rev().fold(0, |up, &byte| up << 2 | table[usize::from(byte)]);
            data.chunks(4).map(join).collect()
        }
        OpacityMicromapFormat::TwoState => {
            let table: [u8; 256] =
                std::array::from_fn(|byte| two_state(byte as u8 & 0xf) | two_state(byte as u8 >> 4) << 1);
            let join = |bytes: &[u8]| bytes.iter().rev().fold(0, |up, &byte| up << 2 | table[usize::from(byte)]);
            let mut coarser: Vec<u8> = data.chunks(4).map(join).collect();
            if let Some(level) = level.coarser() {
                // Level 1 has one nibble: the other reads as four transparent children.
                clear_padding(&mut coarser, format, level);
            }
            coarser
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const FORMATS: [OpacityMicromapFormat; 2] = OpacityMicromapFormat::ALL;
    const PROMOTIONS: [UnknownStatePromotion; 3] =
        [UnknownStatePromotion::Nearest, UnknownStatePromotion::ForceOpaque, UnknownStatePromotion::ForceTransparent];

    fn states(data: &[u8], format: OpacityMicromapFormat, level: SubdivisionLevel) -> Vec<OpacityState> {
        (0..level.microtriangles()).map(|index| format.state(data, index.into()).unwrap()).collect()
    }

    #[test]
    fn bits_are_spread() {
        for bits in 0..=u16::MAX {
            let expected = (0..16).fold(0, |spread, bit| spread | u32::from(bits >> bit & 1) << (2 * bit));
            assert_eq!((spread(bits), gather(expected | !expected << 1 & 0xaaaa_aaaa)), (expected, bits));
        }
    }

    /// Data of any states at any level up to 4, and a second of the same size.
    fn blocks() -> impl Strategy<Value = (OpacityMicromapFormat, SubdivisionLevel, [Vec<u8>; 2])> {
        (0..2_usize, 0..=4_u32).prop_flat_map(|(format, level)| {
            let (format, level) = (FORMATS[format], SubdivisionLevel::new(level).unwrap());
            let byte = prop_oneof![any::<u8>(), Just(0), Just(0x55), Just(0xff), Just(0xaa)];
            let bytes = prop::collection::vec(byte, format.data_size(level) as usize);
            let data = bytes.prop_map(move |mut bytes| {
                clear_padding(&mut bytes, format, level);
                bytes
            });
            (Just(format), Just(level), [data.clone(), data])
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn counting_is_counting_one_by_one((format, level, [data, _]) in blocks()) {
            let mut expected = StateCounts::default();
            states(&data, format, level).into_iter().for_each(|state| expected.add(state, 1));
            prop_assert_eq!(count(&data, format, level), expected);
        }

        #[test]
        fn combined_elements_are_known_only_if_both_know_the_same((_, level, [mut data, _]) in blocks(), seed: u64) {
            let format = OpacityMicromapFormat::FourState;
            data.resize(format.data_size(level) as usize, 0);
            clear_padding(&mut data, format, level);
            let mut other = data.clone();
            let flips = other.iter_mut().zip(seed.to_le_bytes().into_iter().cycle());
            flips.for_each(|(byte, flip)| *byte ^= flip & flip.rotate_left(3));
            clear_padding(&mut other, format, level);
            for promotion in PROMOTIONS {
                let mut found = data.clone();
                combine(&mut found, &other);
                settle(&mut found, promotion);
                let all = states(&data, format, level).into_iter().zip(states(&other, format, level));
                for ((a, b), found) in all.zip(states(&found, format, level)) {
                    let expected = if a == b && a.is_known() {
                        a
                    } else {
                        match (promotion, a.to_two_state()) {
                            (UnknownStatePromotion::ForceOpaque, _)
                            | (UnknownStatePromotion::Nearest, OpacityState::Opaque) => OpacityState::UnknownOpaque,
                            _ => OpacityState::UnknownTransparent,
                        }
                    };
                    prop_assert_eq!(found, expected);
                }
                prop_assert_eq!(count(&found, format, level).total(), u64::from(level.microtriangles()));
            }
        }

        #[test]
        fn names_and_formats((format, level, [data, _]) in blocks(), pick: [u8; 4]) {
            let four = match format {
                OpacityMicromapFormat::TwoState => to_four_state(&data, level),
                OpacityMicromapFormat::FourState => data.clone(),
            };
            prop_assert_eq!(states(&four, OpacityMicromapFormat::FourState, level), states(&data, format, level));
            let two = to_two_state(&four);
            prop_assert_eq!(two.len(), OpacityMicromapFormat::TwoState.data_size(level) as usize);
            let sides: Vec<_> = states(&data, format, level).iter().map(|state| state.to_two_state()).collect();
            prop_assert_eq!(states(&two, OpacityMicromapFormat::TwoState, level), sides);
            let names = pick.map(|k| OpacityState::ALL[usize::from(k % 4)]);
            let mut renamed = four.clone();
            rename(&mut renamed, level, names);
            let expected: Vec<_> =
                states(&data, format, level).iter().map(|state| names[usize::from(state.value())]).collect();
            prop_assert_eq!(states(&renamed, OpacityMicromapFormat::FourState, level), expected);
            prop_assert_eq!(count(&renamed, OpacityMicromapFormat::FourState, level).total(), u64::from(level.microtriangles()));
        }

        #[test]
        fn a_coarser_element_is_what_its_children_agree_on((format, level, [data, _]) in blocks()) {
            let Some(up) = level.coarser() else { return Ok(()) };
            for promotion in PROMOTIONS {
                let found = coarser(&data, format, level, promotion);
                prop_assert_eq!(found.len(), format.data_size(up) as usize);
                let children = states(&data, format, level);
                for (state, children) in states(&found, format, up).into_iter().zip(children.chunks(4)) {
                    let opaque = children.iter().filter(|child| child.to_two_state() == OpacityState::Opaque).count();
                    let opaque = match promotion {
                        UnknownStatePromotion::Nearest => opaque >= 2,
                        UnknownStatePromotion::ForceOpaque => true,
                        UnknownStatePromotion::ForceTransparent => false,
                    };
                    let mixed = if opaque { OpacityState::UnknownOpaque } else { OpacityState::UnknownTransparent };
                    let same = children[0].is_known() && children.iter().all(|child| *child == children[0]);
                    let expected = if same { children[0] } else { mixed };
                    let two_state = format == OpacityMicromapFormat::TwoState;
                    prop_assert_eq!(state, if two_state { expected.to_two_state() } else { expected });
                }
                prop_assert_eq!(count(&found, format, up).total(), u64::from(up.microtriangles()));
            }
        }
    }
}
