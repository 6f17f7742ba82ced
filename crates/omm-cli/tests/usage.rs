//! What holds for every verb: help, exit status, closed pipes.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

#[allow(dead_code)]
mod common;

use std::io::Read;
use std::process::{Command, Stdio};

use common::omm;

#[test]
fn help_ends_with_examples_and_exit_status() {
    let verbs: [&[&str]; 7] =
        [&[], &["demo"], &["bake"], &["curve"], &["curve", "index"], &["curve", "table"], &["inspect"]];
    for verb in verbs {
        let run = omm(verb.iter().chain(&["--help"]));
        let help = run.clean();
        let (_, end) = help.split_once("\nExamples:\n").expect("examples");
        let (_, status) = end.split_once("\nExit status:\n").expect("exit status");
        assert!(status.lines().all(|line| line.is_empty() || line.starts_with("  ")), "{verb:?}: {status}");
        assert!(status.contains("  0  ") && status.contains("  2  could not run"), "{verb:?}: {status}");
    }
}

#[test]
fn bad_arguments_exit_with_2() {
    let cases: [&[&str]; 14] = [
        &[],
        &["frob"],
        &["bake", "x.glb"],
        &["bake", "x.glb", "--out", "y", "--level", "13"],
        &["bake", "x.glb", "--out", "y", "--level", "-1"],
        &["bake", "x.glb", "--out", "y", "--cutoff", "nan"],
        &["bake", "x.glb", "--out", "y", "--dynamic", "0"],
        &["bake", "x.glb", "--out", "y", "--dynamic", "inf"],
        &["bake", "x.glb", "--out", "y", "--state", "3"],
        &["curve", "index", "--level", "3", "0.5"],
        &["curve", "index", "--level", "13", "0.5", "0.5"],
        &["curve", "index", "--level", "3", "nan", "0.5"],
        &["curve", "table"],
        &["--format", "xml", "inspect", "x"],
    ];
    for arguments in cases {
        let run = omm(arguments);
        assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{arguments:?}: {run:?}");
        assert!(!run.stderr.is_empty());
    }
}

#[test]
fn a_closed_pipe_is_no_error() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_omm"))
        .args(["curve", "table", "--level", "9"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut start = [0; 64];
    let mut stdout = child.stdout.take().unwrap();
    stdout.read_exact(&mut start).unwrap();
    drop(stdout);
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(0), b"".as_slice()));
}
