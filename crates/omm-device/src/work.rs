//! Commands that write memory, on either timeline: what they write is worked out in units that can be done in any order, by any
//! thread, and all of it is written at the end.

use omm_model::call::{Call, Timeline};
use omm_model::vk;

use crate::build::Ranges;
use crate::build::access::{Access, Accesses};
use crate::copy::Form;
use crate::device::Device;
use crate::holder::Holder;
use crate::memory::Address;
use crate::undefined::{At, Reason, Stop};

/// What one unit writes, and where.
#[derive(Debug)]
pub(crate) struct Unit {
    pub(crate) address: Address,
    pub(crate) bytes: Vec<u8>,
    /// The memory that the unit uses, so that units can be held against each other.
    pub(crate) access: Access,
}

/// A command that writes memory.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Work<'a> {
    Build(&'a [vk::BuildGeometryInfo], &'a [Option<Vec<vk::BuildRangeInfo>>]),
    BuildIndirect(&'a [vk::BuildGeometryInfo], Indirect<'a>),
    BuildMicromaps(&'a [vk::MicromapBuildInfo]),
    Copy { src: Holder, dst: Holder, form: Result<Form, i32> },
    Serialize { src: Holder, dst: vk::DeviceOrHostAddress, mode: Result<(), i32> },
    Deserialize { src: vk::DeviceOrHostAddress, dst: Holder, mode: Result<(), i32> },
}

/// The arrays of an indirect build.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Indirect<'a> {
    addresses: &'a [vk::DeviceAddress],
    strides: &'a [u32],
    counts: &'a [Option<Vec<u32>>],
}

fn structure_mode(
    mode: vk::CopyAccelerationStructureMode,
    required: vk::CopyAccelerationStructureMode,
) -> Result<(), i32> {
    if mode == required { Ok(()) } else { Err(mode.0) }
}

fn micromap_mode(mode: vk::CopyMicromapMode, required: vk::CopyMicromapMode) -> Result<(), i32> {
    if mode == required { Ok(()) } else { Err(mode.0) }
}

impl<'a> Work<'a> {
    /// The work that a command stands for; `None` for a command of another kind.
    pub(crate) fn of(call: &'a Call) -> Option<Self> {
        type Structure = vk::CopyAccelerationStructureMode;
        type Micromap = vk::CopyMicromapMode;
        Some(match call {
            Call::CmdBuildAccelerationStructures { infos, build_range_infos, .. }
            | Call::BuildAccelerationStructures { infos, build_range_infos, .. } => {
                Self::Build(infos, build_range_infos)
            }
            Call::CmdBuildAccelerationStructuresIndirect {
                infos,
                indirect_device_addresses: addresses,
                indirect_strides: strides,
                max_primitive_counts: counts,
                ..
            } => Self::BuildIndirect(infos, Indirect { addresses, strides, counts }),
            Call::CmdBuildMicromaps { infos, .. } | Call::BuildMicromaps { infos, .. } => Self::BuildMicromaps(infos),
            Call::CmdCopyAccelerationStructure { info, .. } | Call::CopyAccelerationStructure { info, .. } => {
                let form = match info.mode {
                    Structure::CLONE => Ok(Form::Same),
                    Structure::COMPACT => Ok(Form::Compacted),
                    vk::CopyAccelerationStructureMode(found) => Err(found),
                };
                Self::Copy { src: info.src.into(), dst: info.dst.into(), form }
            }
            Call::CmdCopyMicromap { info, .. } | Call::CopyMicromap { info, .. } => {
                let form = match info.mode {
                    Micromap::CLONE => Ok(Form::Same),
                    Micromap::COMPACT => Ok(Form::Compacted),
                    vk::CopyMicromapMode(found) => Err(found),
                };
                Self::Copy { src: info.src.into(), dst: info.dst.into(), form }
            }
            Call::CmdCopyAccelerationStructureToMemory { info, .. }
            | Call::CopyAccelerationStructureToMemory { info, .. } => {
                let mode = structure_mode(info.mode, Structure::SERIALIZE);
                Self::Serialize { src: info.src.into(), dst: info.dst, mode }
            }
            Call::CmdCopyMicromapToMemory { info, .. } | Call::CopyMicromapToMemory { info, .. } => {
                let mode = micromap_mode(info.mode, Micromap::SERIALIZE);
                Self::Serialize { src: info.src.into(), dst: info.dst, mode }
            }
            Call::CmdCopyMemoryToAccelerationStructure { info, .. }
            | Call::CopyMemoryToAccelerationStructure { info, .. } => {
                let mode = structure_mode(info.mode, Structure::DESERIALIZE);
                Self::Deserialize { src: info.src, dst: info.dst.into(), mode }
            }
            Call::CmdCopyMemoryToMicromap { info, .. } | Call::CopyMemoryToMicromap { info, .. } => {
                let mode = micromap_mode(info.mode, Micromap::DESERIALIZE);
                Self::Deserialize { src: info.src, dst: info.dst.into(), mode }
            }
            _ => return None,
        })
    }

