//! What reports on builds of micromap objects say.

use omm_model::vk;
use omm_validate::Validator;

use crate::ext_build_world::*;
use crate::ext_copy_world::{HOST_BASE, World};

/// Command, path, found and required of all that the changed program breaks.
fn text(change: fn(&mut World)) -> String {
    let mut world = program();
    change(&mut world);
    let mut validator = Validator::new(world.profile.clone());
    let reports = world.calls.iter().map(|(call, output)| validator.check_and_track(call, output, &world));
    let lines: Vec<_> = reports.flat_map(|report| report.into_iter().map(|it| it.summary())).collect();
    lines.join("\n")
}

#[test]
fn found_and_required() {
    let all = [
        text(|world| {
            alone(world, "vkCmdBuildMicromapsEXT");
            world.profile.features.micromap_ext = false;
        }),
        text(|world| {
            world.on_two_devices();
            world.profile.features.buffer_device_address_multi_device = false;
            world.calls.truncate(world.position("vkGetMicromapBuildSizesEXT") + 1);
        }),
        text(|world| {
            world.on_two_devices();
            allocate(world, STORAGE).next.clear();
        }),
        text(|world| allocate(world, STORAGE).memory_type_index = 0),
        text(|world| create_buffer_info(world, SCRATCH).usage = vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS),
        text(|world| {
            create(world).ty = vk::MicromapType::DISPLACEMENT_MICROMAP;
            world.remove("vkCmdBuildAccelerationStructuresKHR");
        }),
        text(|world| {
            let second = vk::MicromapBuildInfo { scratch_data: vk::DeviceAddress::NULL.into(), ..build_info(BUILT) };
            builds(world).push(second);
        }),
        text(|world| host_build(world).scratch_data = vk::HostAddress(HOST_BASE + HOST_SIZE - 1).into()),
        text(|world| host_build(world).data = vk::HostAddress(1).into()),
        text(|world| usage(build(world)).format = 7),
    ];
    insta::assert_snapshot!(all.join("\n"));
}
