use std::collections::BTreeSet;

use super::samples::samples;
use super::*;
use crate::profile::{DeviceProfile, Features};

#[test]
fn there_is_a_sample_of_every_command() {
    let names: BTreeSet<&str> = samples().iter().map(Call::command).collect();
    assert_eq!(names.len(), samples().len(), "two samples of one command");
    assert_eq!(names.len(), include_str!("names.rs").matches("Self::").count());
    assert!(names.iter().all(|name| name.starts_with("vk")));
}

#[test]
fn calls_survive_a_text_form() {
    for call in samples() {
        let text = serde_json::to_string(&call).unwrap();
        assert_eq!(serde_json::from_str::<Call>(&text).unwrap(), call);
    }
}

#[test]
fn outputs_survive_a_text_form() {
    let limits = vk::OpacityMicromapProperties { max_micromap_triangles: 9, ..Default::default() };
    let outputs = [
        Output::None,
        Output::Result(vk::Result::OPERATION_DEFERRED),
        Output::DeviceAddress(vk::DeviceAddress(256)),
        Output::BuildSizes(vk::BuildSizesInfo { build_scratch_size: 3, ..Default::default() }),
        Output::MicromapBuildSizes(vk::MicromapBuildSizesInfo { discardable: vk::Bool32::TRUE, ..Default::default() }),
        Output::Compatibility(vk::AccelerationStructureCompatibility::INCOMPATIBLE),
        Output::QueryResults(vec![u64::MAX, 1, 0, 0]),
        Output::Properties(vec![40, 50]),
        Output::MaxConcurrency(u32::MAX),
        Output::Structures(vec![limits.into()]),
    ];
    for output in outputs {
        let text = serde_json::to_string(&output).unwrap();
        assert_eq!(serde_json::from_str::<Output>(&text).unwrap(), output);
    }
}

#[test]
fn what_a_command_is_given_goes_by_its_name() {
    for call in samples() {
        let name = call.command();
        assert_eq!(call.recorded_into().is_some(), name.starts_with("vkCmd"), "{name}");
        assert_eq!(call.timeline() == Timeline::Device, name.starts_with("vkCmd"), "{name}");
        let text = serde_json::to_value(&call).unwrap();
        let fields = text.as_object().and_then(|call| call.values().next()).unwrap();
        let number = |field: &str| fields.get(field).and_then(serde_json::Value::as_u64);
        assert_eq!(call.device().map(|device| device.0), number("device"), "{name}");
        let deferred = number("deferred_operation").filter(|_| name != "vkCreateDeferredOperationKHR");
        assert_eq!(call.deferred_operation().map(|operation| operation.0), deferred, "{name}");
        let target = number("command_buffer").filter(|_| name.starts_with("vkCmd"));
        assert_eq!(call.recorded_into().map(|target| target.0), target, "{name}");
    }
}

#[test]
fn a_null_operation_defers_nothing() {
    let call = Call::CopyMicromap {
        device: vk::Device(1),
        deferred_operation: vk::DeferredOperation::NULL,
        info: vk::CopyMicromapInfo::default(),
    };
    assert_eq!(call.deferred_operation(), None);
}

#[test]
fn the_chain_has_the_last_word_on_features() {
    let profile = DeviceProfile::minimum().features;
    let mut info = DeviceCreateInfo::default();
    assert_eq!(info.features(&profile), profile);
    assert_eq!((info.physical_device_count(), info.has_queue()), (1, false));

    info.enabled_features = Some(Features::ALL);
    assert_eq!(info.features(&profile), Features::ALL);

    let liar = vk::OpacityMicromapFeatures { s_type: vk::StructureType(0), ..Default::default() };
    let group = vk::DeviceGroupDeviceCreateInfo {
        physical_devices: vec![vk::PhysicalDevice(1), vk::PhysicalDevice(2)],
        ..Default::default()
    };
    info.next = vec![liar.into(), group.into()];
    info.queue_create_infos = vec![DeviceQueueCreateInfo { queue_family_index: 1, queue_count: 0 }];
    assert_eq!(info.features(&profile), Features { micromap: false, ..Features::ALL });
    assert_eq!((info.physical_device_count(), info.has_queue()), (2, false));
    info.queue_create_infos.push(DeviceQueueCreateInfo { queue_family_index: 0, queue_count: 1 });
    assert!(info.has_queue());

    info.next = vec![
        vk::OpacityMicromapFeaturesExt { micromap: vk::Bool32::TRUE, ..Default::default() }.into(),
        vk::AccelerationStructureFeatures {
            acceleration_structure_host_commands: vk::Bool32::TRUE,
            ..Default::default()
        }
        .into(),
        vk::RayTracingMotionBlurFeatures::default().into(),
    ];
    let expected = Features {
        micromap_capture_replay: false,
        micromap_host_commands: false,
        acceleration_structure: false,
        acceleration_structure_capture_replay: false,
        acceleration_structure_indirect_build: false,
        ray_tracing_motion_blur: false,
        ..Features::ALL
    };
    assert_eq!(info.features(&profile), expected);
}
