//! Scenarios in files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use omm_validate::RuleId;
use omm_validate::catalog::{RULES, Status};

use crate::error::ScenarioError;
use crate::scenario::Scenario;

/// Why the scenarios of a folder cannot be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LibraryError {
    /// A file or folder cannot be read.
    #[error("{}: {error}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What is wrong with it.
        error: std::io::Error,
    },
    /// A file holds no scenario.
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
}

/// Names and texts of the scenarios under `spec-tests/`; `build.rs` lists them.
const BUILT_IN: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/scenarios.rs"));

const INDEX_TYPE_PARAMETER: RuleId = RuleId::AccelerationStructureTrianglesOpacityMicromapKhrIndexTypeParameter;

/// Pairs of rules that the specification makes inseparable: whoever breaks the first breaks the second, too.
///
/// The enumerants that `indexType-11570` lists are all that `VkIndexType` has. Both commands that build on the device repeat
/// the rule on the flags of an instance; a build on the host breaks that one alone.
const INSEPARABLE: [(RuleId, RuleId); 4] = [
    (RuleId::IndexType11570, INDEX_TYPE_PARAMETER),
    (INDEX_TYPE_PARAMETER, RuleId::IndexType11570),
    (RuleId::InstanceFlags10607, RuleId::InstanceFlags11581),
    (RuleId::IndirectInstanceFlags10607, RuleId::InstanceFlags11581),
];

/// The scenarios of a folder, by their paths in it.
#[derive(Clone, Debug, Default)]
pub struct Library {
    scenarios: BTreeMap<PathBuf, Scenario>,
}

impl Library {
    /// The scenarios under `spec-tests/` as they were when the library was compiled. No file is needed.
    ///
    /// # Errors
    /// A text that is no scenario; tests show that there is none.
    pub fn built_in() -> Result<Self, LibraryError> {
        let read = |(name, text): &(&str, &str)| Ok((PathBuf::from(name), Scenario::parse(name, text)?));
        Ok(Self { scenarios: BUILT_IN.iter().map(read).collect::<Result<_, ScenarioError>>()? })
    }

    /// Reads every `.ron` file below a folder. Names are paths below it, with slashes on every machine.
    ///
    /// # Errors
    /// The first file that cannot be read or holds no scenario.
    pub fn read(folder: &Path) -> Result<Self, LibraryError> {
        let mut scenarios = BTreeMap::new();
        for path in files(folder, "ron")? {
            let text = std::fs::read_to_string(folder.join(&path))
                .map_err(|error| LibraryError::Io { path: folder.join(&path), error })?;
            let scenario = Scenario::parse(&name(&path), &text)?;
            scenarios.insert(path, scenario);
        }
        Ok(Self { scenarios })
    }

    /// The scenarios, by path.
    pub fn iter(&self) -> impl Iterator<Item = (&Path, &Scenario)> {
        self.scenarios.iter().map(|(path, scenario)| (path.as_path(), scenario))
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.scenarios.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.scenarios.is_empty()
    }

    /// The scenarios that break a rule, one that breaks nothing else first.
    #[must_use]
    pub fn breaking(&self, rule: RuleId) -> Vec<&Scenario> {
        let mut found: Vec<_> = self.scenarios.values().filter(|it| it.breaks().contains(&rule)).collect();
        found.sort_by_key(|scenario| scenario.breaks().len());
        found
    }

    /// The scenarios that stay just within a rule.
    #[must_use]
    pub fn keeping(&self, rule: RuleId) -> Vec<&Scenario> {
        self.scenarios.values().filter(|scenario| scenario.keeps().contains(&rule)).collect()
    }

    /// The scenarios about a rule: those that break it, then those that keep it.
    pub fn about(&self, rule: RuleId) -> impl Iterator<Item = &Scenario> {
        self.breaking(rule).into_iter().chain(self.keeping(rule))
    }

    /// The rules that are checked but that no scenario breaks alone, or that none keeps. A rule that cannot be broken without
    /// another is to be broken with just that one.
    #[must_use]
    pub fn missing(&self) -> Vec<RuleId> {
        let belongs = |rule, broken| rule == broken || INSEPARABLE.contains(&(rule, broken));
        let alone = |rule| {
            let breaking = self.breaking(rule);
            breaking.iter().any(|scenario| scenario.breaks().iter().all(|broken| belongs(rule, *broken)))
        };
        let checked = RULES.iter().filter(|rule| rule.status == Status::Checked).map(|rule| rule.id);
        checked.filter(|rule| !alone(*rule) || self.keeping(*rule).is_empty()).collect()
    }
}

/// A path with slashes.
fn name(path: &Path) -> String {
    let parts: Vec<_> = path.components().map(|part| part.as_os_str().to_string_lossy()).collect();
    parts.join("/")
}

/// The files of an extension below a folder, as paths in it, sorted. Links to folders are not followed.
///
/// # Errors
/// A folder that cannot be read.
pub fn files(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, LibraryError> {
    let (mut found, mut open) = (Vec::new(), vec![PathBuf::new()]);
    while let Some(below) = open.pop() {
        let path = folder.join(&below);
        let failed = |error| LibraryError::Io { path: path.clone(), error };
        for entry in std::fs::read_dir(&path).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let inner = below.join(entry.file_name());
            let kind = entry.file_type().map_err(failed)?;
            if kind.is_dir() {
                open.push(inner);
            } else if inner.extension().is_some_and(|found| found == extension) {
                found.push(inner);
            }
        }
    }
    found.sort();
    Ok(found)
}
