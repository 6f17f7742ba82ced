//! Bundles: what is written reads back, other readers of the encoding agree, and no lie is believed.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::triangle::MicromapTriangle;
use omm_model::usage::histogram;
use omm_serialize::bundle::{Bundle, BundleData, Checksums, HistogramError, MicromapData, SectionKind, Source};
use proptest::prelude::*;

fn triangle(data_offset: u32, level: u32, format: OpacityMicromapFormat) -> MicromapTriangle {
    MicromapTriangle { data_offset, subdivision_level: SubdivisionLevel::new(level).unwrap(), format }
}

fn leaf() -> MicromapData {
    let triangles =
        vec![triangle(0, 1, OpacityMicromapFormat::FourState), triangle(1, 3, OpacityMicromapFormat::TwoState)];
    MicromapData {
        name: "leaf".to_owned(),
        array: vec![0xb4, 1, 2, 3, 4, 5, 6, 7, 8],
        usage_counts: histogram(triangles.iter().copied()),
        index_usage_counts: histogram([triangles[1], triangles[0], triangles[1]]),
        triangles,
        indices: vec![1, 0, -1, 1, -4],
        settings: r#"{"level":3}"#.to_owned(),
        sources: vec![Source { name: "leaf.png".to_owned(), length: 77, sha256: [9; 32] }],
        statistics: r#"{"states":5}"#.to_owned(),
    }
}

fn data() -> BundleData {
    BundleData { micromaps: vec![leaf(), MicromapData { name: "nothing".to_owned(), ..MicromapData::default() }] }
}

fn error(bytes: &[u8]) -> String {
    Bundle::read(bytes, Checksums::Verify).unwrap_err().to_string()
}

#[test]
fn version_1_is_what_it_was() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/version-1.omm");
    if std::env::var_os("OMM_BLESS").is_some() && !std::path::Path::new(path).exists() {
        std::fs::write(path, data().write()).unwrap();
    }
    let bytes = std::fs::read(path).unwrap();
    let bundle = Bundle::read(&bytes, Checksums::Verify).unwrap();
    assert_eq!(bundle.to_data(), data());
    assert_eq!(data().write(), bytes);
    assert!(bundle.micromaps.iter().all(|micromap| micromap.check_histograms().is_ok()));
    // An array is lent, not copied.
    assert!(bytes.as_ptr_range().contains(&bundle.micromaps[0].array.as_ptr()));
}

#[test]
fn other_versions_are_refused_clearly() {
    let mut bytes = data().write();
    for version in [0, 2, u32::MAX] {
        bytes[8..12].copy_from_slice(&version.to_le_bytes());
        let found = format!("version at byte 8: found {version}, required 1, the only version this program reads");
        assert_eq!(error(&bytes), found);
    }
    bytes[0] = b'x';
    assert_eq!(error(&bytes), r#"magic at byte 0: found "xmmbundl", required "ommbundl""#);
    assert_eq!(error(b"omm"), "magic at byte 0: 8 bytes are needed, 3 are there");
}

#[test]
fn every_changed_byte_is_noticed() {
    let bytes = data().write();
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 1;
        let error = Bundle::read(&changed, Checksums::Verify).unwrap_err();
        assert!(error.offset <= bytes.len() as u64, "{error}");
    }
    for end in 0..bytes.len() {
        let error = Bundle::read(&bytes[..end], Checksums::Verify).unwrap_err();
        assert!(error.is_truncated(), "{end}: {error}");
    }
    let found = error(&[&bytes[..], &[0]].concat());
    assert!(found.starts_with("length at byte "), "{found}");
}

#[test]
fn lies_are_named() {
    let lie = |change: &dyn Fn(&mut MicromapData)| {
        let mut micromap = leaf();
        change(&mut micromap);
        BundleData { micromaps: vec![micromap] }.write()
    };
    let text = |change: &dyn Fn(&mut MicromapData)| error(&lie(change));
    let found = text(&|leaf| leaf.array.truncate(8));
    assert!(found.ends_with("triangle.data_end at byte 100: found 9, required at most 8"), "{found}");
    let found = text(&|leaf| leaf.indices[1] = 2);
    assert!(found.ends_with(": found 2, required at most 1"), "{found}");
    let found = text(&|leaf| leaf.indices[0] = -5);
    assert!(found.ends_with(": found -5, required an index or -4 to -1"), "{found}");
    let histograms = |change: &dyn Fn(&mut MicromapData)| {
        let bytes = lie(change);
        Bundle::read(&bytes, Checksums::Verify).unwrap().micromaps[0].check_histograms().unwrap_err()
    };
    assert_eq!(histograms(&|leaf| leaf.usage_counts[0].count += 1), HistogramError::UsageCounts);
    assert_eq!(histograms(&|leaf| leaf.indices[0] = 0), HistogramError::IndexUsageCounts);
    // A length beyond the end, with nothing behind it to be believed.
    let mut bytes = data().write();
    bytes[32..40].copy_from_slice(&u64::MAX.to_le_bytes());
    let found = error(&bytes);
    assert!(
        found.starts_with("micromaps[0].name.contents at byte 32: 18446744073709551615 bytes are needed"),
        "{found}"
    );
    // A count of sections without sections.
    let mut bytes = data().write();
    bytes[12..20].copy_from_slice(&(u64::MAX / 9 * 9).to_le_bytes());
    assert!(Bundle::read(&bytes, Checksums::Skip).unwrap_err().is_truncated());
    bytes[12] = 1;
    assert!(error(&bytes).starts_with("sections at byte 12: "));
}

