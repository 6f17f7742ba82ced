//! `omm demo`: the whole path from an alpha texture to traced rays, on a scene that the program makes itself.

use std::path::PathBuf;
use std::time::Instant;

use omm_bake::{BakeOptions, LevelChoice, picture};
use omm_render::{Baked, Mode, PictureOptions, RenderError, Tracer, garden, paper};
use omm_trace::Scene;
use serde::Serialize;

use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::output::{self, OutputSet};
use crate::progress::Progress;

mod devices;

use devices::Path;

/// Arguments of `omm demo`.
#[derive(Debug, clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct DemoArgs {
    /// Folder for the results.
    #[arg(long, value_name = "DIR", default_value = "omm-demo")]
    out: PathBuf,
}

const HELP: &str = "\
Writes summary.json, overlay.png (the texture with its microtriangles coloured by state: transparent blue, opaque
green, unknown pink and yellow) and render.png (left without, right with micromaps; below, any-hit calls per pixel).

Examples:
  omm demo
  omm demo --out /tmp/demo --format json

Exit status:
  0  the validator was silent, both pictures are identical, and serialized data survived the round trip
  1  one of these does not hold
  2  could not run";

/// What happened: `summary.json`.
#[derive(Debug, Serialize)]
struct Summary {
    /// Microtriangles in the baked array.
    micro_triangles: u64,
    /// How many of them need no shader, as a fraction, each mesh triangle counted.
    known_fraction: f64,
    /// Bytes of the baked array.
    array_bytes: u64,
    /// Bytes of the micromap as path.
    micromap_bytes: u64,
    /// Bytes of the micromap as compacted.
    compacted_bytes: u64,
    /// API calls on both devices.
    calls: u64,
    /// Violations that the validator reported about them.
    reports: u64,
    /// Bytes of the serialized micromap and acceleration structures.
    serialized_bytes: u64,
    /// Whether the second device serializes the same bytes again, but for addresses.
    roundtrip_identical: bool,
    /// Triangles that rays can meet, each instance counted.
    triangles: u64,
    /// Rays traced for one picture.
    rays: u64,
    /// Any-hit calls with micromaps disabled.
    any_hit_without: u64,
    /// Any-hit calls with micromaps.
    any_hit_with: u64,
    /// Whether both pictures have the same colours.
    images_identical: bool,
    /// Seconds to bake.
    bake_seconds: f64,
    /// Seconds to trace without micromaps.
    trace_seconds_without: f64,
    /// Seconds to trace with micromaps.
    trace_seconds_with: f64,
}

/// Pixels of a picture, across and down.
const SIZE: [u32; 2] = [960, 540];

/// Runs the demo.
pub(crate) fn run(args: &DemoArgs, format: Format) -> Result<Outcome, CliError> {
    let scene = garden::garden()?;
    let options = BakeOptions { level: LevelChoice::Uniform(garden::LEVEL), ..BakeOptions::default() };

    let start = Instant::now();
    let progress = Progress::new("baking", 0);
    let baked = Baked::new(&scene, &options, &|done, total| progress.set(done, total))?;
    drop(progress);
    let bake_seconds = start.elapsed().as_secs_f64();

    let path = Path::walk(&scene, &baked)?;
    let progress = Progress::new("tracing", 2 * u64::from(SIZE[0]) * u64::from(SIZE[1]));
    let traced = |view, address| -> Result<_, RenderError> {
        let rays = Scene::load(view, address)?;
        let tracer = Tracer::new(&rays, &scene)?;
        let start = Instant::now();
        let options = PictureOptions { size: SIZE, samples: 1, seed: 0 };
        let picture = tracer.picture(&options, &|pixels, _| progress.advance(pixels))?;
        Ok((picture, start.elapsed().as_secs_f64(), rays.triangle_count()))
    };
    let (without, trace_seconds_without, triangles) = traced(&path.first, path.without)?;
    let (with, trace_seconds_with, _) = traced(&path.second, path.with)?;
    drop(progress);

    let summary = Summary {
        micro_triangles: baked.microtriangles(),
        known_fraction: baked.known_fraction(),
        array_bytes: baked.array_bytes(),
        micromap_bytes: path.micromap_bytes[0],
        compacted_bytes: path.micromap_bytes[1],
        calls: path.calls,
        reports: path.violations.len() as u64,
        serialized_bytes: path.serialized_bytes,
        roundtrip_identical: path.roundtrip_identical,
        triangles,
        rays: without.counters.rays,
        any_hit_without: without.counters.any_hit_calls,
        any_hit_with: with.counters.any_hit_calls,
        images_identical: without.colours == with.colours,
        bake_seconds,
        trace_seconds_without,
        trace_seconds_with,
    };

    let mut files = OutputSet::new(&args.out);
    for ((_, _, (input, own)), output) in scene.bakes(&options).zip(baked.outputs()) {
        files.add_png("overlay.png", &picture::overlay(&input, own.sampler, output))?;
    }
    let rows = [Mode::Shaded, Mode::AnyHit].map(|mode| paper::pair(&without, &with, mode));
    files.add_png("render.png", &paper::stacked(&rows))?;
    files.add_json("summary.json", &summary)?;
    let written = files.commit()?;

    match format {
        Format::Json => output::print_json(&summary)?,
        Format::Text => output::print(|out| {
            summary.print(out)?;
            written.iter().try_for_each(|path| writeln!(out, "wrote {}", path.display()))
        })?,
    }
    for violation in &path.violations {
        output::complain(&violation.to_string());
    }
    let clean = summary.reports == 0 && summary.images_identical && summary.roundtrip_identical;
    Ok(if clean { Outcome::Clean } else { Outcome::Violations })
}

impl Summary {
    /// The summary for people.
    fn print(&self, out: &mut dyn std::io::Write) -> std::io::Result<()> {
        let yes = |yes: bool| if yes { "yes" } else { "NO" };
        let saved = 100.0 * (1.0 - self.any_hit_with as f64 / self.any_hit_without.max(1) as f64);
        let rate = |seconds: f64| self.rays as f64 / seconds.max(1e-9) / 1e6;
        writeln!(
            out,
            "baked        {} microtriangles, {:.1} % known, {} bytes, {:.2} s",
            self.micro_triangles,
            100.0 * self.known_fraction,
            self.array_bytes,
            self.bake_seconds
        )?;
        writeln!(out, "built        micromap of {} bytes, compacted to {}", self.micromap_bytes, self.compacted_bytes)?;
        writeln!(out, "validated    {} calls, {} reports", self.calls, self.reports)?;
        writeln!(
            out,
            "serialized   {} bytes, identical after the round trip: {}",
            self.serialized_bytes,
            yes(self.roundtrip_identical)
        )?;
        writeln!(out, "traced       {} rays against {} triangles, twice", self.rays, self.triangles)?;
        for (label, calls, seconds) in [
            ("  without    ", self.any_hit_without, self.trace_seconds_without),
            ("  with       ", self.any_hit_with, self.trace_seconds_with),
        ] {
            writeln!(out, "{label}{calls} any-hit calls, {seconds:.2} s, {:.2} million rays a second", rate(seconds))?;
        }
        writeln!(
            out,
            "             {saved:.1} % of the any-hit calls saved, pictures identical: {}",
            yes(self.images_identical)
        )
    }
}
