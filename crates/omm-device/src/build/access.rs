//! Which memory the builds of one command touch. They run in no order, so what one writes no other may touch.

use crate::memory::Place;
use crate::undefined::{Reason, Stop};

/// One use of memory by one build.
#[derive(Clone, Debug)]
struct Use {
    place: Place,
    /// Position in `pInfos`.
    info: usize,
    at: String,
    written: bool,
    /// The source of an update, which may be what the same build writes.
    updated: bool,
}

/// All uses of memory by the builds of one command.
#[derive(Debug)]
pub(crate) struct Accesses {
    uses: Vec<Use>,
}

/// The uses of one build.
#[derive(Debug)]
pub(crate) struct Access {
    info: usize,
    uses: Vec<Use>,
}

impl Access {
    pub(crate) const fn new(info: usize) -> Self {
        Self { info, uses: Vec::new() }
    }

    fn push(&mut self, place: Place, at: impl Into<String>, written: bool, updated: bool) {
        if !place.bytes.is_empty() {
            self.uses.push(Use { place, info: self.info, at: at.into(), written, updated });
        }
    }

    /// The build writes this.
    pub(crate) fn write(&mut self, place: Place, at: &str) {
        self.push(place, at, true, false);
    }

    /// The build reads this acceleration structure.
    pub(crate) fn read(&mut self, place: Place, at: impl Into<String>) {
        self.push(place, at, false, false);
    }

    /// The build updates what lies here, perhaps in place.
    pub(crate) fn update(&mut self, place: Place, in_place: bool) {
        self.push(place, "srcAccelerationStructure", false, in_place);
    }
}

impl Accesses {
    /// The uses of these builds together.
    pub(crate) fn of<'a>(all: impl Iterator<Item = &'a Access>) -> Self {
        Self { uses: all.flat_map(|access| access.uses.iter().cloned()).collect() }
    }

    /// Stops where something that is written is touched twice.
    pub(crate) fn check(mut self) -> Result<(), Stop> {
        self.uses.sort_by_key(|used| (used.place.origin, used.place.bytes.start));
        // Of what begins earlier only what reaches furthest can overlap. Sources of updates in place count apart, because what
        // they are allowed to overlap would hide what lies below them.
        let mut furthest = Furthest::default();
        for used in &self.uses {
            let Furthest { any, updated, written } = furthest;
            let earlier = if used.written { [any, updated, written] } else { [written, None, None] };
            for other in earlier.into_iter().flatten() {
                if other.place.overlaps(&used.place) && !in_place(other, used) {
                    let (at, other) = if used.written { (used, other) } else { (other, used) };
                    let stop = Stop::from(Reason::Overlap { other: format!("pInfos[{}].{}", other.info, other.at) });
                    return Err(stop.within(&at.at).within(format_args!("pInfos[{}]", at.info)));
                }
            }
            let slot = if used.updated { &mut furthest.updated } else { &mut furthest.any };
            *slot = further(*slot, used);
            if used.written {
                furthest.written = further(furthest.written, used);
            }
        }
        Ok(())
    }
}

/// What reaches furthest among the uses seen so far.
#[derive(Clone, Copy, Debug, Default)]
struct Furthest<'a> {
    any: Option<&'a Use>,
    updated: Option<&'a Use>,
    written: Option<&'a Use>,
}

/// Whichever of the two reaches further.
fn further<'a>(known: Option<&'a Use>, used: &'a Use) -> Option<&'a Use> {
    let end = |used: &Use| (used.place.origin, used.place.bytes.end);
    known.filter(|known| end(known) >= end(used)).or(Some(used))
}

/// Whether the two are source and destination of one update in place.
fn in_place(a: &Use, b: &Use) -> bool {
    a.info == b.info
        && ((a.updated && b.at == "dstAccelerationStructure") || (b.updated && a.at == "dstAccelerationStructure"))
}

#[cfg(test)]
mod tests {
    use std::ops::Range;

    use omm_model::vk;

    use super::*;
    use crate::memory::Origin;

    /// Uses of one allocation as (build, bytes, how): `r`ead, `w`ritten, source of an update in place (`u`) or elsewhere (`s`).
    fn check(uses: &[(usize, Range<usize>, char)]) -> Result<(), String> {
        let mut all = Vec::new();
        for (info, bytes, how) in uses.iter().cloned() {
            let place = Place { origin: Origin::Device(vk::DeviceMemory(1)), bytes };
            let mut access = Access::new(info);
            match how {
                'r' => access.read(place, "micromap"),
                'w' => access.write(place, "dstAccelerationStructure"),
                how => access.update(place, how == 'u'),
            }
            all.push(access);
        }
        Accesses::of(all.iter()).check().map_err(|stop| format!("{}: {}", stop.at, stop.why))
    }

    #[test]
    fn what_is_written_is_touched_by_nobody_else() {
        assert_eq!(
            check(&[(0, 0..8, 'w'), (1, 8..16, 'w'), (1, 16..20, 'r'), (0, 16..24, 'r'), (0, 8..8, 'r')]),
            Ok(())
        );
        let dst = "dstAccelerationStructure: its memory overlaps that of";
        assert_eq!(check(&[(0, 0..9, 'w'), (1, 8..16, 'r')]), Err(format!("pInfos[0].{dst} pInfos[1].micromap")));
        assert_eq!(check(&[(1, 8..16, 'r'), (0, 0..9, 'w')]), Err(format!("pInfos[0].{dst} pInfos[1].micromap")));
        assert!(check(&[(0, 0..8, 'r'), (0, 4..6, 'w')]).is_err());
        assert!(check(&[(0, 0..8, 'r'), (0, 0..2, 'r'), (0, 4..6, 'w')]).is_err());
        assert!(check(&[(0, 0..8, 'w'), (0, 1..2, 'r'), (0, 4..6, 'r')]).is_err());
    }

    #[test]
    fn an_update_may_be_in_place() {
        assert_eq!(check(&[(0, 0..8, 'u'), (0, 0..8, 'w')]), Ok(()));
        assert_eq!(check(&[(0, 0..8, 'w'), (0, 0..8, 'u')]), Ok(()));
        assert!(check(&[(0, 0..8, 's'), (0, 4..12, 'w')]).is_err());
        assert!(check(&[(0, 0..8, 'u'), (0, 0..8, 'w'), (1, 0..8, 'u'), (1, 0..8, 'w')]).is_err());
        for position in 0..3 {
            let mut uses = vec![(0, 0..8, 'u'), (0, 0..8, 'w')];
            uses.insert(position, (1, 0..4, 'r'));
            assert!(check(&uses).is_err());
        }
    }
}
