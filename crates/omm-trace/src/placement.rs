//! Where an instance lies at a time, and a box around all places that it can be in.

use omm_model::vk::{MotionInstanceData, SrtData};

use crate::bvh::Bounds;
use crate::transform::{Matrix, WorldToObject};

/// Instances whose transform may grow rounding errors more than this are not put into a box: every ray visits them.
const MAX_CONDITION: f64 = (1 << 20) as f64;
/// How much the box of an instance is grown, in parts of the largest numbers that went into it.
const MARGIN: f64 = 1.0 / (1 << 24) as f64;

/// The transformation of an instance over time.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Placement {
    Static(Matrix),
    /// At the times 0 and 1; each element is interpolated linearly.
    Matrix([Matrix; 2]),
    /// At the times 0 and 1; each component is interpolated linearly.
    Srt([SrtData; 2]),
}

impl From<&MotionInstanceData> for Placement {
    fn from(data: &MotionInstanceData) -> Self {
        let wide = |matrix: [[f32; 4]; 3]| matrix.map(|row| row.map(f64::from));
        match data {
            MotionInstanceData::StaticInstance(found) => Self::Static(wide(found.transform.matrix)),
            MotionInstanceData::MatrixMotionInstance(found) => {
                Self::Matrix([wide(found.transform_t0.matrix), wide(found.transform_t1.matrix)])
            }
            MotionInstanceData::SrtMotionInstance(found) => Self::Srt([found.transform_t0, found.transform_t1]),
        }
    }
}

impl Placement {
    /// Whether the transformation is another one at another time.
    pub(crate) const fn moves(&self) -> bool {
        !matches!(self, Self::Static(_))
    }

    /// The transformation at a time in `0.0..=1.0`, in `f64`.
    pub(crate) fn at(&self, time: f32) -> Matrix {
        match self {
            Self::Static(matrix) => *matrix,
            Self::Matrix([start, end]) => {
                std::array::from_fn(|row| std::array::from_fn(|at| lerp(start[row][at], end[row][at], time)))
            }
            Self::Srt([start, end]) => Srt::between(start, end, time).matrix(),
        }
    }

    /// A box around all places that the instance takes a box to, with room for rounding on the way there and back if it
    /// [is well conditioned](Self::is_well_conditioned). `None` if it is not finite.
    pub(crate) fn bounds(&self, of: &Bounds) -> Option<Bounds> {
        match self {
            Self::Static(matrix) => affine_bounds(matrix, of),
            // Every point moves along a line, so it stays between its ends.
            Self::Matrix([start, end]) => Some(affine_bounds(start, of)?.union(affine_bounds(end, of)?)),
            Self::Srt([start, end]) => {
                let [start, end] = [start, end].map(|data| Srt::between(data, data, 0.0));
                turning_bounds([&start, &end], of)
            }
        }
    }

    /// Whether what the transform does to rounding errors can be bounded at all times: it grows them by less than a
    /// millionfold, and the linear part does not change too much between the times.
    pub(crate) fn is_well_conditioned(&self) -> bool {
        match self {
            Self::Static(matrix) => well_conditioned(matrix, matrix, 1.0),
            Self::Matrix([start, end]) => well_conditioned(start, end, 1.0),
            Self::Srt([start, end]) => {
                let [start, end] = [start, end].map(|data| Srt::between(data, data, 0.0));
                // A rotation changes no length; it grows the sums that norms are by a factor of 3 at most, each way.
                well_conditioned(&start.scale, &end.scale, 9.0)
            }
        }
    }
}

/// A number between two others; one of them, or both, exactly where that is due.
fn lerp(start: f64, end: f64, time: f32) -> f64 {
    let time = f64::from(time);
    start * (1.0 - time) + end * time
}

/// The vertices of a triangle at a time. Each is a function of where it starts and ends alone, so neighbours agree on it; rounded to
/// `f32` it does not leave the box around both.
pub(crate) fn moved(start: &[[f32; 3]; 3], end: &[[f32; 3]; 3], time: f32) -> [[f32; 3]; 3] {
    let between = |start: f32, end: f32| lerp(start.into(), end.into(), time) as f32;
    std::array::from_fn(|vertex| std::array::from_fn(|axis| between(start[vertex][axis], end[vertex][axis])))
}

/// An SRT transformation taken apart: what is applied is scale, then rotation, then translation.
#[derive(Clone, Copy, Debug)]
struct Srt {
    /// Scale, shear and pivot.
    scale: Matrix,
    /// x, y, z, w; not normalised.
    quaternion: [f64; 4],
    translation: [f64; 3],
}

impl Srt {
    fn between(start: &SrtData, end: &SrtData, time: f32) -> Self {
        let part = |part: fn(&SrtData) -> f32| lerp(part(start).into(), part(end).into(), time);
        Self {
            scale: [
                [part(|it| it.sx), part(|it| it.a), part(|it| it.b), part(|it| it.pvx)],
                [0.0, part(|it| it.sy), part(|it| it.c), part(|it| it.pvy)],
                [0.0, 0.0, part(|it| it.sz), part(|it| it.pvz)],
            ],
            quaternion: [part(|it| it.qx), part(|it| it.qy), part(|it| it.qz), part(|it| it.qw)],
            translation: [part(|it| it.tx), part(|it| it.ty), part(|it| it.tz)],
        }
    }

