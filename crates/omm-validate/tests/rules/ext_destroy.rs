//! Rules of `vkDestroyMicromapEXT` and `vkGetDeviceMicromapCompatibilityEXT`.

use omm_model::call::Call;
use omm_model::vk;
use omm_validate::RuleId::*;

use crate::ext_copy_world::*;

/// A program that does nothing but that, on a device that has micromap objects or not.
fn alone(world: &mut World, command: &str, has_feature: bool) {
    world.only(&[command]);
    if let Some((Call::DestroyMicromap { micromap, .. }, _)) = world.calls.first_mut() {
        *micromap = vk::Micromap::NULL;
    }
    world.profile.features.micromap_ext = has_feature;
}

pub(crate) fn cases() -> Vec<WorldCase> {
    vec![
        breaks(|world| alone(world, "vkDestroyMicromapEXT", false), &[(DestroyFeature11619, "device")]),
        keeps(DestroyFeature11619, |world| alone(world, "vkDestroyMicromapEXT", true)),
        breaks(
            |world| alone(world, "vkGetDeviceMicromapCompatibilityEXT", false),
            &[(CompatibilityFeature11666, "device")],
        ),
        keeps(CompatibilityFeature11666, |world| alone(world, "vkGetDeviceMicromapCompatibilityEXT", true)),
    ]
}

#[test]
fn cases_hold() {
    run_cases(&cases());
}
