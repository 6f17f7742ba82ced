//! Traversal beside that of the crate that its hierarchy comes from, and with micromaps beside without.
//!
//! The scene is the garden of `omm_render`, the rays are those of a picture of it. Micromaps are compared with an any-hit shader that
//! reads the texture, both without what a picture costs beside its rays. What is compared with [`obvhs`] is one mesh of all its triangles
//! in world space, every triangle opaque: the other side is the crate's own binary tree with its own build, its own walk and its own
//! triangles, which neither knows instances nor promises that no ray slips through between triangles.

use std::hint::black_box;
use std::time::Duration;

use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::ray::{Ray as BareRay, RayHit};
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;
use omm_bake::{BakeOptions, LevelChoice};
use omm_device::Device;
use omm_device::app::App;
use omm_model::profile::DeviceProfile;
use omm_render::trace::tiles;
use omm_render::{
    Baked, Built, Mesh, Paint, Part, PictureOptions, Placement, RenderError, RenderScene, Tracer, garden,
};
use omm_trace::{Candidate, Counters, NoShaders, Ray, Scene, Shaders, TraceOptions};

/// The garden, built.
#[derive(Debug)]
pub struct Garden {
    /// Meshes and camera.
    pub scene: RenderScene,
    /// Rays against it with 4-state micromaps.
    pub with: Scene,
    /// Rays against it with micromaps disabled.
    pub without: Scene,
}

impl Garden {
    /// Bakes and builds the garden.
    ///
    /// # Errors
    /// None in practice.
    pub fn new() -> Result<Self, RenderError> {
        let scene = garden::garden()?;
        let options = BakeOptions { level: LevelChoice::Uniform(garden::LEVEL), ..BakeOptions::default() };
        let baked = Baked::new(&scene, &options, &|_, _| {})?;
        let (with, without) = build(&scene, &baked)?;
        Ok(Self { scene, with, without })
    }

    /// The rays of a picture.
    ///
    /// # Errors
    /// None in practice.
    pub fn rays(&self, size: [u32; 2]) -> Result<Vec<Aimed>, RenderError> {
        let tracer = Tracer::new(&self.with, &self.scene)?;
        aim(&tracer, &self.with, size, &mut |candidate: &Candidate| tracer.alpha_test(candidate))
    }

    /// Traces rays with the any-hit shader and answers with what happened.
    ///
    /// # Errors
    /// None in practice.
    pub fn trace(&self, scene: &Scene, rays: &[Aimed]) -> Result<Counters, RenderError> {
        let tracer = Tracer::new(scene, &self.scene)?;
        let mut counters = Counters::default();
        for (ray, options) in rays {
            black_box(scene.trace(ray, options, &mut |of: &Candidate| tracer.alpha_test(of), &mut counters));
        }
        Ok(counters)
    }

    /// Traces a picture and answers with what happened; the number of threads is that of rayon's current pool.
    ///
    /// # Errors
    /// None in practice.
    pub fn picture(&self, rays: &Scene, size: [u32; 2]) -> Result<Counters, RenderError> {
        let options = PictureOptions { size, samples: 1, seed: 0 };
        let picture = Tracer::new(rays, &self.scene)?.picture(&options, &|_, _| {})?;
        Ok(black_box(picture).counters)
    }

    /// All triangles in world space as one opaque mesh.
    #[must_use]
    pub fn flattened(&self) -> RenderScene {
        let mut part = Part {
            positions: Vec::new(),
            uvs: Vec::new(),
            triangles: Vec::new(),
            paint: Paint::Plain([255.0; 3]),
            cutout: None,
        };
        for placement in self.scene.placed() {
            let parts = self.scene.meshes.get(placement.mesh).map_or([].as_slice(), |mesh| &mesh.parts);
            for Part { positions, triangles, .. } in parts {
                let first = part.positions.len() as u32;
                let placed = positions.iter().map(|&position| placement.apply(position).map(|x| x as f32));
                part.positions.extend(placed);
                part.triangles.extend(triangles.iter().map(|corners| corners.map(|corner| first + corner)));
            }
        }
        RenderScene {
            meshes: vec![Mesh { parts: vec![part] }],
            placements: vec![Placement { mesh: 0, transform: Placement::IDENTITY }],
            ..self.scene.clone()
        }
    }
}

fn build(scene: &RenderScene, baked: &Baked) -> Result<(Scene, Scene), RenderError> {
    let mut device = Device::new(DeviceProfile::reference());
    let built = Built::new(&mut App::new(&mut device, &mut ()), scene, baked)?;
    Ok((Scene::load(&device, built.with.address)?, Scene::load(&device, built.without.address)?))
}

/// A ray, and how it is traced.
pub type Aimed = (Ray, TraceOptions);

