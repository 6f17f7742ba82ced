//! The intersection of a ray with a triangle, without gaps between neighbours.
//!
//! After Woop, Benthin and Wald, *Watertight Ray/Triangle Intersection* (JCGT 2013): space is sheared so that the
//! ray becomes the axis of a coordinate, and the ray hits if the origin of the plane lies inside the projected
//! triangle. Three things make it exact where it matters:
//! - a vertex is projected by a function of its position and the ray alone, so triangles that share a vertex see
//!   the same point;
//! - an edge function is the difference of two rounded products. Rounding is monotonic, so whenever the difference
//!   is not zero its sign is that of the real number; where it is zero the rounding errors of the products, which
//!   are exact, decide;
//! - a point exactly on an edge counts as moved by (ε, ε²). So of two triangles with a common edge that lie on both
//!   sides of it exactly one is hit, and likewise around a common vertex.

mod packet;

pub(crate) use packet::{Packet, PacketRay};

/// A ray in the space of a bottom-level structure, made ready for triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TriangleRay {
    origin: [f64; 3],
    /// How coordinates are permuted so that the last is the one along which the direction is longest.
    order: Order,
    /// What one unit along the last coordinate moves the others by.
    shear: [f64; 2],
    /// Length of the direction along the last coordinate, inverted.
    scale: f64,
}

/// A permutation of coordinates; the last is the main one. It mirrors space exactly if the direction's main
/// component is negative, so that the projected winding does not depend on that sign.
#[derive(Clone, Copy, Debug)]
enum Order {
    Yzx,
    Zyx,
    Zxy,
    Xzy,
    Xyz,
    Yxz,
}

impl Order {
    /// For each main axis: if the direction's main component is positive, and if it is not.
    const BY_MAIN_AXIS: [[Self; 2]; 3] = [[Self::Yzx, Self::Zyx], [Self::Zxy, Self::Xzy], [Self::Xyz, Self::Yxz]];

    /// The order for a direction, without a branch: instances are turned every way, so none would be foreseen.
    #[inline]
    fn of(direction: [f64; 3]) -> Self {
        let [x, y, z] = direction.map(f64::abs);
        let main = usize::from(!((x >= y) & (x >= z))) << usize::from(y < z);
        let not_positive = usize::from(direction[main] <= 0.0);
        Self::BY_MAIN_AXIS[main][not_positive]
    }

    /// The axes in their new order.
    const fn axes(self) -> [usize; 3] {
        match self {
            Self::Yzx => [1, 2, 0],
            Self::Zyx => [2, 1, 0],
            Self::Zxy => [2, 0, 1],
            Self::Xzy => [0, 2, 1],
            Self::Xyz => [0, 1, 2],
            Self::Yxz => [1, 0, 2],
        }
    }

    fn apply(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Yzx => [y, z, x],
            Self::Zyx => [z, y, x],
            Self::Zxy => [z, x, y],
            Self::Xzy => [x, z, y],
            Self::Xyz => [x, y, z],
            Self::Yxz => [y, x, z],
        }
    }
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TriangleHit {
    /// The ray's parameter.
    pub(crate) t: f32,
    /// Weights of vertices 1 and 2.
    pub(crate) barycentrics: [f32; 2],
    /// Whether the winding shows the front: counterclockwise as seen from the ray in a right-handed system.
    pub(crate) front: bool,
}

impl TriangleRay {
    /// The ray through `origin` along `direction`, which is not zero.
    pub(crate) fn new(origin: [f64; 3], direction: [f64; 3]) -> Self {
        let order = Order::of(direction);
        let [a, b, main] = order.apply(direction);
        Self { origin, order, shear: [a / main, b / main], scale: 1.0 / main }
    }

    /// The vertex as the ray sees it: two coordinates across the ray, and one along it.
    fn project(&self, vertex: [f32; 3]) -> [f64; 3] {
        let [x, y, z] = vertex.map(f64::from);
        let [ox, oy, oz] = self.origin;
        let [a, b, main] = self.order.apply([x - ox, y - oy, z - oz]);
        [a - self.shear[0] * main, b - self.shear[1] * main, main]
    }

    /// Where the ray meets the triangle, for any `t`; `None` if it does not or the triangle is seen edge-on or is
    /// degenerate.
    pub(crate) fn intersect(&self, vertices: &[[f32; 3]; 3]) -> Option<TriangleHit> {
        let [a, b, c] = vertices.map(|vertex| self.project(vertex));
        let mut weights = [edge(c, b), edge(a, c), edge(b, a)];
        let outside = |[u, v, w]: [f64; 3]| (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0);
        if outside(weights) {
            return None;
        }
        let front = if weights.contains(&0.0) {
            weights = [edge_exact(c, b), edge_exact(a, c), edge_exact(b, a)];
            let signs = [edge_sign(c, b, weights[0]), edge_sign(a, c, weights[1]), edge_sign(b, a, weights[2])];
            match signs {
                [1, 1, 1] => true,
                [-1, -1, -1] => false,
                _ => return None,
            }
        } else {
            weights[0] > 0.0
        };
        let [u, v, w] = weights;
        let area = u + v + w;
        let t = (u * a[2] + v * b[2] + w * c[2]) * self.scale / area;
        // Also refuses the NaN of a zero area and of values beyond the range of f64.
        let hit = area != 0.0 && t.is_finite();
        hit.then(|| TriangleHit { t: t as f32, barycentrics: [(v / area) as f32, (w / area) as f32], front })
    }
}

/// Twice the signed area of the plane's origin and the edge from `p` to `q`, rounded.
fn edge([px, py, _]: [f64; 3], [qx, qy, _]: [f64; 3]) -> f64 {
    px * qy - py * qx
}

/// The same where the rounded products are equal: then what rounding took from them is all that is left.
fn edge_exact([px, py, _]: [f64; 3], [qx, qy, _]: [f64; 3]) -> f64 {
    let ((left, left_error), (right, right_error)) = (product(px, qy), product(py, qx));
    if left == right { left_error - right_error } else { left - right }
}

/// The sign of an edge function, which is only zero if both ends are one point: an origin on the edge counts as
/// moved by (ε, ε²).
fn edge_sign([px, py, _]: [f64; 3], [qx, qy, _]: [f64; 3], value: f64) -> i8 {
    let sign = |positive: bool, negative: bool| i8::from(positive) - i8::from(negative);
    if value != 0.0 {
        sign(value > 0.0, value < 0.0)
    } else if py != qy {
        sign(py > qy, py < qy)
    } else {
        sign(qx > px, qx < px)
    }
}

/// A product and the error of its rounding, so that their sum is the real product (Dekker 1971).
fn product(a: f64, b: f64) -> (f64, f64) {
    // 2^27 + 1 splits 53 bits into two halves whose products are exact.
    let split = |x: f64| {
        let scaled = 134_217_729.0 * x;
        let high = scaled - (scaled - x);
        (high, x - high)
    };
    let ((a_high, a_low), (b_high, b_low)) = (split(a), split(b));
    let rounded = a * b;
    let error = ((a_high * b_high - rounded) + a_high * b_low + a_low * b_high) + a_low * b_low;
    (rounded, error)
}

#[cfg(test)]
mod tests;
