//! Rays and what a trace instruction says about them.

use crate::flags::RayFlags;
use crate::hit::Hit;

/// A ray in the space of the top-level acceleration structure: the points `origin + t * direction`.
///
/// Made by [`Ray::new`] only, so that traversal never meets a NaN. The direction need not be of unit length; `t`
/// counts in lengths of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    origin: [f32; 3],
    direction: [f32; 3],
    t_min: f32,
    t_max: f32,
    time: f32,
}

/// Operands that make no ray.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RayError {
    /// A component of the origin is NaN or infinite.
    #[error("origin[{axis}]: found {found}, required a finite number")]
    Origin {
        /// 0 for x, 1 for y, 2 for z.
        axis: usize,
        /// The component found.
        found: f32,
    },
    /// A component of the direction is NaN or infinite.
    #[error("direction[{axis}]: found {found}, required a finite number")]
    Direction {
        /// 0 for x, 1 for y, 2 for z.
        axis: usize,
        /// The component found.
        found: f32,
    },
    /// All components of the direction are zero.
    #[error("direction: found zero in every component, required one that is not")]
    ZeroDirection,
    /// `t_min` is NaN or negative.
    #[error("t_min: found {found}, required at least 0")]
    TMin {
        /// The value found.
        found: f32,
    },
    /// `t_max` is NaN or less than `t_min`.
    #[error("t_max: found {found}, required at least t_min, {t_min}")]
    TMax {
        /// The value found.
        found: f32,
        /// The `t_min` it was given with.
        t_min: f32,
    },
    /// The time is NaN or not in `0.0..=1.0`.
    #[error("time: found {found}, required 0 to 1")]
    Time {
        /// The value found.
        found: f32,
    },
}

impl Ray {
    /// A ray, if origin and direction are finite, the direction is not zero, and `0 <= t_min <= t_max`. `t_max` may
    /// be infinite.
    ///
    /// # Errors
    /// The first operand that is not so.
    pub fn new(origin: [f32; 3], direction: [f32; 3], t_min: f32, t_max: f32) -> Result<Self, RayError> {
        let not_finite = |point: [f32; 3]| point.into_iter().enumerate().find(|(_, component)| !component.is_finite());
        if let Some((axis, found)) = not_finite(origin) {
            return Err(RayError::Origin { axis, found });
        }
        if let Some((axis, found)) = not_finite(direction) {
            return Err(RayError::Direction { axis, found });
        }
        if direction == [0.0; 3] {
            return Err(RayError::ZeroDirection);
        }
        if t_min.is_nan() || t_min < 0.0 {
            return Err(RayError::TMin { found: t_min });
        }
        if t_max.is_nan() || t_max < t_min {
            return Err(RayError::TMax { found: t_max, t_min });
        }
        Ok(Self { origin, direction, t_min, t_max, time: 0.0 })
    }

    /// The ray from `origin` in `direction` with `t` from 0 to infinity.
    ///
    /// # Errors
    /// As [`Ray::new`].
    pub fn unbounded(origin: [f32; 3], direction: [f32; 3]) -> Result<Self, RayError> {
        Self::new(origin, direction, 0.0, f32::INFINITY)
    }

    /// The same ray at another time than 0, from when the shutter opens to 1, when it closes: the `Time` operand of
    /// `OpTraceRayMotionNV`. It matters where a scene has motion.
    ///
    /// # Errors
    /// [`RayError::Time`] if the time is not in `0.0..=1.0`.
    pub fn at_time(self, time: f32) -> Result<Self, RayError> {
        if (0.0..=1.0).contains(&time) { Ok(Self { time, ..self }) } else { Err(RayError::Time { found: time }) }
    }

    /// Where the ray starts: `WorldRayOriginKHR`.
    #[must_use]
    pub const fn origin(&self) -> [f32; 3] {
        self.origin
    }

    /// Where it goes: `WorldRayDirectionKHR`. Not normalised.
    #[must_use]
    pub const fn direction(&self) -> [f32; 3] {
        self.direction
    }

    /// The smallest `t` of interest: `RayTminKHR`.
    #[must_use]
    pub const fn t_min(&self) -> f32 {
        self.t_min
    }

    /// The largest `t` of interest before anything was hit.
    #[must_use]
    pub const fn t_max(&self) -> f32 {
        self.t_max
    }

    /// When the ray is traced: `CurrentRayTimeNV`.
    #[must_use]
    pub const fn time(&self) -> f32 {
        self.time
    }

    /// The point at `t`, in `f32`.
    #[must_use]
    pub fn at(&self, t: f32) -> [f32; 3] {
        let [ox, oy, oz] = self.origin;
        let [dx, dy, dz] = self.direction;
        [ox + t * dx, oy + t * dy, oz + t * dz]
    }
}

/// The other operands of a trace instruction, and what the pipeline or shader around it says about micromaps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TraceOptions {
    /// The ray flags: `IncomingRayFlagsKHR`.
    pub flags: RayFlags,
    /// The cull mask: `CullMaskKHR`. Only its low 8 bits count; an instance is visible to the ray if its mask has one
    /// of them in common.
    pub cull_mask: u32,
    /// What the ray adds to the index of every hit group. Only its low 4 bits count.
    pub sbt_offset: u32,
    /// How many hit groups further that of the next geometry is. Only its low 4 bits count.
    pub sbt_stride: u32,
    /// Which miss shader is meant. Only its low 16 bits count.
    pub miss_index: u32,
    /// Whether micromaps count: for a pipeline, whether it was created with
    /// `VK_PIPELINE_CREATE_RAY_TRACING_OPACITY_MICROMAP_BIT_KHR`; for a ray query, see
    /// [`micromaps_in_ray_queries`](crate::query::micromaps_in_ray_queries). Where they do not, the geometry's flag
    /// decides.
    pub micromaps: bool,
}

