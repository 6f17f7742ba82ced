//! Built bottom-level acceleration structures: geometry records and primitives.

use omm_model::special_index::TriangleMap;
use omm_model::vk;

use super::header::{ObjectForm, ObjectHeader, ObjectKind};
use crate::aabb;
use crate::bytes::push_f32s;
use crate::error::{WriteError, fits};

mod record;
mod view;

use record::{Binding, GeometryRecord, Layout};
pub use view::{BlasObject, GeometryView, StoredAabb, StoredTriangle};

/// The three vertices of a triangle, transformed, in the order of the index buffer.
pub type TriangleVertices = [[f32; 3]; 3];

/// What a bottom-level acceleration structure holds, as a build collects it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BlasContents {
    /// The flags of the build.
    pub flags: u32,
    /// The geometries in order.
    pub geometries: Vec<BlasGeometry>,
}

/// One geometry.
#[derive(Clone, Debug, PartialEq)]
pub struct BlasGeometry {
    /// The flags of the geometry.
    pub flags: vk::GeometryFlags,
    /// Its primitives.
    pub primitives: BlasPrimitives,
}

/// The primitives of a geometry in order; an inactive one is `None`, so that the others keep their index.
#[derive(Clone, Debug, PartialEq)]
pub enum BlasPrimitives {
    /// Triangles without a micromap.
    Triangles(Vec<Option<TriangleVertices>>),
    /// Triangles with a micromap, which is null if every entry is a special index.
    MicromapTriangles {
        /// Device address of the micromap; 0 for a null one.
        micromap: u64,
        /// The triangles.
        triangles: Vec<Option<MappedTriangle>>,
    },
    /// Triangles that move, without a micromap.
    MovingTriangles(Vec<Option<MovingVertices>>),
    /// Triangles that move, with a micromap as above.
    MovingMicromapTriangles {
        /// Device address of the micromap; 0 for a null one.
        micromap: u64,
        /// The triangles.
        triangles: Vec<Option<MovingMappedTriangle>>,
    },
    /// Axis-aligned boxes.
    Aabbs(Vec<Option<vk::AabbPositions>>),
}

/// A triangle of a geometry with a micromap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MappedTriangle {
    /// The vertices.
    pub vertices: TriangleVertices,
    /// Its entry of the micromap index buffer, base triangle added; the index is at most `i32::MAX`.
    pub map: TriangleMap,
}

/// The vertices of a triangle at the times 0 and 1.
pub type MovingVertices = [TriangleVertices; 2];

/// A triangle that moves, of a geometry with a micromap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingMappedTriangle {
    /// The vertices.
    pub vertices: MovingVertices,
    /// As in [`MappedTriangle`].
    pub map: TriangleMap,
}

/// What a geometry consists of, after [`vk::GeometryType`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GeometryKind {
    /// Triangles, with or without a micromap.
    Triangles,
    /// Axis-aligned boxes.
    Aabbs,
}

/// What the size of a geometry depends on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BlasGeometrySize {
    /// Triangles.
    Triangles {
        /// Number of triangles, inactive ones included.
        count: u32,
        /// Whether a micromap, null or not, is attached.
        micromap: bool,
        /// Whether the vertices move.
        motion: bool,
    },
    /// Axis-aligned boxes.
    Aabbs {
        /// Number of boxes, inactive ones included.
        count: u32,
    },
}

/// Bytes of a built bottom-level acceleration structure with these geometries; `None` if it would not fit into 64 bits.
#[must_use]
pub fn blas_size(geometries: impl IntoIterator<Item = BlasGeometrySize>) -> Option<u64> {
    geometries.into_iter().try_fold(ObjectHeader::SIZE, |size, geometry| {
        let (layout, count) = match geometry {
            BlasGeometrySize::Triangles { count, micromap, motion } => (Layout::of_triangles(micromap, motion), count),
            BlasGeometrySize::Aabbs { count } => (Layout::Aabbs, count),
        };
        // Every geometry with a micromap has room for a reference, needed or not.
        let reference = if layout.is_mapped() { 8 } else { 0 };
        size.checked_add(reference + GeometryRecord::SIZE as u64 + layout.stride() * u64::from(count))
    })
}

