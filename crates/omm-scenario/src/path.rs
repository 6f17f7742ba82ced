//! Places in a call, written as reports write them.
//!
//! `pInfos[0].pGeometries[0].geometry.triangles.pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>.indexStride` is a path.
//! A `…` or `...` in it stands for any steps, so `…indexStride` is enough where only one path ends so.

use crate::structure;
use crate::tree::Tree;

/// A part of a call: its path and the way to it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) path: String,
    pub(crate) route: Vec<usize>,
}

/// Every place in a call.
pub(crate) fn places(root: &Tree) -> Vec<Place> {
    let mut places = Vec::new();
    let mut walk = Walk { places: &mut places, route: Vec::new() };
    walk.inside(root, "", true);
    places
}

struct Walk<'a> {
    places: &'a mut Vec<Place>,
    route: Vec<usize>,
}

impl Walk<'_> {
    /// Part `index` of what the route leads to.
    fn part(&mut self, index: usize, tree: &Tree, path: String) {
        self.route.push(index);
        self.places.push(Place { path: path.clone(), route: self.route.clone() });
        self.inside(tree, &path, false);
        self.route.pop();
    }

    /// All parts of a value; `outermost` for the parameters of a command.
    fn inside(&mut self, tree: &Tree, path: &str, outermost: bool) {
        match tree.body() {
            Tree::Struct(_, fields) => {
                for (index, (name, field)) in fields.iter().enumerate() {
                    if *name == "next" {
                        self.chain(index, field, path);
                    } else {
                        let separator = separator(path);
                        self.part(index, field, format!("{path}{separator}{}", name_in_c(name, field, outermost)));
                    }
                }
            }
            Tree::List(items) => {
                for (index, item) in items.iter().enumerate() {
                    self.part(index, item, format!("{path}[{index}]"));
                }
            }
            // The union says which member it holds.
            Tree::Variant(_, variant, Some(body)) => {
                self.part(0, body, format!("{path}{}{}", separator(path), lower_first(variant)));
            }
            _ => {}
        }
    }

    /// A chain, whose entries go by the names of their structures; the second of a name and unknown ones by their numbers.
    fn chain(&mut self, index: usize, chain: &Tree, path: &str) {
        let path = format!("{path}{}pNext", separator(path));
        self.route.push(index);
        self.places.push(Place { path: path.clone(), route: self.route.clone() });
        let mut seen = Vec::new();
        if let Tree::List(entries) = chain {
            for (index, entry) in entries.iter().enumerate() {
                let path = match structure::chained_name(entry) {
                    Some(name) if !seen.contains(&name) => {
                        seen.push(name);
                        format!("{path}<{name}>")
                    }
                    _ => format!("{path}[{index}]"),
                };
                self.part(index, entry, path);
            }
        }
        self.route.pop();
    }
}

/// What stands between a path and its next step: parameters that point to one structure, and elements of arrays of pointers,
/// are followed by an arrow.
fn separator(path: &str) -> &'static str {
    let last = path.rsplit(['.', '>']).next().unwrap_or_default();
    let pointer = |prefix: &str| {
        last.strip_prefix(prefix).is_some_and(|rest| rest.starts_with(|letter: char| letter.is_ascii_uppercase()))
    };
    match path {
        "" => "",
        _ if pointer("p") && !path.ends_with(']') => "->",
        _ if pointer("pp") && last.matches('[').count() == 1 => "->",
        _ => ".",
    }
}

/// The name of a structure's field in the C interface.
pub(crate) fn field_name(name: &str, field: &Tree) -> String {
    match name {
        "next" => "pNext".to_owned(),
        _ => name_in_c(name, field, false),
    }
}

/// A field's name in the C interface.
fn name_in_c(name: &str, field: &Tree, outermost: bool) -> String {
    let special = match name {
        "ty" => "type",
        "geometry_pointers" => "ppGeometries",
        "usage_count_pointers" => "ppUsageCounts",
        "build_range_infos" => "ppBuildRangeInfos",
        _ => "",
    };
    if !special.is_empty() {
        return special.to_owned();
    }
    let camel = camel(name);
    let nested = |items: &Vec<Tree>| items.iter().any(|item| matches!(item, Tree::Some(_) | Tree::None));
    match field {
        Tree::List(items) if nested(items) => format!("pp{}", upper_first(&camel)),
        Tree::List(_) | Tree::Some(_) | Tree::None => format!("p{}", upper_first(&camel)),
        Tree::Struct(..) if outermost => format!("p{}", upper_first(&camel)),
        _ => camel,
    }
}

/// `index_stride` as `indexStride`.
fn camel(name: &str) -> String {
    let mut words = name.split('_');
    let first = words.next().unwrap_or_default().to_owned();
    words.fold(first, |name, word| name + &upper_first(word))
}

fn upper_first(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn lower_first(name: &str) -> String {
    let mut letters = name.chars();
    letters.next().map_or_else(String::new, |first| first.to_lowercase().chain(letters).collect())
}

/// A path with `…` for what is left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Pattern {
    pieces: Vec<String>,
}

