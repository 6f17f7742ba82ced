//! Scenarios: a readable text form of API calls with expectations, and what runs them.
//!
//! A scenario says what is given, what is done and what is to come of it. Objects have names and defaults that make everything
//! valid, opacity is written as letters, and a call is wrong only where the scenario changes it:
//!
//! ```
//! use omm_scenario::{Scenario, run};
//!
//! let text = r#"(
//!     title: "Indices of 16 bits cannot lie three bytes apart",
//!     breaks: ["VUID-VkAccelerationStructureTrianglesOpacityMicromapKHR-indexStride-11573"],
//!     given: {
//!         "leaf": micromap(["TOUu", "O"]),
//!         "card": blas(triangles: 2, micromap: "leaf", indices: u16([1, 0])),
//!     },
//!     when: build("card", {"…indexStride": 3}),
//!     then: report(found: "3", required: "a multiple of 2"),
//! )"#;
//! let scenario = Scenario::parse("stride.ron", text)?;
//! let transcript = run(&scenario)?;
//! assert!(transcript.passed(), "{transcript}");
//! # Ok::<(), omm_scenario::ScenarioError>(())
//! ```
//!
//! `spec-tests/readme.ron` explains the whole form. The text is [RON](https://docs.rs/ron); names without quotes may stand for
//! values, so that enumerants are written as in C.
//!
//! What a scenario does can be written down as a [trace](omm_serialize::trace) with [`record`], run again with [`replay`], and made
//! smaller with [`minimize`] until nothing is left but what a report needs.
//!
//! Paths of changes are those of reports, so that what a report says can be pasted into a scenario and back; `…` in a path stands
//! for any steps. An unknown one is an error that shows its place in the source and the names nearest to it:
//!
//! ```
//! # use omm_scenario::{Scenario, run};
//! # let text = r#"(title: "", given: {"leaf": micromap(["O"])}, when: build("leaf", {"…triangleArrayStrid": 3}))"#;
//! let error = run(&Scenario::parse("stride.ron", text)?).unwrap_err();
//! assert_eq!((error.line(), error.message()), (1, "the call has no such parameter"));
//! assert!(error.help().unwrap().starts_with("did you mean \"triangleArrayStride\"?"));
//! # Ok::<(), omm_scenario::ScenarioError>(())
//! ```
//!
//! The scenarios under `spec-tests/` are part of the library: [`Library::built_in`] says which of them break or keep a rule.

mod change;
mod command;
mod constant;
mod error;
mod expect;
mod given;
mod library;
mod limits;
mod minimize;
mod nearest;
mod node;
mod objects;
mod path;
mod replay;
mod run;
mod scenario;
mod show;
mod step;
mod structure;
mod summary;
mod transcript;
mod tree;
mod world;

pub use error::ScenarioError;
pub use library::{Library, LibraryError, files};
pub use minimize::{Keep, MinimizeError, MinimizeProgress, minimize};
pub use nearest::names_like;
pub use replay::{Replay, replay};
pub use run::{record, run};
pub use scenario::Scenario;
pub use transcript::{Finding, Transcript};
