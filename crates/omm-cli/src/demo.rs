//! `omm demo`: the whole path from an alpha texture to traced rays, on a scene that the program makes itself.

use std::path::PathBuf;
use std::time::Instant;

use image::{ImageFormat, Rgb, RgbImage};
use omm_bake::bake::{self, BakeOutput};
use omm_bake::level::LevelChoice;
use omm_bake::options::{BakeInput, BakeOptions};
use omm_bake::picture;
use omm_bake::sampler::{AddressMode, Filter, Sampler};
use omm_bake::surface::Surface;
use omm_bake::texture::Texture;
use omm_model::level::SubdivisionLevel;
use omm_trace::Scene;
use serde::Serialize;

use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::output::{self, OutputSet};
use crate::progress::Progress;

mod devices;
mod fern;
mod heat;
mod random;
mod render;
mod scene;

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

/// The finest level that the demo bakes.
const LEVEL: u32 = 7;

/// What happened: `summary.json`.
#[derive(Debug, Serialize)]
struct Summary {
    /// Microtriangles in the baked array.
    micro_triangles: u64,
    /// How many of them need no shader, as a fraction, each mesh triangle counted.
    known_fraction: f64,
    /// Bytes of the baked array.
    array_bytes: u64,
    /// Bytes of the micromap as built.
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

/// Runs the demo.
pub(crate) fn run(args: &DemoArgs, format: Format) -> Result<Outcome, CliError> {
    let texture = Texture::unorm8(fern::SIZE, fern::SIZE, fern::alpha()).map_err(CliError::demo)?;
    let plant = scene::plant();
    let input = BakeInput { texture: &texture, uvs: &plant.uvs, triangles: &plant.triangles };
    let level = SubdivisionLevel::new(LEVEL).map_err(CliError::demo)?;
    let sampler = Sampler::new(AddressMode::Clamp, Filter::Linear, 0.0);
    let options = BakeOptions { level: LevelChoice::Uniform(level), sampler, ..BakeOptions::default() };

    let start = Instant::now();
    let baked = baked(&input, &options)?;
    let bake_seconds = start.elapsed().as_secs_f64();

    let built = devices::build(&baked, &plant).map_err(CliError::demo)?;
    let surface = Surface::new(&texture, sampler, options.alpha_cutoff).map_err(CliError::demo)?;
    let shading = render::Shading { surface: &surface, plant: &plant };
    let progress = Progress::new("tracing", 2 * u64::from(render::SIZE[1]));
    let traced = |view, address| -> Result<_, CliError> {
        let scene = Scene::load(view, address).map_err(CliError::demo)?;
        let start = Instant::now();
        let picture = render::render(&scene, &shading, &progress).map_err(CliError::demo)?;
        Ok((picture, start.elapsed().as_secs_f64(), scene.triangle_count()))
    };
    let (without, trace_seconds_without, triangles) = traced(&built.first, built.without)?;
    let (with, trace_seconds_with, _) = traced(&built.second, built.with)?;
    drop(progress);

    let summary = Summary {
        micro_triangles: baked.statistics.array_states.total(),
        known_fraction: baked.statistics.known_fraction,
        array_bytes: baked.statistics.array_bytes,
        micromap_bytes: built.micromap_bytes[0],
        compacted_bytes: built.micromap_bytes[1],
        calls: built.calls,
        reports: built.violations.len() as u64,
        serialized_bytes: built.serialized_bytes,
        roundtrip_identical: built.roundtrip_identical,
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
    let overlay = picture::overlay(&input, sampler, &baked);
    files.add("overlay.png", |out| overlay.write_to(out, ImageFormat::Png).map_err(std::io::Error::other))?;
    let pictures = side_by_side(&without, &with);
    files.add("render.png", |out| pictures.write_to(out, ImageFormat::Png).map_err(std::io::Error::other))?;
    files.add_json("summary.json", &summary)?;
    let written = files.commit()?;

    match format {
        Format::Json => output::print_json(&summary)?,
        Format::Text => output::print(|out| {
            summary.print(out)?;
            written.iter().try_for_each(|path| writeln!(out, "wrote {}", path.display()))
        })?,
    }
    for violation in &built.violations {
        output::complain(&violation.to_string());
    }
    let clean = summary.reports == 0 && summary.images_identical && summary.roundtrip_identical;
    Ok(if clean { Outcome::Clean } else { Outcome::Violations })
}

/// Bakes with a progress bar.
fn baked(input: &BakeInput<'_>, options: &BakeOptions) -> Result<BakeOutput, CliError> {
    let total = bake::estimate(input, options).map_err(CliError::demo)?.microtriangles;
    let progress = Progress::new("baking", total);
    bake::bake(input, options, &|step| progress.set(step.done, step.total)).map_err(CliError::demo)
}

/// Both pictures above, their any-hit calls below on a common scale, which ends where only one pixel in a hundred of the left
/// picture is beyond it.
fn side_by_side(without: &render::Picture, with: &render::Picture) -> RgbImage {
    let [width, height] = render::SIZE;
    let mut calls = without.any_hit_calls.clone();
    calls.sort_unstable();
    let most = calls.get(calls.len() * 99 / 100).copied().unwrap_or(0);
    RgbImage::from_fn(2 * width, 2 * height, |x, y| {
        let picture = if x < width { without } else { with };
        let pixel = (y % height * width + x % width) as usize;
        Rgb(if y < height { picture.colours[pixel] } else { heat::colour(picture.any_hit_calls[pixel], most) })
    })
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
