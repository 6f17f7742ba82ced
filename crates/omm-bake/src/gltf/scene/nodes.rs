//! The tree of nodes: where meshes and cameras are placed.

use std::collections::BTreeSet;

use gltf::json;
use json::camera::Type;
use json::scene::Node;
use json::validation::Checked;

use super::super::container::Container;
use super::super::error::{GltfError, GltfErrorKind};

/// Three rows of four: a linear map and, in the last column, a translation.
pub type Matrix = [[f64; 4]; 3];

/// A mesh that a node places.
#[derive(Clone, Debug, PartialEq)]
pub struct GltfPlacement {
    /// Number of the mesh in the file.
    pub mesh: usize,
    /// From the mesh's space to that of the scene. All numbers are finite in `f32`.
    pub transform: Matrix,
}

/// A perspective camera that a node places. It looks along its negative *z* axis, its *y* axis is up.
#[derive(Clone, Debug, PartialEq)]
pub struct GltfCamera {
    /// Number of the camera in the file.
    pub number: usize,
    /// Its name, or that of its node if it has none.
    pub name: Option<String>,
    /// From the camera's space to that of the scene.
    pub transform: Matrix,
    /// The vertical field of view in radians, above 0 and below pi.
    pub yfov: f64,
}

const IDENTITY: Matrix = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// Finds all that nodes place, in the order of the tree.
pub(super) fn walk(container: &Container) -> Result<(Vec<GltfPlacement>, Vec<GltfCamera>), GltfError> {
    let nodes = &container.root.nodes;
    let mut open = roots(container)?;
    open.reverse();
    let mut open: Vec<_> = open.into_iter().map(|node| (node, IDENTITY)).collect();
    let mut seen = vec![false; nodes.len()];
    let (mut placements, mut cameras) = (Vec::new(), Vec::new());
    while let Some((number, parent)) = open.pop() {
        let at = format!("nodes[{number}]");
        let node = container.item(nodes, number, "nodes")?;
        // A tree, so that this ends.
        match seen.get_mut(number) {
            Some(seen) if !*seen => *seen = true,
            _ => return Err(container.error(at, GltfErrorKind::NodeTwice)),
        }
        let transform = product(&parent, &local(node));
        if !transform.as_flattened().iter().all(|&x| (x as f32).is_finite()) {
            return Err(container.error(at, GltfErrorKind::Transform));
        }
        if let Some(mesh) = node.mesh {
            container.item(&container.root.meshes, mesh.value(), &format!("{at}.mesh"))?;
            placements.push(GltfPlacement { mesh: mesh.value(), transform });
        }
        if let Some(camera) = node.camera {
            cameras.extend(self::camera(container, camera.value(), node, transform, &at)?);
        }
        let children = node.children.iter().flatten();
        open.extend(children.rev().map(|child| (child.value(), transform)));
    }
    Ok((placements, cameras))
}

/// The nodes at the top.
fn roots(container: &Container) -> Result<Vec<usize>, GltfError> {
    let root = &container.root;
    let scene = match root.scene {
        Some(scene) => Some(container.item(&root.scenes, scene.value(), "scene")?),
        None => root.scenes.first(),
    };
    Ok(match scene {
        Some(scene) => scene.nodes.iter().map(json::Index::value).collect(),
        None => {
            let children = root.nodes.iter().flat_map(|node| node.children.iter().flatten());
            let children: BTreeSet<usize> = children.map(json::Index::value).collect();
            (0..root.nodes.len()).filter(|node| !children.contains(node)).collect()
        }
    })
}

/// The camera; `None` if it is orthographic.
fn camera(
    container: &Container,
    number: usize,
    node: &Node,
    transform: Matrix,
    at: &str,
) -> Result<Option<GltfCamera>, GltfError> {
    let camera = container.item(&container.root.cameras, number, &format!("{at}.camera"))?;
    let fail = |field: &str, kind| Err(container.error(format!("cameras[{number}].{field}"), kind));
    match (&camera.type_, &camera.perspective) {
        (Checked::Valid(Type::Perspective), Some(perspective)) => {
            let yfov = f64::from(perspective.yfov);
            if !(yfov > 0.0 && yfov < std::f64::consts::PI) {
                let (found, most) = (perspective.yfov, std::f32::consts::PI);
                return fail("perspective.yfov", GltfErrorKind::Range { found, least: 0.0, most });
            }
            let name = camera.name.clone().or_else(|| node.name.clone());
            Ok(Some(GltfCamera { number, name, transform, yfov }))
        }
        (Checked::Valid(Type::Orthographic), _) => Ok(None),
        _ => fail("type", GltfErrorKind::Value),
    }
}

/// What a node does to its children.
fn local(node: &Node) -> Matrix {
    if let Some(matrix) = node.matrix {
        // Columns one after the other.
        return [0, 1, 2].map(|row| [0, 1, 2, 3].map(|column| f64::from(matrix[4 * column + row])));
    }
    let [x, y, z, w] = node.rotation.unwrap_or_default().0.map(f64::from);
    let scale = node.scale.unwrap_or([1.0; 3]).map(f64::from);
    let translation = node.translation.unwrap_or_default().map(f64::from);
    // A unit quaternion; one that is not is taken as glTF's formula takes it.
    let rotation = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    [0, 1, 2].map(|row| {
        let [a, b, c] = [0, 1, 2].map(|column| rotation[row][column] * scale[column]);
        [a, b, c, translation[row]]
    })
}

/// `a` after `b`.
fn product(a: &Matrix, b: &Matrix) -> Matrix {
    a.map(|row| {
        [0, 1, 2, 3].map(|column| {
            let rest = if column == 3 { row[3] } else { 0.0 };
            row[0] * b[0][column] + row[1] * b[1][column] + row[2] * b[2][column] + rest
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(value: serde_json::Value) -> Node {
        serde_json::from_value(value).unwrap()
    }

    #[test]
    fn properties_and_matrix_agree() {
        // A quarter turn about z, after a scale, before a translation.
        let half = 0.5_f64.sqrt();
        let properties = serde_json::json!({
            "rotation": [0.0, 0.0, half, half], "scale": [2.0, 3.0, 4.0], "translation": [5.0, 6.0, 7.0],
        });
        let matrix = serde_json::json!({
            "matrix": [0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1],
        });
        let (properties, matrix) = (local(&node(properties)), local(&node(matrix)));
        assert_eq!(matrix, [[0.0, -3.0, 0.0, 5.0], [2.0, 0.0, 0.0, 6.0], [0.0, 0.0, 4.0, 7.0]]);
        for (a, b) in properties.as_flattened().iter().zip(matrix.as_flattened()) {
            assert!((a - b).abs() < 1e-6, "{properties:?}");
        }
    }

    #[test]
    fn products_apply_the_second_first() {
        let shift = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 2.0], [0.0, 0.0, 1.0, 3.0]];
        let double = [[2.0, 0.0, 0.0, 0.0], [0.0, 2.0, 0.0, 0.0], [0.0, 0.0, 2.0, 0.0]];
        assert_eq!(product(&double, &shift)[1], [0.0, 2.0, 0.0, 4.0]);
        assert_eq!(product(&shift, &double)[1], [0.0, 2.0, 0.0, 2.0]);
        assert_eq!(product(&IDENTITY, &shift), shift);
    }
}
