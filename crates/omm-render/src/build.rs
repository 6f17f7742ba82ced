//! From a scene to what rays are traced against: bake every cutout, build micromaps, meshes and two scenes on a device.

use omm_bake::{BakeInput, BakeOptions, BakeOutput, bake, estimate};
use omm_device::app::{App, MicromapBinding, MicromapInput, Structure, TriangleInput};
use omm_layout::index::IndexType;
use omm_model::special_index::TriangleMap;
use omm_model::vk;

use crate::error::RenderError;
use crate::scene::{Mesh, Part, RenderScene};

/// What was baked of each mesh and part; `None` where nothing is cut out.
#[derive(Clone, Debug)]
pub struct Baked {
    /// By mesh, then by part.
    pub parts: Vec<Vec<Option<BakeOutput>>>,
}

impl Baked {
    /// Bakes every part that has a cutout, with `options`, of which sampler and cutoff are those of the cutout.
    ///
    /// `progress` is told how many microtriangles are done and how many there are in all, from any thread.
    ///
    /// # Errors
    /// A part that the baker refuses.
    pub fn new(
        scene: &RenderScene,
        options: &BakeOptions,
        progress: &(dyn Fn(u64, u64) + Sync),
    ) -> Result<Self, RenderError> {
        let mut total = 0_u64;
        for (mesh, part, (input, own)) in scene.bakes(options) {
            let estimate = estimate(&input, &own).map_err(|source| RenderError::Bake { mesh, part, source })?;
            total = total.saturating_add(estimate.microtriangles);
        }
        let mut parts: Vec<Vec<_>> = scene.meshes.iter().map(|mesh| vec![None; mesh.parts.len()]).collect();
        let mut before = 0;
        for (mesh, part, (input, own)) in scene.bakes(options) {
            let step = |at: omm_bake::Progress| progress(before + at.done, total);
            let output = bake(&input, &own, &step).map_err(|source| RenderError::Bake { mesh, part, source })?;
            before += estimate(&input, &own).map_or(0, |estimate| estimate.microtriangles);
            if let Some(slot) = parts.get_mut(mesh).and_then(|parts| parts.get_mut(part)) {
                *slot = Some(output);
            }
        }
        Ok(Self { parts })
    }

    /// What was baked, in order.
    pub fn outputs(&self) -> impl Iterator<Item = &BakeOutput> {
        self.parts.iter().flatten().flatten()
    }

    /// Microtriangles in all arrays.
    #[must_use]
    pub fn microtriangles(&self) -> u64 {
        self.outputs().map(|output| output.statistics.array_states.total()).sum()
    }

    /// Bytes of all arrays.
    #[must_use]
    pub fn array_bytes(&self) -> u64 {
        self.outputs().map(|output| output.statistics.array_bytes).sum()
    }

    /// The part of the area of all triangles with a cutout, each counted as much as any other, that needs no shader; 0 if there is
    /// none.
    #[must_use]
    pub fn known_fraction(&self) -> f64 {
        let triangles: usize = self.outputs().map(|output| output.indices.len()).sum();
        let weight = |output: &BakeOutput| output.indices.len() as f64 / triangles as f64;
        self.outputs().map(|output| weight(output) * output.statistics.known_fraction).sum()
    }
}

impl RenderScene {
    /// Everything to bake, by mesh and part, and how.
    pub fn bakes<'a>(
        &'a self,
        options: &'a BakeOptions,
    ) -> impl Iterator<Item = (usize, usize, (BakeInput<'a>, BakeOptions))> {
        let parts = |mesh: &'a Mesh| mesh.parts.iter().enumerate();
        let parts = self.meshes.iter().enumerate().flat_map(move |(at, mesh)| parts(mesh).map(move |part| (at, part)));
        parts.filter_map(move |(mesh, (at, part))| {
            let cutout = part.cutout?;
            let texture = self.alphas.get(cutout.alpha)?;
            let options = BakeOptions { sampler: cutout.sampler, alpha_cutoff: cutout.alpha_cutoff, ..options.clone() };
            Some((mesh, at, (BakeInput { texture, uvs: &part.uvs, triangles: &part.triangles }, options)))
        })
    }
}

/// What lies on a device.
#[derive(Clone, Debug)]
pub struct Built {
    /// Micromaps, compacted, and the bytes that each had before.
    pub micromaps: Vec<(Structure, u64)>,
    /// A bottom-level structure for each mesh that has triangles.
    pub meshes: Vec<Option<Structure>>,
    /// The scene.
    pub with: Structure,
    /// The scene with all micromaps disabled by instance flags.
    pub without: Structure,
}

