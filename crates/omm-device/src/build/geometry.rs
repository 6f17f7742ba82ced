//! Geometries and addresses as a build reads them.

use omm_model::vk;

use crate::memory::{Address, Memory, add};
use crate::undefined::{At, Reason, Stop};

/// The name of the array that a build's geometries stand in.
pub(crate) const fn array_name(info: &vk::BuildGeometryInfo) -> &'static str {
    if info.geometries.is_some() { "pGeometries" } else { "ppGeometries" }
}

/// What a geometry consists of, its type and its data being in agreement.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Body<'a> {
    Triangles(&'a vk::GeometryTrianglesData),
    Aabbs(&'a vk::GeometryAabbsData),
    Instances(&'a vk::GeometryInstancesData),
    Micromap(&'a vk::GeometryMicromapData),
}

/// What a geometry consists of.
pub(crate) fn body(geometry: &vk::Geometry) -> Result<Body<'_>, Stop> {
    let found = geometry.geometry_type;
    match (found, &geometry.geometry) {
        (vk::GeometryType::TRIANGLES, vk::GeometryData::Triangles(triangles)) => Ok(Body::Triangles(triangles)),
        (vk::GeometryType::AABBS, vk::GeometryData::Aabbs(aabbs)) => Ok(Body::Aabbs(aabbs)),
        (vk::GeometryType::INSTANCES, vk::GeometryData::Instances(instances)) => Ok(Body::Instances(instances)),
        (vk::GeometryType::MICROMAP, _) => {
            let missing = Reason::Missing { what: "VkAccelerationStructureGeometryMicromapDataKHR" };
            geometry.micromap_data().map(Body::Micromap).ok_or(missing).at("pNext")
        }
        _ => Err(Reason::GeometryType { found }).at("geometryType"),
    }
}

/// The only geometry of a build, and where it stands.
pub(crate) fn only(info: &vk::BuildGeometryInfo) -> Result<(&vk::Geometry, String), Stop> {
    let array = array_name(info);
    let found = info.geometries_iter().count() as u64;
    match info.geometries_iter().next() {
        Some(geometry) if found == 1 => Ok((geometry, format!("{array}[0]"))),
        _ => Err(Reason::CountMismatch { found, required: 1 }).at("geometryCount"),
    }
}

/// Items of one size at equal distances in memory.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Items<'a> {
    memory: &'a Memory,
    address: Address,
    stride: u64,
    size: u64,
    /// All of them, where they lie in one buffer; otherwise each is looked up, to name the one that is nowhere.
    whole: Option<&'a [u8]>,
}

impl<'a> Items<'a> {
    /// `count` items of `size` bytes, one every `stride` bytes from `offset` bytes behind `address` on.
    pub(crate) fn new(
        memory: &'a Memory,
        (address, offset): (Address, u64),
        (stride, size): (u64, u64),
        count: u64,
    ) -> Result<Self, Reason> {
        let address = add(address, offset)?;
        let length = count.checked_sub(1).map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(size));
        let whole = length.and_then(|length| memory.read(address, length).ok());
        Ok(Self { memory, address, stride, size, whole })
    }

    /// Item `index`.
    pub(crate) fn get(&self, index: u64) -> Result<&'a [u8], Reason> {
        let overflow = Reason::AddressOverflow { address: self.address.raw(), offset: u64::MAX };
        let offset = index.checked_mul(self.stride).ok_or(overflow)?;
        let whole = self.whole.and_then(|whole| {
            let start = usize::try_from(offset).ok()?;
            whole.get(start..)?.get(..usize::try_from(self.size).ok()?)
        });
        match whole {
            Some(item) => Ok(item),
            None => Ok(self.memory.read(add(self.address, offset)?, self.size)?),
        }
    }
}
