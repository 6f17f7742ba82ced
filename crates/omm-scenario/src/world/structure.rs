//! Acceleration structures and micromaps: asking for sizes, creating, building.

use omm_layout::object::Object as Built;
use omm_model::call::{Call, Output};
use omm_model::vk;

use super::buffer::BufferRequest;
use super::{DEVICE, World};
use crate::error::Mistake;
use crate::node::Node;
use crate::objects::{Object, Range};
use crate::transcript::Outcome;

/// An acceleration structure, or a micromap object of the EXT extension.
#[derive(Clone, Debug)]
pub(crate) struct Structure {
    pub(crate) handle: Handle,
    /// The type that it is created with.
    pub(crate) ty: vk::AccelerationStructureType,
    /// Where it lies. Its address is known once there is a buffer for it.
    pub(crate) range: Range,
    /// The buffer that it lies in.
    pub(crate) buffer: vk::Buffer,
    pub(crate) recipe: Option<Recipe>,
}

/// A structure's handle, of one of two kinds of objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Handle {
    AccelerationStructure(vk::AccelerationStructure),
    Micromap(vk::Micromap),
}

/// What a structure is built from. Destination and scratch memory are filled in.
#[derive(Clone, Debug)]
pub(crate) enum Recipe {
    AccelerationStructure { info: Box<vk::BuildGeometryInfo>, ranges: Option<Vec<vk::BuildRangeInfo>> },
    Micromap(Box<vk::MicromapBuildInfo>),
}

/// How far a declared structure is prepared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Preparation {
    /// There is memory for it.
    Memory,
    /// It is created.
    Created,
    /// It is built.
    Built,
}

/// What a scenario says about a structure beside what it is built from.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Storage {
    /// The type that it is created with instead of its own.
    pub(crate) ty: Option<vk::AccelerationStructureType>,
    /// The size that it is created with instead of what a build needs.
    pub(crate) size: Option<u64>,
}

/// Bytes of scratch memory where the device is not asked how many are needed.
const SCRATCH: u64 = 1 << 16;

impl Recipe {
    pub(crate) fn ty(&self) -> vk::AccelerationStructureType {
        match self {
            Self::AccelerationStructure { info, .. } => info.ty,
            Self::Micromap(_) => vk::AccelerationStructureType::OPACITY_MICROMAP,
        }
    }

    /// The query of sizes that belongs to the build.
    pub(crate) fn sizes(&self) -> Call {
        let build_type = vk::AccelerationStructureBuildType::DEVICE;
        match self {
            Self::AccelerationStructure { info, ranges } => Call::GetAccelerationStructureBuildSizes {
                device: DEVICE,
                build_type,
                build_info: info.as_ref().clone(),
                max_primitive_counts: ranges
                    .as_ref()
                    .map(|ranges| ranges.iter().map(|range| range.primitive_count).collect()),
            },
            Self::Micromap(info) => {
                Call::GetMicromapBuildSizes { device: DEVICE, build_type, build_info: info.as_ref().clone() }
            }
        }
    }
}

