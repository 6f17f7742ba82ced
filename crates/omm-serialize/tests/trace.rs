//! Traces: both forms lose nothing, other readers of the encoding agree, and no lie is believed.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::path::{Path, PathBuf};

use omm_model::call::Call;
use omm_model::curve::TieBreak;
use omm_model::profile::{DeviceProfile, Features, Limits, Uuid};
use omm_model::vk;
use omm_serialize::ReadError;
use omm_serialize::bundle::Checksums;
use omm_serialize::trace::{Event, Trace};
use serde::de::{Deserialize, Deserializer, Error as _, Visitor};

/// The least of a profile.
fn profile() -> DeviceProfile {
    DeviceProfile {
        name: "p".to_owned(),
        driver_uuid: Uuid([1; 16]),
        compatibility_uuid: Uuid([2; 16]),
        limits: Limits {
            max_opacity2_state_subdivision_level: 12,
            max_opacity4_state_subdivision_level: 12,
            max_opacity_lossy4_state_subdivision_level: 11,
            max_displacement_micromap_subdivision_level: 0,
            max_micromap_triangles: 3,
            max_geometry_count: 4,
            max_instance_count: 5,
            max_primitive_count: 6,
            min_acceleration_structure_scratch_offset_alignment: 256,
            protected_no_fault: true,
        },
        features: Features { micromap: true, ..Features::default() },
        queue_families: vec![],
        memory_types: vec![],
        memory_heaps: vec![],
        micromap_tie_break: TieBreak::Reference,
    }
}

/// The example of the documentation.
fn example() -> Trace {
    let write = Event::Write { address: vk::DeviceAddress(0x1_0000_0000), bytes: vec![0x2a, 0xff] };
    let call = Call::DestroyBuffer { device: vk::Device(1), buffer: vk::Buffer(7) };
    Trace { profile: profile(), events: vec![write, call.into()] }
}

fn read(bytes: &[u8]) -> Result<Trace, ReadError> {
    Trace::read(bytes, Checksums::Verify)
}

fn error(bytes: &[u8]) -> String {
    read(bytes).unwrap_err().to_string()
}

fn document() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/trace-format.md");
    std::fs::read_to_string(path).unwrap()
}

/// The lines of the block of code in the document that begins behind `heading`.
fn block(document: &str, heading: &str) -> Vec<String> {
    let at = document.find(heading).unwrap_or_else(|| panic!("no {heading}"));
    let lines = document[at..].lines().skip_while(|line| !line.starts_with("```")).skip(1);
    lines.take_while(|line| !line.starts_with("```")).map(str::to_owned).collect()
}

#[test]
fn the_example_of_the_document_is_true() {
    let mut bytes = Vec::new();
    for line in block(&document(), "## An example") {
        let (offset, rest) = line.split_once("  ").unwrap();
        assert_eq!(usize::from_str_radix(offset, 16).unwrap(), bytes.len(), "{line}");
        let digits = rest.split("  ").next().unwrap();
        bytes.extend(digits.split(' ').map(|byte| u8::from_str_radix(byte, 16).unwrap()));
    }
    assert_eq!(read(&bytes), Ok(example()));
    assert_eq!(example().write(), bytes);
}

/// Learns the names of an enum's variants from what its reader asks for.
struct Variants<'a>(&'a mut Vec<String>);

impl<'de> Deserializer<'de> for Variants<'_> {
    type Error = serde::de::value::Error;

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, Self::Error> {
        *self.0 = variants.iter().map(|&name| name.to_owned()).collect();
        Err(Self::Error::custom("learned"))
    }

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Self::Error> {
        Err(Self::Error::custom("no enum"))
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map struct identifier ignored_any
    }
}

fn variants<T: Deserialize<'static>>() -> Vec<String> {
    let mut names = Vec::new();
    assert!(T::deserialize(Variants(&mut names)).is_err());
    names
}

#[test]
fn the_numbers_of_the_document_are_those_of_the_encoding() {
    let document = document();
    let tables = [
        ("### `Event`", variants::<Event>()),
        ("### `DeviceOrHostAddress`", variants::<vk::DeviceOrHostAddress>()),
        ("### `GeometryData`", variants::<vk::GeometryData>()),
        ("### `ChainStructure`", variants::<vk::ChainStructure>()),
        ("### `Call`", variants::<Call>()),
    ];
    for (heading, names) in tables {
        let numbered: Vec<String> = names.iter().enumerate().map(|(number, name)| format!("{number} {name}")).collect();
        assert_eq!(block(&document, heading), numbered, "{heading}: new variants go to the end");
    }
}

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(name)
}

#[test]
fn version_1_is_what_it_was() {
    let trace = Trace::from_text(&std::fs::read_to_string(fixture("trace-version-1.ron")).unwrap()).unwrap();
    let path = fixture("trace-version-1.ommtrace");
    if std::env::var_os("OMM_BLESS").is_some() && !path.exists() {
        std::fs::write(&path, trace.write()).unwrap();
    }
    let bytes = std::fs::read(path).unwrap();
    assert_eq!(read(&bytes).unwrap(), trace);
    assert_eq!(trace.write(), bytes);
    // Every command is there, so that no structure changes unseen.
    let text = trace.to_text().unwrap();
    for command in variants::<Call>() {
        assert!(
            text.contains(&format!("\n      Call({command}(")),
            "{command} is not in the fixture, on a line of its own"
        );
    }
}

