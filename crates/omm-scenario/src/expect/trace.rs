//! What rays meet: `ray(in: "scene", on: (instance: 0, at: (0.25, 0.5)), is: opaque)`, and `ray_query(…)` with the same words.

use omm_model::opacity::OpacityState;
use omm_model::vk;
use omm_trace::query::{Intersection, QueryCandidate, RayQuery, micromaps_in_ray_queries};
use omm_trace::{
    AabbCandidate, AnyHit, Candidate, Counters, Hit, LastShader, ObjectSpace, QueryError, Ray, RayFlags, ReportedHit,
    Shaders, TraceOptions,
};

use super::{Scene, Verdict};
use crate::error::Mistake;
use crate::node::{Arguments, Kind, Node};

const RAY: &[&str] = &[
    "in",
    "on",
    "from",
    "along",
    "t",
    "time",
    "flags",
    "mask",
    "offset",
    "stride",
    "micromaps",
    "execution_mode",
    "any_hit",
    "reports",
    "is",
    "reads",
    "counters",
];

/// Where a ray is aimed: at a point of a triangle.
const TARGET: &[&str] = &["instance", "geometry", "primitive", "at", "side"];

/// What happened to a ray.
struct Found {
    hit: Option<Hit>,
    space: Option<ObjectSpace>,
    last_shader: Option<LastShader>,
    ray: Ray,
    counters: Counters,
}

/// What the shaders of a scenario answer.
#[derive(Clone, Copy)]
struct Answers {
    any_hit: AnyHit,
    /// Where every box is hit.
    reports: Option<f32>,
}

impl Shaders for Answers {
    fn any_hit(&mut self, _: &Candidate) -> AnyHit {
        self.any_hit
    }

    fn intersection(&mut self, _: &AabbCandidate) -> Option<ReportedHit> {
        self.reports.map(|t| ReportedHit { t, kind: 0 })
    }
}

impl Scene<'_> {
    /// `ray(…)`, traced as by a pipeline, or `ray_query(…)`.
    pub(super) fn ray(&self, node: &Node, by_query: bool) -> Result<Verdict, Mistake> {
        let arguments = Arguments::of(node, RAY)?;
        let name = arguments.need("in")?;
        let address = vk::DeviceAddress(self.world.structure(name.text()?, name)?.range.address);
        // Text says why there is nothing to trace.
        let why = arguments.get("is").and_then(|node| node.text().ok());
        let loaded = omm_trace::Scene::load(&self.world.device.structure_memory(), address);
        let scene = match (loaded, why) {
            (Ok(_), Some(_)) => return Ok(Err("the scene can be traced".to_owned())),
            (Ok(scene), None) => scene.with_tie_break(self.world.profile().micromap_tie_break),
            (Err(error), Some(why)) if error.to_string().contains(why) => return Ok(Ok(())),
            (Err(error), _) => return Ok(Err(self.world.objects.named(&error.to_string()))),
        };
        let ray = aimed(&arguments, &scene, node)?;
        let options = self.options(&arguments, by_query)?;
        let answers = answers(&arguments)?;
        let found = if by_query {
            match ask(&scene, &ray, &options, answers) {
                Ok(found) => found,
                Err(error) => return Ok(Err(error.to_string())),
            }
        } else {
            trace(&scene, &ray, &options, answers)
        };
        judge(&arguments, &found)
    }

    fn options(&self, arguments: &Arguments<'_>, by_query: bool) -> Result<TraceOptions, Mistake> {
        arguments.exclusive("micromaps", "execution_mode")?;
        let mut flags = RayFlags::empty();
        for node in arguments.get("flags").map(Node::one_or_more).unwrap_or_default() {
            let name = node.name().unwrap_or_default();
            flags |= RayFlags::from_name(name).ok_or_else(|| {
                let names = RayFlags::all().iter_names().map(|(name, _)| name).collect::<Vec<_>>();
                node.mistake(format!("{} is no ray flag", node.describe())).nearest(name, names)
            })?;
        }
        let number = |name: &str, default: u32| arguments.get(name).map_or(Ok(default), Node::integer);
        let execution_mode = arguments.get("execution_mode").map(Node::boolean).transpose()?;
        let micromaps = match arguments.get("micromaps") {
            Some(node) => node.boolean()?,
            None if by_query => micromaps_in_ray_queries(self.world.profile().features.micromap_ext, execution_mode),
            None => true,
        };
        let (sbt_offset, sbt_stride) = (number("offset", 0)?, number("stride", 0)?);
        Ok(TraceOptions {
            flags,
            cull_mask: number("mask", 0xff)?,
            sbt_offset,
            sbt_stride,
            micromaps,
            ..TraceOptions::default()
        })
    }
}