#[test]
fn every_byte_has_a_name() {
    let bytes = data().write();
    let bundle = Bundle::read(&bytes, Checksums::Verify).unwrap();
    let (mut end, mut names, mut lines) = (0, Vec::new(), Vec::new());
    bundle.describe(&mut |field| {
        assert!(field.offset == end && field.size > 0, "{field:?}");
        end += field.size;
        lines.push(format!("{}: {}", field.name, field.value));
        names.push(field.name);
    });
    assert_eq!(end, bytes.len() as u64);
    names.sort();
    names.dedup();
    assert_eq!(names.len(), lines.len(), "names are unique");
    for line in [
        "sections: 18, 9 for each micromap",
        "micromaps[0].name: \"leaf\"",
        "micromaps[0].array: packed elements",
        "micromaps[0].triangles[1]: data at 1, level 3, 2-state",
        "micromaps[0].indices[1]: triangles[0]",
        "micromaps[0].indices[4]: -4 (FullyUnknownOpaque)",
        "micromaps[0].index_usage_counts[0]: 2 of level 3, 2-state",
        "micromaps[0].sources[0].length: 77 bytes",
        "micromaps[1].statistics.length: 0 bytes",
    ] {
        assert!(lines.iter().any(|found| found == line), "{line} in {lines:#?}");
    }
}

/// The same file as types of `wincode`, which shares nothing with our reader.
mod wire {
    use wincode::{SchemaRead, SchemaWrite};

    #[derive(Debug, PartialEq, SchemaRead, SchemaWrite)]
    pub(super) struct File {
        pub(super) magic: [u8; 8],
        pub(super) version: u32,
        pub(super) sections: Vec<Section>,
    }

    #[derive(Debug, PartialEq, SchemaRead, SchemaWrite)]
    pub(super) struct Section {
        pub(super) kind: u32,
        pub(super) micromap: u32,
        pub(super) checksum: u32,
        pub(super) contents: Vec<u8>,
    }

    #[derive(Debug, PartialEq, SchemaRead, SchemaWrite)]
    pub(super) struct Source {
        pub(super) name: String,
        pub(super) length: u64,
        pub(super) sha256: [u8; 32],
    }
}

#[test]
fn wincode_reads_and_writes_the_same_bytes() {
    let bytes = data().write();
    let file: wire::File = wincode::deserialize(&bytes).unwrap();
    assert_eq!((&file.magic, file.version, file.sections.len()), (b"ommbundl", 1, 18));
    let kinds: Vec<_> = file.sections.iter().map(|section| (section.micromap, section.kind)).collect();
    let expected = (0..2).flat_map(|micromap| SectionKind::ALL.map(|kind| (micromap, kind.value())));
    assert_eq!(kinds, expected.collect::<Vec<_>>());
    assert_eq!(file.sections[1].contents, leaf().array);
    let sources: Vec<wire::Source> = wincode::deserialize(&file.sections[7].contents).unwrap();
    let expected = wire::Source { name: "leaf.png".to_owned(), length: 77, sha256: [9; 32] };
    assert_eq!(sources, [expected]);
    let usage: Vec<u32> = file.sections[4].contents.as_chunks().0.iter().map(|n| u32::from_le_bytes(*n)).collect();
    assert_eq!(usage, [1, 3, 1, 1, 1, 2]);
    assert_eq!(wincode::serialize(&file).unwrap(), bytes);
}

proptest! {
    #[test]
    fn what_is_written_reads_back(
        names in prop::collection::vec(".{0,8}", 0..4),
        array in prop::collection::vec(any::<u8>(), 8..40),
        formats in prop::collection::vec((0..=2_u32, 0..2_usize, 0..4_u32), 0..9),
        digest: [u8; 32],
    ) {
        let triangles: Vec<_> =
            formats.iter().map(|&(level, format, at)| triangle(at, level, OpacityMicromapFormat::ALL[format])).collect();
        let indices: Vec<_> = (-4..triangles.len() as i32).collect();
        let micromap = |name: String| MicromapData {
            sources: vec![Source { name: name.clone(), length: 3, sha256: digest }; name.len() % 3],
            usage_counts: histogram(triangles.iter().copied()),
            index_usage_counts: histogram(triangles.iter().copied()),
            settings: name.clone(),
            statistics: String::new(),
            name,
            array: array.clone(),
            triangles: triangles.clone(),
            indices: indices.clone(),
        };
        let data = BundleData { micromaps: names.into_iter().map(micromap).collect() };
        let bytes = data.write();
        let bundle = Bundle::read(&bytes, Checksums::Verify).unwrap();
        prop_assert_eq!(bundle.to_data(), data);
        prop_assert!(bundle.micromaps.iter().all(|micromap| micromap.check_histograms().is_ok()));
    }

    #[test]
    fn what_is_accepted_writes_back(
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..4),
    ) {
        let mut bytes = data().write();
        for (at, value) in edits {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        if let Ok(bundle) = Bundle::read(&bytes, Checksums::Skip) {
            let again = bundle.to_data().write();
            let again = Bundle::read(&again, Checksums::Verify).unwrap();
            prop_assert_eq!(again.to_data(), bundle.to_data());
        }
    }
}
