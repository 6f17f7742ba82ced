//! `omm render`: pictures of a scene, with and without opacity micromaps.

use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

use clap::{Args, ValueEnum};
use omm_bake::{BakeOptions, LevelChoice};
use omm_device::Device;
use omm_device::app::App;
use omm_model::level::SubdivisionLevel;
use omm_model::profile::DeviceProfile;
use omm_model::vk::DeviceAddress;
use omm_render::{Baked, Built, Mode, Picture, PictureOptions, RenderError, RenderScene, Tracer, garden, paper};
use omm_trace::Scene;

use crate::cli::Format;
use crate::curve::level;
use crate::error::{CliError, Outcome};
use crate::output::{self, OutputSet};
use crate::progress::Progress;
use crate::watch::Watch;

mod statistics;
mod view;

use statistics::{RenderStatistics, Traced};
use view::View;

/// Arguments of `omm render`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct RenderArgs {
    /// A glTF file (.gltf, .glb); the garden of the demo if there is none.
    scene: Option<PathBuf>,
    /// The picture to write, a PNG.
    #[arg(long, value_name = "FILE.png")]
    out: PathBuf,
    /// Put three pictures side by side: without micromaps, with them, and what differs.
    #[arg(long)]
    compare: bool,
    /// What to show; several are put one below the other. With --compare both shaded and any-hit unless given.
    #[arg(long, value_name = "MODE", value_delimiter = ',')]
    mode: Vec<ModeName>,
    /// Also write what was counted, with and without micromaps, as JSON.
    #[arg(long, value_name = "FILE.json")]
    stats: Option<PathBuf>,
    /// Pixels across and down.
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "960x540")]
    size: [u32; 2],
    /// Camera rays for each pixel: 1 goes through its middle, more through places that the seed picks.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=4096))]
    samples: u32,
    /// Which places.
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    view: View,
    /// Subdivision level of every triangle, 0 to 12; chosen by texel footprint if not given, but for the garden, which has 9.
    #[arg(long, value_name = "L", value_parser = level)]
    level: Option<SubdivisionLevel>,
    /// How many threads work; one for each core if 0.
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ModeName {
    /// Colours in the light of the sun.
    Shaded,
    /// Any-hit calls for each pixel.
    AnyHit,
    /// What decided about the surface: flag grey, micromap green, shader pink (micromap unknown) or red (no micromap).
    Source,
}

impl From<ModeName> for Mode {
    fn from(name: ModeName) -> Self {
        match name {
            ModeName::Shaded => Self::Shaded,
            ModeName::AnyHit => Self::AnyHit,
            ModeName::Source => Self::Source,
        }
    }
}

const HELP: &str = "\
With --compare or --stats everything is traced twice, the second time with all micromaps disabled by instance flags; the pictures
must be identical. The same arguments give the same picture whatever the number of threads.

Examples:
  omm render --compare --out render.png
  omm render scene.glb --out scene.png --stats scene.json
  omm render scene.glb --out source.png --mode source --eye 0,2,5 --target 0,1,0 --samples 16

Exit status:
  0  clean
  1  the validator found something in the calls that built the scene, or pictures differ
  2  could not run: bad arguments, bad input, unwritable output; nothing is left behind";

/// A size as an argument: as many pixels as a picture can reasonably have.
fn size(text: &str) -> Result<[u32; 2], String> {
    let parts = text.split_once('x').ok_or("not of the form WIDTHxHEIGHT")?;
    let number = |text: &str| match text.parse() {
        Ok(number @ 1..=16_384) => Ok(number),
        _ => Err(format!("{text} is not in 1 to 16384")),
    };
    let size: [u32; 2] = [number(parts.0)?, number(parts.1)?];
    if size[0] * size[1] > 1 << 26 { Err(format!("{text} are more than 2^26 pixels")) } else { Ok(size) }
}

/// Runs `omm render`.
pub(crate) fn run(args: &RenderArgs, format: Format) -> Result<Outcome, CliError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads).build();
    pool.map_err(CliError::Threads)?.install(|| args.render(format))
}

