//! The `.omm` bundle: baked micromaps and what is known of them in one file, for pipelines to cache and engines to load.
//!
//! A file is one bincode value of fixed configuration (little-endian, integers at their full width, lengths as u64):
//!
//! | field | type | meaning |
//! |---|---|---|
//! | magic | 8 bytes | ASCII `ommbundl` |
//! | version | u32 | 1 |
//! | sections | list | u64 count, then each section |
//!
//! and a section is
//!
//! | field | type | meaning |
//! |---|---|---|
//! | kind | u32 | see [`SectionKind`] |
//! | micromap | u32 | which micromap it belongs to, from 0 on |
//! | checksum | u32 | CRC-32 (that of zip and PNG) of kind and micromap, 4 bytes each, and the contents |
//! | contents | list of u8 | u64 length, then the bytes |
//!
//! Every micromap has each kind once, in the order of their numbers, and micromaps follow each other; so one content has one
//! encoding. `docs/bundle-format.md` says what the contents are.
//!
//! [`Bundle::read`] borrows: no array is copied, and lengths and offsets are compared with the bytes at hand before they are used.

use omm_model::level::SubdivisionLevel;
use omm_model::special_index::OpacityMicromapSpecialIndex;
use omm_model::triangle::MicromapTriangle;
use omm_model::usage::{self, MicromapUsage};

use crate::{ReadError, ReadErrorKind, codec};

mod data;
mod describe;
mod section;

pub use data::{BundleData, MicromapData, Source};
pub use section::SectionKind;

/// The first eight bytes of a bundle of any version.
pub const MAGIC: [u8; 8] = *b"ommbundl";
/// Bytes of a bundle before its first section.
pub const START_SIZE: usize = 20;
/// The version that is written, and the only one that is read: there is none before it.
pub const VERSION: u32 = 1;

/// Whether checksums are compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Checksums {
    /// Each section's is computed and compared.
    #[default]
    Verify,
    /// They are read and not compared. Everything else is proved all the same.
    Skip,
}

/// A bundle, read in place.
#[derive(Clone, Debug)]
pub struct Bundle<'a> {
    /// The micromaps in order.
    pub micromaps: Vec<BundledMicromap<'a>>,
    /// The whole file.
    bytes: &'a [u8],
}

/// One micromap of a bundle.
///
/// That the triangles' data lies in the array, and that indices name triangles or special indices, was proved. Whether the
/// histograms are those of the triangles says [`check_histograms`](Self::check_histograms).
#[derive(Clone, Copy, Debug)]
pub struct BundledMicromap<'a> {
    /// What it is called.
    pub name: &'a str,
    /// The packed elements of all triangles: the data of a micromap's build.
    pub array: &'a [u8],
    triangles: &'a [[u8; 8]],
    indices: &'a [[u8; 4]],
    usage_counts: &'a [[u8; 12]],
    index_usage_counts: &'a [[u8; 12]],
    /// How it was baked: a JSON text, carried as it is.
    pub settings: &'a str,
    /// What it was baked from, encoded; every record was proved.
    sources: &'a [u8],
    /// What the bake counted: a JSON text, carried as it is.
    pub statistics: &'a str,
}

impl<'a> Bundle<'a> {
    /// Reads a bundle that takes all of `bytes`.
    ///
    /// # Errors
    /// The first field that is truncated, of another version, contradicts its checksum, or has no meaning.
    pub fn read(bytes: &'a [u8], checksums: Checksums) -> Result<Self, ReadError> {
        let mut input = codec::Input::new(bytes);
        let count = section::read_start(&mut input)?;
        let mut micromaps = Vec::new();
        // A count is a claim: the bytes decide how many there are.
        let kinds = SectionKind::ALL.len() as u64;
        if count % kinds != 0 {
            let kind = ReadErrorKind::NotAMultiple { found: count, of: kinds };
            return Err(ReadError { field: "sections".into(), offset: section::COUNT_AT, kind });
        }
        for index in 0..count / kinds {
            let micromap = BundledMicromap::read(&mut input, index, checksums);
            micromaps.push(micromap.map_err(|error| error.within(format_args!("micromaps[{index}]")))?);
        }
        input.finish()?;
        Ok(Self { micromaps, bytes })
    }

    /// The same as a value that owns its parts.
    #[must_use]
    pub fn to_data(&self) -> BundleData {
        BundleData { micromaps: self.micromaps.iter().map(BundledMicromap::to_data).collect() }
    }
}

