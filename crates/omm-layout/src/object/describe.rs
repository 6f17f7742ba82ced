//! A built object field by field: what each of its bytes is.

use omm_model::opacity::OpacityState;
use omm_model::vk::MotionInstanceData;

use super::header::{ObjectForm, ObjectHeader};
use super::{BlasObject, GeometryKind, GeometryView, MicromapObject, Object, TlasObject};
use crate::motion_instance;
use crate::packed::PackedStates;

/// One run of bytes of an object and what it means.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Bytes from the start of the object.
    pub offset: u64,
    /// Bytes that it takes, at least 1.
    pub size: u64,
    /// Its name, as a path: `geometries[2].primitives[0].vertex 1`.
    pub name: String,
    /// What it holds, for people.
    pub value: String,
}

impl Object<'_> {
    /// Gives `visit` every field from the first byte to the last: each begins where the one before it ended, and the last ends with
    /// the object.
    pub fn describe(&self, visit: &mut dyn FnMut(Field)) {
        let mut walk = Walk { bytes: self.as_bytes(), at: 0, visit };
        walk.header();
        for (index, address) in self.references().enumerate() {
            walk.field(8, || format!("references[{index}]"), |_| format!("{address:#018x}"));
        }
        match self {
            Self::Micromap(object) => walk.micromap(object),
            Self::BottomLevel(object) => walk.bottom_level(object),
            Self::TopLevel(object) => walk.top_level(object),
        }
        let rest = (walk.bytes.len() as u64).saturating_sub(walk.at);
        walk.field(rest, || "padding".to_owned(), |_| format!("{rest} bytes up to the size that the build promised"));
    }
}

/// A position that only moves forwards.
struct Walk<'a, 'v> {
    bytes: &'a [u8],
    at: u64,
    visit: &'v mut dyn FnMut(Field),
}

