//! How an instance lies in the scene, as shaders read it.

use crate::placement::moved;
use crate::ray::Ray;
use crate::scene::{Scene, Triangle};
use crate::transform::WorldToObject;

/// What a shader reads about the space of the instance that it is called for.
///
/// Matrices are computed in `f64` and rounded to `f32` once. They are three rows of four, the last column being the
/// translation; SPIR-V holds them as four columns of three.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectSpace {
    /// From the instance to the scene, at the time of the ray: `ObjectToWorldKHR`.
    pub object_to_world: [[f32; 4]; 3],
    /// From the scene to the instance: `WorldToObjectKHR`.
    pub world_to_object: [[f32; 4]; 3],
    /// The ray's origin in the instance: `ObjectRayOriginKHR`.
    pub origin: [f32; 3],
    /// The ray's direction in the instance: `ObjectRayDirectionKHR`. Not normalised; `t` is the same in both spaces.
    pub direction: [f32; 3],
}

impl Scene {
    /// How an instance lies at the time of a ray; `None` if no ray can reach it then.
    #[must_use]
    pub fn object_space(&self, instance_id: u32, ray: &Ray) -> Option<ObjectSpace> {
        let slot = *self.slots.get(instance_id as usize)?;
        let placement = self.placements.get(slot as usize)?;
        let object_to_world = placement.at(ray.time());
        let world_to_object = WorldToObject::new(&object_to_world)?;
        let narrow = |point: [f64; 3]| point.map(|x| x as f32);
        Some(ObjectSpace {
            object_to_world: object_to_world.map(|row| row.map(|x| x as f32)),
            world_to_object: world_to_object.matrix().map(|row| row.map(|x| x as f32)),
            origin: narrow(world_to_object.point(ray.origin())),
            direction: narrow(world_to_object.direction(ray.direction())),
        })
    }

    /// The vertices of a triangle in the space of its instance, at a time in `0.0..=1.0`: `HitTriangleVertexPositionsKHR`.
    /// `None` if no ray can reach such a triangle.
    #[must_use]
    pub fn triangle_vertices(
        &self,
        instance_id: u32,
        geometry_index: u32,
        primitive_id: u32,
        time: f32,
    ) -> Option<[[f32; 3]; 3]> {
        let instance = self.instances.get(*self.slots.get(instance_id as usize)? as usize)?;
        let blas = self.blases.get(instance.blas as usize)?;
        let is_it = |it: &Triangle| (it.geometry, it.primitive) == (geometry_index, primitive_id);
        let slot = blas.triangles.iter().position(is_it)?;
        let start = blas.triangles.get(slot)?.vertices;
        Some(blas.ends.get(slot).map_or(start, |end| moved(&start, end, time)))
    }
}
