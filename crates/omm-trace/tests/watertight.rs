//! No ray leaks through a shared edge or vertex, and none is counted twice there.
#![allow(clippy::unwrap_used)]

mod support;

use omm_model::vk::GeometryFlags;
use omm_trace::{AnyHit, Candidate, Counters, Ray, Scene, TraceOptions};
use proptest::prelude::*;
use support::*;

/// How many triangles the ray meets.
fn crossings(scene: &Scene, ray: &Ray) -> u64 {
    let mut counters = Counters::default();
    scene.trace(ray, &TraceOptions::default(), &mut |_: &Candidate| AnyHit::Ignore, &mut counters);
    counters.candidates
}

fn midpoint(a: [f32; 3], b: [f32; 3]) -> [f32; 3] {
    std::array::from_fn(|i| 0.5 * (a[i] + b[i]))
}

/// The octahedron, each triangle split into four so many times. Neighbours agree on every vertex to the last bit.
fn octahedron(splits: u32) -> Vec<Vertices> {
    let [x, y, z]: Vertices = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let minus = |v: [f32; 3]| v.map(|c| 0.0 - c);
    let mut mesh = Vec::new();
    for z in [z, minus(z)] {
        for (a, b) in [(x, y), (y, minus(x)), (minus(x), minus(y)), (minus(y), x)] {
            mesh.push([a, b, z]);
        }
    }
    for _ in 0..splits {
        mesh = mesh
            .into_iter()
            .flat_map(|[a, b, c]| {
                let (ab, bc, ca) = (midpoint(a, b), midpoint(b, c), midpoint(c, a));
                [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
            })
            .collect();
    }
    mesh
}

/// Moves a vertex outwards by an amount that its position decides.
fn bumpy(vertex: [f32; 3]) -> [f32; 3] {
    let hash = vertex.iter().fold(17_u32, |hash, x| (hash ^ x.to_bits()).wrapping_mul(0x9e37_79b1).rotate_left(13));
    let length = vertex.iter().map(|x| x * x).sum::<f32>().sqrt();
    let factor = (1.0 + 0.3 * (hash >> 8) as f32 / (1 << 24) as f32) / length;
    vertex.map(|x| x * factor)
}

#[test]
fn a_bumpy_sphere_lets_nothing_out() {
    // A star-shaped mesh: from the centre every ray meets it once, and from elsewhere inside an odd number of times.
    let mesh: Vec<Vertices> = octahedron(4).into_iter().map(|triangle| triangle.map(bumpy)).collect();
    let scene = scene_of(triangles(GeometryFlags::empty(), mesh.iter().copied()));
    for [a, b, c] in &mesh {
        for target in [*a, midpoint(*a, *b), midpoint(*b, *c), midpoint(midpoint(*a, *b), *b)] {
            let centre = Ray::unbounded([0.0; 3], target).unwrap();
            assert_eq!(crossings(&scene, &centre), 1, "{target:?}");
            assert!(closest(&scene, &centre).is_some());
            for origin in [[0.1, -0.2, 0.3], [0.5, 0.0, 0.0]] {
                let direction = std::array::from_fn(|i| target[i] - origin[i]);
                let aside = Ray::unbounded(origin, direction).unwrap();
                assert_eq!(crossings(&scene, &aside) % 2, 1, "{origin:?} {direction:?}");
            }
        }
    }
}

#[test]
fn a_flat_sided_mesh_in_binary_fractions_lets_nothing_out() {
    // All coordinates and directions are exact, so rays pass exactly through vertices and along the faces of boxes.
    let mesh = octahedron(3);
    let scene = scene_of(triangles(GeometryFlags::empty(), mesh.iter().copied()));
    for origin in [[0.0, 0.0, 0.0], [0.125, 0.0, 0.25], [-0.25, 0.125, 0.5]] {
        for triangle in &mesh {
            let [a, b, c] = *triangle;
            for target in [a, b, c, midpoint(a, b), midpoint(b, c), midpoint(c, a)] {
                let direction: [f32; 3] = std::array::from_fn(|i| target[i] - origin[i]);
                let ray = Ray::unbounded(origin, direction).unwrap();
                assert_eq!(crossings(&scene, &ray), 1, "{origin:?} {direction:?}");
            }
        }
    }
}

/// A square of `n` by `n` cells of two triangles each, with heights.
fn sheet(n: u16, height: impl Fn(u16, u16) -> f32) -> Vec<Vertices> {
    let vertex = |x, y| [f32::from(x), f32::from(y), height(x, y)];
    let cells = (0..n).flat_map(|y| (0..n).map(move |x| (x, y)));
    cells
        .flat_map(|(x, y)| {
            let [a, b, c, d] = [vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1), vertex(x, y + 1)];
            // Diagonals both ways, and windings mixed: neither may matter.
            if (x + y) % 2 == 0 { [[a, b, c], [d, c, a]] } else { [[a, b, d], [b, c, d]] }
        })
        .collect()
}