    /// Number of units.
    pub(crate) const fn units(&self) -> usize {
        match self {
            Self::Build(infos, _) | Self::BuildIndirect(infos, _) => infos.len(),
            Self::BuildMicromaps(infos) => infos.len(),
            Self::Copy { .. } | Self::Serialize { .. } | Self::Deserialize { .. } => 1,
        }
    }

    /// Requires arrays that belong together to have as many elements.
    pub(crate) fn check(&self) -> Result<(), Stop> {
        let required = self.units() as u64;
        let lengths = match self {
            Self::Build(_, ranges) => vec![(ranges.len(), "ppBuildRangeInfos")],
            Self::BuildIndirect(_, Indirect { addresses, strides, counts }) => vec![
                (addresses.len(), "pIndirectDeviceAddresses"),
                (strides.len(), "pIndirectStrides"),
                (counts.len(), "ppMaxPrimitiveCounts"),
            ],
            _ => Vec::new(),
        };
        match lengths.into_iter().find(|(found, _)| *found as u64 != required) {
            Some((found, at)) => Err(Reason::CountMismatch { found: found as u64, required }).at(at),
            None => Ok(()),
        }
    }
}

impl Device {
    /// Works out a unit.
    pub(crate) fn unit(&self, work: &Work<'_>, index: usize, timeline: Timeline) -> Result<Unit, Stop> {
        let unknown = |found: i32| Stop::from(Reason::UnknownValue { found: found.into() }).within("mode");
        let missing = || Stop::from(Reason::Missing { what: "an element" }).within(format_args!("pInfos[{index}]"));
        match *work {
            Work::Build(infos, ranges) => {
                let (info, ranges) = infos.get(index).zip(ranges.get(index)).ok_or_else(missing)?;
                self.build(info, Ranges::Direct(ranges.as_deref()), index, timeline)
            }
            Work::BuildIndirect(infos, Indirect { addresses, strides, counts }) => {
                let info = infos.get(index).ok_or_else(missing)?;
                let (address, stride) = addresses.get(index).zip(strides.get(index)).ok_or_else(missing)?;
                let counts = counts.get(index).ok_or_else(missing)?.as_deref();
                self.build(info, Ranges::Indirect(*address, *stride, counts), index, timeline)
            }
            Work::BuildMicromaps(infos) => self.build_object(infos.get(index).ok_or_else(missing)?, index, timeline),
            Work::Copy { src, dst, form } => {
                form.map_err(unknown).and_then(|form| self.copy(src, dst, form, timeline)).at("pInfo->")
            }
            Work::Serialize { src, dst, mode } => {
                mode.map_err(unknown).and_then(|()| self.serialize(src, dst, timeline)).at("pInfo->")
            }
            Work::Deserialize { src, dst, mode } => {
                mode.map_err(unknown).and_then(|()| self.deserialize(src, dst, timeline)).at("pInfo->")
            }
        }
    }

    /// Does all units of a command and writes what they make.
    pub(crate) fn perform(&mut self, work: &Work<'_>, timeline: Timeline) -> Result<(), Stop> {
        work.check()?;
        let units = (0..work.units()).map(|index| self.unit(work, index, timeline));
        let units = units.collect::<Result<Vec<_>, _>>()?;
        check(&units)?;
        // Places were looked up when the units were made.
        units.iter().try_for_each(|unit| Ok(self.memory.write(unit.address, &unit.bytes)?))
    }
}

/// Requires what one unit writes to be touched by no other.
pub(crate) fn check(units: &[Unit]) -> Result<(), Stop> {
    Accesses::of(units.iter().map(|unit| &unit.access)).check()
}
