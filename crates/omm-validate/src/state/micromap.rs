//! Micromap objects of the EXT extension, what they hold, and the sizes that the device named for their builds.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use omm_model::call::Timeline;
use omm_model::vk;

use super::{Deserialized, MemorySpan, State};

/// A micromap object.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MicromapState {
    /// The type that it was created for.
    pub ty: vk::MicromapType,
    /// The buffer that it lies in.
    pub buffer: vk::Buffer,
    /// Offset of the first byte.
    pub offset: u64,
    /// Bytes.
    pub size: u64,
    /// What submitted work and host commands left in it; `None` if it was not constructed.
    pub contents: Option<MicromapContents>,
}

impl MicromapState {
    /// How its contents were built, as far as that is known.
    #[must_use]
    pub fn built(&self) -> Option<&MicromapBuilt> {
        self.contents.as_ref()?.built.as_deref()
    }

    /// Whether it was constructed: built, or filled with a constructed or deserialized micromap.
    #[must_use]
    pub const fn is_constructed(&self) -> bool {
        self.contents.is_some()
    }

    /// Bytes that its contents take when serialized, once the program was told.
    #[must_use]
    pub fn serialization_size(&self) -> Option<u64> {
        self.contents.as_ref()?.serialization_size
    }
}

/// What a micromap object holds.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct MicromapContents {
    /// The build behind them, through copies and serialization; `None` if it was not seen.
    pub built: Option<Arc<MicromapBuilt>>,
    /// Set if they were deserialized, also if they were copied since.
    pub deserialized: Option<Deserialized>,
    /// Bytes that they take when serialized, once the program was told.
    pub serialization_size: Option<u64>,
    /// Bytes that they take when compacted, once the program was told.
    pub compacted_size: Option<u64>,
    /// Differs for all contents.
    pub(super) number: u64,
}

/// How a micromap object was built.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct MicromapBuilt {
    /// What was built.
    pub ty: vk::MicromapType,
    /// The flags of the build.
    pub flags: vk::BuildMicromapFlags,
    /// Its usage counts.
    pub usage_counts: Vec<vk::MicromapUsageExt>,
}

impl MicromapBuilt {
    pub(super) fn new(info: &vk::MicromapBuildInfo) -> Self {
        Self { ty: info.ty, flags: info.flags, usage_counts: info.usages().copied().collect() }
    }

    /// How many triangles it has.
    #[must_use]
    pub fn triangles(&self) -> u64 {
        self.usage_counts.iter().fold(0, |sum: u64, usage| sum.saturating_add(usage.count.into()))
    }
}

/// The sizes that the device named, by the build they were asked for.
#[derive(Clone, Debug, Default)]
pub(super) struct BuildSizes(
    BTreeMap<u64, Vec<(vk::AccelerationStructureBuildType, MicromapBuilt, vk::MicromapBuildSizesInfo)>>,
);

/// A number for all that the sizes of a build depend on, made without allocating.
fn key(info: &vk::MicromapBuildInfo) -> u64 {
    let mut hasher = DefaultHasher::new();
    (info.ty, info.flags).hash(&mut hasher);
    info.usages().for_each(|usage| usage.hash(&mut hasher));
    hasher.finish()
}

fn is_build_of(built: &MicromapBuilt, info: &vk::MicromapBuildInfo) -> bool {
    built.ty == info.ty && built.flags == info.flags && built.usage_counts.iter().eq(info.usages())
}

impl State {
    /// The sizes that the device named for this build on that timeline, if it was asked: for the same type, flags and usages.
    #[must_use]
    pub fn micromap_build_sizes(
        &self,
        info: &vk::MicromapBuildInfo,
        timeline: Timeline,
    ) -> Option<&vk::MicromapBuildSizesInfo> {
        if self.micromap_sizes.0.is_empty() {
            return None;
        }
        let one = match timeline {
            Timeline::Host => vk::AccelerationStructureBuildType::HOST,
            Timeline::Device => vk::AccelerationStructureBuildType::DEVICE,
        };
        let asked = self.micromap_sizes.0.get(&key(info))?;
        let fits = |ty| ty == one || ty == vk::AccelerationStructureBuildType::HOST_OR_DEVICE;
        asked.iter().rev().find(|(ty, built, _)| fits(*ty) && is_build_of(built, info)).map(|(_, _, sizes)| sizes)
    }

    pub(super) fn learn_build_sizes(
        &mut self,
        ty: vk::AccelerationStructureBuildType,
        info: &vk::MicromapBuildInfo,
        sizes: &vk::MicromapBuildSizesInfo,
    ) {
        let asked = Arc::make_mut(&mut self.micromap_sizes).0.entry(key(info)).or_default();
        asked.retain(|(old, built, _)| *old != ty || !is_build_of(built, info));
        asked.push((ty, MicromapBuilt::new(info), sizes.clone()));
    }

    /// The micromap object whose first byte has that address, if addresses of buffers are known.
    #[must_use]
    pub fn micromap_at(&self, address: vk::DeviceAddress) -> Option<vk::Micromap> {
        let mut micromaps = self.micromaps.keys().copied();
        micromaps.find(|micromap| self.micromap_address(*micromap) == Some(address.0))
    }

    /// The address of a micromap object's first byte, if that of its buffer is known.
    pub(crate) fn micromap_address(&self, micromap: vk::Micromap) -> Option<u64> {
        let micromap = self.micromap(micromap)?;
        Some(self.buffer(micromap.buffer)?.address?.checked_add(micromap.offset)?.0)
    }

    /// The memory that a micromap object lies in, as far as it is known.
    pub fn micromap_memory(&self, handle: vk::Micromap) -> impl Iterator<Item = MemorySpan> {
        let micromap = self.micromap(handle).into_iter();
        micromap.flat_map(|micromap| self.buffer_memory(micromap.buffer, micromap.offset, micromap.size))
    }

    /// Whether memory is bound to all of a micromap object; `None` if the object or its buffer is not known.
    #[must_use]
    pub fn micromap_is_bound(&self, handle: vk::Micromap) -> Option<bool> {
        let &MicromapState { buffer, offset, size, .. } = self.micromap(handle)?;
        self.is_bound(buffer, offset, size)
    }
}
