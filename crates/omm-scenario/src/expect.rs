//! What a scenario expects, and whether it is so.

mod contents;
mod trace;

use omm_model::call::Output;
use omm_model::vk;
use omm_validate::RuleId;

use crate::error::Mistake;
use crate::node::{Arguments, Node};
use crate::path::Pattern;
use crate::transcript::{CallRecord, Check, Finding, Group};
use crate::world::World;

/// The words that an expectation can begin with.
pub(crate) const WORDS: &[&str] = &[
    "report",
    "ok",
    "undefined",
    "result",
    "sizes",
    "values",
    "compatible",
    "incompatible",
    "states",
    "maps",
    "positions",
    "instances",
    "bytes",
    "same",
    "smaller",
    "ray",
    "ray_query",
];

/// Why something is not as expected.
pub(crate) type Verdict = Result<(), String>;

/// What an expectation may look at.
pub(crate) struct Scene<'a> {
    pub(crate) world: &'a World,
    pub(crate) groups: Vec<&'a Group>,
}

impl Scene<'_> {
    /// Every call, those that lead up to others included.
    fn calls(&self) -> impl DoubleEndedIterator<Item = &CallRecord> {
        self.groups.iter().flat_map(|group| &group.calls)
    }

    fn findings(&self) -> impl Iterator<Item = &Finding> {
        self.calls().flat_map(|call| &call.findings)
    }

    /// Looks whether something is as a scenario expects it.
    pub(crate) fn check(&self, node: &Node, text: &str) -> Result<Check, Mistake> {
        let verdict = match node.head() {
            Some("report") => self.report(node)?,
            Some("ok") => self.ok(),
            Some("undefined") => self.undefined(node)?,
            Some("result") => self.result(node)?,
            Some("sizes") => self.sizes(node)?,
            Some("values") => self.values(node)?,
            Some(word @ ("compatible" | "incompatible")) => self.compatible(word == "compatible"),
            Some("states") => self.states(node)?,
            Some("maps") => self.maps(node)?,
            Some("positions") => self.positions(node)?,
            Some("instances") => self.instances(node)?,
            Some("bytes") => self.bytes(node)?,
            Some("same") => self.same(node)?,
            Some("smaller") => self.smaller(node)?,
            Some(word @ ("ray" | "ray_query")) => self.ray(node, word == "ray_query")?,
            head => {
                let mistake = node.mistake(format!("{} is no expectation", node.describe()));
                return Err(mistake.nearest(head.unwrap_or_default(), WORDS.iter().copied()));
            }
        };
        let expected = text.split_whitespace().collect::<Vec<_>>().join(" ");
        Ok(Check { expected, failure: verdict.err() })
    }

    /// `report(rule, at, found, required)`: one like this was made.
    fn report(&self, node: &Node) -> Result<Verdict, Mistake> {
        let arguments = Arguments::of(node, &["rule", "at", "found", "required"])?;
        let rule = arguments.get("rule").map(rule).transpose()?;
        let pattern = |name: &str| {
            Ok::<_, Mistake>(match arguments.get(name) {
                Some(node) => Some(node.text()?),
                None => None,
            })
        };
        let (at, found, required) = (pattern("at")?, pattern("found")?, pattern("required")?);
        let is_it = |finding: &&Finding| {
            rule.is_none_or(|rule| rule == finding.rule)
                && at.is_none_or(|at| Pattern::new(at).matches(&finding.at))
                && found.is_none_or(|text| is_like(text, &finding.found))
                && required.is_none_or(|text| is_like(text, &finding.required))
        };
        if self.findings().any(|finding| is_it(&finding)) {
            return Ok(Ok(()));
        }
        let show =
            |finding: &Finding| format!("{}: found {}, required {}", finding.at, finding.found, finding.required);
        let all: Vec<String> = self.findings().map(show).collect();
        Ok(Err(if all.is_empty() {
            "nothing was reported".to_owned()
        } else {
            format!("reported: {}", all.join("; "))
        }))
    }

    /// `ok`: the device stopped at nothing.
    fn ok(&self) -> Verdict {
        match self.calls().find(|call| call.is_undefined) {
            None => Ok(()),
            Some(call) => Err(call.outcome.clone().unwrap_or_default()),
        }
    }

    /// `undefined` or `undefined("…part of why…")`: the device stopped.
    fn undefined(&self, node: &Node) -> Result<Verdict, Mistake> {
        let why = Arguments::of(node, &["why"])?.get("why").map(Node::text).transpose()?;
        let Some(call) = self.calls().find(|call| call.is_undefined) else {
            return Ok(Err("the device did not stop".to_owned()));
        };
        let found = call.outcome.as_deref().unwrap_or_default();
        Ok(match why {
            Some(why) if !found.contains(why) => Err(found.to_owned()),
            _ => Ok(()),
        })
    }

    /// `result(VK_…)`: the last call that returned a code returned this.
    fn result(&self, node: &Node) -> Result<Verdict, Mistake> {
        let wanted: vk::Result = self.world.typed(Arguments::of(node, &["code"])?.need("code")?)?;
        let code = |call: &CallRecord| match call.output {
            Some(Output::Result(result)) => Some(result),
            _ => None,
        };
        let found = self.calls().rev().find_map(code).unwrap_or(vk::Result(0));
        Ok(equal(&wanted.name().unwrap_or("another"), &found.name().unwrap_or("another")))
    }

    /// `sizes(structure, build_scratch, update_scratch)` of the last query of sizes.
    fn sizes(&self, node: &Node) -> Result<Verdict, Mistake> {
        let arguments = Arguments::of(node, &["structure", "build_scratch", "update_scratch", "discardable"])?;
        let sizes = |call: &CallRecord| match &call.output {
            Some(Output::BuildSizes(sizes)) if call.is_main => {
                Some([sizes.acceleration_structure_size, sizes.build_scratch_size, sizes.update_scratch_size, 0])
            }
            Some(Output::MicromapBuildSizes(sizes)) if call.is_main => {
                Some([sizes.micromap_size, sizes.build_scratch_size, 0, sizes.discardable.0.into()])
            }
            _ => None,
        };
        let Some(found) = self.calls().rev().find_map(sizes) else {
            return Ok(Err("no step asked for sizes".to_owned()));
        };
        for (name, found) in ["structure", "build_scratch", "update_scratch", "discardable"].into_iter().zip(found) {
            if let Some(node) = arguments.get(name) {
                let wanted: u64 = if node.name().is_some() { node.boolean()?.into() } else { node.integer()? };
                if wanted != found {
                    return Ok(Err(format!("{name} is {found}")));
                }
            }
        }
        Ok(Ok(()))
    }

    /// `values([…])` of the last query.
    fn values(&self, node: &Node) -> Result<Verdict, Mistake> {
        let wanted = Arguments::of(node, &["values"])?.need("values")?.list()?;
        let wanted: Vec<u64> = wanted.iter().map(Node::integer).collect::<Result<_, _>>()?;
        let values = |call: &CallRecord| match &call.output {
            Some(Output::QueryResults(values) | Output::Properties(values)) => Some(values.clone()),
            _ => None,
        };
        Ok(match self.calls().rev().find_map(values) {
            Some(found) => equal(&wanted, &found),
            None => Err("no step asked for values".to_owned()),
        })
    }

    /// `compatible` and `incompatible`: the answer to the last question about serialized data.
    fn compatible(&self, wanted: bool) -> Verdict {
        let answer = |call: &CallRecord| match call.output {
            Some(Output::Compatibility(found)) => Some(found == vk::AccelerationStructureCompatibility::COMPATIBLE),
            _ => None,
        };
        match self.calls().rev().find_map(answer) {
            Some(found) if found == wanted => Ok(()),
            Some(true) => Err("it is compatible".to_owned()),
            Some(false) => Err("it is incompatible".to_owned()),
            None => Err("no step asked for compatibility".to_owned()),
        }
    }
}

