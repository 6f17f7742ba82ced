//! Where the results of a bake go: files in a folder, or one bundle.

use std::path::{Component, Path, PathBuf};

use omm_bake::{BakeOutput, picture};
use omm_serialize::bundle::{BundleData, MicromapData, Source};

use super::baked::{self, Baked};
use super::statistics::Statistics;
use super::{BakeArgs, Input, write_data};
use crate::bundle::{settings_and_statistics, source};
use crate::error::CliError;
use crate::output::OutputSet;

/// Where results go when all of them are there.
pub(super) enum Target {
    Folder { path: PathBuf, files: OutputSet },
    Bundle { path: PathBuf, file: OutputSet, sources: Vec<Source>, data: BundleData },
}

impl Target {
    /// The place that the arguments name. Better to find out now than after the work that it cannot be written.
    pub(super) fn new(args: &BakeArgs, input: &Input) -> Result<Self, CliError> {
        let prepared = |mut files: OutputSet| files.prepare().map(|()| files);
        Ok(match (&args.bundle, &args.out) {
            (Some(path), _) => Self::Bundle {
                path: path.clone(),
                file: prepared(OutputSet::of_file(path)?)?,
                sources: sources(&args.input, input)?,
                data: BundleData::default(),
            },
            (None, out) => {
                let path = out.clone().unwrap_or_default();
                Self::Folder { files: prepared(OutputSet::new(&path))?, path }
            }
        })
    }

    /// Adds pictures of what was baked, and of each texture that more than one primitive reads. A bundle takes none.
    pub(super) fn add_pictures(&mut self, baked: &[Baked<'_>]) -> Result<(), CliError> {
        let Self::Folder { files, .. } = self else { return Ok(()) };
        for one in baked {
            let picture = picture::overlay(&one.input, one.options.sampler, &one.output);
            files.add_png(&format!("{}.overlay.png", one.statistics.name()), &picture)?;
        }
        baked::write_atlases(baked, files)
    }

    /// Adds what was baked, under the name that its statistics have, and answers with these. A bundle takes no coverage.
    pub(super) fn add(&mut self, baked: Baked<'_>, with_coverage: bool) -> Result<Statistics, CliError> {
        let Baked { output, indices, coverage, statistics, .. } = baked;
        let name = statistics.name();
        match self {
            Self::Folder { files, .. } => {
                write_data(name, &output, &indices, files)?;
                if with_coverage {
                    files.add_json(&format!("{name}.coverage.json"), &coverage)?;
                }
                files.add_json(&format!("{name}.stats.json"), &statistics)?;
            }
            Self::Bundle { path, sources, data, .. } => {
                // As text and back, so that numbers are spelt as in NAME.stats.json.
                let text = serde_json::to_vec(&statistics);
                let value = text.and_then(|text| serde_json::from_slice(&text));
                let value = value.map_err(|error| CliError::write(path)(error.into()))?;
                let (settings, numbers) = settings_and_statistics(value);
                let BakeOutput { array, triangles, indices, usage_counts, index_usage_counts, .. } = output;
                data.micromaps.push(MicromapData {
                    name: name.to_owned(),
                    array,
                    triangles,
                    indices,
                    usage_counts,
                    index_usage_counts,
                    settings,
                    sources: sources.clone(),
                    statistics: numbers,
                });
            }
        }
        Ok(statistics)
    }

    /// Lets everything appear, and says where.
    pub(super) fn commit(self) -> Result<PathBuf, CliError> {
        match self {
            Self::Folder { path, files } => files.commit().map(|_| path),
            Self::Bundle { path, mut file, data, .. } => {
                file.add_file(&path, |out| data.write_to(out))?;
                file.commit().map(|_| path)
            }
        }
    }
}

/// The digests of the files that were read, under their paths from the folder of `path` on; outside of it, under their names.
fn sources(path: &Path, input: &Input) -> Result<Vec<Source>, CliError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let relative = |file: &PathBuf| {
        let part = |part| match part {
            Component::Normal(part) => part.to_str(),
            _ => None,
        };
        let parts: Option<Vec<_>> = file.strip_prefix(folder).ok()?.components().map(part).collect();
        Some(parts?.join("/"))
    };
    input
        .files()
        .iter()
        .map(|file| {
            let found = source(file)?;
            Ok(Source { name: relative(file).unwrap_or_else(|| found.name.clone()), ..found })
        })
        .collect()
}