impl<'a> BundledMicromap<'a> {
    fn read(input: &mut codec::Input<'a>, index: u64, checksums: Checksums) -> Result<Self, ReadError> {
        let mut next = |kind| section::read(input, kind, index, checksums);
        let name = next(SectionKind::Name)?.text()?;
        let array = next(SectionKind::Array)?.bytes;
        let triangles = next(SectionKind::Triangles)?;
        let indices = next(SectionKind::Indices)?;
        let usage_counts = next(SectionKind::UsageCounts)?;
        let index_usage_counts = next(SectionKind::IndexUsageCounts)?;
        let settings = next(SectionKind::Settings)?.text()?;
        let sources = next(SectionKind::Sources)?;
        let statistics = next(SectionKind::Statistics)?.text()?;

        let records = triangles.records::<8>()?;
        let mut raw = records.iter().zip(0_u64..);
        raw.try_for_each(|(record, at)| check_triangle(record, array.len() as u64, triangles.offset + 8 * at))?;
        let entries = indices.records::<4>()?;
        let mut raw = entries.iter().zip(0_u64..);
        raw.try_for_each(|(entry, at)| check_index(*entry, records.len(), indices.offset + 4 * at))?;
        for counts in [&usage_counts, &index_usage_counts] {
            let mut raw = counts.records::<12>()?.iter().zip(0_u64..);
            raw.try_for_each(|(record, at)| check_usage(record, counts.offset + 12 * at))?;
        }
        sources.check_sources()?;
        Ok(Self {
            name,
            array,
            triangles: records,
            indices: entries,
            usage_counts: usage_counts.records()?,
            index_usage_counts: index_usage_counts.records()?,
            settings,
            sources: sources.bytes,
            statistics,
        })
    }

    /// The bytes of a section.
    const fn contents(&self, kind: SectionKind) -> &'a [u8] {
        match kind {
            SectionKind::Name => self.name.as_bytes(),
            SectionKind::Array => self.array,
            SectionKind::Triangles => self.triangles.as_flattened(),
            SectionKind::Indices => self.indices.as_flattened(),
            SectionKind::UsageCounts => self.usage_counts.as_flattened(),
            SectionKind::IndexUsageCounts => self.index_usage_counts.as_flattened(),
            SectionKind::Settings => self.settings.as_bytes(),
            SectionKind::Sources => self.sources,
            SectionKind::Statistics => self.statistics.as_bytes(),
        }
    }

    /// The micromap's triangles: where their data lies in the array, level and format.
    pub fn triangles(&self) -> impl ExactSizeIterator<Item = MicromapTriangle> + Clone + use<'a> {
        // Every record was proved, so the default is never taken.
        self.triangles.iter().map(|record| triangle(record).unwrap_or(EMPTY))
    }

    /// The triangles as a micromap's build reads them: u32 offset, u16 level, u16 format, little-endian.
    #[must_use]
    pub const fn triangle_bytes(&self) -> &'a [u8] {
        self.triangles.as_flattened()
    }

    /// For each triangle of the mesh an index into the triangles, or a special index -1 to -4.
    pub fn indices(&self) -> impl ExactSizeIterator<Item = i32> + Clone + use<'a> {
        self.indices.iter().map(|entry| i32::from_le_bytes(*entry))
    }

    /// The indices as a geometry's build reads them: 32 bits each, little-endian.
    #[must_use]
    pub const fn index_bytes(&self) -> &'a [u8] {
        self.indices.as_flattened()
    }

    /// Triangles of the micromap by level and format.
    pub fn usage_counts(&self) -> impl ExactSizeIterator<Item = MicromapUsage> + Clone + use<'a> {
        self.usage_counts.iter().map(|record| codec::usage(record).unwrap_or(NO_USAGE))
    }

    /// Triangles of the mesh that read a triangle of the micromap, by its level and format.
    pub fn index_usage_counts(&self) -> impl ExactSizeIterator<Item = MicromapUsage> + Clone + use<'a> {
        self.index_usage_counts.iter().map(|record| codec::usage(record).unwrap_or(NO_USAGE))
    }

    /// What it was baked from.
    pub fn sources(&self) -> impl Iterator<Item = Source> + Clone + use<'a> {
        let mut input = codec::Input::new(self.sources);
        let count = input.u64("sources").unwrap_or(0);
        // That every record is whole was proved, so the sequence ends with the bytes.
        (0..count).map_while(move |_| codec::source(&mut input).ok())
    }

    /// Compares both histograms with the triangles and indices that they count.
    ///
    /// # Errors
    /// Which one is wrong.
    pub fn check_histograms(&self) -> Result<(), HistogramError> {
        if !self.usage_counts().eq(usage::histogram(self.triangles())) {
            return Err(HistogramError::UsageCounts);
        }
        let triangle = |index: i32| self.triangles.get(usize::try_from(index).ok()?).and_then(triangle);
        let used = usage::histogram(self.indices().filter_map(triangle));
        if self.index_usage_counts().eq(used) { Ok(()) } else { Err(HistogramError::IndexUsageCounts) }
    }

    /// The same as a value that owns its parts.
    #[must_use]
    pub fn to_data(&self) -> MicromapData {
        MicromapData {
            name: self.name.to_owned(),
            array: self.array.to_vec(),
            triangles: self.triangles().collect(),
            indices: self.indices().collect(),
            usage_counts: self.usage_counts().collect(),
            index_usage_counts: self.index_usage_counts().collect(),
            settings: self.settings.to_owned(),
            sources: self.sources().collect(),
            statistics: self.statistics.to_owned(),
        }
    }
}

