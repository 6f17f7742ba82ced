//! `omm bake`: micromaps for glTF files and job files.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use omm_bake::gltf::{self, GltfFile};
use omm_bake::image::ImageOptions;
use omm_bake::job::{self, Job};
use omm_bake::{BakeInput, BakeOptions, BakeOutput, LevelChoice, UnknownStatePromotion};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;

use crate::cli::Format;
use crate::curve::{finite, level};
use crate::error::{CliError, Outcome};
use crate::output::{self, OutputSet};
use crate::progress::Progress;

mod baked;
mod dry;
mod images;
mod report;
mod statistics;
mod target;
mod tuning;

use baked::Baked;
use dry::Forecast;
use images::Images;
pub(crate) use report::ReportError;
use statistics::Statistics;
use target::Target;
use tuning::Tuning;

/// Arguments of `omm bake`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct BakeArgs {
    /// A glTF file (.gltf, .glb), of which every alpha-masked primitive is baked, or a job file (.json).
    input: PathBuf,
    /// Where results go; made if absent.
    #[arg(long, value_name = "DIR", required_unless_present_any = ["dry_run", "bundle"])]
    out: Option<PathBuf>,
    /// Put all results into one bundle and not into a folder.
    #[arg(short = 'o', long, value_name = "FILE.omm", conflicts_with_all = ["out", "picture", "coverage", "index_type"])]
    bundle: Option<PathBuf>,
    /// Also draw each texture with its microtriangles coloured by state.
    #[arg(long)]
    picture: bool,
    /// Also write a page about the results that opens in a browser, without a network.
    #[arg(long, value_name = "FILE.html")]
    report: Option<PathBuf>,
    /// Also write the glTF file with the micromaps in it, complete in itself; .gltf or .glb says which kind.
    #[arg(long, value_name = "OUT.glb")]
    gltf: Option<PathBuf>,
    /// Subdivision level of every triangle, 0 to 12; with --dynamic, the finest.
    #[arg(long, value_name = "L", value_parser = level)]
    level: Option<SubdivisionLevel>,
    /// Choose levels so that a microtriangle covers about SCALE x SCALE texels.
    #[arg(long, value_name = "SCALE", value_parser = positive)]
    dynamic: Option<f32>,
    /// How many states an element can have.
    #[arg(long, value_name = "N")]
    state: Option<States>,
    /// Opaque is alpha above this.
    #[arg(long, value_name = "ALPHA", value_parser = finite, allow_negative_numbers = true)]
    cutoff: Option<f32>,
    /// Which unknown state a mixed microtriangle gets.
    #[arg(long, value_name = "HOW")]
    promotion: Option<Promotion>,
    /// Store data for triangles of one state, too.
    #[arg(long)]
    no_special_indices: bool,
    /// How many threads bake; one for each core if 0.
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,
    #[command(flatten)]
    images: Images,
    #[command(flatten)]
    tuning: Tuning,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum States {
    /// Transparent and opaque.
    #[value(name = "2")]
    Two,
    /// Also unknown transparent and unknown opaque.
    #[value(name = "4")]
    Four,
}

/// Which unknown state a mixed microtriangle gets.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Promotion {
    /// The one that more of it is.
    Nearest,
    /// Unknown opaque.
    #[value(alias = "force_opaque")]
    ForceOpaque,
    /// Unknown transparent.
    #[value(alias = "force_transparent")]
    ForceTransparent,
}

impl From<Promotion> for UnknownStatePromotion {
    fn from(promotion: Promotion) -> Self {
        match promotion {
            Promotion::Nearest => Self::Nearest,
            Promotion::ForceOpaque => Self::ForceOpaque,
            Promotion::ForceTransparent => Self::ForceTransparent,
        }
    }
}

/// A finite number above 0 as an argument.
fn positive(text: &str) -> Result<f32, String> {
    match finite(text)? {
        number if number > 0.0 => Ok(number),
        _ => Err(format!("{text} is not above 0")),
    }
}

/// Runs `omm bake`.
pub(crate) fn run(args: &BakeArgs, format: Format) -> Result<Outcome, CliError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads).build().map_err(CliError::Threads)?;
    if args.tuning.dry_run {
        let forecasts = pool.install(|| args.forecast())?;
        match format {
            Format::Text => output::print(|out| dry::print(&forecasts, out))?,
            Format::Json => output::print_json(&forecasts)?,
        }
        return Ok(Outcome::Clean);
    }
    let (results, place) = pool.install(|| args.bake())?;
    match format {
        Format::Text => output::print(|out| print(&results, &place, out))?,
        Format::Json => output::print_json(&results)?,
    }
    Ok(Outcome::Clean)
}

