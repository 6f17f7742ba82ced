//! The parts of a scenario.

use std::sync::Arc;

use omm_model::profile::DeviceProfile;
use omm_validate::RuleId;

use crate::change::Changes;
use crate::error::{Mistake, ScenarioError, Source};
use crate::expect;
use crate::given;
use crate::limits;
use crate::node::{self, Arguments, Kind, Node};
use crate::objects::Objects;
use crate::step;
use crate::tree::Tree;

/// A scenario, read and ready to [`run`](crate::run).
#[derive(Clone, Debug)]
pub struct Scenario {
    pub(crate) source: Arc<Source>,
    title: String,
    section: Option<String>,
    about: Option<String>,
    pub(crate) profile: DeviceProfile,
    breaks: Vec<RuleId>,
    keeps: Vec<RuleId>,
    pub(crate) given: Vec<(String, Node)>,
    pub(crate) when: Vec<Node>,
    pub(crate) then: Vec<Node>,
}

impl Scenario {
    /// Reads the text of a scenario. `name` is how messages call it, usually its file.
    ///
    /// # Errors
    /// The first place where the text is no scenario: what is not RON, a word, name or rule that is unknown, more than a scenario
    /// may ask for. What an object or step says in its parentheses is looked at when the scenario runs.
    pub fn parse(name: &str, text: &str) -> Result<Self, ScenarioError> {
        let source = Arc::new(Source { name: name.to_owned(), text: text.to_owned() });
        read(&source).map_err(|mistake| ScenarioError::new(&source, mistake))
    }

    /// What the scenario shows, in one sentence.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The section of the specification, where the scenario names one.
    #[must_use]
    pub fn section(&self) -> Option<&str> {
        self.section.as_deref()
    }

    /// More words on what the scenario shows.
    #[must_use]
    pub fn about(&self) -> Option<&str> {
        self.about.as_deref()
    }

    /// The device that it runs on.
    #[must_use]
    pub const fn profile(&self) -> &DeviceProfile {
        &self.profile
    }

    /// The rules that it breaks: exactly these are to be reported.
    #[must_use]
    pub fn breaks(&self) -> &[RuleId] {
        &self.breaks
    }

    /// The rules that it stays just within.
    #[must_use]
    pub fn keeps(&self) -> &[RuleId] {
        &self.keeps
    }

    /// The text that it was read from.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.source.text
    }

    /// The name that it was read under.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.source.name
    }
}

fn read(source: &Source) -> Result<Scenario, Mistake> {
    let root = node::read(&source.text)?;
    let names = &["title", "section", "about", "profile", "breaks", "keeps", "given", "when", "then"];
    let arguments = Arguments::of(&root, names)?;
    let text = |name: &str| arguments.get(name).map(|node| node.text().map(str::to_owned)).transpose();
    let rules = |name: &str| {
        let nodes = arguments.get(name).map(Node::list).transpose()?.unwrap_or_default();
        nodes.iter().map(expect::rule).collect::<Result<Vec<_>, _>>()
    };
    let list = |name: &str, words: &[&str]| {
        let nodes = arguments.get(name).map(Node::one_or_more).unwrap_or_default();
        nodes.iter().try_for_each(|node| known(node, words))?;
        Ok::<_, Mistake>(nodes.to_vec())
    };
    let given = match arguments.get("given") {
        Some(node) => objects(node)?,
        None => Vec::new(),
    };
    let when = list("when", step::VERBS)?;
    if step::count(&when) > limits::STEPS {
        let node = arguments.need("when")?;
        return Err(node.mistake(format!("these are more steps than the {} of a scenario", limits::STEPS)));
    }
    Ok(Scenario {
        source: Arc::new(source.clone()),
        title: arguments.need("title")?.text()?.to_owned(),
        section: text("section")?,
        about: text("about")?,
        profile: arguments.get("profile").map_or(Ok(DeviceProfile::reference()), profile)?,
        breaks: rules("breaks")?,
        keeps: rules("keeps")?,
        given,
        when,
        then: list("then", expect::WORDS)?,
    })
}

/// Refuses a word that is not known; commands are.
fn known(node: &Node, words: &[&str]) -> Result<(), Mistake> {
    match node.head() {
        Some(head) if words.contains(&head) || head.starts_with("vk") => Ok(()),
        head => {
            let mistake = node.mistake(format!("{} has no meaning here", node.describe()));
            Err(mistake.nearest(head.unwrap_or_default(), words.iter().copied()))
        }
    }
}

/// `{"name": kind(…)}`
fn objects(node: &Node) -> Result<Vec<(String, Node)>, Mistake> {
    let entries = node.map()?;
    if entries.len() > limits::OBJECTS {
        return Err(node.mistake(format!("{} objects are more than {}", entries.len(), limits::OBJECTS)));
    }
    let mut objects: Vec<(String, Node)> = Vec::with_capacity(entries.len());
    for (key, value) in entries {
        let name = key.text()?;
        known(value, given::KINDS)?;
        if name.is_empty() || name.contains(['+', ' ', '[', '.']) {
            return Err(key.mistake("a name has at least one letter, and no dot, blank, bracket or plus"));
        }
        if objects.iter().any(|(known, _)| known == name) {
            return Err(key.mistake(format!("there are two objects \"{name}\"")));
        }
        objects.push((name.to_owned(), value.clone()));
    }
    Ok(objects)
}

/// `reference`, `minimum`, or either with changes: `minimum({"maxMicromapTriangles": 3})`.
fn profile(node: &Node) -> Result<DeviceProfile, Mistake> {
    let name = node.head().unwrap_or_default();
    let preset = DeviceProfile::preset(name).ok_or_else(|| {
        node.mistake(format!("{} is no profile", node.describe())).nearest(name, ["reference", "minimum"])
    })?;
    let Some(set) = Arguments::of(node, &["set"])?.get("set") else { return Ok(preset) };
    // A limit or feature goes by its own name; where it stands in the profile is of no interest.
    let mut entries = set.map()?.to_vec();
    for (key, _) in &mut entries {
        if let Kind::Text(text) = &mut key.kind {
            *text = format!("…{}", text.trim_start_matches('…'));
        }
    }
    let changes = Changes::read(&Node { span: set.span, kind: Kind::Map(entries) })?;
    let tree = Tree::of(&preset).map_err(|error| node.mistake(error.to_string()))?;
    Ok(changes.apply::<DeviceProfile>(tree, &Objects::default())?.value)
}
