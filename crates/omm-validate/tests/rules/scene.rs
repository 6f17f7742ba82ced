//! A small world in which one call is valid, and cases that change the call or the world a little.

use omm_model::call::{Call, Output};
use omm_model::memory::{MemoryError, MemoryView};
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use omm_validate::{Report, RuleId, Validator};

pub(crate) const DEVICE: vk::Device = vk::Device(1);
pub(crate) const QUEUE: vk::Queue = vk::Queue(2);
pub(crate) const COMMAND_BUFFER: vk::CommandBuffer = vk::CommandBuffer(7);
pub(crate) const MEMORY: vk::DeviceMemory = vk::DeviceMemory(8);
pub(crate) const BUFFER: vk::Buffer = vk::Buffer(9);
/// A built micromap of [`MICROMAP_TRIANGLES`] triangles.
pub(crate) const MICROMAP: vk::AccelerationStructure = vk::AccelerationStructure(0x20);
pub(crate) const MICROMAP_TRIANGLES: u32 = 3;
/// What the scene builds.
pub(crate) const TARGET: vk::AccelerationStructure = vk::AccelerationStructure(0x21);

/// The one buffer: triangle array, opacity data, micromap indices and, behind them, room for structures.
pub(crate) const BASE: u64 = 0x1_0000;
pub(crate) const BUFFER_SIZE: u64 = 0x1000;
pub(crate) const TRIANGLE_ARRAY: u64 = BASE;
pub(crate) const DATA: u64 = BASE + 0x100;
pub(crate) const INDICES: u64 = BASE + 0x200;
/// Where ranges of indirect builds go.
pub(crate) const RANGES: u64 = BASE + 0x300;
const STRUCTURES: u64 = BASE + 0x400;
/// Zeros, which nothing is written to.
const VERTICES: u64 = BASE + 0xc00;
/// Where the micromap lies.
pub(crate) const MICROMAP_AT: u64 = STRUCTURES;
/// Where another buffer lies.
const OTHER_BASE: u64 = 0x8_0000;

/// Triangles of the geometry that the micromap is attached to.
pub(crate) const PRIMITIVES: u32 = 4;

/// A validator that has seen a program so far, memory, and the program's next call.
#[derive(Clone)]
pub(crate) struct Scene {
    pub(crate) name: &'static str,
    pub(crate) validator: Validator,
    pub(crate) memory: Vec<u8>,
    pub(crate) call: Call,
}

impl MemoryView for Scene {
    fn read(&self, address: vk::DeviceAddress, size: u64) -> Result<&[u8], MemoryError> {
        let rest = address.0.checked_sub(BASE).and_then(|start| self.memory.get(start as usize..)).unwrap_or_default();
        rest.get(..size as usize).ok_or(MemoryError { address: address.0, size, available: rest.len() as u64 })
    }
}

impl Scene {
    /// A micromap of three triangles: two 4-state ones of level 1, one 2-state one of level 2.
    pub(crate) fn micromap() -> Self {
        Self::new("micromap", vk::AccelerationStructureType::OPACITY_MICROMAP, micromap_build(TARGET), None)
    }

    /// A mesh of four triangles whose 16-bit indices name micromap triangles 0 to 2 and a special index.
    pub(crate) fn bottom_level() -> Self {
        let attached = vk::TrianglesOpacityMicromap {
            index_type: vk::IndexType::UINT16,
            index_buffer: vk::DeviceAddress(INDICES),
            index_stride: 2,
            micromap: MICROMAP,
            ..Default::default()
        };
        let triangles = vk::GeometryTrianglesData {
            next: vec![attached.into()],
            vertex_format: vk::Format::R32G32B32_SFLOAT,
            vertex_data: vk::DeviceAddress(VERTICES).into(),
            vertex_stride: 12,
            max_vertex: 3 * PRIMITIVES - 1,
            index_type: vk::IndexType::NONE,
            ..Default::default()
        };
        let geometry = vk::Geometry {
            geometry_type: vk::GeometryType::TRIANGLES,
            geometry: vk::GeometryData::Triangles(triangles),
            flags: vk::GeometryFlags::OPAQUE,
            ..Default::default()
        };
        let info = vk::BuildGeometryInfo {
            ty: vk::AccelerationStructureType::BOTTOM_LEVEL,
            flags: vk::BuildAccelerationStructureFlags::PREFER_FAST_TRACE,
            dst_acceleration_structure: TARGET,
            geometries: Some(vec![geometry]),
            ..Default::default()
        };
        let ranges = vec![vk::BuildRangeInfo { primitive_count: PRIMITIVES, ..Default::default() }];
        Self::new("bottom level", vk::AccelerationStructureType::BOTTOM_LEVEL, info, Some(ranges))
    }

