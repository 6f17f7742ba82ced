use super::*;

/// A build of triangles with a micromap, with something odd in most places where something odd can stand.
fn odd_build() -> BuildGeometryInfo {
    let micromap = TrianglesOpacityMicromap {
        s_type: StructureType(77),
        index_type: IndexType(5),
        base_triangle: u32::MAX,
        micromap: AccelerationStructure(9),
        ..Default::default()
    };
    let triangles = GeometryTrianglesData {
        next: vec![ChainStructure::Unknown(StructureType(1)), micromap.into()],
        vertex_format: Format(-1),
        vertex_data: HostAddress(16).into(),
        ..Default::default()
    };
    let geometry = Geometry {
        geometry_type: GeometryType::AABBS,
        geometry: GeometryData::Triangles(triangles),
        flags: GeometryFlags::OPAQUE | GeometryFlags::from_bits_retain(1 << 30),
        ..Default::default()
    };
    BuildGeometryInfo {
        ty: AccelerationStructureType::BOTTOM_LEVEL,
        geometries: Some(vec![]),
        geometry_pointers: Some(vec![geometry]),
        scratch_data: DeviceAddress(256).into(),
        ..Default::default()
    }
}

#[test]
fn what_an_application_gets_wrong_survives_a_round_trip() {
    let build = odd_build();
    let text = serde_json::to_string(&build).unwrap();
    assert_eq!(serde_json::from_str::<BuildGeometryInfo>(&text).unwrap(), build);
}

#[test]
fn a_chained_structure_is_found_by_what_it_is_and_not_by_what_it_claims() {
    let build = odd_build();
    let geometry = &build.geometry_pointers.as_ref().unwrap()[0];
    let GeometryData::Triangles(triangles) = &geometry.geometry else { panic!("triangles") };
    assert_eq!(triangles.opacity_micromap().map(|micromap| micromap.micromap), Some(AccelerationStructure(9)));
    assert_eq!(triangles.next[1].s_type(), StructureType(77));
    assert_eq!(triangles.next[0].s_type(), StructureType(1));
    assert!(triangles.opacity_micromap_ext().is_none());
    assert!(triangles.motion_data().is_none());
    assert!(geometry.micromap_data().is_none());
}

#[test]
fn the_first_of_two_structures_of_one_kind_is_found() {
    let chained = |device_mask| MemoryAllocateFlagsInfo { device_mask, ..Default::default() }.into();
    let info = MemoryAllocateInfo { next: vec![chained(1), chained(2)], ..Default::default() };
    assert_eq!(info.allocate_flags().map(|flags| flags.device_mask), Some(1));
}

#[test]
fn an_array_comes_before_the_array_of_pointers_and_null_is_not_empty() {
    let mut build = odd_build();
    assert_eq!(build.geometries_iter().count(), 0, "an empty array is there");
    build.geometries = None;
    assert_eq!(build.geometries_iter().count(), 1, "a null pointer is not");
    build.geometry_pointers = None;
    assert_eq!(build.geometries_iter().count(), 0);

    let usage = |count| MicromapUsage { count, subdivision_level: 3, format: OpacityMicromapFormat::TWO_STATE };
    let data = GeometryMicromapData { usage_count_pointers: Some(vec![usage(4), usage(2)]), ..Default::default() };
    assert_eq!(data.usages().map(|usage| usage.count).collect::<Vec<_>>(), [4, 2]);
}

#[test]
fn a_default_structure_has_its_own_type() {
    assert_eq!(Geometry::default().s_type, StructureType::ACCELERATION_STRUCTURE_GEOMETRY);
    assert_eq!(OpacityMicromapPropertiesExt::default().s_type, OpacityMicromapPropertiesExt::S_TYPE);
    assert_ne!(OpacityMicromapPropertiesExt::S_TYPE, OpacityMicromapProperties::S_TYPE);
}

#[test]
fn addresses_stop_at_the_end_of_the_address_space() {
    assert_eq!(DeviceAddress(8).checked_add(8), Some(DeviceAddress(16)));
    assert_eq!(DeviceAddress(u64::MAX).checked_add(1), None);
    assert_eq!(DeviceAddressRange { address: DeviceAddress(u64::MAX), size: 2 }.end(), None);
    assert!(DeviceAddress(256).is_aligned_to(128));
    assert!(!DeviceAddress(64).is_aligned_to(128));
    assert!(DeviceAddress(1).is_aligned_to(0));
    let host = DeviceOrHostAddress::from(HostAddress(3));
    assert_eq!((host.raw(), host.device_address(), host.host_address()), (3, None, Some(HostAddress(3))));
    assert!(DeviceOrHostAddress::default().is_null());
}

#[test]
fn an_index_type_has_a_size_if_it_has_a_meaning() {
    let sizes = [IndexType::NONE, IndexType::UINT8, IndexType::UINT16, IndexType::UINT32, IndexType(2)];
    assert_eq!(sizes.map(IndexType::size), [Some(0), Some(1), Some(2), Some(4), None]);
}
