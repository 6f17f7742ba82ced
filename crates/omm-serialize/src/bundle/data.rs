//! A bundle as a value, and writing it.

use std::io::{self, Write};

use omm_model::triangle::MicromapTriangle;
use omm_model::usage::MicromapUsage;

use super::section::{SectionKind, checksum};
use super::{MAGIC, START_SIZE, VERSION};
use crate::codec;

/// Bytes of a section without its contents.
const HEAD_SIZE: usize = 20;

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
        let mut out = Vec::with_capacity(START_SIZE + self.micromaps.iter().map(MicromapData::size).sum::<usize>());
        // Memory takes everything.
        let result = self.write_to(&mut out);
        debug_assert!(result.is_ok());
        out
    }

    /// Writes the bundle's bytes, the arrays without copying them first.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn write_to(&self, out: &mut impl Write) -> io::Result<()> {
        let mut start = Vec::with_capacity(START_SIZE);
        codec::push(&mut start, MAGIC);
        codec::push(&mut start, VERSION);
        codec::push(&mut start, (self.micromaps.len() * SectionKind::ALL.len()) as u64);
        out.write_all(&start)?;
        self.micromaps.iter().zip(0_u32..).try_for_each(|(micromap, index)| micromap.write_to(index, out))
    }
}

impl MicromapData {
    fn write_to(&self, index: u32, out: &mut impl Write) -> io::Result<()> {
        let Self { name, array, triangles, indices, usage_counts, index_usage_counts, settings, sources, statistics } =
            self;
        let mut section = |kind: SectionKind, contents: &[u8]| {
            let kind = kind.value();
            let mut head = Vec::with_capacity(HEAD_SIZE);
            codec::push(&mut head, (kind, index, checksum(kind, index, contents)));
            // A list: its length, then its items.
            codec::push(&mut head, contents.len() as u64);
            out.write_all(&head)?;
            out.write_all(contents)
        };
        section(SectionKind::Name, name.as_bytes())?;
        section(SectionKind::Array, array)?;
        let mut records = Vec::with_capacity(omm_layout::triangle::SIZE * triangles.len());
        for &triangle in triangles {
            records.extend_from_slice(&omm_layout::triangle::encode(&triangle.into()));
        }
        section(SectionKind::Triangles, &records)?;
        let mut entries = Vec::with_capacity(size_of::<i32>() * indices.len());
        indices.iter().for_each(|index| entries.extend_from_slice(&index.to_le_bytes()));
        section(SectionKind::Indices, &entries)?;
        for (kind, counts) in
            [(SectionKind::UsageCounts, usage_counts), (SectionKind::IndexUsageCounts, index_usage_counts)]
        {
            let mut records = Vec::new();
            for MicromapUsage { count, subdivision_level, format } in counts {
                codec::push(&mut records, (*count, subdivision_level.get(), u32::from(format.value())));
            }
            section(kind, &records)?;
        }
        section(SectionKind::Settings, settings.as_bytes())?;
        let mut records = Vec::new();
        codec::push(&mut records, sources.len() as u64);
        for Source { name, length, sha256 } in sources {
            codec::push(&mut records, (name.as_str(), *length, *sha256));
        }
        section(SectionKind::Sources, &records)?;
        section(SectionKind::Statistics, statistics.as_bytes())
    }

    /// About how many bytes [`write_to`](Self::write_to) writes.
    fn size(&self) -> usize {
        let Self { name, array, triangles, indices, usage_counts, index_usage_counts, settings, sources, statistics } =
            self;
        let texts = name.len() + settings.len() + statistics.len();
        let sources: usize = 8 + sources.iter().map(|source| 48 + source.name.len()).sum::<usize>();
        let usages = 12 * (usage_counts.len() + index_usage_counts.len());
        let records = omm_layout::triangle::SIZE * triangles.len() + size_of::<i32>() * indices.len();
        SectionKind::ALL.len() * HEAD_SIZE + texts + array.len() + records + usages + sources
    }
}