    /// The same mesh less a triangle, each triangle with the micromap triangle of its own index.
    pub(crate) fn bottom_level_without_indices() -> Self {
        let mut scene = Self::bottom_level();
        scene.name = "bottom level without indices";
        scene.range().primitive_count = MICROMAP_TRIANGLES;
        *scene.attached() =
            vk::TrianglesOpacityMicromap { index_type: vk::IndexType::NONE, micromap: MICROMAP, ..Default::default() };
        scene
    }

    /// The same mesh with special indices only.
    pub(crate) fn bottom_level_without_micromap() -> Self {
        let mut scene = Self::bottom_level();
        scene.name = "bottom level without micromap";
        scene.attached().micromap = vk::AccelerationStructure::NULL;
        scene.write(INDICES, &[-1_i16, -2, -3, -4].map(i16::to_le_bytes).concat());
        scene
    }

    /// Instances.
    pub(crate) fn top_level() -> Self {
        let geometry = vk::Geometry {
            geometry_type: vk::GeometryType::INSTANCES,
            geometry: vk::GeometryData::Instances(vk::GeometryInstancesData::default()),
            ..Default::default()
        };
        let info = vk::BuildGeometryInfo {
            ty: vk::AccelerationStructureType::TOP_LEVEL,
            dst_acceleration_structure: TARGET,
            geometries: Some(vec![geometry]),
            ..Default::default()
        };
        let ranges = vec![vk::BuildRangeInfo { primitive_count: 1, ..Default::default() }];
        Self::new("top level", vk::AccelerationStructureType::TOP_LEVEL, info, Some(ranges))
    }

    /// A query of the sizes of what the scene builds.
    pub(crate) fn into_sizes(mut self) -> Self {
        let ty = self.info().ty;
        let max_primitive_counts = (ty != vk::AccelerationStructureType::OPACITY_MICROMAP).then(|| vec![PRIMITIVES]);
        self.call = Call::GetAccelerationStructureBuildSizes {
            device: DEVICE,
            build_type: vk::AccelerationStructureBuildType::DEVICE,
            build_info: self.info().clone(),
            max_primitive_counts,
        };
        self
    }

    fn new(
        name: &'static str,
        ty: vk::AccelerationStructureType,
        info: vk::BuildGeometryInfo,
        ranges: Option<Vec<vk::BuildRangeInfo>>,
    ) -> Self {
        let call = build(vec![info], vec![ranges]);
        let mut scene =
            Self { name, validator: Validator::new(profile()), memory: vec![0; BUFFER_SIZE as usize], call };
        for (index, (level, format)) in [(1_u16, 2_u16), (1, 2), (2, 1)].into_iter().enumerate() {
            let at = TRIANGLE_ARRAY + 8 * index as u64;
            scene.write(at, &[&4_u32.to_le_bytes()[..], &level.to_le_bytes(), &format.to_le_bytes()].concat());
        }
        scene.write(INDICES, &[0_i16, 2, -4, 1].map(i16::to_le_bytes).concat());

        scene.restart(|_| {});
        scene.track_structure(TARGET, ty);
        scene
    }

    /// Starts anew on a device of another profile, as far as the micromap and the first command buffer.
    pub(crate) fn restart(&mut self, change: impl FnOnce(&mut DeviceProfile)) {
        let mut profile = profile();
        change(&mut profile);
        self.validator = Validator::new(profile);
        self.track_buffer();
        self.track_structure(MICROMAP, vk::AccelerationStructureType::OPACITY_MICROMAP);
        self.begin();
        self.track(&build(vec![micromap_build(MICROMAP)], vec![None]));
        self.submit();
        self.begin();
    }

    fn track_buffer(&mut self) {
        let usage = vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS
            | vk::BufferUsageFlags::ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY
            | vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE;
        let create_info = vk::BufferCreateInfo { size: BUFFER_SIZE, usage, ..Default::default() };
        self.track(&Call::CreateBuffer { device: DEVICE, create_info, buffer: BUFFER });
        let allocate_info = vk::MemoryAllocateInfo { allocation_size: BUFFER_SIZE, ..Default::default() };
        self.track(&Call::AllocateMemory { device: DEVICE, allocate_info, memory: MEMORY });
        self.track(&Call::BindBufferMemory { device: DEVICE, buffer: BUFFER, memory: MEMORY, memory_offset: 0 });
        let info = vk::BufferDeviceAddressInfo { buffer: BUFFER, ..Default::default() };
        let address = Output::DeviceAddress(vk::DeviceAddress(BASE));
        self.validator.track(&Call::GetBufferDeviceAddress { device: DEVICE, info }, &address);
    }