impl Default for TraceOptions {
    /// No flags, all mask bits, the first shaders, and micromaps count.
    fn default() -> Self {
        Self { flags: RayFlags::empty(), cull_mask: 0xff, sbt_offset: 0, sbt_stride: 0, miss_index: 0, micromaps: true }
    }
}

impl TraceOptions {
    /// The index of a candidate's hit group, counted from the start of the hit shader binding table: the record offset
    /// of the instance, the geometry's index times the stride, and the offset of the ray.
    ///
    /// It has 64 bits, since geometries are counted with 32.
    #[must_use]
    pub const fn hit_group(&self, geometry_index: u32, sbt_record_offset: u32) -> u64 {
        let [stride, offset] = [self.sbt_stride & 0xf, self.sbt_offset & 0xf];
        sbt_record_offset as u64 + geometry_index as u64 * stride as u64 + offset as u64
    }

    /// The shader that a pipeline runs when the search is over: the closest-hit shader of the hit's group, unless
    /// [`RayFlags::SKIP_CLOSEST_HIT_SHADER`] is set, or the miss shader.
    #[must_use]
    pub fn last_shader(&self, hit: Option<&Hit>) -> Option<LastShader> {
        match hit {
            None => Some(LastShader::Miss { index: self.miss_index & 0xffff }),
            Some(_) if self.flags.contains(RayFlags::SKIP_CLOSEST_HIT_SHADER) => None,
            Some(hit) => {
                Some(LastShader::ClosestHit { hit_group: self.hit_group(hit.geometry_index, hit.sbt_record_offset) })
            }
        }
    }
}

/// The shader that runs when the search is over. Whoever traces calls it; rays that it traces in turn are traced in the
/// same way, as deep as the caller allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LastShader {
    /// The closest-hit shader of a hit group.
    ClosestHit {
        /// See [`TraceOptions::hit_group`].
        hit_group: u64,
    },
    /// A miss shader.
    Miss {
        /// Its index in the miss shader binding table, 16 bits.
        index: u32,
    },
}

impl From<RayFlags> for TraceOptions {
    /// These flags, all mask bits.
    fn from(flags: RayFlags) -> Self {
        Self { flags, ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_rays_are_made() {
        let (o, d) = ([1.0, 2.0, 3.0], [0.0, 0.0, -2.0]);
        let ray = Ray::new(o, d, 0.5, 4.0).unwrap();
        assert_eq!((ray.origin(), ray.direction(), ray.t_min(), ray.t_max()), (o, d, 0.5, 4.0));
        assert_eq!(ray.at(2.0), [1.0, 2.0, -1.0]);
        assert!(Ray::new(o, d, f32::INFINITY, f32::INFINITY).is_ok());
        assert!(Ray::new(o, [0.0, f32::MIN_POSITIVE / 2.0, 0.0], 1.0, 1.0).is_ok());

        assert!(matches!(Ray::new([1.0, f32::NAN, 0.0], d, 0.0, 1.0), Err(RayError::Origin { axis: 1, .. })));
        let error = RayError::Direction { axis: 2, found: f32::INFINITY };
        assert_eq!(Ray::unbounded(o, [0.0, 1.0, f32::INFINITY]), Err(error));
        assert_eq!(error.to_string(), "direction[2]: found inf, required a finite number");
        assert_eq!(Ray::unbounded(o, [0.0, -0.0, 0.0]), Err(RayError::ZeroDirection));
        assert_eq!(Ray::new(o, d, -1.0, 1.0), Err(RayError::TMin { found: -1.0 }));
        assert!(matches!(Ray::new(o, d, f32::NAN, 1.0), Err(RayError::TMin { .. })));
        assert_eq!(Ray::new(o, d, 2.0, 1.0), Err(RayError::TMax { found: 1.0, t_min: 2.0 }));
        assert!(matches!(Ray::new(o, d, 2.0, f32::NAN), Err(RayError::TMax { .. })));

        assert_eq!((ray.time(), ray.at_time(1.0).unwrap().time()), (0.0, 1.0));
        assert_eq!(ray.at_time(-0.5), Err(RayError::Time { found: -0.5 }));
        assert!(matches!(ray.at_time(f32::NAN), Err(RayError::Time { .. })));
    }

    #[test]
    fn only_the_low_bits_of_table_operands_count() {
        let options = TraceOptions { sbt_offset: 0x13, sbt_stride: 0xf2, miss_index: 0x7_0005, ..Default::default() };
        assert_eq!(options.hit_group(5, 1000), 1000 + 5 * 2 + 3);
        assert_eq!(TraceOptions { sbt_stride: 15, ..options }.hit_group(u32::MAX, 0xff_ffff), 64_441_286_643);
        assert_eq!(options.last_shader(None), Some(LastShader::Miss { index: 5 }));
    }
}
