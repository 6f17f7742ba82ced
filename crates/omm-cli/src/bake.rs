//! `omm bake`: micromaps for glTF files and job files.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{ArgGroup, Args, ValueEnum};
use omm_bake::gltf::{self, GltfFile};
use omm_bake::job::{self, Job};
use omm_bake::{BakeInput, BakeOptions, BakeOutput, LevelChoice, UnknownStatePromotion, picture};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;

use crate::cli::Format;
use crate::curve::{finite, level};
use crate::error::{CliError, Outcome};
use crate::output::{self, OutputSet};
use crate::progress::Progress;

mod statistics;
mod target;

use statistics::Statistics;
use target::Target;

/// Arguments of `omm bake`.
#[derive(Debug, Args)]
#[command(after_help = HELP, group(ArgGroup::new("target").required(true)))]
pub(crate) struct BakeArgs {
    /// A glTF file (.gltf, .glb), of which every alpha-masked primitive is baked, or a job file (.json).
    input: PathBuf,
    /// Where results go; made if absent.
    #[arg(long, value_name = "DIR", group = "target")]
    out: Option<PathBuf>,
    /// Put all results into one bundle and not into a folder.
    #[arg(short = 'o', long, value_name = "FILE.omm", group = "target", conflicts_with = "picture")]
    bundle: Option<PathBuf>,
    /// Also draw each texture with its microtriangles coloured by state.
    #[arg(long)]
    picture: bool,
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

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Promotion {
    /// The one that more of it is.
    Nearest,
    /// Unknown opaque.
    #[value(alias = "force_opaque")]
    ForceOpaque,
    /// Unknown transparent.
    #[value(alias = "force_transparent")]
    ForceTransparent,
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
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads).build();
    let (results, place) = pool.map_err(CliError::Threads)?.install(|| args.bake())?;
    match format {
        Format::Text => output::print(|out| print(&results, &place, out))?,
        Format::Json => output::print_json(&results)?,
    }
    Ok(Outcome::Clean)
}

/// What an input file holds.
enum Input {
    Job(Job),
    Gltf(GltfFile),
}

impl Input {
    /// Reads a file of the kind that its first bytes or its name say.
    fn read(path: &Path) -> Result<Self, CliError> {
        let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
        if name.ends_with(".gltf") || name.ends_with(".glb") || output::starts_with(path, b"glTF")? {
            Ok(Self::Gltf(gltf::read(path)?))
        } else if name.ends_with(".json") {
            Ok(Self::Job(job::read(path)?))
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

impl BakeArgs {
    /// Bakes everything and leaves the results in their place, which it names: all or none.
    fn bake(&self) -> Result<(Vec<Statistics>, PathBuf), CliError> {
        let input = Input::read(&self.input)?;
        let mut files = Target::new(self, &input)?;
        let mut results = Vec::new();
        match &input {
            Input::Job(job) => {
                let options = self.options(job.options.clone());
                results.push(self.bake_one(&job.name, &job.input(), &options, &mut files)?);
            }
            Input::Gltf(file) => {
                for primitive in &file.primitives {
                    let Some(texture) = file.textures.get(primitive.texture) else { continue };
                    let BakeArgs { cutoff, .. } = *self;
                    let options = BakeOptions {
                        sampler: primitive.sampler,
                        alpha_cutoff: cutoff.map_or(primitive.alpha_cutoff, |cutoff| primitive.cutoff_for(cutoff)),
                        ..self.options(BakeOptions::default())
                    };
                    let input = BakeInput { texture, uvs: &primitive.uvs, triangles: &primitive.triangles };
                    results.push(self.bake_one(&primitive.name, &input, &options, &mut files)?);
                }
            }
        }
        Ok((results, files.commit()?))
    }

    /// `options` with those of the command line in their place.
    fn options(&self, options: BakeOptions) -> BakeOptions {
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
        let promotion = self.promotion.map(|promotion| match promotion {
            Promotion::Nearest => UnknownStatePromotion::Nearest,
            Promotion::ForceOpaque => UnknownStatePromotion::ForceOpaque,
            Promotion::ForceTransparent => UnknownStatePromotion::ForceTransparent,
        });
        BakeOptions {
            level,
            format: format.unwrap_or(options.format),
            promotion: promotion.unwrap_or(options.promotion),
            alpha_cutoff: self.cutoff.unwrap_or(options.alpha_cutoff),
            special_indices: options.special_indices && !self.no_special_indices,
            ..options
        }
    }

    fn bake_one(
        &self,
        name: &str,
        input: &BakeInput<'_>,
        options: &BakeOptions,
        files: &mut Target,
    ) -> Result<Statistics, CliError> {
        let since = std::time::Instant::now();
        let bar = Progress::new(name, 0);
        let progress = |at: omm_bake::Progress| bar.set(at.done, at.total);
        let output = omm_bake::bake(input, options, &progress)
            .map_err(|source| CliError::Bake { input: format!("{}: {name}", self.input.display()), source })?;
        drop(bar);
        let statistics = Statistics::new(name, input, options, &output, since.elapsed());
        let picture = self.picture.then(|| picture::overlay(input, options.sampler, &output));
        files.add(name, output, &statistics, picture.as_ref())?;
        Ok(statistics)
    }
}

/// Adds the three files of data: the micromap's array, its triangles, and the index buffer.
pub(crate) fn write_data(name: &str, output: &BakeOutput, files: &mut OutputSet) -> Result<(), CliError> {
    let BakeOutput { array, triangles, indices, .. } = output;
    files.add(format!("{name}.array.bin"), |out| out.write_all(array))?;
    files.add(format!("{name}.desc.bin"), |out| {
        triangles.iter().try_for_each(|&triangle| out.write_all(&omm_layout::triangle::encode(&triangle.into())))
    })?;
    files.add(format!("{name}.index.bin"), |out| {
        indices.iter().try_for_each(|index| out.write_all(&index.to_le_bytes()))
    })
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
  NAME.index.bin     for each triangle of the mesh: i32, a micromap triangle or a special index
  NAME.stats.json    what was counted
  NAME.overlay.png   the picture
With -o they go into one bundle instead, with the digests of the files that were read.

A glTF file's alphaCutoff, alpha factor, texture transform and sampler are honoured, and its
levels are chosen as with --dynamic 2 --level 8. The order of a triangle's vertices matters:
build the geometry from the same indices.

Examples:
  omm bake model.glb --out baked --picture
  omm bake model.glb --out baked --level 5 --state 2
  omm bake leaf.job.json --out baked --format json
  omm bake model.glb -o model.omm

Exit status:
  0  clean
  2  could not run: bad arguments, bad input, unwritable output; nothing is left behind";
