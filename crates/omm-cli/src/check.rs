//! `omm check`: is this data what a device may be given?
//!
//! The data is uploaded to a simulated device and built there by the calls that an application would make; every call passes the
//! validator, whose findings are the answer.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use clap::{Args, Subcommand, ValueEnum};
use omm_device::Device;
use omm_device::app::{App, AppError, Structure};
use omm_layout::index::IndexType;
use omm_layout::triangle::{self, TriangleArray};
use omm_model::call::Call;
use omm_model::profile::DeviceProfile;
use omm_model::vk;
use omm_validate::Violation;
use serde::Serialize;

use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::output;
use crate::watch::Watch;

/// Arguments of `omm check`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct CheckArgs {
    #[command(subcommand)]
    what: What,
}

/// What is checked.
#[derive(Debug, Subcommand)]
enum What {
    /// Packed data, triangle array and index buffer of a micromap.
    Array(ArrayArgs),
}

/// Arguments of `omm check array`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
struct ArrayArgs {
    /// The packed elements: what `data` points to.
    #[arg(long, value_name = "FILE")]
    array: PathBuf,
    /// The triangle array, 8 bytes an entry: what `triangleArray` points to.
    #[arg(long, value_name = "FILE")]
    desc: PathBuf,
    /// The index buffer of the geometry that the micromap is attached to.
    #[arg(long, value_name = "FILE")]
    index: Option<PathBuf>,
    /// How its indices are stored.
    #[arg(long, value_enum, default_value_t = Index::Uint32)]
    index_type: Index,
    /// What is added to indices that are not special.
    #[arg(long, default_value_t = 0)]
    base_triangle: u32,
    /// The device: reference, minimum, or a JSON file with a profile.
    #[arg(long, default_value = "reference")]
    profile: String,
    /// Build lossy: levels up to the lossy limit are allowed.
    #[arg(long)]
    lossy: bool,
}

/// How indices are stored.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Index {
    Uint8,
    Uint16,
    Uint32,
}

const HELP: &str = "\
Usage counts are made from the triangle array. Signed 32-bit indices, as `omm bake` writes them, are uint32.

Examples:
  omm check array --array fern.array.bin --desc fern.desc.bin --index fern.index.bin
  omm check array --array a.bin --desc d.bin --profile minimum --format json

Exit status:
  0  nothing is wrong
  1  violations were found
  2  could not run";

/// What was found.
#[derive(Serialize)]
struct Findings {
    micromap_triangles: u64,
    geometry_triangles: u64,
    violations: Vec<Violation>,
    /// What the simulated device cannot go on with, if it stops.
    device: Option<String>,
}

/// Runs `omm check`.
pub(crate) fn run(args: &CheckArgs, format: Format) -> Result<Outcome, CliError> {
    let What::Array(args) = &args.what;
    let findings = args.findings()?;
    let clean = findings.violations.is_empty() && findings.device.is_none();
    match format {
        Format::Json => output::print_json(&findings)?,
        Format::Text => output::print(|out| {
            for violation in &findings.violations {
                writeln!(out, "{violation}")?;
            }
            if let Some(stop) = &findings.device {
                writeln!(out, "device: {stop}")?;
            }
            let Findings { micromap_triangles, geometry_triangles, violations, .. } = &findings;
            writeln!(
                out,
                "{micromap_triangles} micromap triangles, {geometry_triangles} indices, {} violations",
                violations.len()
            )
        })?,
    }
    Ok(if clean { Outcome::Clean } else { Outcome::Violations })
}

impl ArrayArgs {
    fn profile(&self) -> Result<DeviceProfile, CliError> {
        if let Some(profile) = DeviceProfile::preset(&self.profile) {
            return Ok(profile);
        }
        let path = PathBuf::from(&self.profile);
        let text = output::read(&path)?;
        serde_json::from_slice(&text).map_err(|source| CliError::Profile { path, source })
    }

    fn findings(&self) -> Result<Findings, CliError> {
        let profile = self.profile()?;
        let data = output::read(&self.array)?;
        let entries = output::read(&self.desc)?;
        let count = entries.len() / triangle::SIZE;
        if !entries.len().is_multiple_of(triangle::SIZE) {
            return Err(CliError::CutShort {
                path: self.desc.clone(),
                size: entries.len() as u64,
                unit: triangle::SIZE as u64,
            });
        }
        let index = self.index.as_deref().map(output::read).transpose()?;
        let unit = self.index_type.ty().size();
        if let (Some(path), Some(index)) = (&self.index, &index)
            && !(index.len() as u64).is_multiple_of(unit.into())
        {
            return Err(CliError::CutShort { path: path.clone(), size: index.len() as u64, unit: unit.into() });
        }
        let indices = index.as_ref().map_or(0, |index| index.len() as u64 / u64::from(unit));

        let mut device = Device::new(profile.clone());
        let mut watch = Watch::new(profile);
        let mut app = App::new(&mut device, &mut watch);
        let built = self.build(&mut app, &data, &entries, index.as_deref());
        let device = match built {
            Ok(()) => None,
            Err(AppError::Undefined(stop)) => Some(stop.to_string()),
            Err(other) => return Err(CliError::Check(other)),
        };
        let violations = without_repeats(watch.violations);
        Ok(Findings { micromap_triangles: count as u64, geometry_triangles: indices, violations, device })
    }

