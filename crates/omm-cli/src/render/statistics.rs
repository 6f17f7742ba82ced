//! What `omm render` counted.

use std::io::{self, Write};
use std::path::PathBuf;

use omm_render::{Baked, Picture};
use serde::Serialize;

/// A traced picture and what it took.
pub(super) struct Traced {
    pub(super) picture: Picture,
    pub(super) seconds: f64,
    /// Triangles that rays can meet, each instance counted.
    pub(super) triangles: u64,
}

/// What was counted: the file that `--stats` names. What is `null` was not traced.
#[derive(Debug, Serialize)]
pub(super) struct RenderStatistics {
    /// Triangles that rays can meet, each instance counted.
    triangles: u64,
    /// Microtriangles in the baked arrays.
    micro_triangles: u64,
    /// How much of the triangles with a cutout needs no shader, as a fraction.
    known_fraction: f64,
    /// Rays traced for one picture.
    rays: u64,
    /// Any-hit calls with micromaps.
    any_hit_with: u64,
    /// Any-hit calls with micromaps disabled.
    any_hit_without: Option<u64>,
    /// Seconds to trace with micromaps.
    seconds: f64,
    /// Seconds to trace with micromaps disabled.
    seconds_without: Option<f64>,
    /// Rays a second with micromaps.
    rays_per_second: f64,
    /// Rays a second with micromaps disabled.
    rays_per_second_without: Option<f64>,
    /// Whether both pictures have the same colours.
    pub(super) images_identical: Option<bool>,
}

impl RenderStatistics {
    pub(super) fn new(baked: &Baked, with: &Traced, without: Option<&Traced>) -> Self {
        let rate = |traced: &Traced| traced.picture.counters.rays as f64 / traced.seconds.max(1e-9);
        Self {
            triangles: with.triangles,
            micro_triangles: baked.microtriangles(),
            known_fraction: baked.known_fraction(),
            rays: with.picture.counters.rays,
            any_hit_with: with.picture.counters.any_hit_calls,
            any_hit_without: without.map(|traced| traced.picture.counters.any_hit_calls),
            seconds: with.seconds,
            seconds_without: without.map(|traced| traced.seconds),
            rays_per_second: rate(with),
            rays_per_second_without: without.map(rate),
            images_identical: without.map(|traced| traced.picture.colours == with.picture.colours),
        }
    }

    /// The statistics for people.
    pub(super) fn print(&self, out: &mut dyn Write, written: &[PathBuf]) -> io::Result<()> {
        let known = 100.0 * self.known_fraction;
        writeln!(out, "baked    {} microtriangles, {known:.1} % known", self.micro_triangles)?;
        writeln!(out, "traced   {} rays against {} triangles", self.rays, self.triangles)?;
        let row = |out: &mut dyn Write, label, calls: u64, seconds: f64, rate: f64| {
            let rate = rate / 1e6;
            writeln!(out, "{label}{calls} any-hit calls, {seconds:.2} s, {rate:.2} million rays a second")
        };
        row(out, "with     ", self.any_hit_with, self.seconds, self.rays_per_second)?;
        if let (Some(calls), Some(seconds), Some(rate)) =
            (self.any_hit_without, self.seconds_without, self.rays_per_second_without)
        {
            row(out, "without  ", calls, seconds, rate)?;
            let saved = 100.0 * (1.0 - self.any_hit_with as f64 / calls.max(1) as f64);
            let identical = if self.images_identical == Some(true) { "yes" } else { "NO" };
            writeln!(out, "         {saved:.1} % of the any-hit calls saved, pictures identical: {identical}")?;
        }
        written.iter().try_for_each(|path| writeln!(out, "wrote {}", path.display()))
    }
}