/// A histogram that does not count what is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HistogramError {
    /// That of the micromap's triangles.
    #[error("the usage counts are not those of the triangles")]
    UsageCounts,
    /// That of the mesh's triangles.
    #[error("the index usage counts are not those of the indices")]
    IndexUsageCounts,
}

const EMPTY: MicromapTriangle = MicromapTriangle {
    data_offset: 0,
    subdivision_level: SubdivisionLevel::ZERO,
    format: omm_model::format::OpacityMicromapFormat::TwoState,
};
const NO_USAGE: MicromapUsage =
    MicromapUsage { count: 0, subdivision_level: EMPTY.subdivision_level, format: EMPTY.format };

/// The triangle that a record holds, if level and format have a meaning.
fn triangle(record: &[u8; 8]) -> Option<MicromapTriangle> {
    let [a, b, c, d, level, level_high, format, format_high] = *record;
    Some(MicromapTriangle {
        data_offset: u32::from_le_bytes([a, b, c, d]),
        subdivision_level: SubdivisionLevel::try_from(u16::from_le_bytes([level, level_high])).ok()?,
        format: omm_model::format::OpacityMicromapFormat::from_value(u16::from_le_bytes([format, format_high]).into())?,
    })
}

fn check_triangle(record: &[u8; 8], limit: u64, offset: u64) -> Result<(), ReadError> {
    let error = |field: &'static str, kind| ReadError { field: field.into(), offset, kind };
    let Some(triangle) = triangle(record) else {
        let [.., a, b, c, d] = *record;
        let found = u32::from_le_bytes([a, b, c, d]).into();
        let required = "level 0 to 12 in the low half, format 1 or 2 in the high";
        return Err(error("triangle", ReadErrorKind::Unknown { found, required }));
    };
    match triangle.data_range().end {
        end if end <= limit => Ok(()),
        end => Err(error("triangle.data_end", ReadErrorKind::Above { found: end, limit })),
    }
}

fn check_index(entry: [u8; 4], triangles: usize, offset: u64) -> Result<(), ReadError> {
    let index = i32::from_le_bytes(entry);
    let kind = match usize::try_from(index) {
        Ok(found) if found < triangles => return Ok(()),
        Ok(found) => ReadErrorKind::Above { found: found as u64, limit: (triangles as u64).saturating_sub(1) },
        Err(_) if OpacityMicromapSpecialIndex::from_value(index).is_some() => return Ok(()),
        Err(_) => ReadErrorKind::Unknown { found: index.into(), required: "an index or -4 to -1" },
    };
    Err(ReadError { field: "index".into(), offset, kind })
}

fn check_usage(record: &[u8; 12], offset: u64) -> Result<(), ReadError> {
    if codec::usage(record).is_some() {
        return Ok(());
    }
    let [.., a, b, c, d, e, f, g, h] = *record;
    let found = i64::from_le_bytes([a, b, c, d, e, f, g, h]);
    let required = "level 0 to 12 in the low half, format 1 or 2 in the high";
    Err(ReadError { field: "usage".into(), offset: offset + 4, kind: ReadErrorKind::Unknown { found, required } })
}
