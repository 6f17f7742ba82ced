//! Cases: a valid call of which one value is changed, or what came before it.

use omm_model::call::Call;
use omm_model::memory::NoMemory;
use omm_validate::RuleId;
use serde_json::Value;

use crate::calls::base;
use crate::world::World;

/// One value of a call that breaks a rule, and one in its place that keeps it.
pub(crate) struct Case {
    /// Every rule broken and its path; the first is the one shown.
    pub(crate) broken: Vec<(RuleId, &'static str)>,
    /// The valid call.
    pub(crate) base: &'static str,
    /// The value, as a JSON pointer into the parameters.
    pub(crate) pointer: &'static str,
    pub(crate) bad: Value,
    /// `None` for the value of the valid call.
    pub(crate) good: Option<Value>,
    /// What comes before the call.
    pub(crate) before: fn(&mut World),
}

impl Case {
    pub(crate) fn new(
        rule: RuleId,
        base: &'static str,
        pointer: &'static str,
        bad: impl Into<Value>,
        path: &'static str,
    ) -> Self {
        Self { broken: vec![(rule, path)], base, pointer, bad: bad.into(), good: None, before: |_| {} }
    }

    pub(crate) fn good(mut self, good: impl Into<Value>) -> Self {
        self.good = Some(good.into());
        self
    }

    /// Breaks another rule too, found before or behind the one shown.
    pub(crate) fn also(mut self, rule: RuleId, path: &'static str) -> Self {
        self.broken.push((rule, path));
        self
    }

    /// The call is as it is; what came before breaks the rule.
    pub(crate) fn after(rule: RuleId, base: &'static str, path: &'static str, before: fn(&mut World)) -> Self {
        Self { before, ..Self::new(rule, base, "", Value::Null, path) }
    }

    pub(crate) fn rule(&self) -> RuleId {
        self.broken[0].0
    }

    /// What is not as the case says.
    pub(crate) fn failures(&self) -> Vec<String> {
        let mut world = World::new();
        let call = base(self.base);
        let name = format!("{:?} of {}", self.rule(), self.base);
        let mut failures = Vec::new();
        let good = self.good.as_ref().map_or_else(|| call.clone(), |good| changed(&call, self.pointer, good));
        let found = findings(&world, &good);
        if !found.is_empty() {
            failures.push(format!("{name} is kept by {:?}: {found:?}", self.good));
        }
        (self.before)(&mut world);
        let bad = if self.bad.is_null() { call } else { changed(&call, self.pointer, &self.bad) };
        let mut expected: Vec<_> = self.broken.iter().map(|(rule, path)| (*rule, (*path).to_owned())).collect();
        expected.sort();
        let found = findings(&world, &bad);
        if found != expected {
            failures.push(format!("{name} is broken by {}: {found:?}", self.bad));
        }
        failures
    }
}

/// The rules that a call breaks, and the paths, in a fixed order.
pub(crate) fn findings(world: &World, call: &Call) -> Vec<(RuleId, String)> {
    let report = world.0.check(call, &NoMemory);
    let mut found: Vec<_> = report.iter().map(|it| (it.rule, it.location.as_str().to_owned())).collect();
    found.sort();
    for violation in &report {
        let text = violation.to_string();
        assert!(text.contains(violation.rule.vuid()) && text.contains(violation.rule.explanation()), "{text}");
    }
    found
}

/// The call with another value in one place.
pub(crate) fn changed(call: &Call, pointer: &str, value: &Value) -> Call {
    let mut text = serde_json::to_value(call).unwrap();
    let parameters = text.as_object_mut().unwrap().values_mut().next().unwrap();
    *parameters.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer} in {call:?}")) = value.clone();
    serde_json::from_value(text).unwrap_or_else(|error| panic!("{pointer}: {error}"))
}