/// What an input file holds.
enum Input {
    Job(Box<Job>),
    Gltf(GltfFile),
}

impl Input {
    /// Reads a file of the kind that its first bytes or its name say.
    fn read(path: &Path, options: ImageOptions) -> Result<Self, CliError> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        if name.ends_with(".gltf") || name.ends_with(".glb") || output::starts_with(path, b"glTF")? {
            Ok(Self::Gltf(gltf::read(path, options)?))
        } else if name.ends_with(".json") {
            Ok(Self::Job(Box::new(job::read(path)?)))
        } else {
            Err(CliError::UnknownInput { path: path.into() })
        }
    }

    /// The files that were read.
    fn files(&self) -> &[PathBuf] {
        match self {
            Self::Job(job) => &job.files,
            Self::Gltf(file) => &file.files,
        }
    }
}

/// One thing to bake.
struct Item<'a> {
    name: &'a str,
    /// The name of the mesh in the file, which may be anything.
    label: Option<&'a str>,
    /// Number of the mesh in the glTF file and of the primitive in the mesh; none for a job.
    place: Option<(usize, usize)>,
    /// Number of the texture among those of the file.
    texture: usize,
    input: BakeInput<'a>,
    options: BakeOptions,
}

impl BakeArgs {
    /// Bakes everything and leaves the results in their place, which it names: all or none.
    fn bake(&self) -> Result<(Vec<Statistics>, PathBuf), CliError> {
        let input = Input::read(&self.input, self.images.options(self.tuning.mips))?;
        self.check_gltf(&input)?;
        let mut files = Target::new(self, &input)?;
        let all: Vec<_> = self.items(&input)?.into_iter().map(|item| self.bake_one(item)).collect::<Result<_, _>>()?;
        if self.picture {
            files.add_pictures(&all)?;
        }
        let report = self.report.as_deref().map(|path| baked::stage_report(&self.input, &all, path)).transpose()?;
        let gltf = self.gltf.as_deref().map(|path| baked::stage_gltf(&self.input, &all, path)).transpose()?;
        let mut results = Vec::new();
        for one in all {
            results.push(files.add(one, self.tuning.coverage)?);
        }
        let place = files.commit()?;
        for files in [report, gltf].into_iter().flatten() {
            files.commit()?;
        }
        Ok((results, place))
    }

    /// Says what would be baked.
    fn forecast(&self) -> Result<Vec<Forecast>, CliError> {
        let input = Input::read(&self.input, self.images.options(self.tuning.mips))?;
        let forecast = |item: Item<'_>| {
            Forecast::new(item.name, &item.input, &item.options).map_err(dry::refused(&self.input, item.name))
        };
        self.items(&input)?.into_iter().map(forecast).collect()
    }

    /// Everything to bake, in order.
    fn items<'a>(&self, input: &'a Input) -> Result<Vec<Item<'a>>, CliError> {
        match input {
            Input::Job(job) => {
                let options = self.options(job.options.clone())?;
                Ok(vec![Item { name: &job.name, label: None, place: None, texture: 0, input: job.input(), options }])
            }
            Input::Gltf(file) => {
                let mut items = Vec::new();
                for primitive in &file.primitives {
                    let Some(texture) = file.textures.get(primitive.texture) else { continue };
                    let BakeArgs { cutoff, .. } = *self;
                    let options = BakeOptions {
                        sampler: primitive.sampler,
                        alpha_cutoff: cutoff.map_or(primitive.alpha_cutoff, |cutoff| primitive.cutoff_for(cutoff)),
                        ..self.options(BakeOptions::default())?
                    };
                    items.push(Item {
                        name: &primitive.name,
                        label: primitive.mesh_name.as_deref(),
                        place: Some((primitive.mesh, primitive.primitive)),
                        texture: primitive.texture,
                        input: BakeInput { texture, uvs: &primitive.uvs, triangles: &primitive.triangles },
                        options,
                    });
                }
                Ok(items)
            }
        }
    }

    /// `--gltf` needs a glTF file to add to, and a name that says what kind is to be written.
    fn check_gltf(&self, input: &Input) -> Result<(), CliError> {
        match (&self.gltf, input) {
            (Some(_), Input::Job(_)) => Err(CliError::GltfOfJob { path: self.input.clone() }),
            (Some(path), _) if baked::gltf_kind(path).is_none() => Err(CliError::UnknownOutput { path: path.clone() }),
            _ => Ok(()),
        }
    }

    /// `options` with those of the command line in their place.
    fn options(&self, options: BakeOptions) -> Result<BakeOptions, CliError> {
        let level = match (self.level, self.dynamic, options.level) {
            (None, None, level) => level,
            (Some(level), None, _) => LevelChoice::Uniform(level),
            (Some(max), Some(scale), _) => LevelChoice::Dynamic { scale, max },
            (None, Some(scale), LevelChoice::Uniform(max) | LevelChoice::Dynamic { max, .. }) => {
                LevelChoice::Dynamic { scale, max }
            }
        };
        let format = self.state.map(|states| match states {
            States::Two => OpacityMicromapFormat::TwoState,
            States::Four => OpacityMicromapFormat::FourState,
        });
        self.tuning.apply(BakeOptions {
            level,
            format: format.unwrap_or(options.format),
            promotion: self.promotion.map_or(options.promotion, Into::into),
            alpha_cutoff: self.cutoff.unwrap_or(options.alpha_cutoff),
            special_indices: options.special_indices && !self.no_special_indices,
            ..options
        })
    }

    fn bake_one<'a>(&self, item: Item<'a>) -> Result<Baked<'a>, CliError> {
        let Item { name, input, options, .. } = &item;
        let since = std::time::Instant::now();
        let bar = Progress::new(name, 0);
        let progress = |at: omm_bake::Progress| bar.set(at.done, at.total);
        let refused = || dry::refused(&self.input, name);
        let output = omm_bake::bake(input, options, &progress).map_err(refused())?;
        drop(bar);
        let time = since.elapsed();
        let (index_type, indices) = output.index_buffer(self.tuning.index_type.types()).map_err(refused())?;
        let coverage = omm_bake::coverage(input, &output);
        let statistics = Statistics::new(name, input, options, &output, &coverage, index_type, time);
        Ok(Baked { item, output, indices, coverage, statistics })
    }
}