/// The ray that a scenario describes: from a place along a direction, or at a point of a triangle.
fn aimed(arguments: &Arguments<'_>, scene: &omm_trace::Scene, node: &Node) -> Result<Ray, Mistake> {
    arguments.exclusive("on", "from")?;
    arguments.exclusive("on", "along")?;
    let time = arguments.get("time").map_or(Ok(0.0), Node::float)? as f32;
    let range = arguments.get("t").map_or(Ok([0.0, f32::INFINITY]), numbers::<2>)?;
    let refused = |error: omm_trace::RayError| node.mistake(format!("this is no ray: {error}"));
    let (origin, direction) = match arguments.get("on") {
        None => (numbers::<3>(arguments.need("from")?)?, numbers::<3>(arguments.need("along")?)?),
        Some(target) => {
            let target_arguments = Arguments::of(target, TARGET)?;
            let index = |name: &str| target_arguments.get(name).map_or(Ok(0), Node::integer);
            let [u, v] = numbers::<2>(target_arguments.need("at")?)?.map(f64::from);
            let sign = match target_arguments.get("side").and_then(Node::head) {
                None | Some("front") => 1.0,
                Some("back") => -1.0,
                Some(_) => return Err(target.mistake("a side is front or back")),
            };
            let (instance, geometry, primitive) = (index("instance")?, index("geometry")?, index("primitive")?);
            let any = Ray::unbounded([0.0; 3], [1.0; 3]).and_then(|ray| ray.at_time(time)).map_err(refused)?;
            let found = scene.triangle_vertices(instance, geometry, primitive, time);
            let (vertices, space) = found
                .zip(scene.object_space(instance, &any))
                .ok_or_else(|| target.mistake("no ray can reach such a triangle"))?;
            in_front_of(vertices, [u, v], sign, &space)
        }
    };
    let [t_min, t_max] = range;
    Ray::new(origin, direction, t_min, t_max).and_then(|ray| ray.at_time(time)).map_err(refused)
}

/// Origin and direction of the ray along a triangle's normal that meets a point of it at t = 1, from the front if `sign`
/// is positive.
fn in_front_of(vertices: [[f32; 3]; 3], [u, v]: [f64; 2], sign: f64, space: &ObjectSpace) -> ([f32; 3], [f32; 3]) {
    let [a, b, c] = vertices.map(|vertex| vertex.map(f64::from));
    let edge = |end: [f64; 3]| -> [f64; 3] { std::array::from_fn(|axis| end[axis] - a[axis]) };
    let ([px, py, pz], [qx, qy, qz]) = (edge(b), edge(c));
    let normal = [py * qz - pz * qy, pz * qx - px * qz, px * qy - py * qx];
    let point: [f64; 3] = std::array::from_fn(|axis| (1.0 - u - v) * a[axis] + u * b[axis] + v * c[axis]);
    let start = std::array::from_fn(|axis| point[axis] + sign * normal[axis]);
    let to_world = |[x, y, z]: [f64; 3]| {
        space.object_to_world.map(|row| {
            let [p, q, r, s] = row.map(f64::from);
            p * x + q * y + r * z + s
        })
    };
    let (origin, target) = (to_world(start), to_world(point));
    (origin.map(|x| x as f32), std::array::from_fn(|axis| (target[axis] - origin[axis]) as f32))
}

