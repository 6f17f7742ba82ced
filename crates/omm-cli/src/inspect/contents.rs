//! What our own payload holds, counted.

use std::collections::BTreeMap;
use std::io::{self, Write};

use omm_layout::object::{Object, ObjectForm};
use omm_layout::packed::PackedStates;
use omm_model::opacity::OpacityState;
use omm_model::special_index::TriangleMap;
use omm_serialize::Blob;
use serde::Serialize;

/// Numbers by name, in the order of the names.
type Counts = BTreeMap<String, u64>;

/// The object in the payload.
#[derive(Serialize)]
pub(super) struct Contents {
    form: &'static str,
    /// Bytes of the object when compacted.
    compacted_size: u64,
    #[serde(flatten)]
    kind: Kind,
}

#[derive(Serialize)]
#[serde(untagged)]
enum Kind {
    Micromap {
        triangles: u32,
        /// Triangles by level and format, finest first: the usage counts.
        usage: Vec<Usage>,
        /// Elements by state; data that triangles share counts for each.
        states: Counts,
    },
    BottomLevel {
        geometries: u32,
        primitives: u64,
        active: u64,
        /// Entries of the micromap index buffers of active triangles, by what they say.
        maps: Counts,
    },
    TopLevel {
        instances: u32,
        active: u64,
    },
}

#[derive(Serialize)]
struct Usage {
    level: u32,
    /// 1: 2-state, 2: 4-state.
    format: u16,
    count: u32,
}

const fn state_name(state: OpacityState) -> &'static str {
    match state {
        OpacityState::Transparent => "transparent",
        OpacityState::Opaque => "opaque",
        OpacityState::UnknownTransparent => "unknown_transparent",
        OpacityState::UnknownOpaque => "unknown_opaque",
    }
}

impl Contents {
    /// Counts what `blob` holds, if it is ours.
    pub(super) fn new(blob: &Blob<'_>) -> Option<Self> {
        let bytes = blob.to_object().ok()?;
        let object = Object::read(&bytes).ok()?;
        let form = match object.header().form {
            ObjectForm::Built => "built",
            ObjectForm::Compacted => "compacted",
        };
        Some(Self { form, compacted_size: object.header().compacted_size, kind: Kind::new(&object) })
    }

    pub(super) fn print(&self, out: &mut dyn Write) -> io::Result<()> {
        let Self { form, compacted_size, kind } = self;
        let mut line = |name: &str, value: String| writeln!(out, "{name:<19} {value}");
        line("form", format!("{form}, {compacted_size} bytes when compacted"))?;
        match kind {
            Kind::Micromap { triangles, usage, states } => {
                line("triangles", triangles.to_string())?;
                for Usage { level, format, count } in usage {
                    line("", format!("{count} of level {level}, {}-state", 2 * format))?;
                }
                line("elements", states.values().sum::<u64>().to_string())?;
                for (name, count) in states {
                    line("", format!("{count} {}", name.replace('_', " ")))?;
                }
            }
            Kind::BottomLevel { geometries, primitives, active, maps } => {
                line("geometries", geometries.to_string())?;
                line("primitives", format!("{primitives}, {active} of them active"))?;
                for (name, count) in maps {
                    line("", format!("{count} mapped to {}", name.replace('_', " ")))?;
                }
            }
            Kind::TopLevel { instances, active } => {
                line("instances", format!("{instances}, {active} of them active"))?;
            }
        }
        Ok(())
    }
}

impl Kind {
    fn new(object: &Object<'_>) -> Self {
        match object {
            Object::Micromap(object) => {
                let mut counts = [0_u64; 4];
                for triangle in object.triangles() {
                    let states = PackedStates::new(triangle.data, triangle.format, triangle.subdivision_level);
                    for state in states.iter().flat_map(PackedStates::iter) {
                        if let Some(count) = counts.get_mut(usize::from(state.value())) {
                            *count += 1;
                        }
                    }
                }
                let usage = object.usage();
                let usage = usage.iter().map(|usage| Usage {
                    level: usage.subdivision_level.get(),
                    format: usage.format.value(),
                    count: usage.count,
                });
                let states = OpacityState::ALL.into_iter().map(state_name).map(str::to_owned).zip(counts);
                Self::Micromap {
                    triangles: object.triangle_count(),
                    usage: usage.collect(),
                    states: states.filter(|(_, count)| *count > 0).collect(),
                }
            }
            Object::BottomLevel(object) => {
                let (mut active, mut maps) = (0, Counts::new());
                for geometry in object.geometries() {
                    active += geometry.aabbs().count() as u64;
                    for triangle in geometry.triangles() {
                        active += 1;
                        let name = match triangle.map {
                            None => continue,
                            Some(TriangleMap::Triangle(_)) => "a_micromap_triangle".to_owned(),
                            Some(TriangleMap::SpecialIndex(special)) => {
                                format!("fully_{}", state_name(special.state()))
                            }
                        };
                        *maps.entry(name).or_default() += 1;
                    }
                }
                let primitives = object.header().primitive_count;
                Self::BottomLevel { geometries: object.geometry_count(), primitives, active, maps }
            }
            Object::TopLevel(object) => Self::TopLevel {
                instances: object.instance_count(),
                active: object.instances().filter(|it| it.acceleration_structure_reference() != 0).count() as u64,
            },
        }
    }
}
