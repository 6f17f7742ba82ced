//! Lossy builds: micromaps whose level is beyond the limit of their format are stored at the limit.
//!
//! A coarse microtriangle covers 4<sup>n</sup> consecutive fine ones, because the curve visits all parts of a microtriangle before
//! it goes on. Where all of them have one state the coarse one has it too. Otherwise it becomes unknown: unknown opaque if at
//! least half of them are opaque or unknown opaque, else unknown transparent. So no known state is ever replaced by another
//! known one, and what replaces a state depends on the elements of that triangle alone.

use omm_layout::object::MicromapTriangleData;
use omm_layout::packed;
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;
use omm_model::profile::Limits;

use crate::undefined::Stop;

/// The level at which a lossy build stores triangles of a level: the highest that the format allows, at most the level itself.
///
/// Two-state data has no unknown states to fall back to and stays as it is.
pub(crate) fn stored_level(
    limits: &Limits,
    format: OpacityMicromapFormat,
    level: SubdivisionLevel,
) -> SubdivisionLevel {
    let limit = limits.max_opacity4_state_subdivision_level.min(level.get());
    match format {
        OpacityMicromapFormat::TwoState => level,
        OpacityMicromapFormat::FourState => SubdivisionLevel::new(limit).unwrap_or(level),
    }
}

/// The elements of a four-state triangle at a coarser level, packed.
pub(crate) fn coarsen(fine: &MicromapTriangleData<'_>, level: SubdivisionLevel) -> Result<Vec<u8>, Stop> {
    let states = packed::PackedStates::new(fine.data, fine.format, fine.subdivision_level)?;
    let parts = 1_usize << (2 * fine.subdivision_level.get().saturating_sub(level.get()));
    let mut states = states.iter();
    let mut coarse = Vec::with_capacity(level.microtriangles() as usize);
    for _ in 0..level.microtriangles() {
        coarse.extend(merge(states.by_ref().take(parts)));
    }
    // As many states come out as the level has microtriangles, all of which the format can hold.
    Ok(packed::pack(fine.format, &coarse).map_err(super::too_large)?)
}

/// The state that stands for several.
fn merge(states: impl Iterator<Item = OpacityState>) -> Option<OpacityState> {
    let (mut first, mut uniform, mut opaque, mut all) = (None, true, 0_u32, 0_u32);
    for state in states {
        uniform &= *first.get_or_insert(state) == state;
        opaque += u32::from(matches!(state, OpacityState::Opaque | OpacityState::UnknownOpaque));
        all += 1;
    }
    let unknown = if opaque >= all - opaque { OpacityState::UnknownOpaque } else { OpacityState::UnknownTransparent };
    if uniform { first } else { Some(unknown) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn coarse(letters: &str, to: u32) -> String {
        let states = packed::states(letters).unwrap();
        let (format, from) = (OpacityMicromapFormat::FourState, states.len().ilog2() / 2);
        let data = packed::pack(format, &states).unwrap();
        let subdivision_level = SubdivisionLevel::new(from).unwrap();
        let level = SubdivisionLevel::new(to).unwrap();
        let bytes = coarsen(&MicromapTriangleData { subdivision_level, format, data: &data }, level).unwrap();
        packed::PackedStates::new(&bytes, format, level).unwrap().letters()
    }

    #[test]
    fn what_is_not_uniform_becomes_unknown() {
        assert_eq!(coarse("TTTTOOOOuuuuUUUU", 1), "TOuU");
        assert_eq!(coarse("TTTOTTOOTOOOTuuU", 1), "uUUu");
        assert_eq!(coarse("TTTTTTTTTTTTTTTO", 0), "u");
        assert_eq!(coarse("OOOOOOOOTTTTTTTT", 0), "U");
        assert_eq!(coarse("TOuU", 1), "TOuU");
    }
}
