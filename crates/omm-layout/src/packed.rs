//! Packed elements: the opacity of microtriangles at one or two bits each, least significant bits first.

use bitvec::field::BitField;
use bitvec::order::Lsb0;
use bitvec::slice::BitSlice;
use bitvec::view::BitView;
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;

use crate::error::{ReadError, ReadErrorKind, WriteError, WriteErrorKind};

/// Bytes that `count` elements of `format` take, the last byte filled up.
#[must_use]
pub const fn size(format: OpacityMicromapFormat, count: u64) -> u64 {
    let per_byte = 8 / format.bits() as u64;
    count.div_ceil(per_byte)
}

/// The bits of the last byte of a triangle's data that belong to elements; all of them from level 2 on.
#[must_use]
pub const fn last_byte_mask(format: OpacityMicromapFormat, level: SubdivisionLevel) -> u8 {
    let bits = level.microtriangles() * format.bits();
    if bits < 8 { (1 << bits) - 1 } else { u8::MAX }
}

/// The elements of one micromap triangle, read in place.
#[derive(Clone, Copy, Debug)]
pub struct PackedStates<'a> {
    format: OpacityMicromapFormat,
    bits: &'a BitSlice<u8, Lsb0>,
}

impl<'a> PackedStates<'a> {
    /// The elements of a triangle of `format` and `level` at the start of `data`, which may go on behind them.
    ///
    /// # Errors
    /// `data` is shorter than the triangle.
    pub fn new(data: &'a [u8], format: OpacityMicromapFormat, level: SubdivisionLevel) -> Result<Self, ReadError> {
        Self::with_count(data, format, level.microtriangles().into())
    }

    /// The first `count` elements of `data`.
    ///
    /// # Errors
    /// `data` is shorter than that.
    pub fn with_count(data: &'a [u8], format: OpacityMicromapFormat, count: u64) -> Result<Self, ReadError> {
        let (required, available) = (size(format, count), data.len() as u64);
        let bits = count.checked_mul(format.bits().into()).and_then(|bits| usize::try_from(bits).ok());
        let bits = bits.and_then(|bits| data.view_bits().get(..bits));
        let kind = ReadErrorKind::Truncated { available, required };
        Ok(Self { format, bits: bits.ok_or_else(|| ReadError::new("data", 0, kind))? })
    }

    /// Number of elements.
    #[must_use]
    pub fn len(&self) -> usize {
        self.bits.len() / self.format.bits() as usize
    }

    /// Whether there are no elements.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.bits.is_empty()
    }

    /// The state of element `index`, if there are so many.
    #[must_use]
    pub fn get(&self, index: usize) -> Option<OpacityState> {
        let width = self.format.bits() as usize;
        let start = index.checked_mul(width)?;
        self.bits.get(start..start.checked_add(width)?).map(state)
    }

    /// The states in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = OpacityState> + DoubleEndedIterator + 'a {
        let packed = *self;
        // Every index is below the length, so the default is never taken.
        (0..self.len()).map(move |index| packed.get(index).unwrap_or(OpacityState::Transparent))
    }

    /// The states as letters, one each; see [`OpacityState::letter`].
    #[must_use]
    pub fn letters(&self) -> String {
        self.iter().map(OpacityState::letter).collect()
    }
}

/// The state that an element's bits stand for; a single bit has no unknown states.
fn state(bits: &BitSlice<u8, Lsb0>) -> OpacityState {
    let [low, high] = [0, 1].map(|bit| bits.get(bit).is_some_and(|bit| *bit));
    match (high, low) {
        (false, false) => OpacityState::Transparent,
        (false, true) => OpacityState::Opaque,
        (true, false) => OpacityState::UnknownTransparent,
        (true, true) => OpacityState::UnknownOpaque,
    }
}

/// Packs `states`, each in turn from the least significant bit on; unused bits of the last byte are 0.
///
/// # Errors
/// An unknown state in 2-state data.
pub fn pack(format: OpacityMicromapFormat, states: &[OpacityState]) -> Result<Vec<u8>, WriteError> {
    // A slice of states is at least as long as its packed form.
    let mut data = vec![0; states.len().div_ceil(8 / format.bits() as usize)];
    write(format, states, &mut data)?;
    Ok(data)
}

