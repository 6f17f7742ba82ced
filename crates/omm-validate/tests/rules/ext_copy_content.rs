//! Rules of copies of micromap objects on the contents of memory.

use omm_layout::object::TlasContents;
use omm_model::call::Call;
use omm_model::memory::{MemoryView, NoMemory};
use omm_model::profile::{DeviceProfile, Uuid};
use omm_model::vk;
use omm_validate::RuleId::*;
use omm_validate::Validator;

use crate::ext_copy_world::*;

pub(crate) fn cases() -> Vec<WorldCase> {
    [pointers(), data(), formats(), sizes()].concat()
}

fn pointers() -> Vec<WorldCase> {
    const DST: &str = "pInfo->dst";
    const SRC: &str = "pInfo->src";
    vec![
        breaks(|world| world.host_serialize().dst = vk::HostAddress::NULL.into(), &[(HostSerializePointer07569, DST)]),
        breaks(
            |world| world.host_serialize().dst = vk::DeviceAddress(SERIALIZED).into(),
            &[(HostSerializePointer07569, DST)],
        ),
        breaks(
            |world| world.host_serialize().dst = vk::HostAddress(HOST_BASE + HOST_SIZE).into(),
            &[(HostSerializePointer07569, DST)],
        ),
        keeps(HostSerializePointer07569, |world| {
            world.host_serialize().dst = vk::HostAddress(HOST_BASE + HOST_SIZE - SERIALIZED_SIZE).into();
        }),
        breaks(
            |world| world.host_deserialize().src = vk::HostAddress::NULL.into(),
            &[(HostDeserializePointer07563, SRC)],
        ),
        breaks(
            |world| world.host_deserialize().src = vk::DeviceAddress(BLOB).into(),
            &[(HostDeserializePointer07563, SRC)],
        ),
        breaks(
            |world| world.host_deserialize().src = vk::HostAddress(HOST_BASE + HOST_SIZE).into(),
            &[(HostDeserializePointer07563, SRC)],
        ),
        keeps(HostDeserializePointer07563, |world| {
            let blob = serialized(&world.profile);
            world.put_on_host(HOST_BASE, &blob);
            world.host_deserialize().src = vk::HostAddress(HOST_BASE).into();
        }),
    ]
}

/// Where the data that the host reads ends with the memory after so many bytes.
fn cut_on_host(world: &mut World, size: usize) {
    // A whole number of 16 bytes before the end, so that nothing else is wrong.
    let start = size.next_multiple_of(16);
    let blob = serialized(&world.profile);
    world.host_memory.truncate(HOST_SIZE as usize - start + size);
    let at = HOST_BASE + HOST_SIZE - start as u64;
    world.put_on_host(at, &blob[..size]);
    world.host_deserialize().src = vk::HostAddress(at).into();
}

fn data() -> Vec<WorldCase> {
    vec![
        // The right 32 bytes, then zeros.
        breaks(|world| world.put(BLOB + 32, &[0; 0x100]), &[(SerializedData07547, "pInfo->src")]),
        breaks(|world| world.put_on_host(HOST_BLOB + 32, &[0; 0x100]), &[(SerializedData07547, "pInfo->src")]),
        // The payload is not ours.
        breaks(|world| world.put(BLOB + 56, b"?"), &[(SerializedData07547, "pInfo->src")]),
        // It ends with the memory, within the identities, the header and the payload.
        breaks(|world| cut_on_host(world, 20), &[(SerializedData07547, "pInfo->src")]),
        breaks(|world| cut_on_host(world, 40), &[(SerializedData07547, "pInfo->src")]),
        breaks(|world| cut_on_host(world, 80), &[(SerializedData07547, "pInfo->src")]),
        // It is not a micromap.
        breaks(
            |world| {
                let object = TlasContents::default().encode().unwrap();
                let profile = &world.profile;
                let blob = omm_serialize::serialize_object(&object, profile.driver_uuid, profile.compatibility_uuid);
                world.put(BLOB, &blob.unwrap());
            },
            &[(SerializedData07547, "pInfo->src")],
        ),
        keeps(SerializedData07547, |world| cut_on_host(world, serialized(&world.profile).len())),
        // What a foreign driver writes behind the identities is its own business.
        keeps(SerializedData07547, |world| {
            world.profile.driver_uuid = Uuid(*b"another driver..");
            let version = serialized(&world.profile)[..32].to_vec();
            let data = [version, vec![0; 0x100]].concat();
            world.put(BLOB, &data);
            world.put_on_host(HOST_BLOB, &data);
        }),
        // What the command buffer writes there is not there yet.
        keeps(SerializedData07547, |world| {
            world.put(SERIALIZED, &serialized(&world.profile)[..32]);
            world.deserialize().src = vk::DeviceAddress(SERIALIZED).into();
        }),
    ]
}

