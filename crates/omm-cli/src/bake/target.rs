//! Where the results of a bake go: files in a folder, or one bundle.

use std::path::{Component, Path, PathBuf};

use image::RgbaImage;
use omm_bake::BakeOutput;
use omm_serialize::bundle::{BundleData, MicromapData, Source};

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

    /// Adds what was baked under `name`. A bundle takes no picture.
    pub(super) fn add(
        &mut self,
        name: &str,
        output: BakeOutput,
        statistics: &Statistics,
        picture: Option<&RgbaImage>,
    ) -> Result<(), CliError> {
        match self {
            Self::Folder { files, .. } => {
                write_data(name, &output, files)?;
                files.add_json(&format!("{name}.stats.json"), statistics)?;
                picture.map_or(Ok(()), |picture| files.add_png(&format!("{name}.overlay.png"), picture))
            }
            Self::Bundle { path, sources, data, .. } => {
                // As text and back, so that numbers are spelt as in NAME.stats.json.
                let text = serde_json::to_vec(statistics);
                let value = text.and_then(|text| serde_json::from_slice(&text));
                let value = value.map_err(|error| CliError::write(path)(error.into()))?;
                let (settings, statistics) = settings_and_statistics(value);
                let BakeOutput { array, triangles, indices, usage_counts, index_usage_counts, statistics: _ } = output;
                let (name, sources) = (name.to_owned(), sources.clone());
                data.micromaps.push(MicromapData {
                    name,
                    array,
                    triangles,
                    indices,
                    usage_counts,
                    index_usage_counts,
                    settings,
                    sources,
                    statistics,
                });
                Ok(())
            }
        }
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
