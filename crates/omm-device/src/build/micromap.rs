//! Micromap builds: the triangle array names level, format and place of each triangle's data, which is copied as it is unless the
//! build is [lossy](super::lossy) and the level too high.

use omm_layout::object::{MicromapContents, MicromapTriangleData};
use omm_layout::triangle;
use omm_model::call::Timeline;
use omm_model::format::OpacityMicromapFormat;
use omm_model::triangle::MicromapTriangle;
use omm_model::vk;

use super::geometry::{self, Body, Items};
use super::lossy;
use crate::device::Device;
use crate::memory::{Address, add};
use crate::undefined::{At, Reason, Stop};

/// How the structure with a micromap's input is named in a path.
pub(crate) const DATA: &str = "pNext<VkAccelerationStructureGeometryMicromapDataKHR>";

/// What a micromap is built from, in either extension.
struct Input {
    /// The flags that the object keeps.
    flags: vk::BuildAccelerationStructureFlags,
    /// Triangles: the sum of the usage counts.
    count: u64,
    data: Address,
    triangle_array: Address,
    triangle_array_stride: u64,
}

/// The flags of an EXT build under the numbers that the KHR extension gives them, so that both make the same object.
fn flags_of(flags: vk::BuildMicromapFlags) -> vk::BuildAccelerationStructureFlags {
    use vk::{BuildAccelerationStructureFlags as Khr, BuildMicromapFlags as Ext};
    let pairs = [
        (Ext::PREFER_FAST_TRACE, Khr::PREFER_FAST_TRACE),
        (Ext::PREFER_FAST_BUILD, Khr::PREFER_FAST_BUILD),
        (Ext::ALLOW_COMPACTION, Khr::ALLOW_COMPACTION),
    ];
    pairs.into_iter().filter(|(ext, _)| flags.contains(*ext)).map(|(_, khr)| khr).collect()
}

impl Device {
    /// The bytes of a micromap of the KHR extension, of which no more than `room` are made.
    pub(crate) fn build_micromap(&self, info: &vk::BuildGeometryInfo, room: u64) -> Result<Vec<u8>, Stop> {
        let (geometry, at) = geometry::only(info)?;
        let Body::Micromap(data) = geometry::body(geometry).at(&at)? else {
            return Err(Reason::GeometryType { found: geometry.geometry_type }).at("geometryType").at(at);
        };
        let input = Input {
            flags: info.flags,
            count: data.usages().map(|usage| u64::from(usage.count)).sum(),
            data: data.data.0.into(),
            triangle_array: data.triangle_array.0.into(),
            triangle_array_stride: data.triangle_array_stride,
        };
        self.micromap_bytes(&input, room).at(DATA).at(at)
    }

    /// The bytes of a micromap object of the EXT extension.
    pub(crate) fn build_micromap_object(
        &self,
        info: &vk::MicromapBuildInfo,
        timeline: Timeline,
        room: u64,
    ) -> Result<Vec<u8>, Stop> {
        let count = info.usages().map(|usage| u64::from(usage.count)).sum();
        // Without triangles nothing is read, wherever that is.
        let address = |address| if count == 0 { Ok(Address::Device(0)) } else { Address::of(timeline, address) };
        let input = Input {
            flags: flags_of(info.flags),
            count,
            data: address(info.data).at("data")?,
            triangle_array: address(info.triangle_array).at("triangleArray")?,
            triangle_array_stride: info.triangle_array_stride,
        };
        self.micromap_bytes(&input, room)
    }

    fn micromap_bytes(&self, input: &Input, room: u64) -> Result<Vec<u8>, Stop> {
        // The usage counts have been found to fit into the destination, so this many triangles are not too many to go through.
        let item = (input.triangle_array_stride, triangle::SIZE as u64);
        let entries = Items::new(&self.memory, (input.triangle_array, 0), item, input.count)?;
        let mut required = 0_u64;
        let mut triangles = Vec::new();
        for index in 0..input.count {
            let at = format_args!("triangleArray[{index}]");
            let entry = entries.get(index).at(at)?;
            let triangle = self.micromap_triangle(input.flags, entry).at(at)?;
            let stored = self.stored_level(input.flags, &triangle);
            required = required.saturating_add(triangle.format.data_size(stored).into());
            if required > room {
                return Err(Reason::TooSmall { required, available: room }).at(at);
            }
            let start = add(input.data, triangle.data_offset.into()).at(at)?;
            let data = self.memory.read(start, triangle.data_size().into()).at(format_args!("{at}.dataOffset"))?;
            let MicromapTriangle { data_offset: _, subdivision_level, format } = triangle;
            let fine = MicromapTriangleData { subdivision_level, format, data };
            let coarse = if stored == subdivision_level { None } else { Some(lossy::coarsen(&fine, stored).at(at)?) };
            triangles.push((fine, stored, coarse));
        }
        let triangles = triangles.iter().map(|(fine, stored, coarse)| match coarse {
            None => *fine,
            Some(data) => MicromapTriangleData { subdivision_level: *stored, data, ..*fine },
        });
        let contents = MicromapContents { flags: input.flags.bits(), triangles: triangles.collect() };
        let bytes = contents.encode().map_err(super::too_large)?;
        if bytes.len() as u64 > room {
            return Err(Reason::TooSmall { required: bytes.len() as u64, available: room }).at("triangleArray");
        }
        Ok(bytes)
    }

    /// The level at which a triangle is stored.
    fn stored_level(
        &self,
        flags: vk::BuildAccelerationStructureFlags,
        triangle: &MicromapTriangle,
    ) -> omm_model::level::SubdivisionLevel {
        if flags.contains(vk::BuildAccelerationStructureFlags::MICROMAP_LOSSY) {
            lossy::stored_level(&self.profile.limits, triangle.format, triangle.subdivision_level)
        } else {
            triangle.subdivision_level
        }
    }

    /// One entry of the triangle array, within the device's limits.
    fn micromap_triangle(
        &self,
        flags: vk::BuildAccelerationStructureFlags,
        entry: &[u8],
    ) -> Result<MicromapTriangle, Stop> {
        let raw = entry.first_chunk().map(triangle::decode).unwrap_or_default();
        let triangle = MicromapTriangle::try_from(raw)?;
        let limits = &self.profile.limits;
        let limit = match triangle.format {
            OpacityMicromapFormat::TwoState => limits.max_opacity2_state_subdivision_level,
            OpacityMicromapFormat::FourState if flags.contains(vk::BuildAccelerationStructureFlags::MICROMAP_LOSSY) => {
                limits.max_opacity_lossy4_state_subdivision_level
            }
            OpacityMicromapFormat::FourState => limits.max_opacity4_state_subdivision_level,
        };
        let found = triangle.subdivision_level.get();
        if found > limit {
            return Err(Reason::LevelLimit { found, limit }).at("subdivisionLevel");
        }
        Ok(triangle)
    }
}
