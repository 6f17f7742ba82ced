//! Three numbers.

pub(crate) fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

pub(crate) fn cross([ax, ay, az]: [f64; 3], [bx, by, bz]: [f64; 3]) -> [f64; 3] {
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The vector with length 1; `None` for zero and for what has no length.
pub(crate) fn normalised(vector: [f64; 3]) -> Option<[f64; 3]> {
    let largest = vector.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    // Scaled first, so that squares stay within the numbers.
    let scaled = vector.map(|x| x / largest);
    let length = dot(scaled, scaled).sqrt();
    (largest > 0.0 && length.is_finite()).then(|| scaled.map(|x| x / length))
}
