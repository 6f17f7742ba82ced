//! `micromap(["TOUu", (states: "O", level: 0)])`: opacity as letters, one for each microtriangle.

use omm_layout::packed;
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::vk;

use crate::error::Mistake;
use crate::node::{Arguments, Kind, Node};
use crate::world::{Cost, Preparation, Recipe, World};

/// Level and format of each triangle of a micromap.
pub(crate) type MicromapTriangles = Vec<(u32, u32)>;

/// What a micromap is built from.
#[derive(Debug, Default)]
struct Input {
    data: Vec<u8>,
    entries: Vec<vk::MicromapTriangle>,
}

impl World {
    /// `micromap(…)` and `micromap_ext(…)`.
    pub(super) fn micromap(
        &mut self,
        name: &str,
        node: &Node,
        wanted: Preparation,
        is_ext: bool,
    ) -> Result<String, Mistake> {
        let arguments = Arguments::of(node, &["triangles", "flags", "stride", "usage", "created_as", "size", "built"])?;
        let mut input = Input::default();
        for triangle in arguments.need("triangles")?.list()? {
            self.triangle(triangle, &mut input)?;
        }
        let stride = arguments.get("stride").map_or(Ok(8), Node::integer)?;
        let entries: Vec<_> = input.entries.iter().map(omm_layout::triangle::encode).collect();
        let array = self.spread(&entries, stride, node)?;
        let usages = match arguments.get("usage") {
            Some(node) => node.list()?.iter().map(usage).collect::<Result<_, _>>()?,
            None => histogram(&input.entries),
        };
        let data = self.upload(&format!("{name}.data"), &input.data, node)?;
        let triangle_array = self.upload(&format!("{name}.triangles"), &array, node)?;
        let recipe = if is_ext {
            let usage = |&(count, subdivision_level, format)| vk::MicromapUsageExt { count, subdivision_level, format };
            Recipe::Micromap(Box::new(vk::MicromapBuildInfo {
                flags: self.typed_or_default(arguments.get("flags"))?,
                usage_counts: Some(usages.iter().map(usage).collect()),
                data: data.into(),
                triangle_array: triangle_array.into(),
                triangle_array_stride: stride,
                ..Default::default()
            }))
        } else {
            let usage = |&(count, subdivision_level, format): &(u32, u32, u32)| vk::MicromapUsage {
                count,
                subdivision_level,
                format: vk::OpacityMicromapFormat(format.cast_signed()),
            };
            let data = vk::GeometryMicromapData {
                usage_counts: Some(usages.iter().map(usage).collect()),
                data,
                triangle_array,
                triangle_array_stride: stride,
                ..Default::default()
            };
            let geometry = vk::Geometry {
                next: vec![data.into()],
                geometry_type: vk::GeometryType::MICROMAP,
                ..Default::default()
            };
            let info = Box::new(vk::BuildGeometryInfo {
                ty: vk::AccelerationStructureType::OPACITY_MICROMAP,
                flags: self.typed_or_default(arguments.get("flags"))?,
                geometries: Some(vec![geometry]),
                ..Default::default()
            });
            Recipe::AccelerationStructure { info, ranges: None }
        };
        let (storage, wanted) = self.storage(&arguments, wanted)?;
        self.make_structure(name, recipe, &storage, wanted, node)?;
        let triangles: MicromapTriangles =
            input.entries.iter().map(|entry| (entry.subdivision_level.into(), entry.format.into())).collect();
        let count = super::counted(triangles.len(), "triangle", "triangles");
        self.micromaps.insert(name.to_owned(), triangles);
        Ok(format!("{}micromap of {count}", if is_ext { "EXT " } else { "" }))
    }

