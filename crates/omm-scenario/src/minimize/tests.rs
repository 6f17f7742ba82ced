use omm_model::vk;

use super::*;
use crate::{Scenario, record};

const STRIDE: &str = r#"(
    title: "Indices of 16 bits cannot lie three bytes apart",
    breaks: ["VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexStride-11573"],
    given: {
        "unused": micromap(["TOUu"]),
        "leaf": micromap(["TOUu", "O"]),
        "card": blas(triangles: 2, micromap: "leaf", indices: u16([1, 0])),
    },
    when: [build("unused"), build("card", {"…indexStride": 3}), clone("unused", "twin")],
)"#;

fn trace_of(text: &str) -> Trace {
    record(&Scenario::parse("test.ron", text).unwrap()).unwrap().1
}

#[test]
fn what_a_report_needs_is_left() {
    let trace = trace_of(STRIDE);
    let mut progress = Vec::new();
    let small = minimize(&trace, None, &mut |now| progress.push(now)).unwrap();
    let verdict = judge(&small);
    assert_eq!(verdict.reported, judge(&trace).reported);
    assert_eq!(verdict.stop, None);
    assert!(small.events.len() * 2 < trace.events.len(), "{} of {}", small.events.len(), trace.events.len());
    assert!(progress.windows(2).all(|pair| pair[1].events <= pair[0].events && pair[1].runs > pair[0].runs));
    assert_eq!(minimize(&trace, None, &mut |_| {}).unwrap(), small, "the same again");
    // No event can go by itself.
    for at in 0..small.events.len() {
        let mut less = small.clone();
        less.events.remove(at);
        let less = judge(&less);
        assert!(less.reported != verdict.reported || less.stop.is_some(), "event {at} is not needed");
    }
}

#[test]
fn where_the_device_stops_is_kept() {
    let text = r#"(title: "", given: {"leaf": micromap(["O"]), "card": blas(triangles: 1, micromap: "leaf", indices: u16([1]))},
        when: build("card"))"#;
    let trace = trace_of(text);
    let small = minimize(&trace, Some(Keep::Undefined), &mut |_| {}).unwrap();
    assert_eq!(judge(&small).stop, judge(&trace).stop);
    assert!(small.events.len() < trace.events.len());
}

#[test]
fn elements_and_bytes_go_too() {
    let command_buffer = vk::CommandBuffer(9);
    let write = Event::Write { address: vk::DeviceAddress(7), bytes: vec![1] };
    let call = Call::QueueSubmit { queue: vk::Queue(1), command_buffers: vec![vk::CommandBuffer(1), command_buffer] };
    let trace = Trace { events: vec![call.into(), write], ..trace_of(STRIDE) };
    let small = minimize(&trace, None, &mut |_| {}).unwrap();
    let [Event::Call(call)] = small.events.as_slice() else { panic!("{small:?}") };
    let Call::QueueSubmit { command_buffers, .. } = &**call else { panic!("{call:?}") };
    assert!(command_buffers.len() < 2);
}

#[test]
fn there_has_to_be_something_to_keep() {
    let clean = trace_of(r#"(title: "", given: {"leaf": micromap(["O"])}, when: build("leaf"))"#);
    assert_eq!(minimize(&clean, None, &mut |_| {}), Err(MinimizeError::Clean));
    assert_eq!(minimize(&clean, Some(Keep::Undefined), &mut |_| {}), Err(MinimizeError::NotStopped));
    let rule = judge(&trace_of(STRIDE)).first.unwrap();
    assert_eq!(minimize(&clean, Some(Keep::Rule(rule)), &mut |_| {}), Err(MinimizeError::NotBroken(rule)));
}
