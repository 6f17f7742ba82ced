//! Four triangles at once in `f32`, to find those that the ray misses for certain.
//!
//! With R the largest distance between the ray's origin and a vertex on any axis and u = 2<sup>-24</sup>: a difference
//! of coordinates is off by less than 2.1 uR, since the origin was rounded too; a projected coordinate, which is at
//! most 2 R, by less than 8.5 uR, since shears are at most 1; and an edge function by less than 84 uR². So one beyond
//! 128 uR² has the sign that the exact test finds, and a triangle with two such of different signs is missed there too.

use glam::Vec4;

use super::Order;

/// The vertices of up to four triangles: by axis, then by vertex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Packet {
    vertices: [[Vec4; 3]; 3],
}

/// A [`TriangleRay`](super::TriangleRay), rounded.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PacketRay {
    /// How coordinates are permuted.
    axes: [usize; 3],
    /// Permuted.
    origin: [Vec4; 3],
    shear: [Vec4; 2],
    /// No edge function is further off than this.
    room: Vec4,
}

impl Packet {
    /// The first four of some triangles.
    pub(crate) fn new<'a>(triangles: impl IntoIterator<Item = &'a [[f32; 3]; 3]>) -> Self {
        let mut vertices = [[[0.0; 4]; 3]; 3];
        for (lane, triangle) in triangles.into_iter().enumerate().take(4) {
            for (vertex, position) in triangle.iter().enumerate() {
                for (axis, coordinate) in position.iter().enumerate() {
                    vertices[axis][vertex][lane] = *coordinate;
                }
            }
        }
        Self { vertices: vertices.map(|axis| axis.map(Vec4::from_array)) }
    }
}

impl PacketRay {
    /// The ray through `origin` along `direction`, which is not zero, for packets without a coordinate larger than
    /// `largest`.
    #[inline]
    pub(crate) fn new(origin: [f64; 3], direction: [f64; 3], largest: f64) -> Self {
        let distance = origin.into_iter().fold(0.0, |distance: f64, x| distance.max(x.abs()));
        // Where a product of coordinates could overflow this does; what underflows is less than the last term.
        let eight = 8.0 * (distance + largest) as f32;
        let room = eight * eight * (1.0 / (1_u32 << 23) as f32) + f32::MIN_POSITIVE;
        let axes = Order::of(direction).axes();
        let [a, b, main] = axes.map(|axis| direction[axis]);
        let scale = 1.0 / main;
        Self {
            axes,
            origin: axes.map(|axis| Vec4::splat(origin[axis] as f32)),
            shear: [a, b].map(|x| Vec4::splat((x * scale) as f32)),
            room: Vec4::splat(room),
        }
    }

    /// A bit for each triangle that [`TriangleRay::intersect`](super::TriangleRay::intersect) may find a hit with.
    #[inline]
    pub(crate) fn may_meet(&self, packet: &Packet) -> u32 {
        let [a, b, main] = self.axes.map(|axis| &packet.vertices[axis]);
        let [p, q, r] = [0, 1, 2].map(|vertex| {
            let along = main[vertex] - self.origin[2];
            let across =
                |axis: usize, values: &[Vec4; 3]| values[vertex] - self.origin[axis] - self.shear[axis] * along;
            [across(0, a), across(1, b)]
        });
        let edge = |[px, py]: [Vec4; 2], [qx, qy]: [Vec4; 2]| px * qy - py * qx;
        let (u, v, w) = (edge(r, q), edge(p, r), edge(q, p));
        // A NaN is passed over by `min` and `max`, or makes the comparison fail.
        let missed = u.min(v).min(w).cmplt(-self.room) & u.max(v).max(w).cmpgt(self.room);
        (!missed).bitmask()
    }
}
