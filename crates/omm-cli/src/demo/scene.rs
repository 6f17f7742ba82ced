//! The demo's scene: ferns of many cards on a patch of ground, a camera and a sun.
//!
//! Positions are metres, *y* up. Only basic arithmetic and square roots are used, so that every machine builds the same scene.

use super::random::Random;

/// Quads along a frond.
const SEGMENTS: u32 = 8;
/// Fronds of a plant.
const FRONDS: u32 = 7;
/// Plants along each side of the patch.
const PLANTS: u32 = 22;
/// Metres between plants.
const SPACING: f64 = 0.62;

/// A triangle mesh with texture coordinates.
pub(super) struct Mesh {
    pub(super) positions: Vec<[f32; 3]>,
    /// Empty if the mesh has no texture.
    pub(super) uvs: Vec<[f32; 2]>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Where an instance stands: a 3 by 4 row-major matrix.
pub(super) type Transform = [[f32; 4]; 3];

/// The transform that changes nothing.
pub(super) const IDENTITY: Transform = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// One fern: cards that rise from the root and bend outwards, each with the whole frond texture on it.
pub(super) fn plant() -> Mesh {
    let mut mesh = Mesh { positions: Vec::new(), uvs: Vec::new(), triangles: Vec::new() };
    // Directions of the fronds: a seventh of a turn, repeated.
    let turn = (0.623_489_801_858_733_5, 0.781_831_482_468_029_8);
    let mut out = (1.0, 0.0);
    for frond in 0..FRONDS {
        let reach = if frond % 2 == 0 { 0.50 } else { 0.42 };
        let first = mesh.positions.len() as u32;
        for step in 0..=SEGMENTS {
            let along = f64::from(step) / f64::from(SEGMENTS);
            let (away, height) = (0.04 + reach * along, 0.75 * along - 0.42 * along * along);
            for side in [-1.0, 1.0] {
                let half_width = 0.17 * side;
                let x = out.0 * away - out.1 * half_width;
                let z = out.1 * away + out.0 * half_width;
                mesh.positions.push([x as f32, height as f32, z as f32]);
                mesh.uvs.push([if side < 0.0 { 0.0 } else { 1.0 }, 1.0 - along as f32]);
            }
        }
        for step in 0..SEGMENTS {
            let at = first + 2 * step;
            mesh.triangles.extend([[at, at + 1, at + 2], [at + 2, at + 1, at + 3]]);
        }
        out = (out.0 * turn.0 - out.1 * turn.1, out.0 * turn.1 + out.1 * turn.0);
    }
    mesh
}

/// The ground: two opaque triangles.
pub(super) fn ground() -> Mesh {
    let half = 12.0;
    Mesh {
        positions: vec![[-half, 0.0, -half], [half, 0.0, -half], [-half, 0.0, half], [half, 0.0, half]],
        uvs: Vec::new(),
        triangles: vec![[0, 1, 2], [2, 1, 3]],
    }
}

/// Where the plants stand: a grid shaken, turned and scaled by chance.
pub(super) fn plants() -> Vec<Transform> {
    let mut random = Random::new(2026);
    let mut transforms = Vec::new();
    let half = f64::from(PLANTS - 1) / 2.0;
    for row in 0..PLANTS {
        for column in 0..PLANTS {
            let (turn_x, turn_z) = direction(&mut random);
            let scale = random.between(0.75, 1.35);
            let x = (f64::from(column) - half + random.between(-0.4, 0.4)) * SPACING;
            let z = (f64::from(row) - half + random.between(-0.4, 0.4)) * SPACING;
            let (c, s) = ((turn_x * scale) as f32, (turn_z * scale) as f32);
            transforms.push([[c, 0.0, s, x as f32], [0.0, scale as f32, 0.0, 0.0], [-s, 0.0, c, z as f32]]);
        }
    }
    transforms
}

/// A direction in the plane, by rejection.
fn direction(random: &mut Random) -> (f64, f64) {
    loop {
        let (x, y) = (random.between(-1.0, 1.0), random.between(-1.0, 1.0));
        let square = x * x + y * y;
        if (0.01..1.0).contains(&square) {
            let length = square.sqrt();
            return (x / length, y / length);
        }
    }
}

/// Towards the sun; of length 1.
pub(super) const SUN: [f32; 3] = [0.48, 0.8, 0.36];

/// A pinhole camera that looks down on the patch, so that every ray meets something.
pub(super) struct Camera {
    eye: [f64; 3],
    forward: [f64; 3],
    right: [f64; 3],
    up: [f64; 3],
}

impl Camera {
    /// The demo's view.
    pub(super) fn new() -> Self {
        let eye = [0.0, 2.6, 5.2];
        let forward = normalised([0.0, -1.0, -1.55]);
        let right = [1.0, 0.0, 0.0];
        let up = [0.0, -forward[2], forward[1]];
        Self { eye, forward, right, up }
    }

    /// Where rays start.
    pub(super) fn eye(&self) -> [f32; 3] {
        self.eye.map(|coordinate| coordinate as f32)
    }

    /// The direction through the middle of a pixel; rows run down.
    pub(super) fn direction(&self, [column, row]: [u32; 2], [width, height]: [u32; 2]) -> [f32; 3] {
        let unit = 0.84 / f64::from(height);
        let x = (f64::from(column) + 0.5 - f64::from(width) / 2.0) * unit;
        let y = (f64::from(height) / 2.0 - f64::from(row) - 0.5) * unit;
        let through = [0, 1, 2].map(|axis| self.forward[axis] + x * self.right[axis] + y * self.up[axis]);
        normalised(through).map(|coordinate| coordinate as f32)
    }
}

fn normalised([x, y, z]: [f64; 3]) -> [f64; 3] {
    let length = (x * x + y * y + z * z).sqrt();
    [x / length, y / length, z / length]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_are_indexed_in_range() {
        for mesh in [plant(), ground()] {
            assert!(mesh.triangles.iter().flatten().all(|&index| (index as usize) < mesh.positions.len()));
            assert!(mesh.uvs.is_empty() || mesh.uvs.len() == mesh.positions.len());
        }
        assert_eq!(plant().triangles.len(), 112);
        assert_eq!(plants().len(), 484);
    }

    #[test]
    fn every_pixel_looks_down() {
        let camera = Camera::new();
        for pixel in [[0, 0], [959, 0], [0, 539], [959, 539], [480, 270]] {
            assert!(camera.direction(pixel, [960, 540])[1] < -0.05, "{pixel:?}");
        }
        let length: f32 = SUN.iter().map(|c| c * c).sum();
        assert!((length - 1.0).abs() < 1e-6);
    }
}