impl Built {
    /// Builds the scene with the micromaps of `baked`.
    ///
    /// The instance of a placement has the mesh's number as its custom index, a geometry is a part. Only parts with a cutout are not
    /// opaque.
    ///
    /// # Errors
    /// The device stopped or has no room, or there are more meshes than a custom index can count.
    pub fn new(app: &mut App<'_>, scene: &RenderScene, baked: &Baked) -> Result<Self, RenderError> {
        if scene.meshes.len() > 1 << 24 {
            return Err(RenderError::Meshes { found: scene.meshes.len() });
        }
        let compactable = vk::BuildAccelerationStructureFlags::ALLOW_COMPACTION;
        let (mut micromaps, mut meshes) = (Vec::new(), Vec::new());
        for (mesh, outputs) in scene.meshes.iter().zip(&baked.parts) {
            meshes.push(if mesh.triangles() > 0 {
                Some(build_mesh(app, mesh, outputs, &mut micromaps)?)
            } else {
                None
            });
        }
        let mut placed = |flags| {
            let instances: Vec<_> = instances(scene, &meshes, flags).collect();
            app.build_instances(&instances, compactable)
        };
        let with = placed(vk::GeometryInstanceFlags::empty())?;
        let without = placed(vk::GeometryInstanceFlags::DISABLE_OPACITY_MICROMAPS)?;
        Ok(Self { micromaps, meshes, with, without })
    }

    /// All structures that the scene needs, each after those to which it refers.
    pub fn in_order(&self) -> impl Iterator<Item = &Structure> {
        let micromaps = self.micromaps.iter().map(|(micromap, _)| micromap);
        micromaps.chain(self.meshes.iter().flatten()).chain([&self.with])
    }
}

/// Builds the micromaps of a mesh and the mesh.
fn build_mesh(
    app: &mut App<'_>,
    mesh: &Mesh,
    outputs: &[Option<BakeOutput>],
    micromaps: &mut Vec<(Structure, u64)>,
) -> Result<Structure, RenderError> {
    let mut attached = Vec::new();
    for output in outputs {
        attached.push(match output {
            Some(output) => {
                Some(Attached { maps: output.triangle_maps().collect(), micromap: build_micromap(app, output)? })
            }
            None => None,
        });
    }
    let parts = mesh.parts.iter().zip(&attached);
    let geometries: Vec<_> = parts.map(|(part, attached)| geometry(part, attached.as_ref())).collect();
    let built =
        app.build_triangles(&geometries, vk::BuildAccelerationStructureFlags::ALLOW_DISABLE_OPACITY_MICROMAPS)?;
    micromaps.extend(attached.into_iter().flatten().filter_map(|attached| attached.micromap));
    Ok(built)
}

/// What a part's triangles have, and the micromap with the bytes that it had before it was compacted.
struct Attached {
    maps: Vec<TriangleMap>,
    micromap: Option<(Structure, u64)>,
}

fn geometry<'a>(part: &'a Part, attached: Option<&'a Attached>) -> TriangleInput<'a> {
    let flags = if part.cutout.is_some() { vk::GeometryFlags::empty() } else { vk::GeometryFlags::OPAQUE };
    let micromap = attached.map(|Attached { maps, micromap }| MicromapBinding {
        micromap: micromap.as_ref().map(|(micromap, _)| micromap),
        maps,
        index_type: index_type(maps),
    });
    TriangleInput { positions: &part.positions, indices: part.triangles.as_flattened(), flags, micromap }
}

/// Builds a micromap and compacts it; answers with it and the bytes that it had before. `None` if special indices say all.
fn build_micromap(app: &mut App<'_>, output: &BakeOutput) -> Result<Option<(Structure, u64)>, RenderError> {
    if output.triangles.is_empty() {
        return Ok(None);
    }
    let flags = vk::BuildAccelerationStructureFlags::ALLOW_COMPACTION;
    let micromap = app.build_micromap(&MicromapInput { data: &output.array, triangles: &output.triangles, flags })?;
    let compacted = app.copy(&micromap, vk::CopyAccelerationStructureMode::COMPACT)?;
    app.destroy_structure(micromap)?;
    Ok(Some((compacted, micromap.size)))
}

/// The smaller type that holds all indices, special ones included.
fn index_type(maps: &[TriangleMap]) -> IndexType {
    let largest = maps.iter().map(|map| if let TriangleMap::Triangle(index) = map { *index } else { 0 }).max();
    // The special indices are the last four of each type.
    if largest.unwrap_or(0) < 0xfffc { IndexType::Uint16 } else { IndexType::Uint32 }
}

fn instances(
    scene: &RenderScene,
    meshes: &[Option<Structure>],
    flags: vk::GeometryInstanceFlags,
) -> impl Iterator<Item = vk::Instance> {
    scene.placed().filter_map(move |placement| {
        let structure = meshes.get(placement.mesh)?.as_ref()?;
        Some(vk::Instance {
            transform: vk::TransformMatrix { matrix: placement.transform },
            instance_custom_index: placement.mesh as u32,
            mask: 0xff,
            flags,
            acceleration_structure_reference: structure.address.0,
            ..Default::default()
        })
    })
}
