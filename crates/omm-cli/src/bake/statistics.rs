//! What a bake counted, as scripts and people read it.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::time::Duration;

use omm_bake::{BakeInput, BakeOptions, BakeOutput, BakeStatistics, Coverage, StateCounts};
use omm_layout::index::IndexType;
use omm_model::usage::MicromapUsage;
use serde::Serialize;

use crate::indices;

/// The contents of `NAME.stats.json`.
#[derive(Debug, Serialize)]
pub(crate) struct Statistics {
    name: String,
    /// Width and height in texels.
    texture: [u32; 2],
    /// How it was baked.
    options: BakeOptions,
    /// Triangles of the mesh.
    triangles: u64,
    /// Micromap triangles.
    micromap_triangles: u64,
    /// Microtriangles in the array by state: data that triangles share counts once.
    states: StateCounts,
    /// Microtriangles of all triangles of the mesh by state, whether in the array or by a special index.
    triangle_states: StateCounts,
    /// Triangles of the mesh with a special index, by its state.
    special_indices: StateCounts,
    /// Micromap triangles by level and format: the usage counts of the micromap's build.
    histogram: Vec<Usage>,
    /// Triangles of the mesh that read a micromap triangle, by its level and format: the usage counts of the geometry.
    index_histogram: Vec<Usage>,
    /// The part of `triangle_states` that needs no shader, 0 to 1.
    known_fraction: f64,
    /// The part of the mesh's area in the texture that needs no shader, 0 to 1.
    area_known_fraction: f64,
    /// Triangles that were rejected because too little of them was known.
    rejected: u64,
    /// Triangles whose level was lowered for the byte budget, or that were given up.
    lowered: u64,
    /// Micromap triangles that became one with another that was almost the same.
    near_merged: u64,
    /// Triangles whose texture coordinates are not finite.
    not_finite: u64,
    /// Triangles whose texture coordinates are too far out to name texels.
    out_of_range: u64,
    /// Microtriangles left unknown because deciding would have taken too long.
    undecided: u64,
    /// How indices are stored: `uint8`, `uint16` or `uint32`.
    index_type: &'static str,
    bytes: Bytes,
    /// Time that baking took.
    seconds: f64,
}

/// So many triangles have this level and format.
#[derive(Debug, Serialize)]
pub(super) struct Usage {
    level: u32,
    /// 1: 2-state, 2: 4-state.
    format: u16,
    count: u32,
}

/// Bytes of the files of data.
#[derive(Debug, Serialize)]
struct Bytes {
    array: u64,
    desc: u64,
    index: u64,
    total: u64,
}

impl From<&MicromapUsage> for Usage {
    fn from(&MicromapUsage { count, subdivision_level, format }: &MicromapUsage) -> Self {
        Self { level: subdivision_level.get(), format: format.value(), count }
    }
}

impl Usage {
    pub(super) fn level(&self) -> u32 {
        self.level
    }

    pub(super) fn count(&self) -> u32 {
        self.count
    }
}

impl Statistics {
    pub(super) fn new(
        name: &str,
        input: &BakeInput<'_>,
        options: &BakeOptions,
        output: &BakeOutput,
        coverage: &Coverage,
        index_type: IndexType,
        time: Duration,
    ) -> Self {
        let BakeOutput { array, triangles, indices: entries, usage_counts, index_usage_counts, statistics } = output;
        let &BakeStatistics {
            triangles: mesh_triangles,
            baked_triangles: _,
            micromap_triangles,
            array_states,
            triangle_states,
            special_indices,
            known_fraction,
            not_finite,
            out_of_range,
            undecided,
            rejected,
            lowered,
            near_merged,
            array_bytes: _,
        } = statistics;
        let [array, desc, index] =
            [array.len(), triangles.len() * omm_layout::triangle::SIZE, entries.len() * index_type.size() as usize]
                .map(|n| n as u64);
        Self {
            name: name.to_owned(),
            texture: [input.texture.width(), input.texture.height()],
            options: options.clone(),
            triangles: mesh_triangles,
            micromap_triangles,
            states: array_states,
            triangle_states,
            special_indices,
            histogram: usage_counts.iter().map(Usage::from).collect(),
            index_histogram: index_usage_counts.iter().map(Usage::from).collect(),
            known_fraction,
            area_known_fraction: coverage.area_known_fraction,
            rejected,
            lowered,
            near_merged,
            not_finite,
            out_of_range,
            undecided,
            index_type: indices::name(index_type),
            bytes: Bytes { array, desc, index, total: array + desc + index },
            seconds: time.as_secs_f64(),
        }
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Triangles of the mesh.
    pub(super) const fn triangles(&self) -> u64 {
        self.triangles
    }

    /// Microtriangles of all triangles of the mesh by state.
    pub(super) const fn triangle_states(&self) -> StateCounts {
        self.triangle_states
    }

    /// Triangles of the mesh with a special index, by its state.
    pub(super) const fn special_indices(&self) -> StateCounts {
        self.special_indices
    }

    /// The part of the microtriangles that needs no shader, 0 to 1.
    pub(super) const fn known_fraction(&self) -> f64 {
        self.known_fraction
    }

    /// Bytes of the micromap's data.
    pub(super) const fn array_bytes(&self) -> u64 {
        self.bytes.array
    }

    /// How many triangles of the mesh read a micromap triangle of each level, the coarsest first.
    pub(super) fn levels(&self) -> BTreeMap<u32, u64> {
        let mut levels = BTreeMap::new();
        for usage in &self.index_histogram {
            *levels.entry(usage.level).or_default() += u64::from(usage.count);
        }
        levels
    }

    /// One row of the table that people get.
    pub(super) fn print_row(&self, width: usize, out: &mut dyn Write) -> io::Result<()> {
        writeln!(
            out,
            "{:<width$}  {:>9}  {:>9}  {:>12}  {:>14}  {:>6.2}%  {:>8.3}",
            self.name,
            self.triangles,
            self.special_indices.total(),
            self.bytes.array,
            self.triangle_states.total(),
            100.0 * self.known_fraction,
            self.seconds
        )
    }
}
