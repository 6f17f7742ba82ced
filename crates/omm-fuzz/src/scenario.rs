//! Scenarios.

use omm_scenario::{Scenario, record, replay, run};

/// A text is refused at a place that it has, or runs; what it does is the same again, written down and read, and written down it
/// is what the transcript says.
pub fn scenario_text(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let scenario = match Scenario::parse("fuzz.ron", text) {
        Ok(scenario) => scenario,
        Err(error) => {
            let lines = text.split('\n').count();
            assert!((1..=lines).contains(&error.line()), "line {} of {lines}: {error}", error.line());
            return;
        }
    };
    let Ok((transcript, trace)) = record(&scenario) else { return };
    assert_eq!(run(&scenario).map(|again| again.to_string()), Ok(transcript.to_string()), "the same again");
    let replay = replay(&trace);
    assert_eq!(replay.reported(), transcript.reported(), "{replay}");
}