fn answers(arguments: &Arguments<'_>) -> Result<Answers, Mistake> {
    let any_hit = match arguments.get("any_hit") {
        None => AnyHit::Accept,
        Some(node) => match node.name() {
            Some("accept") => AnyHit::Accept,
            Some("ignore") => AnyHit::Ignore,
            Some("end") => AnyHit::AcceptAndEndSearch,
            _ => return Err(node.mistake("an any-hit shader can accept, ignore or end the search: `end`")),
        },
    };
    let reports = arguments.get("reports").map(Node::float).transpose()?.map(|t| t as f32);
    Ok(Answers { any_hit, reports })
}

fn trace(scene: &omm_trace::Scene, ray: &Ray, options: &TraceOptions, mut answers: Answers) -> Found {
    let mut counters = Counters::default();
    let hit = scene.trace(ray, options, &mut answers, &mut counters);
    let space = hit.and_then(|hit| scene.object_space(hit.instance_id, ray));
    Found { hit, space, last_shader: options.last_shader(hit.as_ref()), ray: *ray, counters }
}

fn ask(scene: &omm_trace::Scene, ray: &Ray, options: &TraceOptions, answers: Answers) -> Result<Found, QueryError> {
    let mut query = RayQuery::new();
    query.initialize(scene, ray, options);
    while query.proceed()? {
        match query.candidate()? {
            QueryCandidate::Triangle(_) if answers.any_hit == AnyHit::Ignore => {}
            QueryCandidate::Triangle(_) => {
                query.confirm()?;
                if answers.any_hit == AnyHit::AcceptAndEndSearch {
                    query.terminate()?;
                }
            }
            QueryCandidate::Aabb(aabb) => {
                let within = |t: &f32| (aabb.t_min..=aabb.t_max).contains(t);
                answers.reports.filter(within).map_or(Ok(()), |t| query.generate(t))?;
            }
        }
    }
    Ok(Found {
        hit: query.committed()?.map(|committed| *committed.hit()),
        space: query.object_space(Intersection::Committed)?,
        last_shader: None,
        ray: *query.ray()?,
        counters: query.counters(),
    })
}

/// Compares what happened with what is expected.
fn judge(arguments: &Arguments<'_>, found: &Found) -> Result<Verdict, Mistake> {
    let mut wrong = Vec::new();
    if let Some(node) = arguments.get("is") {
        let outcome = match &found.hit {
            None => "miss",
            Some(hit) if hit.opaque => "opaque",
            Some(_) => "non_opaque",
        };
        match node.name() {
            Some("miss" | "opaque" | "non_opaque") if node.name() == Some(outcome) => {}
            Some("miss" | "opaque" | "non_opaque") => wrong.push(format!("it is {outcome}")),
            _ => return Err(node.mistake("an outcome is miss, opaque, non_opaque, or a text")),
        }
    }
    for (key, wanted) in arguments.get("reads").map(Node::map).transpose()?.unwrap_or_default() {
        let name = key.text()?;
        if name == "micromap" {
            let letter = found.hit.and_then(|hit| hit.micromap).map_or("none".to_owned(), letter);
            if wanted.describe() != letter {
                wrong.push(format!("micromap is {letter}"));
            }
            continue;
        }
        match read(name, found) {
            Read::Unknown => {
                return Err(key.mistake(format!("shaders read no \"{name}\"")).nearest(name, READS.iter().copied()));
            }
            Read::Nothing => wrong.push(format!("there is no {name}")),
            Read::Numbers(numbers) if flat(wanted)?.iter().map(|x| *x as f32).eq(numbers.iter().map(|x| *x as f32)) => {
            }
            Read::Numbers(numbers) => wrong.push(format!("{name} is {numbers:?}")),
        }
    }
    for (key, wanted) in arguments.get("counters").map(Node::map).transpose()?.unwrap_or_default() {
        let name = key.text()?;
        let counts = counts(&found.counters);
        let Some((_, count)) = counts.iter().find(|(known, _)| *known == name) else {
            let names = counts.iter().map(|(name, _)| *name);
            return Err(key.mistake(format!("nothing counts \"{name}\"")).nearest(name, names));
        };
        if wanted.integer::<u64>()? != *count {
            wrong.push(format!("{name} are {count}"));
        }
    }
    Ok(if wrong.is_empty() { Ok(()) } else { Err(wrong.join("; ")) })
}