impl World {
    /// Prepares a structure as far as `wanted`.
    pub(crate) fn make_structure(
        &mut self,
        name: &str,
        recipe: Recipe,
        storage: &Storage,
        wanted: Preparation,
        node: &Node,
    ) -> Result<(), Mistake> {
        let (size, scratch) = match storage.size {
            // Whoever wants another size may want one that no build asks for.
            Some(size) => (size, SCRATCH),
            None => match self.prepare(&recipe.sizes(), node)? {
                Output::BuildSizes(sizes) => {
                    (sizes.acceleration_structure_size, sizes.build_scratch_size.max(sizes.update_scratch_size))
                }
                Output::MicromapBuildSizes(sizes) => (sizes.micromap_size, sizes.build_scratch_size),
                _ => return Err(node.mistake("the device told no sizes")),
            },
        };
        let is_ext = matches!(recipe, Recipe::Micromap(_));
        let ty = storage.ty.unwrap_or(recipe.ty());
        let mut structure = self.reserve(name, ty, is_ext, size, node)?;
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let scratch_name = format!("{name}.scratch");
        let request = BufferRequest::new(&scratch_name, scratch, usage);
        let scratch = vk::DeviceAddress(self.make_buffer(&request, node)?.address);
        structure.recipe = Some(match (recipe, structure.handle) {
            (Recipe::AccelerationStructure { mut info, ranges }, Handle::AccelerationStructure(handle)) => {
                info.dst_acceleration_structure = handle;
                info.scratch_data = scratch.into();
                Recipe::AccelerationStructure { info, ranges }
            }
            (Recipe::Micromap(mut info), Handle::Micromap(handle)) => {
                info.dst_micromap = handle;
                info.scratch_data = scratch.into();
                Recipe::Micromap(info)
            }
            (recipe, _) => recipe,
        });
        self.structures.insert(name.to_owned(), structure);
        if wanted >= Preparation::Created {
            self.create(name, node)?;
        }
        if wanted >= Preparation::Built {
            let command_buffer = self.begin(node)?;
            let build = self.build_call(&[name], command_buffer, node)?;
            self.prepare(&build, node)?;
            if let Outcome::Undefined(undefined) = self.submit(command_buffer) {
                let undefined = self.objects.named(&undefined.to_string());
                return Err(node.mistake(format!("this cannot be built: {undefined}")));
            }
        }
        Ok(())
    }

    /// A structure that something is copied into.
    pub(crate) fn make_empty(
        &mut self,
        name: &str,
        ty: vk::AccelerationStructureType,
        is_ext: bool,
        size: u64,
        wanted: Preparation,
        node: &Node,
    ) -> Result<(), Mistake> {
        let structure = self.reserve(name, ty, is_ext, size, node)?;
        self.structures.insert(name.to_owned(), structure);
        if wanted >= Preparation::Created { self.create(name, node) } else { Ok(()) }
    }

    /// Memory for a structure, and its handle.
    fn reserve(
        &mut self,
        name: &str,
        ty: vk::AccelerationStructureType,
        is_ext: bool,
        size: u64,
        node: &Node,
    ) -> Result<Structure, Mistake> {
        let usage = if is_ext {
            vk::BufferUsageFlags::MICROMAP_STORAGE
        } else {
            vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE
        };
        let usage = usage | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let storage = format!("{name}.storage");
        let request = BufferRequest::new(&storage, size, usage);
        let range = self.make_buffer(&request, node)?;
        let buffer = self.objects.handle("Buffer", &storage).map(vk::Buffer).unwrap_or_default();
        let handle = self.handle();
        let (type_name, handle) = if is_ext {
            ("Micromap", Handle::Micromap(vk::Micromap(handle)))
        } else {
            ("AccelerationStructure", Handle::AccelerationStructure(vk::AccelerationStructure(handle)))
        };
        let handles = vec![(type_name, handle.raw())];
        self.objects.insert(Object { name: name.to_owned(), handles, place: Some(range) });
        Ok(Structure { handle, ty, range, buffer, recipe: None })
    }

    /// Creates a structure whose memory is there.
    fn create(&mut self, name: &str, node: &Node) -> Result<(), Mistake> {
        let Some(create) = self.structures.get(name).map(Structure::create_call) else { return Ok(()) };
        self.prepare(&create, node)?;
        if let Some(Handle::AccelerationStructure(acceleration_structure)) =
            self.structures.get(name).map(|structure| structure.handle)
        {
            let info = vk::AccelerationStructureDeviceAddressInfo { acceleration_structure, ..Default::default() };
            self.prepare(&Call::GetAccelerationStructureDeviceAddress { device: DEVICE, info }, node)?;
        }
        Ok(())
    }