impl BlasGeometry {
    /// What the size of this geometry depends on.
    ///
    /// # Errors
    /// More than `u32::MAX` primitives.
    fn size(&self) -> Result<BlasGeometrySize, WriteError> {
        let (count, _) = self.primitives.counts();
        fits("primitives", count, u32::MAX.into())?;
        let count = count as u32;
        let triangles = |micromap, motion| BlasGeometrySize::Triangles { count, micromap, motion };
        Ok(match self.primitives {
            BlasPrimitives::Triangles(_) => triangles(false, false),
            BlasPrimitives::MicromapTriangles { .. } => triangles(true, false),
            BlasPrimitives::MovingTriangles(_) => triangles(false, true),
            BlasPrimitives::MovingMicromapTriangles { .. } => triangles(true, true),
            BlasPrimitives::Aabbs(_) => BlasGeometrySize::Aabbs { count },
        })
    }
}

impl BlasContents {
    /// The built form, [`blas_size`] bytes.
    ///
    /// # Errors
    /// More geometries or primitives than 32 bits count, or a micromap triangle index above `i32::MAX`.
    pub fn encode(&self) -> Result<Vec<u8>, WriteError> {
        let Self { flags, geometries } = self;
        fits("geometries", geometries.len() as u64, u32::MAX.into())?;
        let (mut references, mut records, mut data) = (Vec::new(), Vec::new(), Vec::new());
        let (mut sizes, mut primitive_count, mut inactive_size) = (Vec::with_capacity(geometries.len()), 0, 0);
        for (index, geometry) in geometries.iter().enumerate() {
            let within = |error: WriteError| error.within(format_args!("geometries[{index}]"));
            sizes.push(geometry.size().map_err(within)?);
            let offset = data.len() as u64;
            let (layout, binding) = match &geometry.primitives {
                BlasPrimitives::Triangles(triangles) => {
                    push_triangles(&mut data, triangles);
                    (Layout::Triangles, Binding::None)
                }
                BlasPrimitives::MicromapTriangles { micromap, triangles } => {
                    push_mapped(&mut data, triangles).map_err(within)?;
                    (Layout::MappedTriangles, Binding::add(&mut references, *micromap))
                }
                BlasPrimitives::MovingTriangles(triangles) => {
                    push_moving(&mut data, triangles);
                    (Layout::MovingTriangles, Binding::None)
                }
                BlasPrimitives::MovingMicromapTriangles { micromap, triangles } => {
                    push_moving_mapped(&mut data, triangles).map_err(within)?;
                    (Layout::MovingMappedTriangles, Binding::add(&mut references, *micromap))
                }
                BlasPrimitives::Aabbs(aabbs) => {
                    push_aabbs(&mut data, aabbs);
                    (Layout::Aabbs, Binding::None)
                }
            };
            let (count, active) = geometry.primitives.counts();
            primitive_count += count;
            inactive_size += (count - active) * layout.stride();
            // `size` has proved that the count fits.
            let count = count as u32;
            let record = GeometryRecord { layout, flags: geometry.flags, count, stored: count, binding, offset };
            records.extend_from_slice(&record.to_bytes());
        }
        let used = ObjectHeader::SIZE + 8 * references.len() as u64 + (records.len() + data.len()) as u64;
        let size = blas_size(sizes).unwrap_or(used);
        let header = ObjectHeader {
            kind: ObjectKind::BottomLevel,
            form: ObjectForm::Built,
            size,
            compacted_size: used - inactive_size,
            flags: *flags,
            // At most the number of geometries.
            reference_count: references.len() as u32,
            primitive_count,
            geometry_count: geometries.len() as u32,
        };
        let references: Vec<u8> = references.into_iter().flat_map(u64::to_le_bytes).collect();
        let mut bytes = [header.to_bytes().as_slice(), &references, &records, &data].concat();
        // The padding, at most 8 bytes for each geometry.
        bytes.resize(bytes.len() + (size - used) as usize, 0);
        Ok(bytes)
    }
}

