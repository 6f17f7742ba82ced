//! Every combination of micromap state and flags, against the tables of the specification written out here.

use super::*;

/// The table of the chapter: element or special index value, two-state override, result. `I`gnored, `O`paque, `N`on-opaque.
const TABLE: [(OpacityState, bool, char); 8] = [
    (OpacityState::Transparent, true, 'I'),
    (OpacityState::Transparent, false, 'I'),
    (OpacityState::Opaque, true, 'O'),
    (OpacityState::Opaque, false, 'O'),
    (OpacityState::UnknownTransparent, true, 'I'),
    (OpacityState::UnknownTransparent, false, 'N'),
    (OpacityState::UnknownOpaque, true, 'O'),
    (OpacityState::UnknownOpaque, false, 'N'),
];

/// Instance overrides: force opaque, force no opaque, opacity before, opacity after.
const INSTANCE: [(bool, bool, char, char); 8] = [
    (false, false, 'O', 'O'),
    (false, false, 'N', 'N'),
    (true, false, 'O', 'O'),
    (true, false, 'N', 'O'),
    (false, true, 'O', 'N'),
    (false, true, 'N', 'N'),
    // Both at once is invalid usage; ours lets "no opaque" win.
    (true, true, 'O', 'N'),
    (true, true, 'N', 'N'),
];

/// Culling: cull opaque, cull no opaque, opacity before, outcome. `C`ulled.
const CULL: [(bool, bool, char, char); 8] = [
    (false, false, 'O', 'O'),
    (false, false, 'N', 'N'),
    (true, false, 'O', 'C'),
    (true, false, 'N', 'N'),
    (false, true, 'O', 'O'),
    (false, true, 'N', 'C'),
    (true, true, 'O', 'C'),
    (true, true, 'N', 'C'),
];

fn look_up<const N: usize>(table: &[(bool, bool, char, char); N], a: bool, b: bool, before: char) -> char {
    table.iter().find(|row| (row.0, row.1, row.2) == (a, b, before)).unwrap().3
}

fn by_table(candidate: CandidateOpacity) -> char {
    let CandidateOpacity { micromap, geometry_opaque, instance, ray } = candidate;
    let initial = match micromap.filter(|_| !instance.disable_micromaps) {
        Some(state) => {
            let override_two_state = instance.force_two_state | ray.force_two_state;
            TABLE.iter().find(|row| (row.0, row.1) == (state, override_two_state)).unwrap().2
        }
        None => ['N', 'O'][usize::from(geometry_opaque)],
    };
    if initial == 'I' {
        return 'I';
    }
    let by_instance = look_up(&INSTANCE, instance.force_opaque, instance.force_no_opaque, initial);
    // Ray flags override with the same table as the instance flags.
    let by_ray = look_up(&INSTANCE, ray.opaque, ray.no_opaque, by_instance);
    look_up(&CULL, ray.cull_opaque, ray.cull_no_opaque, by_ray)
}

#[test]
fn every_combination_follows_the_tables() {
    let sources = OpacityState::ALL.map(Some).into_iter().chain([None]);
    let mut seen = 0;
    for micromap in sources {
        for bits in 0_u32..1 << 10 {
            let bit = |n: u32| bits >> n & 1 == 1;
            let candidate = CandidateOpacity {
                micromap,
                geometry_opaque: bit(0),
                instance: InstanceOpacity {
                    force_opaque: bit(1),
                    force_no_opaque: bit(2),
                    force_two_state: bit(3),
                    disable_micromaps: bit(4),
                },
                ray: RayOpacity {
                    opaque: bit(5),
                    no_opaque: bit(6),
                    cull_opaque: bit(7),
                    cull_no_opaque: bit(8),
                    force_two_state: bit(9),
                },
            };
            let expected = match by_table(candidate) {
                'I' => OpacityResult::Ignored,
                'C' => OpacityResult::Culled,
                'O' => OpacityResult::Opaque,
                'N' => OpacityResult::NonOpaque,
                other => panic!("{other}"),
            };
            assert_eq!(candidate.resolve(), expected, "{candidate:?}");
            seen += 1;
        }
    }
    assert_eq!(seen, 5 * 1024);
}

#[test]
fn values_round_trip() {
    for (value, state) in (0..).zip(OpacityState::ALL) {
        assert_eq!(state.value(), value);
        assert_eq!(OpacityState::from_value(value), Some(state));
        assert_eq!(state.is_known(), value < 2);
        assert!(state.to_two_state().is_known());
    }
    assert_eq!(OpacityState::from_value(4), None);
}
