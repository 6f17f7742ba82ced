//! How a run ends: an [`Outcome`], or a [`CliError`] that says what could not be done and where.

use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use omm_bake::BakeError;
use omm_bake::gltf::GltfError;
use omm_bake::job::JobError;

/// How a verb that could run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Nothing to complain about: exit status 0.
    Clean,
    /// The input contradicts what it was held against: exit status 1.
    Violations,
}

impl From<Outcome> for ExitCode {
    fn from(outcome: Outcome) -> Self {
        match outcome {
            Outcome::Clean => 0.into(),
            Outcome::Violations => 1.into(),
        }
    }
}

/// Why a verb could not run: exit status 2.
#[derive(Debug, thiserror::Error)]
pub(crate) enum CliError {
    /// A file cannot be opened or read.
    #[error("{}: cannot read: {source}", path.display())]
    Read { path: PathBuf, source: io::Error },
    /// A file or folder cannot be created, written or renamed.
    #[error("{}: cannot write: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
    /// The standard output cannot be written.
    #[error("standard output: {0}")]
    StandardOutput(io::Error),
    /// A file of curve records ends within a record.
    #[error("{}: record {record} at byte {offset} is cut short: {found} of 16 bytes", path.display())]
    TruncatedRecord { path: PathBuf, record: u64, offset: u64, found: usize },
    /// A curve record's level is above 12.
    #[error("{}: record {record}, field level at byte {offset}: {source}", path.display())]
    RecordLevel { path: PathBuf, record: u64, offset: u64, source: omm_model::level::SubdivisionLevelError },
    /// The input of `bake` is of no kind that it knows.
    #[error("{}: neither glTF (.gltf, .glb) nor a job file (.json)", path.display())]
    UnknownInput { path: PathBuf },
    /// The kind of a glTF file to write cannot be told from its name.
    #[error("{}: neither .gltf nor .glb", path.display())]
    UnknownOutput { path: PathBuf },
    /// There is no glTF file to which the results could be added.
    #[error("{}: --gltf adds to a glTF file, which a job is not", path.display())]
    GltfOfJob { path: PathBuf },
    /// A report cannot be written.
    #[error("report: {0}")]
    Report(crate::bake::ReportError),
    /// A job file or a file that it names is bad.
    #[error(transparent)]
    Job(#[from] JobError),
    /// A glTF file or a file that it names is bad.
    #[error(transparent)]
    Gltf(#[from] GltfError),
    /// A scenario is no text.
    #[error("{}: {source}", path.display())]
    NotText { path: PathBuf, source: std::string::FromUtf8Error },
    /// A scenario cannot be read or run.
    #[error("{0}")]
    Scenario(omm_scenario::ScenarioError),
    /// The scenarios that `omm` carries cannot be read.
    #[error(transparent)]
    Library(#[from] omm_scenario::LibraryError),
    /// There is no rule of that identifier.
    #[error("no rule is, or ends in, {wanted}; {}`omm rules` lists them", offered(near))]
    UnknownRule { wanted: String, near: Vec<String> },
    /// A file is not a whole number of elements long.
    #[error("{}: {size} bytes are not a multiple of {unit}, the size of an element", path.display())]
    CutShort { path: PathBuf, size: u64, unit: u64 },
    /// A profile file is bad.
    #[error("{}: not a device profile: {source}", path.display())]
    Profile { path: PathBuf, source: serde_json::Error },
    /// The simulated device had no room.
    #[error("check: {0}")]
    Check(omm_device::app::AppError),
    /// A scene cannot be baked, built or traced.
    #[error(transparent)]
    Render(#[from] omm_render::RenderError),
    /// A serialized structure does not decode.
    #[error("{}: {source} (the file has {file_size} bytes)", path.display())]
    Blob { path: PathBuf, file_size: u64, source: omm_serialize::ReadError },
    /// A map of addresses is no JSON object of hexadecimal addresses.
    #[error("{}: {reason}", path.display())]
    AddressMap { path: PathBuf, reason: String },
    /// A bundle does not decode.
    #[error("{}: {source} (the file has {file_size} bytes)", path.display())]
    Bundle { path: PathBuf, file_size: u64, source: omm_serialize::ReadError },
    /// The bytes of a trace do not decode.
    #[error("{}: {source} (the file has {file_size} bytes)", path.display())]
    Trace { path: PathBuf, file_size: u64, source: omm_serialize::ReadError },
    /// The text of a trace cannot be read, or a trace has no text.
    #[error("{}: {source}", path.display())]
    TraceText { path: PathBuf, source: omm_serialize::trace::TraceTextError },
    /// The name of a file says nothing of the form of trace that is to be written.
    #[error("{}: a trace is written as .ron (text) or .ommtrace (bytes)", path.display())]
    TraceExtension { path: PathBuf },
    /// A trace is of one scenario.
    #[error("{}: a trace is of one scenario, these are {scenarios}", path.display())]
    TraceOfMany { path: PathBuf, scenarios: usize },
    /// A trace does not do what is to be kept of it.
    #[error("{}: {source}", path.display())]
    Minimize { path: PathBuf, source: omm_scenario::MinimizeError },
    /// Results of `bake` cannot go into a bundle.
    #[error("{}: {reason}", path.display())]
    Pack { path: PathBuf, reason: String },
    /// Elements of a file are none: levels or formats of triangles, or records of micromap triangles.
    #[error("{}: {reason}", path.display())]
    Elements { path: PathBuf, reason: String },
    /// Threads cannot be started.
    #[error("cannot start threads: {0}")]
    Threads(rayon::ThreadPoolBuildError),
    /// The baker refuses an input.
    #[error("{input}: {source}")]
    Bake { input: String, source: BakeError },
}

/// `did you mean A, B or C? `
fn offered(near: &[String]) -> String {
    match near {
        [] => String::new(),
        [only] => format!("did you mean {only}? "),
        [first @ .., last] => format!("did you mean {} or {last}? ", first.join(", ")),
    }
}

impl CliError {
    /// The exit status of every error.
    pub(crate) const EXIT_CODE: u8 = 2;

    /// For `map_err`: `path` cannot be read.
    pub(crate) fn read(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Read { path: path.into(), source }
    }

    /// For `map_err`: `path` cannot be written.
    pub(crate) fn write(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Write { path: path.into(), source }
    }
}