fn letter(state: OpacityState) -> String {
    state.letter().to_string()
}

fn counts(counters: &Counters) -> [(&'static str, u64); 10] {
    let Counters {
        rays: _,
        candidates,
        ignored,
        culled_by_facing,
        culled_by_opacity,
        opaque,
        any_hit_calls,
        any_hit_ignored,
        intersection_calls,
        culled_aabbs,
        hits,
    } = *counters;
    [
        ("candidates", candidates),
        ("ignored", ignored),
        ("culledByFacing", culled_by_facing),
        ("culledByOpacity", culled_by_opacity),
        ("opaque", opaque),
        ("anyHitCalls", any_hit_calls),
        ("anyHitIgnored", any_hit_ignored),
        ("intersectionCalls", intersection_calls),
        ("culledAabbs", culled_aabbs),
        ("hits", hits),
    ]
}

/// What shaders read of a hit.
const READS: &[&str] = &[
    "t",
    "barycentrics",
    "hitKind",
    "instanceId",
    "instanceCustomIndex",
    "geometryIndex",
    "primitiveId",
    "micromap",
    "objectToWorld",
    "worldToObject",
    "objectRayOrigin",
    "objectRayDirection",
    "hitGroup",
    "missIndex",
    "worldRayOrigin",
    "worldRayDirection",
    "rayTime",
];

enum Read {
    Unknown,
    Nothing,
    Numbers(Vec<f64>),
}

fn read(name: &str, found: &Found) -> Read {
    let one = |number: u32| vec![f64::from(number)];
    let many = |numbers: &[f32]| numbers.iter().map(|number| f64::from(*number)).collect::<Vec<_>>();
    let hit = |of: &dyn Fn(&Hit) -> Vec<f64>| found.hit.as_ref().map(of);
    let space = |of: &dyn Fn(&ObjectSpace) -> Vec<f64>| found.space.as_ref().map(of);
    let numbers = match name {
        "t" => hit(&|hit| many(&[hit.t])),
        "barycentrics" => hit(&|hit| many(&hit.barycentrics)),
        "hitKind" => hit(&|hit| one(hit.kind.value().into())),
        "instanceId" => hit(&|hit| one(hit.instance_id)),
        "instanceCustomIndex" => hit(&|hit| one(hit.instance_custom_index)),
        "geometryIndex" => hit(&|hit| one(hit.geometry_index)),
        "primitiveId" => hit(&|hit| one(hit.primitive_id)),
        "objectToWorld" => space(&|space| many(space.object_to_world.as_flattened())),
        "worldToObject" => space(&|space| many(space.world_to_object.as_flattened())),
        "objectRayOrigin" => space(&|space| many(&space.origin)),
        "objectRayDirection" => space(&|space| many(&space.direction)),
        "hitGroup" => match found.last_shader {
            Some(LastShader::ClosestHit { hit_group }) => Some(vec![hit_group as f64]),
            _ => None,
        },
        "missIndex" => match found.last_shader {
            Some(LastShader::Miss { index }) => Some(one(index)),
            _ => None,
        },
        "worldRayOrigin" => Some(many(&found.ray.origin())),
        "worldRayDirection" => Some(many(&found.ray.direction())),
        "rayTime" => Some(many(&[found.ray.time()])),
        _ => return Read::Unknown,
    };
    numbers.map_or(Read::Nothing, Read::Numbers)
}

/// All numbers of a value, however they are grouped.
fn flat(node: &Node) -> Result<Vec<f64>, Mistake> {
    match &node.kind {
        Kind::List(nodes) | Kind::Tuple(None, nodes) => {
            Ok(nodes.iter().map(flat).collect::<Result<Vec<_>, _>>()?.concat())
        }
        _ => Ok(vec![node.float()?]),
    }
}

/// So many numbers in a list or in parentheses.
fn numbers<const N: usize>(node: &Node) -> Result<[f32; N], Mistake> {
    let found: Vec<f32> = flat(node)?.into_iter().map(|number| number as f32).collect();
    <[f32; N]>::try_from(found).map_err(|_| node.mistake(format!("{N} numbers are needed here")))
}