/// The rule of an identifier.
pub(crate) fn rule(node: &Node) -> Result<RuleId, Mistake> {
    let vuid = node.text()?;
    RuleId::from_vuid(vuid).ok_or_else(|| {
        let mistake = node.mistake(format!("{vuid} is no rule of the catalog"));
        mistake.nearest(vuid, RuleId::ALL.iter().map(|rule| rule.vuid()))
    })
}

/// Whether a text is another one, in which `…` stands for anything.
fn is_like(pattern: &str, text: &str) -> bool {
    let pattern = pattern.replace("...", "…");
    let mut pieces = pattern.split('…');
    let first = pieces.next().unwrap_or_default();
    let Some(mut rest) = text.strip_prefix(first) else { return false };
    let mut pieces: Vec<&str> = pieces.collect();
    let Some(last) = pieces.pop() else { return rest.is_empty() };
    for piece in pieces {
        let Some(at) = rest.find(piece) else { return false };
        rest = rest.get(at + piece.len()..).unwrap_or_default();
    }
    rest.ends_with(last)
}

/// Whether two values are equal.
pub(crate) fn equal<T: PartialEq + std::fmt::Debug>(wanted: &T, found: &T) -> Verdict {
    if wanted == found { Ok(()) } else { Err(format!("found {found:?}")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_compared_with_gaps() {
        for (pattern, text) in
            [("a", "a"), ("at most 1…", "at most 1 (limit)"), ("…b", "ab"), ("a…c…e", "abcde"), ("…", "")]
        {
            assert!(is_like(pattern, text), "{pattern} {text}");
        }
        for (pattern, text) in [("a", "ab"), ("a…", "ba"), ("a…a", "a"), ("…x…", "abc"), ("", "a")] {
            assert!(!is_like(pattern, text), "{pattern} {text}");
        }
    }
}