impl BlasPrimitives {
    /// The number of primitives and of active ones among them.
    fn counts(&self) -> (u64, u64) {
        fn counts<T>(primitives: &[Option<T>]) -> (u64, u64) {
            (primitives.len() as u64, primitives.iter().flatten().count() as u64)
        }
        match self {
            Self::Triangles(triangles) => counts(triangles),
            Self::MicromapTriangles { triangles, .. } => counts(triangles),
            Self::MovingTriangles(triangles) => counts(triangles),
            Self::MovingMicromapTriangles { triangles, .. } => counts(triangles),
            Self::Aabbs(aabbs) => counts(aabbs),
        }
    }
}

/// Appends a record that starts with the primitive's index, or one that says that the primitive is inactive.
fn push_primitive<T>(
    out: &mut Vec<u8>,
    layout: Layout,
    index: usize,
    primitive: &Option<T>,
    push: impl FnOnce(&mut Vec<u8>, &T),
) {
    let end = out.len() + layout.stride() as usize;
    match primitive {
        Some(primitive) => {
            out.extend_from_slice(&(index as u32).to_le_bytes());
            push(out, primitive);
        }
        None => out.extend_from_slice(&record::INACTIVE.to_le_bytes()),
    }
    out.resize(end, 0);
}

fn push_triangles(out: &mut Vec<u8>, triangles: &[Option<TriangleVertices>]) {
    for (index, triangle) in triangles.iter().enumerate() {
        push_primitive(out, Layout::Triangles, index, triangle, |out, vertices| {
            push_f32s(out, vertices.as_flattened().iter().copied());
        });
    }
}

fn push_moving(out: &mut Vec<u8>, triangles: &[Option<MovingVertices>]) {
    for (index, triangle) in triangles.iter().enumerate() {
        push_primitive(out, Layout::MovingTriangles, index, triangle, |out, vertices| {
            push_f32s(out, vertices.as_flattened().as_flattened().iter().copied());
        });
    }
}

/// The number that stands for what a triangle has of a micromap.
fn map_value(index: usize, map: Option<TriangleMap>) -> Result<i32, WriteError> {
    match map {
        None => Ok(0),
        Some(TriangleMap::SpecialIndex(special)) => Ok(special.value()),
        Some(TriangleMap::Triangle(found)) => {
            let within = |error: WriteError| error.within(format_args!("triangles[{index}]"));
            fits("map", found.into(), i32::MAX as u64).map_err(within)?;
            Ok(found as i32)
        }
    }
}

fn push_mapped(out: &mut Vec<u8>, triangles: &[Option<MappedTriangle>]) -> Result<(), WriteError> {
    for (index, triangle) in triangles.iter().enumerate() {
        let map = map_value(index, triangle.map(|triangle| triangle.map))?;
        push_primitive(out, Layout::MappedTriangles, index, triangle, |out, triangle| {
            push_f32s(out, triangle.vertices.as_flattened().iter().copied());
            out.extend_from_slice(&map.to_le_bytes());
        });
    }
    Ok(())
}

fn push_moving_mapped(out: &mut Vec<u8>, triangles: &[Option<MovingMappedTriangle>]) -> Result<(), WriteError> {
    for (index, triangle) in triangles.iter().enumerate() {
        let map = map_value(index, triangle.map(|triangle| triangle.map))?;
        push_primitive(out, Layout::MovingMappedTriangles, index, triangle, |out, triangle| {
            let [start, end] = triangle.vertices;
            push_f32s(out, start.as_flattened().iter().copied());
            out.extend_from_slice(&map.to_le_bytes());
            push_f32s(out, end.as_flattened().iter().copied());
        });
    }
    Ok(())
}

fn push_aabbs(out: &mut Vec<u8>, aabbs: &[Option<vk::AabbPositions>]) {
    for (index, positions) in aabbs.iter().enumerate() {
        push_primitive(out, Layout::Aabbs, index, positions, |out, positions| {
            out.extend_from_slice(&aabb::encode(positions));
        });
    }
}
