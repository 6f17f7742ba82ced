//! Holds `omm_model::vk` against the Vulkan registry: the value of every constant, the order of every structure's fields, and
//! that nothing of the extensions in scope is missing.
//!
//! The registry is `vk.xml` at `OMM_REGISTRY`, or beside the workspace, where there is one. Otherwise it is the extract in
//! `registry/extract.txt`, which in the former case is compared with `vk.xml` and with `OMM_BLESS=1` written anew.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "registry/coverage.rs"]
mod coverage;
#[path = "registry/extract.rs"]
mod extract;
#[path = "registry/xml.rs"]
mod xml;

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use coverage::{Coverage, coverage};
use extract::{Extract, Member};
use omm_model::vk::StructureType;

/// The extensions in scope; of one, only the blocks with the `depends` given.
///
/// Their names and revisions, which are constants too, are left out: no call carries them.
const EXTENSIONS: &[xml::InScope] = &[
    ("VK_KHR_opacity_micromap", None),
    ("VK_EXT_opacity_micromap", None),
    ("VK_KHR_acceleration_structure", None),
    ("VK_KHR_device_address_commands", Some("VK_KHR_acceleration_structure")),
    ("VK_KHR_deferred_host_operations", None),
    ("VK_NV_ray_tracing_motion_blur", None),
];

/// Types that the extensions bring in and the model leaves out, with the reason.
const LEFT_OUT: &[(&str, &str)] =
    &[("VkDebugReportObjectTypeEXT", "names objects to VK_EXT_debug_report, which VkObjectType replaced")];

/// Constants whose name begins with a digit, with the words that we put there.
const RENAMED: &[(&str, &str)] = &[
    ("VK_OPACITY_MICROMAP_FORMAT_2_STATE_KHR", "TWO_STATE"),
    ("VK_OPACITY_MICROMAP_FORMAT_4_STATE_KHR", "FOUR_STATE"),
    ("VK_QUERY_RESULT_64_BIT", "RESULT_64"),
];

/// The text of `vk.xml`, where there is one.
fn registry_text() -> Option<String> {
    let path = match std::env::var_os("OMM_REGISTRY") {
        Some(path) => PathBuf::from(path),
        None => Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/registry/vk.xml"),
    };
    path.exists().then(|| std::fs::read_to_string(&path).unwrap())
}

fn extract_path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/registry/extract.txt")
}

/// What the registry says, from `vk.xml` or the extract.
fn registry(coverage: &Coverage) -> Extract {
    match registry_text() {
        Some(text) => xml::extract(&text, EXTENSIONS, coverage),
        None => Extract::parse(&std::fs::read_to_string(extract_path()).unwrap()),
    }
}

#[test]
fn the_extract_says_what_the_registry_says() {
    let Some(text) = registry_text() else {
        println!("skipped: vk.xml absent, the extract stands in for it");
        return;
    };
    let extract = xml::extract(&text, EXTENSIONS, &coverage());
    let text = extract.to_string();
    assert_eq!(Extract::parse(&text), extract, "the text form loses something");
    if std::env::var_os("OMM_BLESS").is_some() {
        std::fs::write(extract_path(), &text).unwrap();
    }
    let kept = std::fs::read_to_string(extract_path()).unwrap_or_default();
    assert!(kept == text, "registry/extract.txt differs from vk.xml; OMM_BLESS=1 writes it anew");
}

#[test]
fn everything_required_has_a_counterpart() {
    let coverage = coverage();
    let ours: BTreeSet<&str> = coverage
        .enumerations
        .iter()
        .map(|enumeration| enumeration.name)
        .chain(coverage.structures.iter().map(|(name, _)| *name))
        .chain(coverage.unions.iter().map(|(name, _)| *name))
        .chain(coverage.handles.iter().map(|(name, _)| *name))
        .collect();
    let left_out: BTreeSet<&str> = LEFT_OUT.iter().map(|(name, _)| *name).collect();
    let registry = registry(&coverage);
    let required: BTreeSet<&str> = registry.required.values().map(String::as_str).collect();
    assert!(required.len() > 60, "only {} types are required", required.len());
    let missing: Vec<_> = required.iter().filter(|name| !ours.contains(*name) && !left_out.contains(*name)).collect();
    assert!(missing.is_empty(), "without a counterpart: {missing:?}");
    for name in left_out {
        assert!(required.contains(name) && !ours.contains(name), "{name} does not have to be left out");
    }
}

#[test]
fn constants_have_the_value_of_the_registry() {
    let coverage = coverage();
    let registry = registry(&coverage);
    for enumeration in &coverage.enumerations {
        let name = enumeration.name;
        let ours: BTreeMap<&str, i64> = enumeration.constants.iter().copied().collect();
        let theirs = registry.constants.get(name).unwrap_or_else(|| panic!("{name} is not in the extract"));
        for (constant, value) in &ours {
            assert_eq!(Some(value), theirs.get(*constant), "{name}: {constant}");
        }
        let missing: Vec<_> = theirs.keys().filter(|constant| !ours.contains_key(constant.as_str())).collect();
        assert!(missing.is_empty(), "{name} is without {missing:?}");
    }
}

