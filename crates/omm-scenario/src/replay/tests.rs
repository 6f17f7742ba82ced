use std::path::Path;

use omm_serialize::bundle::Checksums;

use super::*;
use crate::{Library, Scenario, Transcript, record};

/// What a run says of a call: command, rules, whether the device stopped, what it returned.
fn essence(call: &CallRecord) -> (&str, Vec<RuleId>, bool, Option<&Output>) {
    let rules = call.findings.iter().map(|finding| finding.rule).collect();
    (call.command, rules, call.is_undefined, call.output.as_ref())
}

fn calls(transcript: &Transcript) -> impl Iterator<Item = &CallRecord> {
    transcript.given.iter().chain(&transcript.when).flat_map(|group| &group.calls)
}

#[test]
fn recorded_scenarios_run_again_alike_in_both_forms() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../spec-tests");
    let library = Library::read(&folder).unwrap();
    // Every fifth, to be done in seconds.
    for (path, scenario) in library.iter().step_by(5) {
        let (transcript, trace) = record(scenario).unwrap();
        assert_eq!(Trace::read(&trace.write(), Checksums::Verify).as_ref(), Ok(&trace), "{}", path.display());
        assert_eq!(Trace::from_text(&trace.to_text().unwrap()).as_ref(), Ok(&trace), "{}", path.display());
        let replay = replay(&trace);
        let calls: Vec<_> = calls(&transcript).collect();
        let again: Vec<_> = replay.events.iter().filter(|event| event.command.starts_with("vk")).collect();
        for (call, again) in calls.iter().zip(&again) {
            let (call, again) = (essence(call), essence(again));
            assert_eq!((call.0, &call.1, call.3), (again.0, &again.1, again.3), "{}", path.display());
            // The end of a scenario does not tell the device's stop from what it only does not simulate.
            assert!(call.2 || !again.2, "{}: {}", path.display(), call.0);
        }
        assert!(again.len() == calls.len() || replay.stopped, "{}", path.display());
    }
}

#[test]
fn a_run_is_written_down_event_by_event() {
    let text = r#"(title: "", given: {"leaf": micromap(["O"]), "memory": host_memory("0102"), "card": blas(triangles: 1, micromap: "leaf",
        indices: u16([1]))}, when: build("card"))"#;
    let (_, trace) = record(&Scenario::parse("test.ron", text).unwrap()).unwrap();
    let again = replay(&trace);
    let text = again.to_string();
    assert!(text.contains("  write host memory: 2 bytes to 0x7f0000000000\n"), "{text}");
    assert!(text.contains("! VUID-vkCmdBuildAccelerationStructuresKHR-indexBuffer-11575\n"), "{text}");
    assert!(text.contains("→ undefined: vkCmdBuildAccelerationStructuresKHR"), "{text}");
    assert!(text.ends_with("the device stopped; 0 events after that were not executed\n"), "{text}");
    assert!(!again.is_clean() && again.stopped());
    let json = serde_json::to_value(&again).unwrap();
    assert_eq!(json["stopped"], true);
    assert_eq!(json["events"][0]["command"], "vkCreateBuffer");
}

#[test]
fn memory_that_is_not_there_stops_the_run() {
    let (_, trace) =
        record(&Scenario::parse("test.ron", r#"(title: "", given: {"b": buffer(bytes: "01")}, when: [])"#).unwrap())
            .unwrap();
    let only = |wanted: fn(&Event) -> bool| {
        let events = trace.events.iter().filter(|event| wanted(event)).cloned().collect();
        replay(&Trace { events, ..trace.clone() })
    };
    let run = only(|event| !matches!(event, Event::Call(_)));
    assert!(run.stopped() && run.to_string().contains("→ undefined: 1 bytes from address"), "{run}");
    assert!(!only(|_| true).stopped());
}