    /// The calls of an application that builds the micromap and attaches it.
    fn build(&self, app: &mut App<'_>, data: &[u8], entries: &[u8], index: Option<&[u8]>) -> Result<(), AppError> {
        let micromap = self.build_micromap(app, data, entries)?;
        match index {
            Some(index) => self.attach(app, &micromap, index),
            None => Ok(()),
        }
    }

    fn build_micromap(&self, app: &mut App<'_>, data: &[u8], entries: &[u8]) -> Result<Structure, AppError> {
        let array = TriangleArray::new(entries, triangle::SIZE as u64, entries.len() as u64 / triangle::SIZE as u64)?;
        let usage_counts = Some(usage_counts(&array));
        let (data, triangles) = (app.upload_input(data)?, app.upload_input(entries)?);
        let micromap_data = vk::GeometryMicromapData {
            usage_counts,
            data: data.address,
            triangle_array: triangles.address,
            triangle_array_stride: triangle::SIZE as u64,
            ..Default::default()
        };
        let geometry = vk::Geometry {
            next: vec![micromap_data.into()],
            geometry_type: vk::GeometryType::MICROMAP,
            ..Default::default()
        };
        let lossy = vk::BuildAccelerationStructureFlags::MICROMAP_LOSSY;
        let info = vk::BuildGeometryInfo {
            ty: vk::AccelerationStructureType::OPACITY_MICROMAP,
            flags: if self.lossy { lossy } else { vk::BuildAccelerationStructureFlags::empty() },
            geometries: Some(vec![geometry]),
            ..Default::default()
        };
        match app.build(info.clone(), None) {
            // The device cannot size what it cannot read; the rules can still say which entry it is.
            Err(AppError::Undefined(stop)) if stop.command == SIZES => build_without_sizes(app, info),
            result => result,
        }
    }

    /// Attaches the micromap to as many triangles as there are indices. The triangles are all the same point: only indices matter.
    fn attach(&self, app: &mut App<'_>, micromap: &Structure, index: &[u8]) -> Result<(), AppError> {
        let ty = self.index_type.ty();
        let (vertex, indices) = (app.upload_input(&[0; 12])?, app.upload_input(index)?);
        let attached = vk::TrianglesOpacityMicromap {
            index_type: ty.into(),
            index_buffer: indices.address,
            index_stride: ty.size().into(),
            base_triangle: self.base_triangle,
            micromap: micromap.handle,
            ..Default::default()
        };
        let triangles = vk::GeometryTrianglesData {
            next: vec![attached.into()],
            vertex_format: vk::Format::R32G32B32_SFLOAT,
            vertex_data: vertex.address.into(),
            index_type: vk::IndexType::NONE,
            ..Default::default()
        };
        let geometry = vk::Geometry {
            geometry_type: vk::GeometryType::TRIANGLES,
            geometry: vk::GeometryData::Triangles(triangles),
            ..Default::default()
        };
        let info = vk::BuildGeometryInfo {
            ty: vk::AccelerationStructureType::BOTTOM_LEVEL,
            geometries: Some(vec![geometry]),
            ..Default::default()
        };
        let found = index.len() / ty.size().max(1) as usize;
        let primitive_count = u32::try_from(found).map_err(|_| AppError::Count { what: "indices", found })?;
        app.build(info, Some(vec![vk::BuildRangeInfo { primitive_count, ..Default::default() }]))?;
        Ok(())
    }
}

/// The command that asks for sizes, which repeats what the build finds.
const SIZES: &str = "vkGetAccelerationStructureBuildSizesKHR";

/// Records the build into a micromap of a made-up size.
fn build_without_sizes(app: &mut App<'_>, mut info: vk::BuildGeometryInfo) -> Result<Structure, AppError> {
    let micromap = app.create(info.ty, 1 << 16)?;
    let scratch = app.buffer(1 << 16, vk::BufferUsageFlags::STORAGE_BUFFER)?;
    info.dst_acceleration_structure = micromap.handle;
    info.scratch_data = scratch.address.into();
    app.submit(|command_buffer| {
        vec![Call::CmdBuildAccelerationStructures { command_buffer, infos: vec![info], build_range_infos: vec![None] }]
    })?;
    Ok(micromap)
}

/// Leaves out what the size query found if the build found it, too.
fn without_repeats(violations: Vec<Violation>) -> Vec<Violation> {
    let again: BTreeSet<_> = violations.iter().filter(|found| found.command != SIZES).map(|found| found.rule).collect();
    violations.into_iter().filter(|found| found.command != SIZES || !again.contains(&found.rule)).collect()
}

/// Counts entries by level and format as they stand, meaningful or not.
fn usage_counts(array: &TriangleArray<'_>) -> Vec<vk::MicromapUsage> {
    let mut counts = BTreeMap::<_, u32>::new();
    for entry in array.iter() {
        let count = counts.entry((entry.subdivision_level, entry.format)).or_default();
        *count = count.saturating_add(1);
    }
    let usage = |((level, format), count): ((u16, u16), u32)| vk::MicromapUsage {
        count,
        subdivision_level: level.into(),
        format: vk::OpacityMicromapFormat(format.into()),
    };
    counts.into_iter().map(usage).collect()
}

impl Index {
    pub(crate) const fn ty(self) -> IndexType {
        match self {
            Self::Uint8 => IndexType::Uint8,
            Self::Uint16 => IndexType::Uint16,
            Self::Uint32 => IndexType::Uint32,
        }
    }
}
