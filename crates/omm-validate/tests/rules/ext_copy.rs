//! Rules of copies of micromap objects on their parameters.

use omm_model::vk;
use omm_validate::RuleId::*;
use vk::CopyMicromapMode as Mode;

use crate::ext_copy_world::*;

pub(crate) fn cases() -> Vec<WorldCase> {
    [modes(), alignments(), features()].concat()
}

fn modes() -> Vec<WorldCase> {
    vec![
        breaks(|world| world.copy().mode = Mode::SERIALIZE, &[(CopyMode07531, "pInfo->mode")]),
        breaks(|world| world.host_copy().mode = Mode::DESERIALIZE, &[(CopyMode07531, "pInfo->mode")]),
        // The structure has no other rule on modes that are none.
        breaks(|world| world.copy().mode = Mode(4), &[(CopyMode07531, "pInfo->mode")]),
        keeps(CopyMode07531, |world| world.copy().mode = Mode::COMPACT),
        breaks(|world| world.serialize().mode = Mode::COMPACT, &[(SerializeMode07542, "pInfo->mode")]),
        breaks(|world| world.host_serialize().mode = Mode::CLONE, &[(SerializeMode07542, "pInfo->mode")]),
        keeps(SerializeMode07542, |world| world.serialize().mode = Mode::SERIALIZE),
        breaks(|world| world.deserialize().mode = Mode::CLONE, &[(DeserializeMode07548, "pInfo->mode")]),
        breaks(|world| world.host_deserialize().mode = Mode::SERIALIZE, &[(DeserializeMode07548, "pInfo->mode")]),
        keeps(DeserializeMode07548, |world| world.deserialize().mode = Mode::DESERIALIZE),
    ]
}

fn serialize_to(world: &mut World, offset: u64) {
    world.serialize().dst = vk::DeviceAddress(SERIALIZED + offset).into();
}

fn serialize_on_host_to(world: &mut World, offset: u64) {
    world.host_serialize().dst = vk::HostAddress(HOST_SERIALIZED + offset).into();
}

fn deserialize_from(world: &mut World, offset: u64) {
    let blob = serialized(&world.profile);
    world.put(BLOB + offset, &blob);
    world.deserialize().src = vk::DeviceAddress(BLOB + offset).into();
}

fn deserialize_on_host_from(world: &mut World, offset: u64) {
    let blob = serialized(&world.profile);
    world.put_on_host(HOST_BLOB + offset, &blob);
    world.host_deserialize().src = vk::HostAddress(HOST_BLOB + offset).into();
}

fn alignments() -> Vec<WorldCase> {
    vec![
        breaks(|world| serialize_to(world, 128), &[(SerializeAlignment07537, "pInfo->dst")]),
        keeps(SerializeAlignment07537, |world| serialize_to(world, 256)),
        breaks(|world| serialize_on_host_to(world, 8), &[(HostSerializeAlignment07570, "pInfo->dst")]),
        keeps(HostSerializeAlignment07570, |world| serialize_on_host_to(world, 16)),
        breaks(|world| deserialize_from(world, 128), &[(DeserializeAlignment07544, "pInfo->src")]),
        keeps(DeserializeAlignment07544, |world| deserialize_from(world, 256)),
        breaks(|world| deserialize_on_host_from(world, 8), &[(HostDeserializeAlignment07564, "pInfo->src")]),
        keeps(HostDeserializeAlignment07564, |world| deserialize_on_host_from(world, 16)),
    ]
}

/// The host does that alone, on a device that has the feature or not.
fn alone_on_host(world: &mut World, command: &str, has_feature: bool) {
    world.only_on_host(command);
    world.profile.features.micromap_host_commands = has_feature;
}

fn features() -> Vec<WorldCase> {
    vec![
        breaks(|world| alone_on_host(world, "vkCopyMicromapEXT", false), &[(HostCopyFeature07560, "device")]),
        keeps(HostCopyFeature07560, |world| alone_on_host(world, "vkCopyMicromapEXT", true)),
        breaks(
            |world| alone_on_host(world, "vkCopyMicromapToMemoryEXT", false),
            &[(HostSerializeFeature07571, "device")],
        ),
        keeps(HostSerializeFeature07571, |world| alone_on_host(world, "vkCopyMicromapToMemoryEXT", true)),
        breaks(
            |world| alone_on_host(world, "vkCopyMemoryToMicromapEXT", false),
            &[(HostDeserializeFeature07566, "device")],
        ),
        keeps(HostDeserializeFeature07566, |world| alone_on_host(world, "vkCopyMemoryToMicromapEXT", true)),
    ]
}

#[test]
fn cases_hold() {
    run_cases(&cases());
}
