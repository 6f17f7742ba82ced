//! Running a scenario.

use std::collections::BTreeSet;

use omm_serialize::trace::Trace;
use omm_validate::RuleId;

use crate::error::{Mistake, ScenarioError};
use crate::expect::Scene;
use crate::node::Node;
use crate::scenario::Scenario;
use crate::step;
use crate::transcript::{Check, Group, Transcript};
use crate::world::{Preparation, World};

/// Runs a scenario: makes what is given, takes each step through validator and simulated device, looks at what is expected.
///
/// The same scenario gives the same transcript on every machine. The steps end where the device stops because a call leaves its
/// behaviour undefined; what is expected is looked at all the same.
///
/// # Errors
/// A place in the text that asks for what there is not: an unknown object, parameter or argument, a value that does not fit, an
/// object that cannot be prepared. A scenario whose expectations fail is no error; see [`Transcript::passed`].
pub fn run(scenario: &Scenario) -> Result<Transcript, ScenarioError> {
    let mut world = World::new(scenario.profile.clone());
    run_in(&mut world, scenario).map_err(|mistake| ScenarioError::new(&scenario.source, mistake))
}

/// Runs a scenario as [`run`] does, and writes down what it does, up to the call at which the device stops.
///
/// # Errors
/// As [`run`].
pub fn record(scenario: &Scenario) -> Result<(Transcript, Trace), ScenarioError> {
    let mut world = World::new(scenario.profile.clone());
    world.events = Some(Vec::new());
    let transcript = run_in(&mut world, scenario).map_err(|mistake| ScenarioError::new(&scenario.source, mistake))?;
    Ok((transcript, Trace { profile: scenario.profile.clone(), events: world.events.unwrap_or_default() }))
}

fn run_in(world: &mut World, scenario: &Scenario) -> Result<Transcript, Mistake> {
    let given = make(world, scenario)?;
    let mut when = Vec::with_capacity(scenario.when.len());
    for node in &scenario.when {
        if world.stopped {
            break;
        }
        world.step(node)?;
        when.push(std::mem::take(&mut world.group));
    }
    let scene = Scene { world, groups: given.iter().chain(&when).collect() };
    let text = |node: &Node| scenario.source.text.get(node.span.start..node.span.end).unwrap_or_default();
    let mut then = scenario.then.iter().map(|node| scene.check(node, text(node))).collect::<Result<Vec<_>, _>>()?;
    then.extend(rules(scenario, &world.reported));
    let judges_device = scenario.then.iter().any(|node| matches!(node.head(), Some("ok" | "undefined")));
    if world.stopped && !world.unsupported && scenario.breaks().is_empty() && !judges_device {
        let failure = Some("the device stopped".to_owned());
        then.push(Check { expected: "a scenario that breaks no rule runs to its end".to_owned(), failure });
    }
    let passed = then.iter().all(|check| check.failure.is_none());
    Ok(Transcript {
        title: scenario.title().to_owned(),
        section: scenario.section().map(str::to_owned),
        profile: scenario.profile.name.clone(),
        breaks: scenario.breaks().to_vec(),
        keeps: scenario.keeps().to_vec(),
        given,
        when,
        then,
        reported: world.reported.iter().copied().collect(),
        stops: world.stopped && !world.unsupported,
        passed,
    })
}

/// Makes what is given, in order. What a step creates or builds itself is made only as far as the step needs it.
fn make(world: &mut World, scenario: &Scenario) -> Result<Vec<Group>, Mistake> {
    let mut made = Vec::new();
    step::made_by(&scenario.when, &mut made);
    let mut groups = Vec::with_capacity(scenario.given.len());
    for (name, node) in &scenario.given {
        let by_step = |word: &str| made.iter().any(|(found, by)| found == name && *by == word);
        let wanted = match (by_step("create"), by_step("build")) {
            (true, _) => Preparation::Memory,
            (false, true) => Preparation::Created,
            (false, false) => Preparation::Built,
        };
        world.group.name.clone_from(name);
        world.group.description = world.declare(name, node, wanted)?;
        groups.push(std::mem::take(&mut world.group));
    }
    Ok(groups)
}

/// Whether exactly the rules were reported that the scenario breaks; nothing if so.
fn rules(scenario: &Scenario, reported: &BTreeSet<RuleId>) -> Vec<Check> {
    let wanted: BTreeSet<RuleId> = scenario.breaks().iter().copied().collect();
    let check = |rule: &RuleId, expected: &str, failure: &str| Check {
        expected: format!("{expected} {rule}"),
        failure: Some(failure.to_owned()),
    };
    let missing = wanted.difference(reported).map(|rule| check(rule, "breaks", "it was not reported"));
    let extra = reported.difference(&wanted).map(|rule| check(rule, "does not break", "it was reported"));
    missing.chain(extra).collect()
}
