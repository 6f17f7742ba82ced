//! A pinhole camera.

use crate::vector::{cross, normalised, sub};

/// A pinhole camera: rays through the pixels of a picture of any size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    eye: [f64; 3],
    forward: [f64; 3],
    right: [f64; 3],
    up: [f64; 3],
    /// Height of the picture at distance 1.
    height: f64,
}

/// Why there is no such camera.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum CameraError {
    /// A coordinate is NaN or infinite.
    #[error("the camera's position or direction is not finite")]
    NotFinite,
    /// The direction of view is zero.
    #[error("the camera looks at the point where it is")]
    NoDirection,
    /// No such picture can be looked at.
    #[error("a picture of height {height} at distance 1 cannot be looked at")]
    Height {
        /// The height.
        height: f64,
    },
}

impl Camera {
    /// A camera at `eye` that looks along `forward`, its picture `height` high at distance 1: twice the tangent of half the
    /// vertical field of view.
    ///
    /// `up` says which direction is up in the picture; where it is along `forward`, another axis serves.
    ///
    /// # Errors
    /// A number that is not finite, a direction of zero, or a height that is not positive.
    pub fn new(eye: [f64; 3], forward: [f64; 3], up: [f64; 3], height: f64) -> Result<Self, CameraError> {
        if !(height > 0.0 && height.is_finite()) {
            return Err(CameraError::Height { height });
        }
        if ![eye, forward, up].as_flattened().iter().all(|number| number.is_finite()) {
            return Err(CameraError::NotFinite);
        }
        let forward = normalised(forward).ok_or(CameraError::NoDirection)?;
        let sideways = [up, [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let right = sideways.into_iter().find_map(|up| normalised(cross(forward, up)));
        let right = right.ok_or(CameraError::NoDirection)?;
        Ok(Self { eye, forward, right, up: cross(right, forward), height })
    }

    /// A camera at `eye` that looks at `target`; *y* is up.
    ///
    /// # Errors
    /// As [`Camera::new`].
    pub fn look_at(eye: [f64; 3], target: [f64; 3], height: f64) -> Result<Self, CameraError> {
        Self::new(eye, sub(target, eye), [0.0, 1.0, 0.0], height)
    }

    /// A camera that sees all of a box from above and aside.
    ///
    /// # Errors
    /// As [`Camera::new`].
    pub fn around([low, high]: [[f64; 3]; 2], height: f64) -> Result<Self, CameraError> {
        let middle = [0, 1, 2].map(|axis| low[axis] / 2.0 + high[axis] / 2.0);
        let radius = sub(high, middle).iter().map(|x| x * x).sum::<f64>().sqrt();
        // The sphere around the box touches the upper and lower edge: its radius is the sine of half the field of view.
        let distance = if radius > 0.0 { radius * (1.0 + 4.0 / (height * height)).sqrt() } else { 1.0 };
        let from = [0.48, 0.36, 0.8];
        Self::look_at([0, 1, 2].map(|axis| middle[axis] + distance * from[axis]), middle, height)
    }

    /// Where rays start.
    #[must_use]
    pub fn eye(&self) -> [f32; 3] {
        self.eye.map(|coordinate| coordinate as f32)
    }

    /// The direction through a point of a picture of `width` by `height` pixels, of length 1. The point counts pixels from the upper
    /// left corner; the middle of the first pixel is at (0.5, 0.5).
    #[must_use]
    pub fn direction(&self, [column, row]: [f64; 2], [width, height]: [u32; 2]) -> [f32; 3] {
        let unit = self.height / f64::from(height);
        let x = (column - f64::from(width) / 2.0) * unit;
        let y = (f64::from(height) / 2.0 - row) * unit;
        let through = [0, 1, 2].map(|axis| self.forward[axis] + x * self.right[axis] + y * self.up[axis]);
        normalised(through).unwrap_or(self.forward).map(|coordinate| coordinate as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_the_picture_is_what_is_looked_at() {
        let camera = Camera::look_at([1.0, 2.0, 3.0], [1.0, 2.0, -3.0], 2.0).unwrap();
        assert_eq!(camera.eye(), [1.0, 2.0, 3.0]);
        assert_eq!(camera.direction([8.0, 4.0], [16, 8]), [0.0, 0.0, -1.0]);
        // The upper edge is as high as far; right is +x when looking along -z.
        let [x, y, z] = camera.direction([8.0, 0.0], [16, 8]);
        assert!(x.abs() < 1e-7 && (y + z).abs() < 1e-6 && y > 0.7);
        assert!(camera.direction([16.0, 4.0], [16, 8])[0] > 0.8);
    }

    #[test]
    fn looking_straight_up_has_a_picture_too() {
        let camera = Camera::look_at([0.0; 3], [0.0, 5.0, 0.0], 1.0).unwrap();
        assert_eq!(camera.direction([1.0, 1.0], [2, 2]), [0.0, 1.0, 0.0]);
    }

    #[test]
    fn a_box_is_seen_whole() {
        let [low, high] = [[-3.0, 0.0, 10.0], [5.0, 2.0, 11.0]];
        let camera = Camera::around([low, high], 0.7).unwrap();
        for corner in 0..8_u32 {
            let point = [0, 1, 2].map(|axis| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] });
            let to = sub(point, camera.eye);
            let dot = |axis: [f64; 3]| (0..3).map(|k| axis[k] * to[k]).sum::<f64>();
            let half = camera.height / 2.0 * dot(camera.forward);
            assert!(half > 0.0 && dot(camera.right).abs() <= half && dot(camera.up).abs() <= half, "{point:?}");
        }
    }

    #[test]
    fn impossible_cameras_are_refused() {
        let at = |eye, target, height| Camera::look_at(eye, target, height).unwrap_err();
        assert_eq!(at([1.0; 3], [1.0; 3], 1.0), CameraError::NoDirection);
        assert_eq!(at([f64::NAN; 3], [1.0; 3], 1.0), CameraError::NotFinite);
        for height in [0.0, -1.0, f64::INFINITY] {
            assert_eq!(at([0.0; 3], [1.0; 3], height), CameraError::Height { height });
        }
        assert!(Camera::around([[0.0; 3]; 2], 0.7).is_ok());
    }
}
