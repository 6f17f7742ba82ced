//! A bundle as a value, and writing it.

use omm_model::triangle::MicromapTriangle;
use omm_model::usage::MicromapUsage;

use super::section::{SectionKind, checksum};
use super::{MAGIC, VERSION};
use crate::codec;

/// What a bundle holds.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BundleData {
    /// The micromaps in order; 2<sup>32</sup> - 1 at most.
    pub micromaps: Vec<MicromapData>,
}

/// One micromap and what is known of it.
///
/// Nothing is checked when it is written: data out of the array, indices out of range and wrong histograms are written as they
/// are, and then refused by [`Bundle::read`](super::Bundle::read) or by
/// [`check_histograms`](super::BundledMicromap::check_histograms).
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MicromapData {
    /// What it is called.
    pub name: String,
    /// The packed elements of all triangles.
    pub array: Vec<u8>,
    /// Where each triangle's data lies in the array, level and format.
    pub triangles: Vec<MicromapTriangle>,
    /// For each triangle of the mesh an index into `triangles`, or a special index -1 to -4.
    pub indices: Vec<i32>,
    /// `triangles` by level and format.
    pub usage_counts: Vec<MicromapUsage>,
    /// `indices` that are no special index, by level and format of what they name.
    pub index_usage_counts: Vec<MicromapUsage>,
    /// How it was baked: a JSON text.
    pub settings: String,
    /// What it was baked from.
    pub sources: Vec<Source>,
    /// What the bake counted: a JSON text.
    pub statistics: String,
}

/// A file that a micromap was baked from.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Source {
    /// Its name.
    pub name: String,
    /// Its bytes.
    pub length: u64,
    /// Their SHA-256.
    pub sha256: [u8; 32],
}

impl BundleData {
    /// The bundle's bytes.
    #[must_use]
    pub fn write(&self) -> Vec<u8> {
        let arrays: usize = self.micromaps.iter().map(|micromap| micromap.array.len()).sum();
        let mut out = Vec::with_capacity(arrays.saturating_add(4096));
        codec::push(&mut out, MAGIC);
        codec::push(&mut out, VERSION);
        codec::push(&mut out, (self.micromaps.len() * SectionKind::ALL.len()) as u64);
        for (micromap, index) in self.micromaps.iter().zip(0_u32..) {
            micromap.write(index, &mut out);
        }
        out
    }
}

impl MicromapData {
    fn write(&self, index: u32, out: &mut Vec<u8>) {
        let Self { name, array, triangles, indices, usage_counts, index_usage_counts, settings, sources, statistics } =
            self;
        let mut section = |kind: SectionKind, contents: &[u8]| {
            let kind = kind.value();
            codec::push(out, (kind, index, checksum(kind, index, contents)));
            codec::push(out, contents);
        };
        section(SectionKind::Name, name.as_bytes());
        section(SectionKind::Array, array);
        let records: Vec<u8> =
            triangles.iter().flat_map(|&triangle| omm_layout::triangle::encode(&triangle.into())).collect();
        section(SectionKind::Triangles, &records);
        let entries: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        section(SectionKind::Indices, &entries);
        for (kind, counts) in
            [(SectionKind::UsageCounts, usage_counts), (SectionKind::IndexUsageCounts, index_usage_counts)]
        {
            let mut records = Vec::new();
            for MicromapUsage { count, subdivision_level, format } in counts {
                codec::push(&mut records, (*count, subdivision_level.get(), u32::from(format.value())));
            }
            section(kind, &records);
        }
        section(SectionKind::Settings, settings.as_bytes());
        let mut records = Vec::new();
        codec::push(&mut records, sources.len() as u64);
        for Source { name, length, sha256 } in sources {
            codec::push(&mut records, (name.as_str(), *length, *sha256));
        }
        section(SectionKind::Sources, &records);
        section(SectionKind::Statistics, statistics.as_bytes());
    }
}