    /// Creates an acceleration structure of that type, or creates it again.
    pub(crate) fn track_structure(&mut self, handle: vk::AccelerationStructure, ty: vk::AccelerationStructureType) {
        self.track_structure_at(handle, ty, STRUCTURES + 0x100 * (handle.0 % 8));
    }

    /// The same at that address.
    pub(crate) fn track_structure_at(
        &mut self,
        handle: vk::AccelerationStructure,
        ty: vk::AccelerationStructureType,
        address: u64,
    ) {
        let address_range = vk::DeviceAddressRange { address: vk::DeviceAddress(address), size: 0x100 };
        self.track_create(handle, vk::AccelerationStructureCreateInfo2 { ty, address_range, ..Default::default() });
    }

    /// The same of that size.
    pub(crate) fn track_structure_sized(
        &mut self,
        handle: vk::AccelerationStructure,
        ty: vk::AccelerationStructureType,
        size: u64,
    ) {
        let address = vk::DeviceAddress(STRUCTURES + 0x100 * (handle.0 % 8));
        let address_range = vk::DeviceAddressRange { address, size };
        self.track_create(handle, vk::AccelerationStructureCreateInfo2 { ty, address_range, ..Default::default() });
    }

    /// Creates an acceleration structure.
    pub(crate) fn track_create(
        &mut self,
        acceleration_structure: vk::AccelerationStructure,
        create_info: vk::AccelerationStructureCreateInfo2,
    ) {
        self.track(&Call::CreateAccelerationStructure2 { device: DEVICE, create_info, acceleration_structure });
    }

    pub(crate) fn track(&mut self, call: &Call) {
        self.validator.track(call, &Output::None);
    }

    pub(crate) fn begin(&mut self) {
        let begin_info = vk::CommandBufferBeginInfo::default();
        self.track(&Call::BeginCommandBuffer { command_buffer: COMMAND_BUFFER, begin_info });
    }

    pub(crate) fn submit(&mut self) {
        self.track(&Call::EndCommandBuffer { command_buffer: COMMAND_BUFFER });
        self.track(&Call::QueueSubmit { queue: QUEUE, command_buffers: vec![COMMAND_BUFFER] });
    }

    pub(crate) fn write(&mut self, address: u64, bytes: &[u8]) {
        let start = (address - BASE) as usize;
        self.memory[start..start + bytes.len()].copy_from_slice(bytes);
    }

    pub(crate) fn check(&self) -> Report {
        self.validator.check(&self.call, self)
    }

    /// Another device with other limits, on which only the buffer was created yet.
    pub(crate) fn with_limits(&mut self, change: impl FnOnce(&mut omm_model::profile::Limits)) {
        let mut profile = self.validator.profile().clone();
        change(&mut profile.limits);
        let mut fresh = Self { validator: Validator::new(profile), ..self.clone() };
        fresh.track_buffer();
        self.validator = fresh.validator;
    }

    pub(crate) fn info(&mut self) -> &mut vk::BuildGeometryInfo {
        match &mut self.call {
            Call::CmdBuildAccelerationStructures { infos, .. }
            | Call::CmdBuildAccelerationStructuresIndirect { infos, .. }
            | Call::BuildAccelerationStructures { infos, .. } => &mut infos[0],
            Call::GetAccelerationStructureBuildSizes { build_info, .. } => build_info,
            other => panic!("{}", other.command()),
        }
    }

    pub(crate) fn ranges(&mut self) -> &mut Option<Vec<vk::BuildRangeInfo>> {
        match &mut self.call {
            Call::CmdBuildAccelerationStructures { build_range_infos, .. } => &mut build_range_infos[0],
            other => panic!("{}", other.command()),
        }
    }

    pub(crate) fn range(&mut self) -> &mut vk::BuildRangeInfo {
        &mut self.ranges().as_mut().unwrap()[0]
    }

    pub(crate) fn geometry(&mut self) -> &mut vk::Geometry {
        let info = self.info();
        let geometries = info.geometries.as_mut().or(info.geometry_pointers.as_mut());
        &mut geometries.unwrap()[0]
    }

    pub(crate) fn micromap_data(&mut self) -> &mut vk::GeometryMicromapData {
        let data = self.geometry().next.iter_mut().find_map(|structure| match structure {
            vk::ChainStructure::GeometryMicromapData(data) => Some(data),
            _ => None,
        });
        data.unwrap()
    }

    pub(crate) fn usages(&mut self) -> &mut Vec<vk::MicromapUsage> {
        let data = self.micromap_data();
        data.usage_counts.as_mut().or(data.usage_count_pointers.as_mut()).unwrap()
    }

    pub(crate) fn triangles(&mut self) -> &mut vk::GeometryTrianglesData {
        let vk::GeometryData::Triangles(triangles) = &mut self.geometry().geometry else { panic!("no triangles") };
        triangles
    }

