//! `omm bake --dry-run`: what would be baked.

use std::io::{self, Write};

use omm_bake::{BakeInput, BakeOptions, DryRun};
use serde::Serialize;

use super::statistics::Usage;
use crate::error::CliError;

/// What one bake would be.
#[derive(Debug, Serialize)]
pub(super) struct Forecast {
    name: String,
    /// Triangles of the mesh.
    triangles: u64,
    /// Those that would be baked.
    baked_triangles: u64,
    /// Their microtriangles, once for each mip.
    microtriangles: u64,
    /// Texels that they cover.
    texels: u64,
    /// Steps of work, as `--max-work` counts them.
    work: u64,
    /// Distinct triangles with data, by level and format.
    histogram: Vec<Usage>,
    /// Triangles of the mesh that would be given up to meet the byte budget.
    given_up: u64,
    /// Triangles of the mesh that would have a special index.
    special_triangles: u64,
    /// Bytes of the array, before triangles turn out to be the same.
    array_bytes: u64,
    /// The known part of the area that the mesh covers in the texture, 0 to 1.
    area_known_fraction: f64,
}

impl Forecast {
    pub(super) fn new(name: &str, input: &BakeInput<'_>, options: &BakeOptions) -> Result<Self, omm_bake::BakeError> {
        let DryRun { estimate, levels, usage_counts, array_bytes, special_triangles, area_known_fraction } =
            omm_bake::dry_run(input, options)?;
        Ok(Self {
            name: name.to_owned(),
            triangles: levels.len() as u64,
            baked_triangles: estimate.baked_triangles,
            microtriangles: estimate.microtriangles,
            texels: estimate.texels,
            work: estimate.work(),
            histogram: usage_counts.iter().map(Usage::from).collect(),
            given_up: levels.iter().filter(|level| level.is_none()).count() as u64,
            special_triangles,
            array_bytes,
            area_known_fraction,
        })
    }
}

/// A table for people.
pub(super) fn print(forecasts: &[Forecast], out: &mut dyn Write) -> io::Result<()> {
    let width = forecasts.iter().map(|forecast| forecast.name.chars().count()).max().unwrap_or(0).max("name".len());
    writeln!(
        out,
        "{:<width$}  {:>9}  {:>9}  {:>12}  {:>14}  {:>7}  levels",
        "name", "triangles", "special", "array bytes", "microtriangles", "known"
    )?;
    for forecast in forecasts {
        let levels: Vec<String> =
            forecast.histogram.iter().map(|usage| format!("{} x {}", usage.level(), usage.count())).collect();
        writeln!(
            out,
            "{:<width$}  {:>9}  {:>9}  {:>12}  {:>14}  {:>6.2}%  {}",
            forecast.name,
            forecast.triangles,
            forecast.special_triangles,
            forecast.array_bytes,
            forecast.microtriangles,
            100.0 * forecast.area_known_fraction,
            levels.join(", ")
        )?;
    }
    writeln!(out, "predicted; nothing was baked or written")
}

/// For `map_err`: the baker refuses an input.
pub(super) fn refused(input: &std::path::Path, name: &str) -> impl FnOnce(omm_bake::BakeError) -> CliError {
    let input = format!("{}: {name}", input.display());
    move |source| CliError::Bake { input, source }
}