#[test]
fn a_sheet_is_hit_once_from_straight_above() {
    const N: u16 = 12;
    for heights in [|_, _| 0.0, |x, y| f32::from((x * 7 + y * 13) % 5) * 0.1] {
        let scene = scene_of(triangles(GeometryFlags::empty(), sheet(N, heights)));
        for x in 1..4 * N {
            for y in 1..4 * N {
                let (x, y) = (f32::from(x) * 0.25, f32::from(y) * 0.25);
                for (z, down) in [(3.0, -1.0), (-3.0, 0.5)] {
                    let ray = Ray::unbounded([x, y, z], [0.0, 0.0, down]).unwrap();
                    assert_eq!(crossings(&scene, &ray), 1, "({x}, {y})");
                }
            }
        }
    }
}

#[test]
fn a_ray_in_the_plane_of_a_box_s_face_reaches_a_wall() {
    // A wall across x = 4; rays run along the edges and corners of the boxes around its triangles.
    let wall = sheet(8, |_, _| 4.0).into_iter().map(|triangle| triangle.map(|[x, y, z]| [z, x, y]));
    let scene = scene_of(triangles(GeometryFlags::empty(), wall));
    for y in 1..8_u8 {
        for z in 1..8_u8 {
            for direction in [[1.0, 0.0, 0.0], [1.0, -0.0, 1e-30], [1.0, f32::MIN_POSITIVE, -0.0]] {
                let ray = Ray::unbounded([-4.0, y.into(), z.into()], direction).unwrap();
                assert_eq!(crossings(&scene, &ray), 1, "({y}, {z}) {direction:?}");
            }
        }
    }
}

proptest! {
    /// An instance is watertight under any transform: rays that are aimed at its transformed vertices and edges, as
    /// near as f32 comes to them, meet the sheet once.
    #[test]
    fn an_instance_is_hit_once(
        linear in prop::array::uniform9(-2.0_f32..2.0),
        offset in prop::array::uniform3(-50.0_f32..50.0),
        stretch in prop::array::uniform3(-6_i32..=6),
        above in prop::array::uniform3(-1.0_f32..1.0),
        at in [2_u8..=14, 2_u8..=14],
    ) {
        let [a, b, c, d, e, f, g, h, i] = linear;
        let [sx, sy, sz] = stretch.map(|s| 2.0_f32.powi(s));
        let [x, y, z] = offset;
        let matrix = [[a * sx, b * sy, c * sz, x], [d * sx, e * sy, f * sz, y], [g * sx, h * sy, i * sz, z]];
        let to_world = |[px, py, pz]: [f32; 3]| matrix.map(|[a, b, c, t]| a * px + b * py + c * pz + t);
        let determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
        prop_assume!(determinant.abs() > 0.1);

        let mut memory = Memory::default();
        let bumps = sheet(8, |x, y| f32::from((x * 3 + y * 5) % 4) * 0.125);
        let blas = memory.blas(vec![triangles(GeometryFlags::empty(), bumps)]);
        let scene = memory.scene(vec![with_transform(blas, matrix)]);
        let target = to_world([f32::from(at[0]) * 0.5, f32::from(at[1]) * 0.5, 0.2]);
        let from = to_world([4.0 + above[0], 4.0 + above[1], 40.0]);
        let direction = std::array::from_fn(|i| target[i] - from[i]);
        let ray = Ray::unbounded(from, direction).unwrap();
        prop_assert_eq!(crossings(&scene, &ray), 1);
    }
}
