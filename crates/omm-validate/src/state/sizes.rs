//! The sizes that the device named for builds of acceleration structures.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use omm_model::call::Timeline;
use omm_model::vk;
use vk::AccelerationStructureBuildType as BuildType;

use super::State;

/// An answer, and what it answers.
#[derive(Clone, Debug)]
struct Asked {
    build_type: BuildType,
    info: vk::BuildGeometryInfo,
    counts: Vec<u32>,
    sizes: vk::BuildSizesInfo,
}

/// The answers, by what sizes depend on but for counts.
#[derive(Clone, Debug, Default)]
pub(super) struct StructureSizes(BTreeMap<u64, Vec<Asked>>);

/// A number for all that the sizes depend on but for counts, made without allocating.
fn key(info: &vk::BuildGeometryInfo) -> u64 {
    let mut hasher = DefaultHasher::new();
    (info.ty, info.flags).hash(&mut hasher);
    info.geometries_iter().for_each(|geometry| (geometry.geometry_type, geometry.flags).hash(&mut hasher));
    hasher.finish()
}

/// Whether the sizes of `asked` are large enough for a build of `info`, counts aside.
fn covers(asked: &vk::BuildGeometryInfo, info: &vk::BuildGeometryInfo) -> bool {
    asked.ty == info.ty
        && asked.flags == info.flags
        && asked.geometries_iter().count() == info.geometries_iter().count()
        && asked.geometries_iter().zip(info.geometries_iter()).all(|(asked, geometry)| covers_geometry(asked, geometry))
}

fn covers_geometry(asked: &vk::Geometry, geometry: &vk::Geometry) -> bool {
    let data = match (&asked.geometry, &geometry.geometry) {
        (vk::GeometryData::Triangles(asked), vk::GeometryData::Triangles(triangles)) => {
            asked.vertex_format == triangles.vertex_format
                && asked.index_type == triangles.index_type
                && asked.max_vertex >= triangles.max_vertex
                && asked.transform_data.is_null() == triangles.transform_data.is_null()
                && asked.opacity_micromap().is_some() == triangles.opacity_micromap().is_some()
                && asked.opacity_micromap_ext().is_some() == triangles.opacity_micromap_ext().is_some()
        }
        (vk::GeometryData::Instances(asked), vk::GeometryData::Instances(instances)) => {
            asked.array_of_pointers == instances.array_of_pointers
        }
        (vk::GeometryData::Aabbs(_), vk::GeometryData::Aabbs(_)) | (vk::GeometryData::None, vk::GeometryData::None) => {
            true
        }
        _ => false,
    };
    let usages = match (asked.micromap_data(), geometry.micromap_data()) {
        (Some(asked), Some(data)) => asked.usages().eq(data.usages()),
        (None, None) => true,
        _ => false,
    };
    asked.geometry_type == geometry.geometry_type && asked.flags == geometry.flags && data && usages
}

impl State {
    /// The sizes that the device named for such a build on that timeline, with as many primitives at least; `count` tells those of
    /// each geometry.
    pub(crate) fn build_sizes(
        &self,
        info: &vk::BuildGeometryInfo,
        count: impl Fn(usize) -> Option<u32>,
        timeline: Timeline,
    ) -> Option<&vk::BuildSizesInfo> {
        let one = match timeline {
            Timeline::Host => BuildType::HOST,
            Timeline::Device => BuildType::DEVICE,
        };
        let fits = |asked: &&Asked| {
            let enough =
                asked.counts.iter().enumerate().all(|(index, asked)| count(index).is_none_or(|it| it <= *asked));
            (asked.build_type == one || asked.build_type == BuildType::HOST_OR_DEVICE)
                && enough
                && covers(&asked.info, info)
        };
        // The smallest will do.
        let asked = self.structure_sizes.0.get(&key(info))?.iter().filter(fits);
        asked.map(|asked| &asked.sizes).min_by_key(|sizes| sizes.acceleration_structure_size)
    }

    pub(super) fn learn_structure_sizes(
        &mut self,
        build_type: BuildType,
        info: &vk::BuildGeometryInfo,
        counts: &[u32],
        sizes: &vk::BuildSizesInfo,
    ) {
        let all = Arc::make_mut(&mut self.structure_sizes).0.entry(key(info)).or_default();
        let is_known =
            |asked: &Asked| asked.build_type == build_type && asked.counts == counts && covers(&asked.info, info);
        if !all.iter().any(is_known) {
            all.push(Asked { build_type, info: info.clone(), counts: counts.to_vec(), sizes: sizes.clone() });
        }
    }
}
