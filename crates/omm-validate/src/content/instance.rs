//! Rules on the instances that a top-level structure is built from.

use omm_layout::instance;
use omm_model::memory::MemoryView;
use omm_model::vk;
use vk::{BuildAccelerationStructureFlags as BuildFlags, GeometryInstanceFlags as InstanceFlags};

use super::range;
use super::triangles_data::offset_by;
use crate::context::{BuildContext, GeometryContext, Purpose};
use crate::location::At;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::stateless::MICROMAP_ANY;
use crate::value::Found;
use crate::violation::ViolationKind;

/// The flags that micromaps have brought, in the order in which they are looked at.
const MICROMAP_FLAGS: [InstanceFlags; 2] =
    [InstanceFlags::FORCE_OPACITY_MICROMAP_2_STATE, InstanceFlags::DISABLE_OPACITY_MICROMAPS];
/// Bytes from one motion instance to the next, and of what stands before the static kind's instance.
const MOTION_STRIDE: u64 = 160;
const MOTION_HEADER: u64 = 8;
/// Bytes of a pointer to an instance, and the low bits of it that tell the kind of a motion instance.
const POINTER_SIZE: u64 = 8;
const POINTER_KIND: u64 = 0xf;

pub(super) fn check(geometry: &GeometryContext<'_>, state: &State, memory: &dyn MemoryView, report: &mut Report) {
    let vk::GeometryData::Instances(data) = &geometry.geometry.geometry else { return };
    if geometry.geometry.geometry_type != vk::GeometryType::INSTANCES {
        return;
    }
    let Some(instances) = Instances::of(geometry, data, memory) else { return };
    let at = geometry.at.field("geometry");
    let at = at.field("instances");
    instance_flags_11580(geometry.build, &instances, &at, report);
    instance_flags_11581(geometry.build, &instances, state, &at, report);
}

/// The flags of micromaps need micromaps.
///
/// VUID-VkAccelerationStructureInstanceKHR-micromap-11580
fn instance_flags_11580(build: &BuildContext<'_>, instances: &Instances<'_>, at: &At<'_>, report: &mut Report) {
    if build.has_micromaps() {
        return;
    }
    for flag in MICROMAP_FLAGS {
        if let Some((index, instance)) = instances.iter().find(|(_, instance)| instance.flags.contains(flag)) {
            let found = Some(Found::Flags(instance.flags.into()));
            let kind = ViolationKind::NeedsFeature { found, features: MICROMAP_ANY };
            report.push(RuleId::InstanceFlags11580, &at.element("data", index).field("flags"), kind);
        }
    }
}

/// Micromaps are disabled in structures that were built for it. Device builds say it twice.
///
/// VUID-VkAccelerationStructureInstanceKHR-flags-11581, with vkCmdBuildAccelerationStructuresKHR 10607 and its indirect twin
fn instance_flags_11581(
    build: &BuildContext<'_>,
    instances: &Instances<'_>,
    state: &State,
    at: &At<'_>,
    report: &mut Report,
) {
    let required = BuildFlags::ALLOW_DISABLE_OPACITY_MICROMAPS;
    let mut disabling = instances.iter().filter(|(_, it)| it.flags.contains(InstanceFlags::DISABLE_OPACITY_MICROMAPS));
    let wrong = disabling.find_map(|(index, instance)| {
        let flags = build_flags(build, state, instance.acceleration_structure_reference)?;
        (!flags.contains(required)).then_some((index, flags))
    });
    let Some((index, flags)) = wrong else { return };
    let twin = match build.purpose {
        Purpose::Build { .. } => Some(RuleId::InstanceFlags10607),
        Purpose::Indirect { .. } => Some(RuleId::IndirectInstanceFlags10607),
        Purpose::Host | Purpose::Sizes => None,
    };
    let kind = ViolationKind::MissingFlags { found: flags.into(), required: required.into() };
    for rule in [RuleId::InstanceFlags11581].into_iter().chain(twin) {
        report.push(rule, &at.element("data", index).field("flags"), kind);
    }
}

/// Instances in memory.
struct Instances<'m> {
    memory: &'m dyn MemoryView,
    data: vk::DeviceOrHostAddress,
    by_pointer: bool,
    has_motion: bool,
    count: u32,
}

impl<'m> Instances<'m> {
    /// The instances that are built.
    fn of(
        geometry: &GeometryContext<'_>,
        data: &vk::GeometryInstancesData,
        memory: &'m dyn MemoryView,
    ) -> Option<Self> {
        let range = range(geometry, memory)?;
        Some(Self {
            memory,
            data: offset_by(data.data, range.primitive_offset.into())?,
            by_pointer: data.array_of_pointers.is_true(),
            has_motion: geometry.build.info.flags.contains(BuildFlags::MOTION),
            count: range.primitive_count,
        })
    }

    /// Those up to the first that is not readable, with their places; motion instances other than the static kind are left out.
    fn iter(&self) -> impl Iterator<Item = (usize, vk::Instance)> {
        (0..self.count).map_while(|index| self.read(index)).zip(0..).filter_map(|(it, index)| Some((index, it?)))
    }

    /// An instance; `None` if it is not readable, and within if it is of another kind.
    fn read(&self, index: u32) -> Option<Option<vk::Instance>> {
        let (address, kind) = self.place(index.into())?;
        if kind != vk::MotionInstanceType::STATIC {
            return Some(None);
        }
        let bytes = self.memory.read_either(address, instance::SIZE as u64).ok()?;
        Some(bytes.first_chunk().map(instance::decode))
    }

    /// Where an instance is, and of which kind.
    fn place(&self, index: u64) -> Option<(vk::DeviceOrHostAddress, vk::MotionInstanceType)> {
        match (self.by_pointer, self.has_motion) {
            (false, false) => {
                Some((offset_by(self.data, instance::SIZE as u64 * index)?, vk::MotionInstanceType::STATIC))
            }
            (false, true) => {
                let entry = offset_by(self.data, MOTION_STRIDE * index)?;
                let kind = self.memory.read_either(entry, 4).ok()?.first_chunk()?;
                Some((offset_by(entry, MOTION_HEADER)?, vk::MotionInstanceType(i32::from_le_bytes(*kind))))
            }
            (true, has_motion) => {
                let entry = offset_by(self.data, POINTER_SIZE * index)?;
                let pointer = u64::from_le_bytes(*self.memory.read_either(entry, POINTER_SIZE).ok()?.first_chunk()?);
                let kind = if has_motion { pointer & POINTER_KIND } else { 0 };
                let address = match self.data {
                    vk::DeviceOrHostAddress::DeviceAddress(_) => vk::DeviceAddress(pointer ^ kind).into(),
                    vk::DeviceOrHostAddress::HostAddress(_) => vk::HostAddress(pointer ^ kind).into(),
                };
                Some((address, vk::MotionInstanceType(i32::try_from(kind).ok()?)))
            }
        }
    }
}

/// The flags that a bottom-level structure is built with when the command executes, as far as is known.
fn build_flags(build: &BuildContext<'_>, state: &State, reference: u64) -> Option<BuildFlags> {
    let handle = match build.purpose {
        Purpose::Host => vk::AccelerationStructure(reference),
        _ => state.acceleration_structure_at(vk::DeviceAddress(reference))?,
    };
    let built = match build.command_buffer() {
        Some(command_buffer) => state.built(command_buffer, handle),
        None => state.acceleration_structure(handle)?.built(),
    };
    Some(built?.flags)
}