impl RenderArgs {
    fn render(&self, format: Format) -> Result<Outcome, CliError> {
        let mut files = OutputSet::of_file(&self.out)?;
        files.prepare()?;
        let scene = self.read_scene()?;
        let progress = Progress::new("baking", 0);
        let baked = Baked::new(&scene, &self.bake_options(), &|done, total| progress.set(done, total))?;
        drop(progress);

        let profile = DeviceProfile::reference();
        let mut device = Device::new(profile.clone());
        let mut watch = Watch::new(profile);
        let built = Built::new(&mut App::new(&mut device, &mut watch), &scene, &baked)?;
        let with = self.trace(&device, built.with.address, &scene)?;
        let without = if self.compare || self.stats.is_some() {
            Some(self.trace(&device, built.without.address, &scene)?)
        } else {
            None
        };
        let statistics = RenderStatistics::new(&baked, &with, without.as_ref());

        let sheet = self.sheet(&with.picture, without.as_ref().map(|traced| &traced.picture));
        files.add_png(&self.out.file_name().unwrap_or_default().to_string_lossy(), &sheet)?;
        let mut written = files.commit()?;
        if let Some(path) = &self.stats {
            let mut files = OutputSet::of_file(path)?;
            files.add_json(&path.file_name().unwrap_or_default().to_string_lossy(), &statistics)?;
            written.extend(files.commit()?);
        }
        match format {
            Format::Json => output::print_json(&statistics)?,
            Format::Text => output::print(|out| statistics.print(out, &written))?,
        }
        for violation in &watch.violations {
            output::complain(&violation.to_string());
        }
        let clean = watch.violations.is_empty() && statistics.images_identical != Some(false);
        Ok(if clean { Outcome::Clean } else { Outcome::Violations })
    }

    fn read_scene(&self) -> Result<RenderScene, CliError> {
        let mut scene = match &self.scene {
            None => garden::garden()?,
            Some(path) => omm_render::gltf::read(path, self.view.camera_name())?,
        };
        self.view.apply(&mut scene)?;
        Ok(scene)
    }

    fn bake_options(&self) -> BakeOptions {
        let options = BakeOptions::default();
        let level = self.level.or(if self.scene.is_none() { Some(garden::LEVEL) } else { None });
        BakeOptions { level: level.map_or(options.level, LevelChoice::Uniform), ..options }
    }

    fn trace(&self, device: &Device, address: DeviceAddress, scene: &RenderScene) -> Result<Traced, RenderError> {
        let rays = Scene::load(device, address)?;
        let tracer = Tracer::new(&rays, scene)?;
        let progress = Progress::new("tracing", self.size.map(u64::from).iter().product());
        let (since, traced) = (Instant::now(), AtomicU64::new(0));
        let step = |pixels, rays| {
            let traced = traced.fetch_add(rays, Ordering::Relaxed) + rays;
            let rate = traced as f64 / since.elapsed().as_secs_f64().max(1e-9) / 1e6;
            progress.advance_with(pixels, format!("tracing, {rate:.2} million rays a second"));
        };
        let options = PictureOptions { size: self.size, samples: self.samples, seed: self.seed };
        let picture = tracer.picture(&options, &step)?;
        Ok(Traced { picture, seconds: since.elapsed().as_secs_f64(), triangles: rays.triangle_count() })
    }

    /// What the file shows.
    fn sheet(&self, with: &Picture, without: Option<&Picture>) -> image::RgbImage {
        let modes: &[ModeName] = match (self.mode.as_slice(), self.compare) {
            ([], true) => &[ModeName::Shaded, ModeName::AnyHit],
            ([], false) => &[ModeName::Shaded],
            (modes, _) => modes,
        };
        let row = |&mode: &ModeName| match without {
            Some(without) if self.compare => paper::compared(without, with, mode.into()),
            _ => paper::single(with, mode.into()),
        };
        paper::stacked(&modes.iter().map(row).collect::<Vec<_>>())
    }
}