/// Packs `states` into the start of `data`; elements behind them are left as they were.
///
/// # Errors
/// An unknown state in 2-state data, or too little room; then nothing is written.
pub fn write(format: OpacityMicromapFormat, states: &[OpacityState], data: &mut [u8]) -> Result<(), WriteError> {
    let required = size(format, states.len() as u64);
    crate::error::fits("states", required, data.len() as u64)?;
    if format == OpacityMicromapFormat::TwoState
        && let Some((index, state)) = states.iter().enumerate().find(|(_, state)| !state.is_known())
    {
        let instead = state.to_two_state();
        let kind = WriteErrorKind::Ambiguous { found: format!("{state:?}"), instead: format!("{instead:?}") };
        return Err(WriteError::new(format!("states[{index}]"), kind));
    }
    // Whole bytes are put together first; only the elements of the last byte have neighbours to keep.
    let width = format.bits() as usize;
    let mut chunks = states.chunks_exact(8 / width);
    let mut bytes = data.iter_mut();
    for (chunk, byte) in chunks.by_ref().zip(bytes.by_ref()) {
        *byte = chunk.iter().rev().fold(0, |byte, state| byte << width | state.value());
    }
    let rest = bytes.into_slice().view_bits_mut::<Lsb0>().chunks_exact_mut(width);
    rest.zip(chunks.remainder()).for_each(|(element, state)| element.store_le(state.value()));
    Ok(())
}

/// Gives `count` elements of `data` from `first` on one state.
///
/// # Errors
/// An unknown state in 2-state data, or elements beyond the end; then nothing is written.
pub fn fill(
    format: OpacityMicromapFormat,
    data: &mut [u8],
    first: usize,
    count: usize,
    state: OpacityState,
) -> Result<(), WriteError> {
    if format == OpacityMicromapFormat::TwoState && !state.is_known() {
        let instead = state.to_two_state();
        let kind = WriteErrorKind::Ambiguous { found: format!("{state:?}"), instead: format!("{instead:?}") };
        return Err(WriteError::new("state", kind));
    }
    let width = format.bits() as usize;
    let limit = data.len().saturating_mul(8 / width);
    let end = first.saturating_add(count);
    crate::error::fits("elements", end as u64, limit as u64)?;
    // The run is cut out first: `nth` of bitvec's mutable chunks, and so `skip`, loses the last chunk (ferrilab/bitvec#231).
    let run = data.view_bits_mut::<Lsb0>().get_mut(first.saturating_mul(width)..end.saturating_mul(width));
    if let Some(run) = run {
        run.chunks_exact_mut(width).for_each(|element| element.store_le(state.value()));
    }
    Ok(())
}

/// A letter that stands for no state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("letter {index} is {found:?}, required T, O, u or U")]
pub struct StateLetterError {
    /// Letters before it.
    pub index: usize,
    /// The letter found.
    pub found: char,
}

