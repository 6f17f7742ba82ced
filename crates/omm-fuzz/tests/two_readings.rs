//! Validator and device read the specification independently of each other; here they meet.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use std::collections::BTreeMap;

use omm_fuzz::calls;

/// Bytes that decide on a sequence: the `index`-th, always the same.
fn choices(index: u64) -> Vec<u8> {
    let mut state = index.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x2545_f491_4f6c_dd1d;
    let mut next = || {
        state ^= state >> 30;
        state = state.wrapping_mul(0xbf58_476d_1ce4_e5b9);
        state ^= state >> 27;
        state = state.wrapping_mul(0x94d0_49bb_1331_11eb);
        state ^= state >> 31;
        state.wrapping_add(0x9e37_79b9_7f4a_7c15)
    };
    (0..16).flat_map(|_| state_bytes(next())).collect()
}

fn state_bytes(word: u64) -> [u8; 8] {
    word.to_le_bytes()
}

/// How often something was seen, and the first sequence that showed it.
type Tally = BTreeMap<String, (u64, u64)>;

#[derive(Default)]
struct Counts {
    silent: u64,
    /// How many of those executed something beyond what every program begins with.
    silent_and_executed: u64,
    reported: u64,
    reported_and_stopped: u64,
    disagreements: Tally,
}

fn count(sequences: std::ops::Range<u64>) -> Counts {
    let mut counts = Counts::default();
    for index in sequences {
        let outcome = calls::run(&choices(index));
        if let (true, Some((undefined, _))) = (outcome.is_disagreement(), &outcome.undefined) {
            let at: String = undefined.at.chars().filter(|found| !found.is_ascii_digit()).collect();
            let why = format!("{:?}", undefined.why);
            let why = why.split([' ', '(']).next().unwrap();
            let kind = format!("{} {at} {why}", undefined.command);
            counts.disagreements.entry(kind).or_insert((0, index)).0 += 1;
        } else if outcome.is_silent() {
            counts.silent += 1;
            counts.silent_and_executed += u64::from(outcome.executed > 1);
        } else {
            counts.reported += 1;
            counts.reported_and_stopped += u64::from(outcome.undefined.is_some());
        }
    }
    counts
}

/// A number from the environment.
fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |found| found.parse().expect(name))
}

/// `OMM_SEQUENCES=1000000 OMM_FROM=3000 cargo test -p omm-fuzz --release --test two_readings` takes more of them, and others.
#[test]
fn where_the_validator_is_silent_the_device_goes_on() {
    let (from, sequences) = (number("OMM_FROM", 0), number("OMM_SEQUENCES", 3000));
    let counts = count(from..from + sequences);
    let Counts { silent, silent_and_executed, reported, reported_and_stopped, disagreements } = counts;
    println!("{sequences} sequences: {silent} silent, {silent_and_executed} of them with work of their own");
    println!("{reported} reported, {reported_and_stopped} of them stopped");
    assert!(
        disagreements.is_empty(),
        "the device stopped and nothing was reported, how often and when: {disagreements:#?}"
    );
    // So that this can fail: silence is not for want of work, and what is reported is not reported for nothing.
    assert!(silent_and_executed * 4 > sequences, "{silent_and_executed} of {sequences}");
    assert!(reported_and_stopped * 4 > sequences, "{reported_and_stopped} of {sequences}");
}

#[test]
fn what_stops_leaves_no_trace_and_the_same_calls_give_the_same_bytes() {
    (0..number("OMM_SEQUENCES", 300)).for_each(|index| calls::replay(&choices(index)));
}

#[test]
fn the_programs_themselves_are_silent() {
    for program in 0..6 {
        let outcome = calls::run(&[program, 0]);
        assert!(outcome.is_silent() && outcome.undefined.is_none(), "program {program}: {outcome:#?}");
        assert!(outcome.calls > 40 && outcome.executed > 1, "program {program}: {outcome:?}");
    }
}
