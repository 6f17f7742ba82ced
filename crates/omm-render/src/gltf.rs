//! Scenes from glTF files.

use std::path::Path;

use omm_bake::gltf::{GltfCamera, GltfScene, ScenePrimitive, read_scene};

use crate::camera::Camera;
use crate::error::RenderError;
use crate::scene::{Cutout, Mesh, Paint, Part, Placement, RenderScene};

/// The height of the picture at distance 1 for a scene without a camera: about 45 degrees.
const HEIGHT: f64 = 0.828;

/// Reads the scene that the glTF file at `path` shows.
///
/// `camera` is the name or the number of one of its cameras. Without, the first that a node places serves; a file that has none is
/// looked at whole, from above and aside. The sun stands high, behind the left shoulder of somebody who looks along -z.
///
/// # Errors
/// A file that cannot be read, or a camera that it does not have.
pub fn read(path: &Path, camera: Option<&str>) -> Result<RenderScene, RenderError> {
    let GltfScene { textures, images, meshes, placements, cameras } = read_scene(path)?;
    let meshes = meshes.into_iter().map(|parts| Mesh { parts: parts.into_iter().map(part).collect() }).collect();
    let placements = placements
        .into_iter()
        .map(|placement| Placement {
            mesh: placement.mesh,
            transform: placement.transform.map(|row| row.map(|x| x as f32)),
        })
        .collect();
    let camera = pick(&cameras, camera)?;
    let mut scene = RenderScene {
        alphas: textures,
        colours: images,
        meshes,
        placements,
        camera: Camera::around([[0.0; 3]; 2], HEIGHT)?,
        sun: [-0.4, 0.8, 0.45],
    };
    scene.camera = match camera {
        Some(camera) => placed(camera)?,
        None => Camera::around(bounds(&scene), HEIGHT)?,
    };
    Ok(scene)
}

fn pick<'a>(cameras: &'a [GltfCamera], wanted: Option<&str>) -> Result<Option<&'a GltfCamera>, RenderError> {
    let Some(wanted) = wanted else { return Ok(cameras.first()) };
    let named = cameras.iter().find(|camera| camera.name.as_deref() == Some(wanted));
    let number = || cameras.iter().find(|camera| wanted.parse() == Ok(camera.number));
    let known = || cameras.iter().map(|camera| camera.name.clone().unwrap_or_else(|| camera.number.to_string()));
    named.or_else(number).map(Some).ok_or_else(|| RenderError::NoCamera {
        wanted: wanted.to_owned(),
        known: known().collect::<Vec<_>>().join(", "),
    })
}

/// A camera where its node places it.
fn placed(camera: &GltfCamera) -> Result<Camera, RenderError> {
    let column = |at: usize| camera.transform.map(|row| row[at]);
    let height = 2.0 * (camera.yfov / 2.0).tan();
    Ok(Camera::new(column(3), column(2).map(|x| -x), column(1), height)?)
}

/// The lowest and highest coordinates of all vertices, placed.
fn bounds(scene: &RenderScene) -> [[f64; 3]; 2] {
    let mut bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    for placement in scene.placed() {
        let parts = scene.meshes.get(placement.mesh).map_or([].as_slice(), |mesh| &mesh.parts);
        for &position in parts.iter().flat_map(|part| &part.positions) {
            let at = placement.apply(position);
            let [low, high] = &mut bounds;
            for axis in 0..3 {
                low[axis] = low[axis].min(at[axis]);
                high[axis] = high[axis].max(at[axis]);
            }
        }
    }
    bounds
}

fn part(primitive: ScenePrimitive) -> Part {
    let ScenePrimitive { positions, uvs, triangles, base_color_factor: [red, green, blue, _], base_color, mask } =
        primitive;
    let factor = [red, green, blue].map(encoded);
    let paint = match base_color {
        Some((colour, sampler)) => Paint::Image { colour, sampler, factor },
        None => Paint::Plain(factor.map(|channel| 255.0 * channel)),
    };
    let cutout =
        mask.map(|mask| Cutout { alpha: mask.texture, sampler: mask.sampler, alpha_cutoff: mask.alpha_cutoff });
    Part { positions, uvs, triangles, paint, cutout }
}

/// A linear factor as one of sRGB values, close enough for looking.
fn encoded(factor: f32) -> f32 {
    factor.clamp(0.0, 1.0).powf(1.0 / 2.2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_are_found_by_name_and_number() {
        let identity = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 4.0]];
        let camera = |number, name: Option<&str>| GltfCamera {
            number,
            name: name.map(str::to_owned),
            transform: identity,
            yfov: std::f64::consts::FRAC_PI_2,
        };
        let cameras = [camera(3, Some("front")), camera(1, None)];
        assert_eq!(pick(&cameras, None).unwrap().unwrap().number, 3);
        assert_eq!(pick(&cameras, Some("front")).unwrap().unwrap().number, 3);
        assert_eq!(pick(&cameras, Some("1")).unwrap().unwrap().number, 1);
        let error = pick(&cameras, Some("back")).unwrap_err().to_string();
        assert_eq!(error, "there is no camera \"back\"; there are: front, 1");
        assert!(pick(&[], None).unwrap().is_none());
        let placed = placed(&cameras[0]).unwrap();
        assert_eq!(placed.eye(), [0.0, 0.0, 4.0]);
        assert_eq!(placed.direction([1.0, 1.0], [2, 2]), [0.0, 0.0, -1.0]);
    }
}
