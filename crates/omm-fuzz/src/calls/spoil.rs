//! Ways to spoil a program: steps that are missing, repeated or elsewhere, and values in a call replaced by others.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use arbitrary::{Result, Unstructured};
use omm_model::call::Call;
use serde_json::Value;

use super::program::programs;
use super::recorder::Step;

/// The values that members have in programs, by the members' names: what looks valid there.
fn seen() -> &'static BTreeMap<String, Vec<Value>> {
    static SEEN: OnceLock<BTreeMap<String, Vec<Value>>> = OnceLock::new();
    SEEN.get_or_init(|| {
        let mut seen = BTreeMap::new();
        for step in programs().iter().flat_map(|program| &program.steps) {
            if let Step::Call(call) = step
                && let Ok(mut value) = serde_json::to_value(call)
            {
                each_value(&mut value, "", &mut |name, value| {
                    let values: &mut Vec<Value> = seen.entry(name.to_owned()).or_default();
                    if values.len() < 64 && !values.contains(value) && value.to_string().len() < 2048 {
                        values.push(value.clone());
                    }
                });
            }
        }
        seen
    })
}

/// Visits every value that is not itself a map, with the name of the member that it is, or is an element of; arrays too.
fn each_value(value: &mut Value, name: &str, visit: &mut dyn FnMut(&str, &mut Value)) {
    if !value.is_object() {
        visit(name, value);
    }
    match value {
        Value::Array(values) => values.iter_mut().for_each(|value| each_value(value, name, visit)),
        Value::Object(values) => {
            values.iter_mut().for_each(|(name, value)| each_value(value, name, visit));
        }
        _ => {}
    }
}

/// Spoils a program in one way.
pub(crate) fn spoil(steps: &mut Vec<Step>, choices: &mut Unstructured<'_>) -> Result<()> {
    let at = choices.choose_index(steps.len())?;
    match choices.int_in_range(0..=15)? {
        0 => drop(steps.remove(at)),
        1 => steps.insert(at, steps[at].clone()),
        2 => {
            let other = choices.choose_index(steps.len())?;
            steps.swap(at, other);
        }
        3 => {
            let other = choices.choose_index(steps.len())?;
            let step = steps.remove(at);
            steps.insert(other.min(steps.len()), step);
        }
        _ => match &mut steps[at] {
            Step::Write(_, bytes) | Step::Host(_, bytes) if !bytes.is_empty() => {
                let at = choices.choose_index(bytes.len())?;
                bytes[at] = number(choices, bytes[at].into())? as u8;
            }
            Step::Write(..) | Step::Host(..) => {}
            Step::Call(call) => {
                if let Some(spoiled) = spoiled(call, choices)? {
                    **call = spoiled;
                }
            }
        },
    }
    Ok(())
}

/// The call with a value replaced; `None` if what comes out is no call.
fn spoiled(call: &Call, choices: &mut Unstructured<'_>) -> Result<Option<Call>> {
    let Ok(mut value) = serde_json::to_value(call) else { return Ok(None) };
    let mut count = 0;
    each_value(&mut value, "", &mut |_, _| count += 1);
    if count == 0 {
        return Ok(None);
    }
    let (mut left, mut result) = (choices.choose_index(count)?, Ok(()));
    each_value(&mut value, "", &mut |name, value| {
        if left == 0 {
            result = replace(name, value, choices);
        }
        left = left.wrapping_sub(1);
    });
    result?;
    Ok(serde_json::from_value(value).ok())
}

/// Replaces a value: by one that the member has elsewhere, or by one that hardly fits.
fn replace(name: &str, value: &mut Value, choices: &mut Unstructured<'_>) -> Result<()> {
    if choices.ratio(1, 2)?
        && let Some(seen) = seen().get(name)
    {
        *value = choices.choose(seen)?.clone();
        return Ok(());
    }
    match value {
        Value::Number(found) => *value = number(choices, found.as_u64().unwrap_or_default())?.into(),
        // Flags are written by name; those without a name by number.
        Value::String(_) => *value = format!("{:#x}", number(choices, 0)? as u32).into(),
        Value::Array(values) if !values.is_empty() => {
            let at = choices.choose_index(values.len())?;
            match choices.int_in_range(0..=2)? {
                0 => drop(values.remove(at)),
                1 => values.insert(at, values[at].clone()),
                _ => *value = Value::Null,
            }
        }
        _ => {}
    }
    Ok(())
}

/// A number close to another, or an interesting one.
fn number(choices: &mut Unstructured<'_>, near: u64) -> Result<u64> {
    Ok(match choices.int_in_range(0..=8)? {
        0 => 0,
        1 => near.wrapping_add(1),
        2 => near.wrapping_sub(1),
        3 => near ^ (1 << choices.int_in_range(0..=63)?),
        4 => choices.int_in_range(0..=20)?,
        5 => u64::MAX,
        6 => u32::MAX.into(),
        7 => near.wrapping_mul(2),
        _ => choices.arbitrary()?,
    })
}