#[test]
fn constants_are_called_what_the_registry_calls_them() {
    for enumeration in coverage().enumerations {
        let mut prefix = None;
        let mut values = BTreeSet::new();
        for (canonical, value) in enumeration.constants {
            if !values.insert(value) {
                continue; // Another name of a value that its first name was compared for.
            }
            let identifier = (enumeration.identifier)(*value);
            if RENAMED.contains(&(*canonical, identifier.as_str())) {
                continue;
            }
            let short = without_author(canonical).trim_end_matches("_BIT");
            let found = short.strip_suffix(&*identifier).or(canonical.strip_suffix(&*identifier));
            assert!(found.is_some(), "{canonical} is called {identifier}");
            assert_eq!(*prefix.get_or_insert(found), found, "{canonical} is called {identifier}");
        }
    }
}

#[test]
fn structures_have_the_fields_of_the_registry_in_order() {
    let coverage = coverage();
    let registry = registry(&coverage);
    for (structure, default) in &coverage.structures {
        let ours: Vec<&str> = default.as_object().unwrap().keys().map(String::as_str).collect();
        let members = registry.members.get(*structure).unwrap_or_else(|| panic!("{structure} is not in the extract"));
        assert_eq!(ours, field_names(members), "{structure}");
        let s_type = members.iter().find(|member| member.name == "sType");
        let number = default.get("s_type").map(|value| serde_json::from_value::<StructureType>(value.clone()).unwrap());
        assert_eq!(
            number.and_then(StructureType::name),
            s_type.and_then(|member| member.value.as_deref()),
            "{structure}"
        );
    }
    for (union, variants) in &coverage.unions {
        let ours: Vec<String> =
            variants.iter().map(|value| snake_case(value.as_object().unwrap().keys().next().unwrap())).collect();
        assert_eq!(
            ours,
            field_names(registry.members.get(*union).unwrap_or_else(|| panic!("{union} is not in the extract"))),
            "{union}"
        );
    }
}

#[test]
fn handles_have_the_object_type_of_the_registry() {
    let coverage = coverage();
    let registry = registry(&coverage);
    for (handle, object_type) in &coverage.handles {
        assert_eq!(object_type.name(), registry.handles.get(*handle).map(String::as_str), "{handle}");
    }
}

/// A constant's name without the tag of the author of its extension.
fn without_author(name: &str) -> &str {
    match name.rsplit_once('_') {
        Some((rest, "KHR" | "EXT" | "NV" | "AMDX" | "QCOM")) => rest,
        _ => name,
    }
}

/// The names that our rules give to the members of a structure.
fn field_names(members: &[Member]) -> Vec<String> {
    let counts: BTreeSet<&str> = members.iter().filter_map(|member| member.len.as_deref()).collect();
    let fields = members.iter().filter(|member| !counts.contains(member.name.as_str()));
    fields.map(|member| field_name(&member.name)).collect()
}

fn field_name(member: &str) -> String {
    let after = |prefix: &str| {
        member.strip_prefix(prefix).filter(|rest| rest.starts_with(|first: char| first.is_ascii_uppercase()))
    };
    match (member, after("pp"), after("p")) {
        ("type", ..) => "ty".into(),
        (_, Some(pointers), _) => format!("{}_pointers", singular(&snake_case(pointers))),
        (_, _, Some(pointed_to)) => snake_case(pointed_to),
        _ => snake_case(member),
    }
}

fn singular(plural: &str) -> String {
    match plural.strip_suffix("ies") {
        Some(stem) => format!("{stem}y"),
        None => plural.strip_suffix('s').unwrap_or(plural).into(),
    }
}

/// `maxOpacity2StateLevel` to `max_opacity2_state_level`: a digit begins no word.
fn snake_case(name: &str) -> String {
    let mut snake = String::new();
    for c in name.chars() {
        if c.is_ascii_uppercase() && !snake.is_empty() {
            snake.push('_');
        }
        snake.push(c.to_ascii_lowercase());
    }
    snake
}

#[test]
fn names_follow_the_rules() {
    for (member, field) in [
        ("sType", "s_type"),
        ("pNext", "next"),
        ("type", "ty"),
        ("ppGeometries", "geometry_pointers"),
        ("ppUsageCounts", "usage_count_pointers"),
        ("pUsageCounts", "usage_counts"),
        ("pvx", "pvx"),
        ("primitiveCount", "primitive_count"),
        ("transformT0", "transform_t0"),
        ("maxOpacity2StateSubdivisionLevel", "max_opacity2_state_subdivision_level"),
    ] {
        assert_eq!(field_name(member), field);
    }
}
