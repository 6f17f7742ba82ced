//! Who looks, and where the sun is.

use clap::Args;
use omm_render::{Camera, RenderError, RenderScene};

/// Arguments about the camera and the light.
#[derive(Debug, Args)]
pub(super) struct View {
    /// The camera of the file, by name or by number; the first that a node places if none is given.
    #[arg(long, value_name = "NAME", requires = "scene", conflicts_with = "eye")]
    camera: Option<String>,
    /// Where to look from, instead of through a camera of the file.
    #[arg(long, value_name = "X,Y,Z", value_parser = point, requires = "target", allow_hyphen_values = true)]
    eye: Option<[f64; 3]>,
    /// What to look at.
    #[arg(long, value_name = "X,Y,Z", value_parser = point, requires = "eye", allow_hyphen_values = true)]
    target: Option<[f64; 3]>,
    /// The vertical field of view in degrees.
    #[arg(long, value_name = "DEGREES", value_parser = angle, default_value_t = 45.0, requires = "eye")]
    fov: f64,
    /// Towards the sun.
    #[arg(long, value_name = "X,Y,Z", value_parser = point, allow_hyphen_values = true)]
    sun: Option<[f64; 3]>,
}

/// Three finite numbers as an argument.
fn point(text: &str) -> Result<[f64; 3], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(str::parse).collect();
    let numbers = numbers.map_err(|error: std::num::ParseFloatError| error.to_string())?;
    let point = <[f64; 3]>::try_from(numbers).map_err(|numbers| format!("{} numbers, not 3", numbers.len()))?;
    // Rays have f32 coordinates.
    if point.iter().all(|x| (*x as f32).is_finite()) { Ok(point) } else { Err("a number is not finite".into()) }
}

/// A field of view as an argument.
fn angle(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(angle) if angle > 0.0 && angle < 180.0 => Ok(angle),
        _ => Err("not an angle between 0 and 180 degrees".into()),
    }
}

impl View {
    /// The camera of the file that is wanted.
    pub(super) fn camera_name(&self) -> Option<&str> {
        self.camera.as_deref()
    }

    /// Puts camera and sun where they are wanted.
    pub(super) fn apply(&self, scene: &mut RenderScene) -> Result<(), RenderError> {
        if let (Some(eye), Some(target)) = (self.eye, self.target) {
            scene.camera = Camera::look_at(eye, target, 2.0 * (self.fov.to_radians() / 2.0).tan())?;
        }
        if let Some(sun) = self.sun {
            scene.sun = sun.map(|x| x as f32);
        }
        Ok(())
    }
}