/// The states that letters stand for: `T` transparent, `O` opaque, `u` unknown transparent, `U` unknown opaque.
///
/// # Errors
/// The first letter that is none of the four.
pub fn states(letters: &str) -> Result<Vec<OpacityState>, StateLetterError> {
    let state = |(index, found)| {
        let state = OpacityState::ALL.into_iter().find(|state| state.letter() == found);
        state.ok_or(StateLetterError { index, found })
    };
    letters.chars().enumerate().map(state).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const FORMATS: [OpacityMicromapFormat; 2] = OpacityMicromapFormat::ALL;

    #[test]
    fn letters_and_bytes() {
        let four = OpacityMicromapFormat::FourState;
        assert_eq!(pack(four, &states("TOuU").unwrap()), Ok(vec![0b1110_0100]));
        assert_eq!(pack(OpacityMicromapFormat::TwoState, &states("TOOTTTTTO").unwrap()), Ok(vec![0b110, 1]));
        let data = [0b1110_0100, 0b01];
        assert_eq!(PackedStates::with_count(&data, four, 5).unwrap().letters(), "TOuUO");
        assert_eq!(states("TOx").unwrap_err().to_string(), "letter 2 is 'x', required T, O, u or U");
    }

    #[test]
    fn what_has_no_room_is_refused() {
        let two = OpacityMicromapFormat::TwoState;
        let error = pack(two, &states("TOu").unwrap()).unwrap_err();
        assert_eq!(error.to_string(), "states[2]: UnknownTransparent cannot be told from Transparent");
        let mut data = [0xff];
        let error = write(two, &[OpacityState::Transparent; 9], &mut data).unwrap_err();
        assert_eq!(error.to_string(), "states: found 2, room for at most 1");
        let error = fill(two, &mut data, 7, 2, OpacityState::Transparent).unwrap_err();
        assert_eq!(error.to_string(), "elements: found 9, room for at most 8");
        assert!(fill(two, &mut data, 0, 1, OpacityState::UnknownOpaque).is_err());
        assert_eq!(data, [0xff]);
        let level = SubdivisionLevel::new(3).unwrap();
        let error = PackedStates::new(&[0; 15], OpacityMicromapFormat::FourState, level).unwrap_err();
        assert_eq!(error.to_string(), "data at byte 0: 16 bytes are needed, 15 are there");
        assert!(PackedStates::with_count(&[], two, u64::MAX).is_err());
    }

    #[test]
    fn only_the_first_levels_leave_bits_unused() {
        for format in FORMATS {
            for level in SubdivisionLevel::all() {
                let mask = last_byte_mask(format, level);
                let used = u64::from(level.microtriangles() * format.bits());
                assert_eq!(8 * (u64::from(format.data_size(level)) - 1) + u64::from(mask.count_ones()), used);
                assert_eq!(size(format, level.microtriangles().into()), format.data_size(level).into());
            }
        }
    }

    fn any_states() -> impl Strategy<Value = (OpacityMicromapFormat, Vec<OpacityState>)> {
        (0..2_usize, prop::collection::vec(0..4_u8, 0..70)).prop_map(|(format, values)| {
            let format = FORMATS[format];
            let state = |value| OpacityState::from_value(value % (1 << format.bits())).unwrap();
            (format, values.into_iter().map(state).collect())
        })
    }

    proptest! {
        #[test]
        fn packing_is_undone_and_agrees_with_the_model((format, states) in any_states()) {
            let data = pack(format, &states).unwrap();
            prop_assert_eq!(data.len() as u64, size(format, states.len() as u64));
            let packed = PackedStates::with_count(&data, format, states.len() as u64).unwrap();
            prop_assert_eq!(packed.len(), states.len());
            prop_assert_eq!(packed.iter().collect::<Vec<_>>(), states.clone());
            prop_assert!(packed.iter().rev().eq(states.iter().rev().copied()));
            for (index, state) in states.iter().enumerate() {
                prop_assert_eq!(packed.get(index), Some(*state));
                prop_assert_eq!(packed.iter().nth(index), Some(*state));
                prop_assert_eq!(format.state(&data, index as u64), Some(*state));
            }
            prop_assert_eq!(packed.get(states.len()), None);
            prop_assert_eq!(super::states(&packed.letters()).unwrap(), states);
        }

        #[test]
        fn writing_leaves_what_follows((format, states) in any_states(), filler: u8) {
            let mut data = [filler; 40];
            write(format, &states, &mut data).unwrap();
            let after = PackedStates::with_count(&data, format, 40 * 8 / u64::from(format.bits())).unwrap();
            let before = [filler; 40];
            let before = PackedStates::with_count(&before, format, after.len() as u64).unwrap();
            let expected = states.iter().copied().chain(before.iter().skip(states.len()));
            prop_assert!(after.iter().eq(expected));
        }

        #[test]
        fn filling_touches_its_elements_only((format, mut states) in any_states(), first in 0..70_usize, count in 0..70_usize) {
            let mut data = pack(format, &states).unwrap();
            let room = data.len() * 8 / format.bits() as usize;
            let result = fill(format, &mut data, first, count, OpacityState::Opaque);
            prop_assert_eq!(result.is_ok(), first + count <= room);
            if result.is_ok() {
                states.iter_mut().skip(first).take(count).for_each(|state| *state = OpacityState::Opaque);
            }
            let packed = PackedStates::with_count(&data, format, states.len() as u64).unwrap();
            prop_assert_eq!(packed.iter().collect::<Vec<_>>(), states);
        }
    }
}
