//! Calls with any value in any place: a report, never a panic, also of what is checked and tracked after them.

use omm_model::call::{Call, Output};
use omm_model::memory::NoMemory;
use omm_model::vk;
use proptest::prelude::*;
use serde_json::Value;

use crate::calls::{BASES, base};
use crate::world::{COMMAND_BUFFER, World};

/// The pointers of all numbers and arrays in a value.
fn places(value: &Value, at: &str, found: &mut Vec<String>) {
    match value {
        Value::Number(_) => found.push(at.to_owned()),
        Value::Array(items) => {
            found.push(at.to_owned());
            items.iter().enumerate().for_each(|(index, item)| places(item, &format!("{at}/{index}"), found));
        }
        Value::Object(fields) => {
            fields.iter().for_each(|(name, field)| places(field, &format!("{at}/{name}"), found));
        }
        _ => {}
    }
}

/// The call with some place changed; as it was where the value does not fit there.
fn mutated(call: &Call, place: usize, number: u64) -> Call {
    let mut text = serde_json::to_value(call).unwrap();
    let mut found = Vec::new();
    places(&text, "", &mut found);
    let pointer = &found[place % found.len()];
    let target = text.pointer_mut(pointer).unwrap();
    match target {
        Value::Array(items) if number.is_multiple_of(2) => items.clear(),
        Value::Array(items) => items.extend(items.clone()),
        other => *other = Value::from(number),
    }
    serde_json::from_value(text).unwrap_or_else(|_| call.clone())
}

fn number() -> impl Strategy<Value = u64> {
    prop_oneof![0_u64..0x70, Just(u64::from(u32::MAX)), Just(u64::MAX), Just(u64::MAX - 0xff), any::<u64>()]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn mutated_calls_are_reported_and_never_panic(
        mutations in prop::collection::vec((0..BASES.len(), any::<usize>(), number()), 1..6),
    ) {
        let mut world = World::new();
        for (index, place, number) in mutations {
            let call = mutated(&base(BASES[index]), place, number);
            let report = world.0.check_and_track(&call, &Output::None, &NoMemory);
            for violation in &report {
                prop_assert!(!violation.summary().is_empty());
            }
        }
        let submit = Call::QueueSubmit { queue: vk::Queue(5), command_buffers: vec![COMMAND_BUFFER] };
        let report = world.0.check_and_track(&submit, &Output::None, &NoMemory);
        prop_assert_eq!(report.len(), report.iter().count());
    }
}
