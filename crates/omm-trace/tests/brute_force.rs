//! The hierarchy against trying every primitive, to the last bit.
//!
//! A scene of one instance of one primitive is traced without any box, so the union of such scenes is the scene without
//! a hierarchy.
#![allow(clippy::unwrap_used)]

mod support;

use omm_model::vk::{GeometryFlags, Instance, TransformMatrix};
use omm_trace::{AabbCandidate, AnyHit, Candidate, Counters, Hit, Ray, ReportedHit, Scene, Shaders, TraceOptions};
use proptest::prelude::*;
use support::*;

/// Everything that the ray meets, in order.
fn everything(scene: &Scene, ray: &Ray) -> Vec<(u32, u32, u32, u32)> {
    let mut seen = Vec::new();
    let mut shader = |candidate: &Candidate| {
        seen.push((candidate.t.to_bits(), candidate.instance_id, candidate.geometry_index, candidate.primitive_id));
        AnyHit::Ignore
    };
    scene.trace(ray, &TraceOptions::default(), &mut shader, &mut Counters::default());
    seen.sort_unstable();
    seen
}

/// The same scene in pieces: one for each instance and triangle, inactive ones standing for the others.
fn pieces(geometries: &[Vec<Vertices>], transforms: &[TransformMatrix]) -> Vec<Scene> {
    let mut scenes = Vec::new();
    for (geometry, mesh) in geometries.iter().enumerate() {
        for primitive in 0..mesh.len() {
            let alone = geometries.iter().enumerate().map(|(at, mesh)| {
                let mut alone = triangles(GeometryFlags::empty(), mesh.iter().copied());
                let omm_layout::object::BlasPrimitives::Triangles(list) = &mut alone.primitives else { return alone };
                for (index, triangle) in list.iter_mut().enumerate() {
                    if (at, index) != (geometry, primitive) {
                        *triangle = None;
                    }
                }
                alone
            });
            let alone: Vec<_> = alone.collect();
            for instance_id in 0..transforms.len() {
                let mut memory = Memory::default();
                let blas = memory.blas(alone.clone());
                let instances = transforms.iter().enumerate().map(|(at, &transform)| {
                    let reference = if at == instance_id { blas } else { 0 };
                    Instance { transform, ..instance(reference) }
                });
                scenes.push(memory.scene(instances.collect()));
            }
        }
    }
    scenes
}

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![4 => (-4_i8..=4).prop_map(f32::from), 4 => -4.0_f32..4.0, 1 => Just(-0.0), 1 => -1e-20_f32..1e-20]
}

fn point() -> impl Strategy<Value = [f32; 3]> {
    [coordinate(), coordinate(), coordinate()]
}

fn mesh() -> impl Strategy<Value = Vec<Vertices>> {
    prop::collection::vec([point(), point(), point()], 1..10)
}