    pub(crate) fn attached(&mut self) -> &mut vk::TrianglesOpacityMicromap {
        let vk::GeometryData::Triangles(triangles) = &mut self.geometry().geometry else { panic!("no triangles") };
        let attached = triangles.next.iter_mut().find_map(|structure| match structure {
            vk::ChainStructure::TrianglesOpacityMicromap(attached) => Some(attached),
            _ => None,
        });
        attached.unwrap()
    }
}

/// The address of another buffer, of that usage.
pub(crate) fn other_buffer(scene: &mut Scene, usage: vk::BufferUsageFlags) -> u64 {
    let buffer = vk::Buffer(0x56);
    let create_info = vk::BufferCreateInfo { size: 0x100, usage, ..Default::default() };
    scene.track(&Call::CreateBuffer { device: DEVICE, create_info, buffer });
    let info = vk::BufferDeviceAddressInfo { buffer, ..Default::default() };
    let address = Output::DeviceAddress(vk::DeviceAddress(OTHER_BASE));
    scene.validator.track(&Call::GetBufferDeviceAddress { device: DEVICE, info }, &address);
    OTHER_BASE
}

/// A command that records builds.
pub(crate) fn build(
    infos: Vec<vk::BuildGeometryInfo>,
    build_range_infos: Vec<Option<Vec<vk::BuildRangeInfo>>>,
) -> Call {
    Call::CmdBuildAccelerationStructures { command_buffer: COMMAND_BUFFER, infos, build_range_infos }
}

/// A valid micromap build.
pub(crate) fn micromap_build(dst: vk::AccelerationStructure) -> vk::BuildGeometryInfo {
    let usage = |count, subdivision_level, format| vk::MicromapUsage { count, subdivision_level, format };
    let data = vk::GeometryMicromapData {
        usage_counts: Some(vec![
            usage(2, 1, vk::OpacityMicromapFormat::FOUR_STATE),
            usage(MICROMAP_TRIANGLES - 2, 2, vk::OpacityMicromapFormat::TWO_STATE),
        ]),
        data: vk::DeviceAddress(DATA),
        triangle_array: vk::DeviceAddress(TRIANGLE_ARRAY),
        triangle_array_stride: 8,
        ..Default::default()
    };
    let geometry =
        vk::Geometry { next: vec![data.into()], geometry_type: vk::GeometryType::MICROMAP, ..Default::default() };
    vk::BuildGeometryInfo {
        ty: vk::AccelerationStructureType::OPACITY_MICROMAP,
        dst_acceleration_structure: dst,
        geometries: Some(vec![geometry]),
        ..Default::default()
    }
}

/// Every feature, and the lowest limits.
fn profile() -> DeviceProfile {
    DeviceProfile { features: omm_model::profile::Features::ALL, ..DeviceProfile::minimum() }
}

/// One change to a valid scene, and what it breaks.
#[derive(Clone)]
pub(crate) struct Case {
    pub(crate) rule: RuleId,
    pub(crate) scene: fn() -> Scene,
    pub(crate) change: fn(&mut Scene),
    /// Every rule broken, with its path; empty if the rule is kept.
    pub(crate) broken: &'static [(RuleId, &'static str)],
}

impl Case {
    /// The change breaks the rule, and no other.
    pub(crate) fn breaks(&self) -> bool {
        !self.broken.is_empty()
    }

    /// Checks the changed scene; what is found beside what should be, if they differ.
    fn run(&self) -> Option<String> {
        let mut scene = (self.scene)();
        (self.change)(&mut scene);
        let report = scene.check();
        let found = report.iter().map(|it| (it.rule, it.location.as_str()));
        let found: Vec<_> = found.filter(|(rule, _)| !crate::is_general(*rule)).collect();
        for violation in &report {
            assert!(!violation.objects.is_empty());
            let text = violation.to_string();
            assert!(text.contains(violation.rule.vuid()) && text.contains(violation.rule.explanation()), "{text}");
        }
        let (rule, name) = (self.rule, scene.name);
        (found != self.broken).then(|| format!("{rule:?} in {name}: {found:?}, not {:?}", self.broken))
    }
}

/// A change that breaks `broken[0]`.
pub(crate) fn fails(scene: fn() -> Scene, change: fn(&mut Scene), broken: &'static [(RuleId, &'static str)]) -> Case {
    Case { rule: broken[0].0, scene, change, broken }
}

/// A change that almost breaks `rule`.
pub(crate) fn passes(rule: RuleId, scene: fn() -> Scene, change: fn(&mut Scene)) -> Case {
    Case { rule, scene, change, broken: &[] }
}

pub(crate) fn run(cases: &[Case]) {
    let wrong: Vec<_> = cases.iter().filter_map(Case::run).collect();
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}