impl Pattern {
    /// A path to compare with; arrows and dots are the same.
    pub(crate) fn new(text: &str) -> Self {
        let pieces =
            plain(text).replace("...", "…").split('…').map(|piece| piece.trim_matches('.').to_owned()).collect();
        Self { pieces }
    }

    /// Whether nothing is left out.
    pub(crate) fn is_exact(&self) -> bool {
        self.pieces.len() < 2
    }

    /// Whether a path is meant. Only whole steps are left out.
    pub(crate) fn matches(&self, path: &str) -> bool {
        let path = plain(path);
        match self.pieces.as_slice() {
            [] => path.is_empty(),
            [only] => path == *only,
            [first, middle @ .., last] => {
                let Some(mut at) = starts(&path, first) else { return false };
                for piece in middle {
                    let Some(found) = find(&path, piece, at) else { return false };
                    at = found + piece.len();
                }
                let end = path.len().saturating_sub(last.len());
                end >= at && path.ends_with(last.as_str()) && is_step(&path, end)
            }
        }
    }
}

/// A path without arrows.
fn plain(path: &str) -> String {
    path.replace("->", ".")
}

/// Where a path goes on behind its first piece.
fn starts(path: &str, first: &str) -> Option<usize> {
    let rest = path.strip_prefix(first)?;
    let whole = first.is_empty() || first.ends_with('<') || rest.is_empty() || rest.starts_with(['.', '[', '<']);
    whole.then_some(first.len())
}

/// Where a piece stands in a path as whole steps, from `at` on.
fn find(path: &str, piece: &str, at: usize) -> Option<usize> {
    let rest = path.get(at..)?;
    let found = rest.match_indices(piece).map(|(found, _)| found + at);
    found.into_iter().find(|found| is_step(path, *found))
}

/// Whether a step begins there.
fn is_step(path: &str, at: usize) -> bool {
    let before = path.get(..at).unwrap_or_default();
    before.is_empty()
        || before.ends_with('.')
        || path.get(at..).is_some_and(|rest| rest.is_empty() || rest.starts_with(['[', '<', '>']))
}

#[cfg(test)]
mod tests {
    use omm_model::call::Call;
    use omm_model::vk;

    use super::*;

    fn build() -> Tree {
        let attached = vk::TrianglesOpacityMicromap::default();
        let next = vec![attached.clone().into(), attached.into(), vk::ChainStructure::Unknown(vk::StructureType(7))];
        let triangles = vk::GeometryTrianglesData { next, ..Default::default() };
        let geometry = vk::Geometry { geometry: vk::GeometryData::Triangles(triangles), ..Default::default() };
        let usages = vk::GeometryMicromapData {
            usage_count_pointers: Some(vec![vk::MicromapUsage::default()]),
            ..Default::default()
        };
        let micromap = vk::Geometry { next: vec![usages.into()], ..Default::default() };
        let call = Call::CmdBuildAccelerationStructures {
            command_buffer: vk::CommandBuffer(1),
            infos: vec![vk::BuildGeometryInfo {
                geometries: Some(vec![geometry]),
                geometry_pointers: Some(vec![micromap]),
                ..Default::default()
            }],
            build_range_infos: vec![Some(vec![vk::BuildRangeInfo::default()])],
        };
        Tree::of(&call).unwrap()
    }

    #[test]
    fn paths_are_those_of_reports() {
        let tree = build();
        let places = places(&tree);
        for place in &places {
            assert!(tree.at(&place.route).is_some(), "{}", place.path);
        }
        let paths: Vec<&str> = places.iter().map(|place| place.path.as_str()).collect();
        insta::assert_snapshot!(paths.join("\n"));
        let query = Call::GetAccelerationStructureBuildSizes {
            device: vk::Device(1),
            build_type: vk::AccelerationStructureBuildType::DEVICE,
            build_info: vk::BuildGeometryInfo::default(),
            max_primitive_counts: Some(vec![1]),
        };
        let places = super::places(&Tree::of(&query).unwrap());
        assert!(places.iter().any(|place| place.path == "pBuildInfo->scratchData.deviceAddress"), "{places:?}");
        assert!(places.iter().any(|place| place.path == "pMaxPrimitiveCounts[0]"), "{places:?}");
    }

    #[test]
    fn steps_can_be_left_out() {
        let path = "pInfos[0].ppGeometries[0]->pNext<VkStructure>.indexStride";
        for pattern in [
            path,
            "pInfos[0].ppGeometries[0].pNext<VkStructure>.indexStride",
            "…indexStride",
            "...indexStride",
            "…",
            "pInfos[0]…",
            "pInfos[0]….indexStride",
            "pInfos…indexStride",
            "…ppGeometries[0]…indexStride",
            "…pNext<VkStructure>.indexStride",
            "…pNext<…>.indexStride",
            "pInfos[0].ppGeometries[0].pNext<…>.indexStride",
        ] {
            assert!(Pattern::new(pattern).matches(path), "{pattern}");
        }
        for pattern in
            ["…Stride", "pInfo…", "pInfos[0]", "…ppGeometries[1]…", "…indexStride…ppGeometries", "", "indexStride"]
        {
            assert!(!Pattern::new(pattern).matches(path), "{pattern}");
        }
    }
}