/// The rays through the middles of pixels and those to the sun from where they end, in the order in which a picture has them.
fn aim<S: Shaders>(
    tracer: &Tracer<'_>,
    scene: &Scene,
    size: [u32; 2],
    shaders: &mut S,
) -> Result<Vec<Aimed>, RenderError> {
    let (mut rays, mut counters) = (Vec::new(), Counters::default());
    for tile in tiles(size) {
        let mut to_sun = Vec::new();
        for pixel in tile.pixels() {
            let (ray, options) = tracer.camera_ray(pixel.map(|at| f64::from(at) + 0.5), size)?;
            rays.push((ray, options));
            if let Some(hit) = scene.trace(&ray, &options, shaders, &mut counters) {
                to_sun.push(tracer.sun_ray(&ray, &hit)?);
            }
        }
        rays.append(&mut to_sun);
    }
    Ok(rays)
}

/// The same opaque triangles and the same rays for both.
pub struct Opaque {
    scene: Scene,
    rays: Vec<Ray>,
    bare: Bvh2,
    /// In the order of the tree.
    bare_triangles: Vec<RtTriangle>,
    bare_rays: Vec<BareRay>,
}

impl Opaque {
    /// The flattened garden and the rays of a picture of it, all traced to the closest hit.
    ///
    /// # Errors
    /// None in practice.
    pub fn new(garden: &Garden, size: [u32; 2]) -> Result<Self, RenderError> {
        let flat = garden.flattened();
        let parts: Vec<_> = flat.meshes.iter().flat_map(|mesh| &mesh.parts).collect();
        let corner = |part: &Part, corner: u32| part.positions.get(corner as usize).copied().unwrap_or_default();
        let triangles: Vec<Triangle> = parts
            .iter()
            .flat_map(|part| part.triangles.iter().map(|corners| corners.map(|at| corner(part, at))))
            .map(|[v0, v1, v2]| Triangle { v0: v0.into(), v1: v1.into(), v2: v2.into() })
            .collect();
        let mut build_time = Duration::ZERO;
        let bare = build_bvh2_from_tris(&triangles, BvhBuildParams::medium_build(), &mut build_time);
        let item = |&item: &u32| triangles.get(item as usize).map(RtTriangle::from);
        let bare_triangles = bare.primitive_indices.iter().filter_map(item).collect();
        let baked = Baked::new(&flat, &BakeOptions::default(), &|_, _| {})?;
        let (scene, _) = build(&flat, &baked)?;
        let aimed = aim(&Tracer::new(&scene, &flat)?, &scene, size, &mut NoShaders)?;
        let rays: Vec<_> = aimed.into_iter().map(|(ray, _)| ray).collect();
        let bare_ray = |ray: &Ray| BareRay::new_inf(ray.origin().into(), glam::Vec3A::from(ray.direction()));
        let bare_rays = rays.iter().map(bare_ray).collect();
        Ok(Self { scene, rays, bare, bare_triangles, bare_rays })
    }

    /// How many rays there are.
    #[must_use]
    pub const fn rays(&self) -> usize {
        self.rays.len()
    }

    /// Traces all rays with `omm_trace` and answers with the number of hits.
    #[must_use]
    pub fn ours(&self) -> usize {
        let (options, mut counters) = (TraceOptions::default(), Counters::default());
        let hits =
            self.rays.iter().filter(|ray| self.scene.trace(ray, &options, &mut NoShaders, &mut counters).is_some());
        black_box(hits.count())
    }

    /// Traces all rays with the crate's own walk and answers with the number of hits.
    #[must_use]
    pub fn bare(&self) -> usize {
        let hits = self.bare_rays.iter().filter(|&&ray| {
            let mut hit = RayHit::none();
            self.bare.ray_traverse(ray, &mut hit, |ray, slot| {
                self.bare_triangles.get(slot).map_or(f32::INFINITY, |triangle| triangle.intersect(ray))
            });
            hit.t < f32::INFINITY
        });
        black_box(hits.count())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_see_the_same() {
        let garden = Garden::new().unwrap();
        let opaque = Opaque::new(&garden, [48, 27]).unwrap();
        let (ours, bare) = (opaque.ours(), opaque.bare());
        assert!(opaque.rays() > 48 * 27 * 3 / 2 && ours > 48 * 27);
        // Theirs may slip through between triangles.
        assert!(ours.abs_diff(bare) * 1000 <= ours, "{ours} {bare}");
        let rays = garden.rays([48, 27]).unwrap();
        let [with, without] = [&garden.with, &garden.without].map(|scene| garden.trace(scene, &rays).unwrap());
        assert_eq!((with.rays, with.hits), (without.rays, without.hits));
        assert!(5 * with.any_hit_calls < without.any_hit_calls);
        assert_eq!(garden.picture(&garden.with, [48, 27]).unwrap(), with);
    }
}