impl<'a> Walk<'a, '_> {
    /// The next `size` bytes; no field at all if that is 0.
    fn field(&mut self, size: u64, name: impl FnOnce() -> String, value: impl FnOnce(&'a [u8]) -> String) {
        if size == 0 {
            return;
        }
        let offset = self.at;
        self.at = offset.saturating_add(size);
        let range = (usize::try_from(offset), usize::try_from(self.at));
        // An object's structure was proved, so its fields lie within its bytes.
        let bytes = match range {
            (Ok(start), Ok(end)) => self.bytes.get(start..end).unwrap_or_default(),
            _ => &[],
        };
        (self.visit)(Field { offset, size, name: name(), value: value(bytes) });
    }

    fn reserved(&mut self, size: u64, name: impl FnOnce() -> String) {
        self.field(size, name, |_| "zero".to_owned());
    }

    fn header(&mut self) {
        let names = [
            (8, "magic"),
            (4, "kind"),
            (4, "form"),
            (8, "size"),
            (8, "compacted_size"),
            (4, "flags"),
            (4, "reference_count"),
            (8, "primitive_count"),
            (4, "geometry_count"),
            (12, "reserved"),
        ];
        for (size, name) in names {
            self.field(
                size,
                || name.to_owned(),
                |bytes| match (name, number(bytes)) {
                    ("magic", _) => format!("\"{}\"", bytes.escape_ascii()),
                    ("kind", 1) => "1 (micromap)".to_owned(),
                    ("kind", 2) => "2 (bottom-level acceleration structure)".to_owned(),
                    ("kind", 3) => "3 (top-level acceleration structure)".to_owned(),
                    ("form", 0) => "0 (built)".to_owned(),
                    ("form", 1) => "1 (compacted)".to_owned(),
                    ("flags", flags) => format!("{flags:#x}"),
                    ("reserved", _) => "zero".to_owned(),
                    (_, number) => number.to_string(),
                },
            );
        }
    }

    fn micromap(&mut self, object: &MicromapObject<'_>) {
        for index in 0..object.triangle_count() {
            let name = |field: &str| format!("triangles[{index}].{field}");
            self.field(8, || name("data_offset"), |bytes| number(bytes).to_string());
            self.field(2, || name("subdivision_level"), |bytes| number(bytes).to_string());
            self.field(
                2,
                || name("format"),
                |bytes| match number(bytes) {
                    1 => "1 (2-state)".to_owned(),
                    other => format!("{other} (4-state)"),
                },
            );
            self.reserved(4, || name("reserved"));
        }
        let data = self.at;
        for (index, triangle) in object.triangles().enumerate() {
            let record = ObjectHeader::SIZE + 16 * index as u64;
            let start = data.saturating_add(self.number_at(record));
            // In a compacted object the block may be one that was named before.
            if start < self.at {
                continue;
            }
            let size = triangle.data.len() as u64;
            let states = PackedStates::new(triangle.data, triangle.format, triangle.subdivision_level);
            let value = |_: &[u8]| states.map_or_else(|error| error.to_string(), |states| summarise(&states));
            self.field(size, || format!("data of triangles[{index}]"), value);
            if object.header().form == ObjectForm::Built {
                let end = data.saturating_add((self.at - data).next_multiple_of(8)).min(self.bytes.len() as u64);
                self.reserved(end.saturating_sub(self.at), || format!("padding of triangles[{index}]"));
            }
        }
    }

    /// The u64 at `offset`.
    fn number_at(&self, offset: u64) -> u64 {
        let bytes = usize::try_from(offset).ok().and_then(|offset| self.bytes.get(offset..)?.first_chunk());
        bytes.map_or(0, |bytes| u64::from_le_bytes(*bytes))
    }

    fn bottom_level(&mut self, object: &BlasObject<'_>) {
        for index in 0..object.geometry_count() {
            let name = |field: &str| format!("geometries[{index}].{field}");
            self.field(
                4,
                || name("type"),
                |bytes| match number(bytes) {
                    0 => "0 (triangles)".to_owned(),
                    other => format!("{other} (boxes)"),
                },
            );
            self.field(4, || name("flags"), |bytes| format!("{:#x}", number(bytes)));
            self.field(4, || name("primitive_count"), |bytes| number(bytes).to_string());
            self.field(4, || name("stored_count"), |bytes| number(bytes).to_string());
            self.field(
                4,
                || name("micromap"),
                |bytes| match number(bytes) {
                    0xffff_ffff => "none".to_owned(),
                    0xffff_fffe => "a null micromap".to_owned(),
                    entry => format!("references[{entry}]"),
                },
            );
            self.field(
                4,
                || name("motion"),
                |bytes| match number(bytes) {
                    0 => "0 (none)".to_owned(),
                    other => format!("{other} (vertices at time 1)"),
                },
            );
            self.field(8, || name("data_offset"), |bytes| number(bytes).to_string());
        }
        for (index, geometry) in object.geometries().enumerate() {
            for record in 0..geometry.stored_count() {
                let at = format!("geometries[{index}].primitives[{record}]");
                self.primitive(&at, &geometry);
            }
        }
    }

    fn primitive(&mut self, at: &str, geometry: &GeometryView<'_>) {
        let name = |field: &str| format!("{at}.{field}");
        let mut inactive = false;
        self.field(
            4,
            || name("index"),
            |bytes| {
                inactive = number(bytes) == u64::from(u32::MAX);
                if inactive { "inactive".to_owned() } else { number(bytes).to_string() }
            },
        );
        let kind = geometry.kind();
        let corners: &[&str] = match kind {
            GeometryKind::Triangles => &["vertex 0", "vertex 1", "vertex 2"],
            GeometryKind::Aabbs => &["lower corner", "upper corner"],
        };
        let map = if geometry.micromap().is_some() && kind == GeometryKind::Triangles { 4 } else { 0 };
        let end: &[&str] = match geometry.has_motion() {
            true => &["vertex 0 at time 1", "vertex 1 at time 1", "vertex 2 at time 1"],
            false => &[],
        };
        if inactive {
            return self.reserved(12 * (corners.len() + end.len()) as u64 + map, || name("unused"));
        }
        for corner in corners {
            self.field(12, || name(corner), floats);
        }
        self.field(
            map,
            || name("map"),
            |bytes| {
                let value = number(bytes) as u32;
                match value.cast_signed() {
                    -1 => "-1 (fully transparent)".to_owned(),
                    -2 => "-2 (fully opaque)".to_owned(),
                    -3 => "-3 (fully unknown transparent)".to_owned(),
                    -4 => "-4 (fully unknown opaque)".to_owned(),
                    index => format!("micromap triangle {index}"),
                }
            },
        );
        for corner in end {
            self.field(12, || name(corner), floats);
        }
    }

    fn top_level(&mut self, object: &TlasObject<'_>) {
        for (index, instance) in object.instances().enumerate() {
            let name = |field: &str| format!("instances[{index}].{field}");
            let end = self.at + motion_instance::SIZE as u64;
            if object.has_motion() {
                let ty = match instance {
                    MotionInstanceData::StaticInstance(_) => "0 (static)",
                    MotionInstanceData::MatrixMotionInstance(_) => "1 (matrix motion)",
                    MotionInstanceData::SrtMotionInstance(_) => "2 (SRT motion)",
                };
                self.field(4, || name("type"), |_| ty.to_owned());
                self.reserved(4, || name("motion_flags"));
            }
            let rows: &[&str] = match instance {
                MotionInstanceData::StaticInstance(_) => &["transform row 0", "transform row 1", "transform row 2"],
                MotionInstanceData::MatrixMotionInstance(_) => &[
                    "transformT0 row 0",
                    "transformT0 row 1",
                    "transformT0 row 2",
                    "transformT1 row 0",
                    "transformT1 row 1",
                    "transformT1 row 2",
                ],
                MotionInstanceData::SrtMotionInstance(_) => &[
                    "transformT0 sx, a, b, pvx",
                    "transformT0 sy, c, pvy, sz",
                    "transformT0 pvz, qx, qy, qz",
                    "transformT0 qw, tx, ty, tz",
                    "transformT1 sx, a, b, pvx",
                    "transformT1 sy, c, pvy, sz",
                    "transformT1 pvz, qx, qy, qz",
                    "transformT1 qw, tx, ty, tz",
                ],
            };
            for row in rows {
                self.field(16, || name(row), floats);
            }
            self.field(3, || name("custom_index"), |bytes| number(bytes).to_string());
            self.field(1, || name("mask"), |bytes| format!("{:#04x}", number(bytes)));
            self.field(3, || name("record_offset"), |bytes| number(bytes).to_string());
            self.field(1, || name("flags"), |bytes| format!("{:#x}", number(bytes)));
            self.field(4, || name("reference"), |bytes| format!("references[{}] if active", number(bytes)));
            self.field(
                4,
                || name("active"),
                |bytes| match number(bytes) {
                    0 => "0 (inactive)".to_owned(),
                    other => format!("{other} (active)"),
                },
            );
            if object.has_motion() {
                self.reserved(end.saturating_sub(self.at), || name("reserved"));
            }
        }
    }
}

/// The little-endian number of up to eight bytes.
fn number(bytes: &[u8]) -> u64 {
    bytes.iter().take(8).rev().fold(0, |number, byte| number << 8 | u64::from(*byte))
}

fn floats(bytes: &[u8]) -> String {
    let numbers: Vec<_> = bytes.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes).to_string()).collect();
    format!("({})", numbers.join(", "))
}

/// The states one by one if they are few, otherwise how many there are of each.
fn summarise(states: &PackedStates<'_>) -> String {
    if states.len() <= 64 {
        return states.letters();
    }
    let counts = OpacityState::ALL.map(|state| {
        let count = states.iter().filter(|found| *found == state).count();
        (count > 0).then(|| format!("{count} {}", state.letter()))
    });
    counts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}