    /// The command that builds some structures of one kind.
    pub(crate) fn build_call(
        &self,
        names: &[&str],
        command_buffer: vk::CommandBuffer,
        node: &Node,
    ) -> Result<Call, Mistake> {
        let (mut infos, mut build_range_infos, mut micromaps) = (Vec::new(), Vec::new(), Vec::new());
        for name in names {
            match &self.structure(name, node)?.recipe {
                Some(Recipe::AccelerationStructure { info, ranges }) => {
                    infos.push(info.as_ref().clone());
                    build_range_infos.push(ranges.clone());
                }
                Some(Recipe::Micromap(info)) => micromaps.push(info.as_ref().clone()),
                None => return Err(node.mistake(format!("nothing says what \"{name}\" is built from"))),
            }
        }
        match (infos.is_empty(), micromaps.is_empty()) {
            (_, true) => Ok(Call::CmdBuildAccelerationStructures { command_buffer, infos, build_range_infos }),
            (true, false) => Ok(Call::CmdBuildMicromaps { command_buffer, infos: micromaps }),
            (false, false) => Err(node.mistake("no command builds micromap objects and acceleration structures")),
        }
    }

    /// The structure of that name.
    pub(crate) fn structure(&self, name: &str, node: &Node) -> Result<&Structure, Mistake> {
        self.structures.get(name).ok_or_else(|| {
            let names = self.structures.keys().map(String::as_str);
            let message = match self.objects.contains(name) {
                true => format!("\"{name}\" is no acceleration structure and no micromap"),
                false => format!("there is no object \"{name}\""),
            };
            node.mistake(message).nearest(name, names)
        })
    }

    /// What a structure holds, if anything was built or copied into it.
    pub(crate) fn built(&self, name: &str, node: &Node) -> Result<Option<Built<'_>>, Mistake> {
        let range = self.structure(name, node)?.range;
        Ok(self.read(range.address, range.size).and_then(|bytes| Built::read(bytes).ok()))
    }
}

impl Handle {
    /// The number.
    pub(crate) const fn raw(self) -> u64 {
        match self {
            Self::AccelerationStructure(handle) => handle.0,
            Self::Micromap(handle) => handle.0,
        }
    }
}

impl Structure {
    /// How it is created if what is built into it moves: with a flag, and for a top level with the number of instances.
    fn motion(&self) -> (vk::AccelerationStructureCreateFlags, vk::Chain) {
        let (flags, mut next) = (vk::AccelerationStructureCreateFlags::MOTION, vk::Chain::new());
        let Some(Recipe::AccelerationStructure { info, ranges }) = &self.recipe else { return Default::default() };
        let moves = |geometry: &vk::Geometry| match &geometry.geometry {
            vk::GeometryData::Triangles(triangles) => triangles.motion_data().is_some(),
            _ => false,
        };
        if info.flags.contains(vk::BuildAccelerationStructureFlags::MOTION)
            && info.ty == vk::AccelerationStructureType::TOP_LEVEL
        {
            let max_instances = ranges.iter().flatten().map(|range| range.primitive_count).sum();
            next.push(vk::AccelerationStructureMotionInfo { max_instances, ..Default::default() }.into());
        } else if !info.geometries_iter().any(moves) {
            return Default::default();
        }
        (flags, next)
    }

    /// The command that creates it: a KHR micromap by address, all else by buffer.
    pub(crate) fn create_call(&self) -> Call {
        let Range { address, size, host: _ } = self.range;
        match self.handle {
            Handle::AccelerationStructure(acceleration_structure)
                if self.ty == vk::AccelerationStructureType::OPACITY_MICROMAP =>
            {
                let address_range = vk::DeviceAddressRange { address: vk::DeviceAddress(address), size };
                let create_info =
                    vk::AccelerationStructureCreateInfo2 { address_range, ty: self.ty, ..Default::default() };
                Call::CreateAccelerationStructure2 { device: DEVICE, create_info, acceleration_structure }
            }
            Handle::AccelerationStructure(acceleration_structure) => {
                let (create_flags, next) = self.motion();
                let create_info = vk::AccelerationStructureCreateInfo {
                    next,
                    create_flags,
                    buffer: self.buffer,
                    size,
                    ty: self.ty,
                    ..Default::default()
                };
                Call::CreateAccelerationStructure { device: DEVICE, create_info, acceleration_structure }
            }
            Handle::Micromap(micromap) => {
                let create_info = vk::MicromapCreateInfo { buffer: self.buffer, size, ..Default::default() };
                Call::CreateMicromap { device: DEVICE, create_info, micromap }
            }
        }
    }
}