    /// One triangle of a micromap: `"TOUu"`, or `(states, level, format, offset, count)`.
    fn triangle(&mut self, node: &Node, input: &mut Input) -> Result<(), Mistake> {
        let text = |node: &Node| matches!(node.kind, Kind::Text(_));
        let arguments = if text(node) {
            None
        } else {
            Some(Arguments::of(node, &["states", "level", "format", "offset", "count"])?)
        };
        let get = |name: &str| arguments.as_ref().and_then(|arguments| arguments.get(name));
        let letters = if text(node) { Some(node) } else { get("states") };
        let states = match letters {
            Some(node) => packed::states(node.text()?).map_err(|error| node.mistake(error.to_string()))?,
            None => Vec::new(),
        };
        let level = match get("level") {
            Some(node) => SubdivisionLevel::new(node.integer()?).map_err(|error| node.mistake(error.to_string()))?,
            None => SubdivisionLevel::all()
                .find(|level| level.microtriangles() as usize == states.len())
                .ok_or_else(|| node.mistake(format!("{} states fill no level: 1, 4, 16, 64 … do", states.len())))?,
        };
        let format = get("format").map_or(Ok(2), format)?;
        let count: u64 = get("count").map_or(Ok(1), Node::integer)?;
        let microtriangles = u64::from(level.microtriangles());
        self.spend(Cost::Primitives, count, node)?;
        if states.len() as u64 > microtriangles {
            let message = format!("{} states are more than the {microtriangles} of level {level}", states.len());
            return Err(node.mistake(message));
        }
        let packing = OpacityMicromapFormat::from_value(format).unwrap_or(OpacityMicromapFormat::FourState);
        for _ in 0..count {
            let offset = match get("offset") {
                Some(node) => node.integer()?,
                None => u32::try_from(input.data.len()).map_err(|_| node.mistake("offsets have 32 bits"))?,
            };
            if !states.is_empty() {
                self.spend(Cost::Microtriangles, microtriangles, node)?;
                // A level is filled by repeating what is given.
                let all: Vec<_> = states.iter().copied().cycle().take(microtriangles as usize).collect();
                let bytes = packed::pack(packing, &all).map_err(|error| node.mistake(error.to_string()))?;
                let start = offset as usize;
                self.spend(Cost::Bytes, (start + bytes.len()).saturating_sub(input.data.len()) as u64, node)?;
                if input.data.len() < start + bytes.len() {
                    input.data.resize(start + bytes.len(), 0);
                }
                if let Some(target) = input.data.get_mut(start..start + bytes.len()) {
                    target.copy_from_slice(&bytes);
                }
            }
            // The level fits into 16 bits, and so does every format that `format` lets through.
            let (subdivision_level, format) = (level.get() as u16, format as u16);
            input.entries.push(vk::MicromapTriangle { data_offset: offset, subdivision_level, format });
        }
        Ok(())
    }
}

/// `two_state`, `four_state`, a name of the API or a number of 16 bits.
fn format(node: &Node) -> Result<u32, Mistake> {
    match node.name() {
        Some("two_state") => Ok(1),
        Some("four_state") => Ok(2),
        Some(name) => match crate::constant::of_any_type(name).and_then(|value| u16::try_from(value).ok()) {
            Some(value) => Ok(value.into()),
            None => Err(node.mistake(format!("{name} is no format")).nearest(name, ["two_state", "four_state"])),
        },
        None => node.integer::<u16>().map(u32::from),
    }
}

/// `(count, level, format)`
fn usage(node: &Node) -> Result<(u32, u32, u32), Mistake> {
    let arguments = Arguments::of(node, &["count", "level", "format"])?;
    Ok((
        arguments.need("count")?.integer()?,
        arguments.need("level")?.integer()?,
        arguments.get("format").map_or(Ok(2), format)?,
    ))
}

/// How many triangles there are of each level and format, in the order in which these appear.
fn histogram(entries: &[vk::MicromapTriangle]) -> Vec<(u32, u32, u32)> {
    let mut usages: Vec<(u32, u32, u32)> = Vec::new();
    for entry in entries {
        let (level, format) = (u32::from(entry.subdivision_level), u32::from(entry.format));
        match usages.iter_mut().find(|usage| (usage.1, usage.2) == (level, format)) {
            Some(usage) => usage.0 += 1,
            None => usages.push((1, level, format)),
        }
    }
    usages
}