/// Adds the three files of data: the micromap's array, its triangles, and the index buffer.
pub(crate) fn write_data(
    name: &str,
    output: &BakeOutput,
    indices: &[u8],
    files: &mut OutputSet,
) -> Result<(), CliError> {
    let BakeOutput { array, triangles, .. } = output;
    files.add(format!("{name}.array.bin"), |out| out.write_all(array))?;
    files.add(format!("{name}.desc.bin"), |out| {
        triangles.iter().try_for_each(|&triangle| out.write_all(&omm_layout::triangle::encode(&triangle.into())))
    })?;
    files.add(format!("{name}.index.bin"), |out| out.write_all(indices))
}

fn print(results: &[Statistics], place: &Path, out: &mut dyn Write) -> std::io::Result<()> {
    let width = results.iter().map(|result| result.name().chars().count()).max().unwrap_or(0).max("name".len());
    writeln!(
        out,
        "{:<width$}  {:>9}  {:>9}  {:>12}  {:>14}  {:>7}  {:>8}",
        "name", "triangles", "special", "array bytes", "microtriangles", "known", "seconds"
    )?;
    for result in results {
        result.print_row(width, out)?;
    }
    writeln!(out, "written to {}", place.display())
}

const HELP: &str = "\
Results, for a job its name, for a glTF primitive MESH_primN:
  NAME.array.bin     the micromap's data
  NAME.desc.bin      for each micromap triangle: u32 offset, u16 level, u16 format
  NAME.index.bin     for each triangle of the mesh: a micromap triangle or, as -1 to -4, a special
                     index; 32 bits unless --index-type says otherwise
  NAME.stats.json    what was counted
  NAME.coverage.json which part of each triangle is known, and its texels
  NAME.overlay.png   the picture
  textureN.atlas.png all primitives that read the texture, where there are several
With -o they go into one bundle instead, with the digests of the files that were read.

A glTF file's alphaCutoff, alpha factor, texture transform and sampler are honoured, and its
levels are chosen as with --dynamic 2 --level 8. The order of a triangle's vertices matters:
build the geometry from the same indices. Images are PNG, JPEG, TGA, DDS or KTX2; block-compressed
ones are decoded as a device does.

Examples:
  omm bake model.glb --out baked --picture
  omm bake model.glb --out baked --report report.html --gltf model-omm.glb
  omm bake model.glb --out baked --level 5 --state 2
  omm bake leaf.job.json --out baked --format json
  omm bake model.glb -o model.omm
  omm bake model.glb --dry-run --max-array-bytes 65536
  omm bake smoke.job.json --out baked --cutoff 0 --greater uo

Exit status:
  0  clean
  2  could not run: bad arguments, bad input, unwritable output; nothing is left behind";