fn formats() -> Vec<WorldCase> {
    vec![
        breaks(|world| world.put(BLOB + 31, b"?"), &[(SerializedFormat07549, "pInfo->src")]),
        breaks(|world| world.put(BLOB, b"?"), &[(SerializedFormat07549, "pInfo->src")]),
        breaks(
            |world| {
                let blob = serialized(&DeviceProfile::minimum());
                world.put_on_host(HOST_BLOB, &blob);
            },
            &[(SerializedFormat07549, "pInfo->src")],
        ),
        keeps(SerializedFormat07549, |world| {
            let blob = serialized(&world.profile);
            world.put(BLOB, &blob);
        }),
    ]
}

/// The bytes that the program's micromap takes.
fn micromap_size(world: &World) -> u64 {
    let bytes: [u8; 8] = serialized(&world.profile)[40..48].try_into().unwrap();
    u64::from_le_bytes(bytes)
}

/// Creates the micromap that is deserialized into with so many bytes.
fn create_with(world: &mut World, wanted: vk::Micromap, new_size: u64) {
    for (call, _) in &mut world.calls {
        if let Call::CreateMicromap { create_info, micromap, .. } = call
            && *micromap == wanted
        {
            create_info.size = new_size;
        }
    }
}

/// The data is that of another driver, which the host writes and reads again.
fn foreign(world: &mut World, size: u64) {
    world.profile.driver_uuid = Uuid(*b"another driver..");
    let version = serialized(&world.profile)[..32].to_vec();
    world.put(BLOB, &version);
    world.put_on_host(HOST_SERIALIZED, &version);
    world.host_deserialize().src = vk::HostAddress(HOST_SERIALIZED).into();
    create_with(world, LOADED, size);
}

fn sizes() -> Vec<WorldCase> {
    const DST: &str = "pInfo->dst";
    vec![
        breaks(
            |world| {
                let size = micromap_size(world) - 1;
                create_with(world, LOADED, size);
                world.only_on_host("");
            },
            &[(DeserializedSize07550, DST)],
        ),
        breaks(
            |world| {
                let size = micromap_size(world) - 1;
                create_with(world, EMPTY, size);
                world.host_deserialize().dst = EMPTY;
            },
            &[(DeserializedSize07550, DST)],
        ),
        keeps(DeserializedSize07550, |world| {
            let size = micromap_size(world);
            create_with(world, LOADED, size);
        }),
        // Known because the serialization was seen.
        breaks(|world| foreign(world, MICROMAP_SIZE - 256), &[(DeserializedSize07550, DST)]),
        keeps(DeserializedSize07550, |world| foreign(world, MICROMAP_SIZE)),
    ]
}

#[test]
fn cases_hold() {
    run_cases(&cases());
}

/// The words of the one finding in the changed program.
fn words(change: fn(&mut World)) -> [String; 2] {
    let mut world = World::new();
    change(&mut world);
    let found: Vec<_> = world.reports().into_iter().flatten().collect();
    let [violation] = found.as_slice() else { panic!("{} findings", found.len()) };
    [violation.kind.found(), violation.kind.required()]
}

#[test]
fn findings_say_what_is_wrong_with_data() {
    let required = "data as vkCmdCopyMicromapToMemoryEXT writes it";
    assert_eq!(words(|world| cut_on_host(world, 40)), ["data that ends at byte 40", required]);
    let zeros = |world: &mut World| world.put(BLOB + 32, &[0; 0x100]);
    assert_eq!(words(zeros), ["data that makes no sense from byte 32 on", required]);
    assert_eq!(
        words(|world| world.put(BLOB, &serialized(&DeviceProfile::minimum()))),
        [
            "driver 6f6d6d2073696d2e206465766963652e and compatibility 6d696e696d756d2c2020207630303032",
            "driver 6f6d6d2073696d2e206465766963652e and compatibility 7265666572656e63652c207630303032",
        ]
    );
}

/// Without host memory only null and device addresses are seen.
#[test]
fn without_memory_contents_are_not_judged() {
    let mut world = World::new();
    world.put(BLOB, &[0; 0x100]);
    world.put_on_host(HOST_BLOB, &[0; 0x100]);
    world.host_serialize().dst = vk::HostAddress(HOST_BASE + HOST_SIZE).into();
    assert!(world.read(vk::DeviceAddress(BLOB), 1).is_ok());
    let mut validator = Validator::new(world.profile.clone());
    for (call, output) in &world.calls {
        let report = validator.check_and_track(call, output, &NoMemory);
        assert!(report.is_empty(), "{report}");
    }
}