#[test]
fn other_versions_are_refused_clearly() {
    let mut bytes = example().write();
    bytes[8] = 2;
    assert_eq!(error(&bytes), "version at byte 8: found 2, required 1, the only version this program reads");
    bytes[0] = b'x';
    assert_eq!(error(&bytes), r#"magic at byte 0: found "xmmtrace", required "ommtrace""#);
    let text = example().to_text().unwrap().replace("version: 1", "version: 2");
    let found = Trace::from_text(&text).unwrap_err().to_string();
    assert_eq!(found, "line 1, column 1: found version 2, required 1, the only version this program reads");
}

#[test]
fn every_changed_byte_is_noticed() {
    let bytes = example().write();
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 1;
        let error = read(&changed).unwrap_err();
        assert!(error.offset <= bytes.len() as u64, "{error}");
    }
    for end in 0..bytes.len() {
        assert!(read(&bytes[..end]).unwrap_err().is_truncated(), "{end}");
    }
    let found = error(&[&bytes[..], &[0]].concat());
    assert!(found.starts_with("length at byte "), "{found}");
}

#[test]
fn events_that_changed_places_are_noticed() {
    let event = |byte| Event::Write { address: vk::DeviceAddress(0), bytes: vec![byte] };
    let trace = |bytes: [u8; 2]| Trace { profile: profile(), events: bytes.map(event).to_vec() }.write();
    let bytes = trace([1, 2]);
    let record = 12 + 4 + 8 + 8 + 1;
    let (head, events) = bytes.split_at(bytes.len() - 2 * record);
    let (first, second) = events.split_at(record);
    let swapped = [head, second, first].concat();
    assert!(Trace::read(&swapped, Checksums::Skip).is_ok());
    let found = error(&swapped);
    assert!(found.starts_with("events[0].checksum at byte "), "{found}");
}

#[test]
fn counts_are_not_believed() {
    let mut bytes = Trace { events: vec![], ..example() }.write();
    let at = bytes.len() - 8;
    bytes[at..].copy_from_slice(&u64::MAX.to_le_bytes());
    assert!(read(&bytes).unwrap_err().is_truncated());
    // The length of the profile's record.
    bytes[16..24].copy_from_slice(&u64::MAX.to_le_bytes());
    let found = error(&bytes);
    assert!(found.starts_with("profile.contents at byte 16: 18446744073709551615 bytes are needed"), "{found}");
}

#[test]
fn bad_texts_are_refused_where_they_are_bad() {
    let text = example().to_text().unwrap();
    let refused = |from: &str, to: &str, expected: &str| {
        let changed = text.replace(from, to);
        assert_ne!(changed, text, "{from}");
        let found = Trace::from_text(&changed).unwrap_err().to_string();
        assert!(found.contains(expected), "{found}");
    };
    refused("2aff", "2af", "a hexadecimal digit without another");
    refused("2aff", "2afg", "no hexadecimal digit");
    refused("DestroyBuffer(", "DestroyBuffet(", "DestroyBuffet");
    refused("events:", "event:", "event");
    refused("Buffer(7)", "Buffer(-7)", "");
    assert_eq!(Trace::from_text(&text.replace("2aff", "2a f F")).unwrap(), example());
}

/// The same file as types of `wincode`, which shares nothing with our reader.
mod wire {
    use wincode::{SchemaRead, SchemaWrite};

    #[derive(Debug, PartialEq, SchemaRead, SchemaWrite)]
    pub(super) struct File {
        pub(super) magic: [u8; 8],
        pub(super) version: u32,
        pub(super) profile: Record,
        pub(super) events: Vec<Record>,
    }

    #[derive(Debug, PartialEq, SchemaRead, SchemaWrite)]
    pub(super) struct Record {
        pub(super) checksum: u32,
        pub(super) contents: Vec<u8>,
    }

    /// An event, as far as the example has it.
    #[derive(Debug, PartialEq, SchemaRead, SchemaWrite)]
    pub(super) enum Event {
        Call { command: u32, device: u64, buffer: u64 },
        Write { address: u64, bytes: Vec<u8> },
    }
}

#[test]
fn wincode_reads_and_writes_the_same_bytes() {
    let bytes = example().write();
    let file: wire::File = wincode::deserialize(&bytes).unwrap();
    assert_eq!((&file.magic, file.version, file.events.len()), (b"ommtrace", 1, 2));
    let events: Vec<wire::Event> =
        file.events.iter().map(|record| wincode::deserialize(&record.contents).unwrap()).collect();
    let write = wire::Event::Write { address: 0x1_0000_0000, bytes: vec![0x2a, 0xff] };
    let call = wire::Event::Call { command: 6, device: 1, buffer: 7 };
    assert_eq!(events, [write, call]);
    let contents: Vec<Vec<u8>> = events.iter().map(|event| wincode::serialize(event).unwrap()).collect();
    assert!(contents.iter().zip(&file.events).all(|(contents, record)| *contents == record.contents));
    assert_eq!(wincode::serialize(&file).unwrap(), bytes);
}