fn transform() -> impl Strategy<Value = TransformMatrix> {
    let flat =
        prop::array::uniform9(coordinate()).prop_map(|m| [[m[0], m[1], m[2]], [m[3], m[4], m[5]], [m[6], m[7], m[8]]]);
    let scaled = prop::array::uniform3(-12_i32..=12).prop_map(|s| {
        let [x, y, z] = s.map(|s| 2.0_f32.powi(s));
        [[x, 0.0, 0.0], [0.0, -y, 0.0], [0.0, 0.0, z]]
    });
    // Nearly singular: too ill-conditioned for a box.
    let squeezed = (1_i32..=23, 0_i32..=12).prop_map(|(close, scale)| {
        let (up, down) = (2.0_f32.powi(scale), 2.0_f32.powi(-scale));
        [[up, up, 0.0], [down, down * (1.0 + 2.0_f32.powi(-close)), 0.0], [0.0, 0.0, 1.0]]
    });
    let identity = Just([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let linear = prop_oneof![2 => identity, 3 => flat, 2 => scaled, 1 => squeezed];
    (linear, point()).prop_map(|([a, b, c], [x, y, z])| {
        let row = |[p, q, r]: [f32; 3], t| [p, q, r, t];
        TransformMatrix { matrix: [row(a, x), row(b, y), row(c, z)] }
    })
}

fn ray() -> impl Strategy<Value = Ray> {
    let direction =
        prop_oneof![point(), point().prop_map(|p| p.map(|x| x * 1e20)), point().prop_map(|p| p.map(|x| x * 1e-15))];
    (point(), direction, 0.0_f32..1.0, prop_oneof![2 => Just(f32::INFINITY), 1 => 1.0_f32..8.0])
        .prop_filter_map("a zero direction", |(origin, direction, t_min, t_max)| {
            Ray::new(origin, direction, t_min * 0.1, t_max).ok()
        })
}

/// A ray that is aimed at a point of a triangle, often at a vertex or an edge of it.
#[derive(Clone, Debug)]
struct Aim {
    from: [f32; 3],
    instance: prop::sample::Index,
    triangle: prop::sample::Index,
    weights: [f32; 2],
}

impl Aim {
    fn ray(&self, geometries: &[Vec<Vertices>], transforms: &[TransformMatrix]) -> Option<Ray> {
        let all: Vec<_> = geometries.iter().flatten().collect();
        let [a, b, c] = *all[self.triangle.index(all.len())];
        let [u, v] = self.weights;
        let [x, y, z]: [f32; 3] = std::array::from_fn(|i| a[i] + u * (b[i] - a[i]) + v * (c[i] - a[i]));
        let TransformMatrix { matrix } = transforms[self.instance.index(transforms.len())];
        let target = matrix.map(|[a, b, c, t]| a * x + b * y + c * z + t);
        Ray::unbounded(self.from, std::array::from_fn(|i| target[i] - self.from[i])).ok()
    }
}

fn aim() -> impl Strategy<Value = Aim> {
    let weight = || prop_oneof![Just(0.0_f32), Just(0.5), Just(1.0), 0.0_f32..1.0];
    (point(), any::<prop::sample::Index>(), any::<prop::sample::Index>(), [weight(), weight()])
        .prop_map(|(from, instance, triangle, weights)| Aim { from, instance, triangle, weights })
}

/// Each ray meets what it meets in the pieces.
fn compare(
    geometries: &[Vec<Vertices>],
    transforms: &[TransformMatrix],
    rays: impl IntoIterator<Item = Ray>,
    opaque: bool,
) -> Result<(), TestCaseError> {
    let mut memory = Memory::default();
    let flags = if opaque { GeometryFlags::OPAQUE } else { GeometryFlags::empty() };
    let blas = memory.blas(geometries.iter().map(|mesh| triangles(flags, mesh.iter().copied())).collect());
    let instances = transforms.iter().map(|&transform| Instance { transform, ..instance(blas) });
    let scene = memory.scene(instances.collect());
    let pieces = pieces(geometries, transforms);
    for ray in rays {
        let alone = pieces.iter().filter_map(|piece| closest(piece, &ray));
        let rank = |hit: &Hit| (hit.t, hit.instance_id, hit.geometry_index, hit.primitive_id);
        let expected = alone.min_by(|a, b| rank(a).partial_cmp(&rank(b)).unwrap());
        let found = closest(&scene, &ray);
        prop_assert_eq!(found.map(|hit| hit.candidate), expected.map(|hit| hit.candidate));
        if !opaque {
            let mut expected: Vec<_> = pieces.iter().flat_map(|piece| everything(piece, &ray)).collect();
            expected.sort_unstable();
            prop_assert_eq!(everything(&scene, &ray), expected);
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]

    #[test]
    fn nothing_is_lost_and_nothing_is_added(
        geometries in prop::collection::vec(mesh(), 1..3),
        transforms in prop::collection::vec(transform(), 1..6),
        rays in prop::collection::vec(ray(), 8),
        aims in prop::collection::vec(aim(), 24),
        opaque in any::<bool>(),
    ) {
        let aimed = aims.iter().filter_map(|aim| aim.ray(&geometries, &transforms));
        compare(&geometries, &transforms, rays.into_iter().chain(aimed), opaque)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { max_shrink_iters: 64, ..ProptestConfig::with_cases(3) })]

    /// Meshes of more leaves than an instance has parts.
    #[test]
    fn nothing_is_lost_below_a_part(
        mesh in prop::collection::vec((point(), prop::array::uniform2(prop::array::uniform3(-0.5_f32..0.5))), 350..450),
        transforms in prop::collection::vec(transform(), 1..3),
        aims in prop::collection::vec(aim(), 32),
        opaque in any::<bool>(),
    ) {
        let corner = |[x, y, z]: [f32; 3], [dx, dy, dz]: [f32; 3]| [x + dx, y + dy, z + dz];
        let mesh = mesh.into_iter().map(|(at, [b, c])| [at, corner(at, b), corner(at, c)]).collect();
        let geometries = [mesh];
        let aimed = aims.iter().filter_map(|aim| aim.ray(&geometries, &transforms));
        compare(&geometries, &transforms, aimed, opaque)?;
    }
}

/// Notes which boxes are offered.
#[derive(Default)]
struct Offers(Vec<(u32, u32)>);

impl Shaders for Offers {
    fn intersection(&mut self, aabb: &AabbCandidate) -> Option<ReportedHit> {
        self.0.push((aabb.instance_id, aabb.primitive_id));
        None
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    /// All numbers are small integers or powers of two, so a ray that is aimed at a point of a box goes exactly through it,
    /// corners and faces of flat boxes included.
    #[test]
    fn every_box_on_the_way_is_offered(
        boxes in prop::collection::vec([[-4_i8..=4, -4_i8..=4, -4_i8..=4], [0_i8..=3, 0_i8..=3, 0_i8..=3]], 1..12),
        instances in prop::collection::vec(([-4_i8..=4, -4_i8..=4, -4_i8..=4], -3_i32..=3, any::<bool>()), 1..5),
        rays in prop::collection::vec(
            ([-9_i8..=9, -9_i8..=9, -9_i8..=9], any::<prop::sample::Index>(), [0_u8..=2, 0_u8..=2, 0_u8..=2]), 32
        ),
    ) {
        let corners: Vec<[[f32; 3]; 2]> = boxes
            .iter()
            .map(|[low, size]| [low.map(f32::from), std::array::from_fn(|i| f32::from(low[i]) + f32::from(size[i]))])
            .collect();
        let mut memory = Memory::default();
        let blas = memory.blas(vec![aabbs(GeometryFlags::empty(), &corners)]);
        let matrices: Vec<[[f32; 4]; 3]> = instances
            .iter()
            .map(|&(shift, scale, turned)| {
                let ([x, y, z], s) = (shift.map(f32::from), 2.0_f32.powi(scale));
                if turned {
                    [[0.0, s, 0.0, x], [0.0, 0.0, -s, y], [s, 0.0, 0.0, z]]
                } else {
                    [[s, 0.0, 0.0, x], [0.0, s, 0.0, y], [0.0, 0.0, s, z]]
                }
            })
            .collect();
        let scene = memory.scene(matrices.iter().map(|&matrix| with_transform(blas, matrix)).collect());
        for (origin, at, part) in rays {
            let at = at.index(corners.len() * matrices.len());
            let (instance_id, primitive_id) = (at / corners.len(), at % corners.len());
            let [low, high] = corners[primitive_id];
            let [x, y, z]: [f32; 3] = std::array::from_fn(|i| low[i] + 0.5 * f32::from(part[i]) * (high[i] - low[i]));
            let target = matrices[instance_id].map(|[a, b, c, t]| a * x + b * y + c * z + t);
            let origin = origin.map(f32::from);
            let Ok(ray) = Ray::new(origin, std::array::from_fn(|i| target[i] - origin[i]), 0.5, 1.0) else { continue };
            let mut offers = Offers::default();
            scene.trace(&ray, &TraceOptions::default(), &mut offers, &mut Counters::default());
            prop_assert!(offers.0.contains(&(instance_id as u32, primitive_id as u32)), "{:?}", ray);
            offers.0.sort_unstable();
            prop_assert!(offers.0.windows(2).all(|pair| pair[0] != pair[1]), "offered twice");
        }
    }
}
