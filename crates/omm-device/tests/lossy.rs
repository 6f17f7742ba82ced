//! Lossy builds: which states are kept, and that nothing but the input decides it.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod common;

use common::{bytes, triangle};
use omm_device::Device;
use omm_device::app::{App, MicromapInput};
use omm_layout::object::MicromapObject;
use omm_layout::packed::{self, PackedStates};
use omm_model::curve::MicroTriangle;
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use proptest::prelude::*;

const LOSSY: vk::BuildAccelerationStructureFlags = vk::BuildAccelerationStructureFlags::MICROMAP_LOSSY;
const FOUR: OpacityMicromapFormat = OpacityMicromapFormat::FourState;

/// Level 3 without loss, 6 with.
fn profile() -> DeviceProfile {
    let mut profile = DeviceProfile::minimum();
    profile.limits.max_opacity_lossy4_state_subdivision_level = 6;
    profile
}

/// The object that a lossy build of one triangle makes.
fn build(level: u32, data: &[u8]) -> Vec<u8> {
    let mut device = Device::with_heap_size(profile(), 1 << 24);
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let triangles = [triangle(0, level, FOUR), triangle(0, 1, FOUR)];
    let structure = app.build_micromap(&MicromapInput { data, triangles: &triangles, flags: LOSSY }).unwrap();
    bytes(&app, &structure)
}

#[test]
fn the_limit_without_loss_is_another() {
    let mut device = Device::with_heap_size(profile(), 1 << 24);
    let mut observer = ();
    let mut app = App::new(&mut device, &mut observer);
    let mut error = |level, flags| {
        let triangles = [triangle(0, level, FOUR)];
        let input = MicromapInput { data: &[0; 4096], triangles: &triangles, flags };
        app.build_micromap(&input).map(drop).map_err(|error| error.to_string())
    };
    assert!(error(4, LOSSY & !LOSSY).unwrap_err().ends_with("subdivision level 4 is beyond the device's limit of 3"));
    assert!(error(7, LOSSY).unwrap_err().ends_with("subdivision level 7 is beyond the device's limit of 6"));
    assert_eq!(error(6, LOSSY), Ok(()));
}

#[test]
fn what_fits_is_not_changed() {
    let data: Vec<u8> = (0..16_u8).map(|byte| byte.wrapping_mul(0x5d)).collect();
    let built = build(3, &data);
    let micromap = MicromapObject::read(&built).unwrap();
    assert_eq!(micromap.triangle(0).unwrap().data, data);
    assert_eq!(micromap.triangle(1).unwrap().data, &data[..1]);
    assert_eq!(micromap.header().flags, LOSSY.bits());
}

#[test]
fn threads_make_no_difference() {
    let data: Vec<u8> = (0..1024_u32).map(|byte| (byte.wrapping_mul(0x9e37_79b9) >> 24) as u8).collect();
    let alone = build(6, &data);
    let together: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..4).map(|_| scope.spawn(|| build(6, &data))).collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    assert!(together.iter().all(|built| *built == alone));
}

fn states() -> impl Strategy<Value = (u32, Vec<OpacityState>)> {
    // Runs of one state, so that some coarse microtriangles are uniform.
    let run = (0..4_u8, prop_oneof![Just(1_usize), Just(4), Just(16), 1..40_usize]);
    (4..=6_u32, prop::collection::vec(run, 1..200)).prop_map(|(level, runs)| {
        let count = 4_usize.pow(level);
        let states =
            runs.into_iter().cycle().flat_map(|(state, length)| std::iter::repeat_n(state, length)).take(count);
        (level, states.map(|state| OpacityState::from_value(state).unwrap()).collect())
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A ray that meets the micromap finds the state of the input, or an unknown one.
    #[test]
    fn a_lookup_finds_the_state_or_an_unknown_one((level, states) in states(), u in 0.0..1.0_f32, v in 0.0..1.0_f32) {
        let data = packed::pack(FOUR, &states).unwrap();
        let built = build(level, &data);
        let micromap = MicromapObject::read(&built).unwrap();
        let stored = micromap.triangle(0).unwrap();
        prop_assert_eq!(stored.subdivision_level.get(), 3);
        let fine = SubdivisionLevel::new(level).unwrap();
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        let index = MicroTriangle::at(u, v, stored.subdivision_level).index();
        let found = stored.state(index).unwrap();
        let exact = states[MicroTriangle::at(u, v, fine).index() as usize];
        prop_assert!(found == exact || !found.is_known());

        let parts = 4_usize.pow(level - 3);
        let coarse = PackedStates::new(stored.data, FOUR, stored.subdivision_level).unwrap();
        for (parts, found) in states.chunks(parts).zip(coarse.iter()) {
            let uniform = parts.iter().all(|part| *part == parts[0]);
            prop_assert_eq!(uniform && found == parts[0], uniform);
            prop_assert!(uniform || !found.is_known());
        }
    }
}
