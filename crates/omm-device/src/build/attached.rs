//! Micromaps attached to triangles: which one, and what of it each triangle has.

use omm_layout::index::IndexType;
use omm_layout::index_buffer;
use omm_layout::object::{Object, ObjectKind, TriangleVertices};
use omm_model::call::Timeline;
use omm_model::special_index::TriangleMap;
use omm_model::vk;

use super::access::Access;
use super::bottom_level::{checked_index_type, index_value};
use super::geometry::Items;
use crate::device::Device;
use crate::holder::Holder;
use crate::memory::Address;
use crate::undefined::{At, Reason, Stop};

/// How the structures that attach a micromap are named in a path.
pub(crate) const KHR: &str = "pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>";
pub(crate) const EXT: &str = "pNext<VkAccelerationStructureTrianglesOpacityMicromapEXT>";

/// A micromap, null or not, and the indices of triangles in it.
///
/// The usage counts of the EXT form say nothing that the index buffer does not, and are not read.
#[derive(Clone, Debug)]
pub(crate) struct Attached {
    /// The structure's name.
    pub(crate) structure: &'static str,
    index_type: vk::IndexType,
    index_buffer: Option<Address>,
    index_stride: u64,
    base_triangle: u32,
    /// `None` for a null handle.
    micromap: Option<Holder>,
}

/// Whether a micromap, null or not, is attached.
pub(crate) fn is_attached(triangles: &vk::GeometryTrianglesData) -> bool {
    triangles.opacity_micromap().is_some() || triangles.opacity_micromap_ext().is_some()
}

/// The micromap attached in one of the two ways, and the structure that does it.
pub(crate) fn holder(triangles: &vk::GeometryTrianglesData) -> Option<(Holder, &'static str)> {
    let khr = triangles.opacity_micromap().map(|found| (found.micromap.into(), KHR));
    let ext = triangles.opacity_micromap_ext().map(|found| (found.micromap.into(), EXT));
    khr.or(ext).filter(|(holder, _): &(Holder, _)| holder.handle() != 0)
}

impl Attached {
    /// What is attached to triangles, in either way.
    pub(crate) fn of(triangles: &vk::GeometryTrianglesData, timeline: Timeline) -> Result<Option<Self>, Stop> {
        match (triangles.opacity_micromap(), triangles.opacity_micromap_ext()) {
            (None, None) => Ok(None),
            (Some(_), Some(_)) => Err(Reason::CountMismatch { found: 2, required: 1 }).at("pNext"),
            (Some(found), None) => Self::khr(found, timeline).at(KHR).map(Some),
            (None, Some(found)) => Self::ext(found, timeline).at(EXT).map(Some),
        }
    }

    fn khr(found: &vk::TrianglesOpacityMicromap, timeline: Timeline) -> Result<Self, Stop> {
        if timeline == Timeline::Host && !found.micromap.is_null() {
            return Err(Reason::WrongCommand { what: "with a micromap of the KHR extension" }).at("micromap");
        }
        // The structure has room for a device address only, whoever reads it.
        let address = Address::Device(found.index_buffer.0);
        let index_buffer = Some(address).filter(|_| found.index_type != vk::IndexType::NONE);
        Ok(Self {
            structure: KHR,
            index_type: found.index_type,
            index_buffer,
            index_stride: found.index_stride,
            base_triangle: found.base_triangle,
            micromap: Some(found.micromap).filter(|micromap| !micromap.is_null()).map(Holder::from),
        })
    }

    fn ext(found: &vk::TrianglesOpacityMicromapExt, timeline: Timeline) -> Result<Self, Stop> {
        let address = Address::of(timeline, found.index_buffer);
        let index_buffer =
            if found.index_type == vk::IndexType::NONE { None } else { Some(address.at("indexBuffer")?) };
        Ok(Self {
            structure: EXT,
            index_type: found.index_type,
            index_buffer,
            index_stride: found.index_stride,
            base_triangle: found.base_triangle,
            micromap: Some(found.micromap).filter(|micromap| !micromap.is_null()).map(Holder::from),
        })
    }
}

/// What the triangles of a geometry have of a micromap.
pub(super) struct Maps {
    /// The micromap's address; 0 for a null one.
    pub(super) micromap: u64,
    /// One for each triangle; `None` for an inactive one.
    pub(super) maps: Vec<Option<TriangleMap>>,
}

impl Device {
    /// What each triangle of a geometry has of the micromap; nothing where the triangle is inactive.
    pub(super) fn maps(
        &self,
        attached: &Attached,
        triangles: &[Option<TriangleVertices>],
        timeline: Timeline,
        access: &mut Access,
        at: &str,
    ) -> Result<Maps, Stop> {
        let index_type = checked_index_type(attached.index_type).at("indexType")?;
        let micromap = self.attached_micromap(attached.micromap, timeline, access, at).at("micromap")?;
        let (size, count) = (u64::from(index_type.size()), triangles.len() as u64);
        let indices = attached.index_buffer.map(|address| {
            Items::new(&self.memory, (address, 0), (attached.index_stride, size), count).at("indexBuffer")
        });
        let indices = indices.transpose()?;
        let map = |(triangle, number): (&Option<TriangleVertices>, u32)| {
            if triangle.is_none() {
                return Ok(None);
            }
            let at = format_args!("indexBuffer[{number}]");
            let index = match (index_type, indices) {
                (IndexType::None, _) | (_, None) => number,
                (_, Some(indices)) => index_value(indices.get(number.into()).at(at)?),
            };
            if let Some(special) = index_buffer::special_index(index_type, index) {
                return Ok(Some(TriangleMap::SpecialIndex(special)));
            }
            let Some((_, count)) = micromap else {
                return Err(Reason::NoMicromap { index }).at(at);
            };
            let base_triangle = attached.base_triangle;
            let found = index.checked_add(base_triangle).filter(|&found| found < count);
            let beyond = Reason::NoMicromapTriangle { index, base_triangle, count };
            found.map(|found| Some(TriangleMap::Triangle(found))).ok_or(beyond).at(at)
        };
        let maps = triangles.iter().zip(0..).map(map).collect::<Result<_, Stop>>()?;
        Ok(Maps { micromap: micromap.map_or(0, |(address, _)| address), maps })
    }

    /// Address and number of triangles of a micromap, unless it is null.
    fn attached_micromap(
        &self,
        holder: Option<Holder>,
        timeline: Timeline,
        access: &mut Access,
        at: &str,
    ) -> Result<Option<(u64, u32)>, Stop> {
        let Some(holder) = holder else {
            return Ok(None);
        };
        let address = self.range(holder)?.address;
        match self.object(timeline, holder)? {
            Object::Micromap(micromap) => {
                access.read(self.memory.place(address, micromap.header().size)?, format!("{at}.micromap"));
                Ok(Some((address, micromap.triangle_count())))
            }
            other => {
                let (found, required) = (other.header().kind, ObjectKind::Micromap);
                Err(Reason::WrongKind { object: holder.name(), handle: holder.handle(), found, required }.into())
            }
        }
    }
}
