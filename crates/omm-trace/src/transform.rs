//! From the space of the scene to that of an instance.

/// Three rows of four: a linear part and a translation.
pub(crate) type Matrix = [[f64; 4]; 3];

/// The way from the scene into an instance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WorldToObject {
    /// The inverse of the linear part.
    linear: [[f64; 3]; 3],
    translation: [f64; 3],
}

impl WorldToObject {
    /// The inverse of `transform`, in `f64`.
    ///
    /// `None` if the matrix has an entry that is not finite, or is singular as far as `f64` can tell: its
    /// determinant is not larger than what rounding may have left of zero.
    pub(crate) fn new(transform: &Matrix) -> Option<Self> {
        let [[a, b, c, tx], [d, e, f, ty], [g, h, i, tz]] = *transform;
        if !transform.as_flattened().iter().all(|entry| entry.is_finite()) {
            return None;
        }
        let cofactors = [
            [e * i - f * h, c * h - b * i, b * f - c * e],
            [f * g - d * i, a * i - c * g, c * d - a * f],
            [d * h - e * g, b * g - a * h, a * e - b * d],
        ];
        let determinant = a * cofactors[0][0] + b * cofactors[1][0] + c * cofactors[2][0];
        let magnitude = (a * e * i).abs()
            + (a * f * h).abs()
            + (b * f * g).abs()
            + (b * d * i).abs()
            + (c * d * h).abs()
            + (c * e * g).abs();
        // Each of the six products is off by at most 2^-51 of itself once all is summed.
        if determinant.abs() <= magnitude * 2.0_f64.powi(-48) {
            return None;
        }
        let linear = cofactors.map(|row| row.map(|cofactor| cofactor / determinant));
        let finite = linear.as_flattened().iter().all(|entry| entry.is_finite());
        finite.then_some(Self { linear, translation: [tx, ty, tz] })
    }

    /// The inverse as a matrix.
    pub(crate) fn matrix(&self) -> Matrix {
        let translation = self.apply(self.translation.map(|x| -x));
        std::array::from_fn(|row| {
            let [a, b, c] = self.linear[row];
            [a, b, c, translation[row]]
        })
    }

    /// A point of the scene as the instance sees it.
    pub(crate) fn point(&self, point: [f32; 3]) -> [f64; 3] {
        let [x, y, z] = point.map(f64::from);
        let [tx, ty, tz] = self.translation;
        self.apply([x - tx, y - ty, z - tz])
    }

    /// A direction of the scene as the instance sees it.
    pub(crate) fn direction(&self, direction: [f32; 3]) -> [f64; 3] {
        self.apply(direction.map(f64::from))
    }

    fn apply(&self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        self.linear.map(|[a, b, c]| a * x + b * y + c * z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matrix(linear: [[f32; 3]; 3], [x, y, z]: [f32; 3]) -> Matrix {
        let [[a, b, c], [d, e, f], [g, h, i]] = linear;
        [[a, b, c, x], [d, e, f, y], [g, h, i, z]].map(|row| row.map(f64::from))
    }

    #[test]
    fn inverts() {
        let identity = matrix([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [0.0; 3]);
        let inverse = WorldToObject::new(&identity).unwrap();
        assert_eq!(inverse.point([1.0, -2.0, 3.5]), [1.0, -2.0, 3.5]);
        assert_eq!(inverse.matrix(), identity);

        // A quarter turn about z, doubled and mirrored in z, then moved.
        let turned =
            WorldToObject::new(&matrix([[0.0, -2.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0]], [10.0, 20.0, 30.0]))
                .unwrap();
        assert_eq!(turned.point([8.0, 22.0, 24.0]), [1.0, 1.0, 3.0]);
        assert_eq!(turned.direction([0.0, 2.0, 0.0]), [1.0, 0.0, 0.0]);
        assert_eq!(turned.matrix(), [[0.0, 0.5, 0.0, -10.0], [-0.5, 0.0, 0.0, 5.0], [0.0, 0.0, -0.5, 15.0]]);
    }

    #[test]
    fn refuses_what_has_no_inverse() {
        let one = [1.0, 0.0, 0.0];
        assert!(WorldToObject::new(&[[0.0; 4]; 3]).is_none());
        assert!(WorldToObject::new(&matrix([one, [0.0, 1.0, 0.0], [0.0; 3]], [0.0; 3])).is_none());
        let (p, q): ([f32; 3], [f32; 3]) = ([0.1, 0.7, -0.3], [1.3, -0.4, 0.9]);
        let twice = p.map(|x| 2.0 * x);
        assert!(WorldToObject::new(&matrix([p, twice, q], [0.0; 3])).is_none());
        assert!(WorldToObject::new(&matrix([[f32::NAN, 0.0, 0.0], q, p], [0.0; 3])).is_none());
        assert!(
            WorldToObject::new(&matrix([one, [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [f32::INFINITY, 0.0, 0.0])).is_none()
        );
    }

    #[test]
    fn tiny_and_huge_scales_are_inverted() {
        for scale in [f32::from_bits(1), 1e-30, 1e30, f32::MAX] {
            let linear = [[scale, 0.0, 0.0], [0.0, scale, 0.0], [0.0, 0.0, scale]];
            let found = WorldToObject::new(&matrix(linear, [0.0; 3])).unwrap().point([scale; 3]);
            assert!(found.iter().all(|x| (x - 1.0).abs() < 1e-15), "{found:?}");
        }
    }
}