    /// Translation · rotation · scale. The quaternion is normalised first, because only those of length 1 are rotations
    /// and interpolation leaves them; one of length 0 turns nothing into anything, and gives NaN.
    fn matrix(&self) -> Matrix {
        let [x, y, z, w] = self.quaternion;
        let length = x * x + y * y + z * z + w * w;
        let twice = |a: f64, b: f64| 2.0 * (a * b) / length;
        let rotation = [
            [1.0 - twice(y, y) - twice(z, z), twice(x, y) - twice(w, z), twice(x, z) + twice(w, y)],
            [twice(x, y) + twice(w, z), 1.0 - twice(x, x) - twice(z, z), twice(y, z) - twice(w, x)],
            [twice(x, z) - twice(w, y), twice(y, z) + twice(w, x), 1.0 - twice(x, x) - twice(y, y)],
        ];
        std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                let [a, b, c] = rotation[row];
                let [[p, ..], [q, ..], [r, ..]] = self.scale.map(|scale| [scale[column], 0.0]);
                let sum = a * p + b * q + c * r;
                if column == 3 { sum + self.translation[row] } else { sum }
            })
        })
    }
}

/// A box around what a transformation makes of a box.
fn affine_bounds(matrix: &Matrix, of: &Bounds) -> Option<Bounds> {
    let (mut low, mut high, mut largest) = ([0.0; 3], [0.0; 3], 0.0_f64);
    for (axis, &[a, b, c, offset]) in matrix.iter().enumerate() {
        let (mut least, mut most, mut sum) = (offset, offset, 0.0);
        for (factor, (low, high)) in [a, b, c].into_iter().zip(of.low.into_iter().zip(of.high)) {
            least += (factor * low).min(factor * high);
            most += (factor * low).max(factor * high);
            sum += factor.abs();
        }
        (low[axis], high[axis]) = (least, most);
        largest = largest.max(sum * of.largest() + offset.abs());
    }
    let margin = largest * MARGIN;
    Bounds::around([low.map(|x| x - margin), high.map(|x| x + margin)])
}

/// A box around all that a turning instance makes of a box: what is scaled lies in a ball about the pivot, which no
/// rotation leaves, and the ball's centre moves along a line.
fn turning_bounds(ends: [&Srt; 2], of: &Bounds) -> Option<Bounds> {
    let [start, end] = ends;
    let scaled = affine_bounds(&start.scale, of)?.union(affine_bounds(&end.scale, of)?);
    let radius = [0, 1, 2].map(|axis| scaled.low[axis].abs().max(scaled.high[axis].abs()));
    let radius = (radius[0] * radius[0] + radius[1] * radius[1] + radius[2] * radius[2]).sqrt();
    let largest = ends.iter().flat_map(|end| end.translation).fold(radius, |largest, x| largest.max(x.abs()));
    let room = radius + largest * MARGIN;
    let corner = |sign: f64| {
        let at = |axis: usize| {
            let (a, b) = (start.translation[axis], end.translation[axis]);
            if sign < 0.0 { a.min(b) - room } else { a.max(b) + room }
        };
        [0, 1, 2].map(at)
    };
    // `min` and `max` hide NaN.
    let finite = start.translation.iter().chain(&end.translation).all(|x| x.is_finite());
    Bounds::around([corner(-1.0), corner(1.0)]).filter(|_| finite)
}

/// Whether no matrix on the way from one to the other grows rounding errors too much, `factor` times what it does.
///
/// With E = start⁻¹ (end - start) and a norm of E of at most 1/2, all of them have inverses, whose norms are at most
/// twice that of start⁻¹; and no norm is larger than that of both ends.
fn well_conditioned(start: &Matrix, end: &Matrix, factor: f64) -> bool {
    let Some(inverse) = WorldToObject::new(start) else { return false };
    let largest = norm(start).max(norm(end));
    let change: Matrix = std::array::from_fn(|row| std::array::from_fn(|at| end[row][at] - start[row][at]));
    let still = change.iter().all(|row| row[..3] == [0.0; 3]);
    let growth = if still { 1.0 } else { 2.0 };
    let applied = inverse.matrix().map(|row| {
        let column = |at: usize| (0..3).map(|k| row[k] * change[k][at]).sum::<f64>();
        [column(0), column(1), column(2), 0.0]
    });
    norm(&applied) <= 0.5 && factor * growth * largest * norm(&inverse.matrix()) <= MAX_CONDITION
}

/// The largest sum of a row of the linear part, without signs.
fn norm(matrix: &Matrix) -> f64 {
    matrix.iter().map(|row| row.iter().take(3).map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max)
}
