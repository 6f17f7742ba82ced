//! Valid usage of opacity micromaps, reported in the manner of a validation layer.
//!
//! Feed a [`Validator`] the calls of a program — real ones of an engine, or those of a simulated device — and it answers with a
//! [`Report`]: which rules a call breaks, the path to the offending value as the caller wrote it, what was found there and what
//! was required, and in our own words what goes wrong on hardware and how to mend it. It depends on no device.
//!
//! Rules live in rooms by what they need to know, and run in this order:
//!
//! | room | looks at |
//! |---|---|
//! | `stateless/` | the parameters and the device's limits |
//! | `tracked/` | also what earlier calls created, bound and recorded ([`state::State`]) |
//! | `content/` | also the bytes in memory that a build will read, through a [`MemoryView`](omm_model::memory::MemoryView) |
//! | `implicit/` | what the registry says of every structure and command: types, chains, values, handles, where a command is recorded |
//! | `own/` | what the specification says in words, of all commands, where no other rule has anything to say of the call |
//!
//! Each room has a file for each structure or command, and each rule is one short function there. Implicit rules come by the
//! dozen, so that room has a file for each kind of check and tables of where it applies. [`catalog::RULES`] is the ledger of all
//! rules.
//!
//! # Example
//!
//! An engine checks one call and prints what is wrong with it.
//!
//! ```
//! use omm_model::call::Call;
//! use omm_model::memory::NoMemory;
//! use omm_model::profile::DeviceProfile;
//! use omm_model::vk;
//! use omm_validate::{RuleId, Validator};
//!
//! let micromap = vk::TrianglesOpacityMicromap {
//!     index_type: vk::IndexType::UINT16,
//!     index_buffer: vk::DeviceAddress(0x1000),
//!     index_stride: 3, // Two bytes an index, three bytes apart?
//!     micromap: vk::AccelerationStructure(0x20),
//!     ..Default::default()
//! };
//! let triangles = vk::GeometryTrianglesData { next: vec![micromap.into()], ..Default::default() };
//! let geometry = vk::Geometry {
//!     geometry_type: vk::GeometryType::TRIANGLES,
//!     geometry: vk::GeometryData::Triangles(triangles),
//!     ..Default::default()
//! };
//! let build = Call::CmdBuildAccelerationStructures {
//!     command_buffer: vk::CommandBuffer(0x7),
//!     infos: vec![vk::BuildGeometryInfo {
//!         ty: vk::AccelerationStructureType::BOTTOM_LEVEL,
//!         dst_acceleration_structure: vk::AccelerationStructure(0x21),
//!         geometries: Some(vec![geometry]),
//!         ..Default::default()
//!     }],
//!     build_range_infos: vec![Some(vec![vk::BuildRangeInfo { primitive_count: 2, ..Default::default() }])],
//! };
//!
//! let validator = Validator::new(DeviceProfile::reference());
//! let report = validator.check(&build, &NoMemory);
//!
//! let [violation] = report.violations() else { panic!("{report}") };
//! assert_eq!(violation.rule, RuleId::IndexStride11573);
//! assert_eq!(
//!     violation.summary(),
//!     "vkCmdBuildAccelerationStructuresKHR(): pInfos[0].pGeometries[0].geometry.triangles\
//!      .pNext<VkAccelerationStructureTrianglesOpacityMicromapKHR>.indexStride: found 3, required a multiple of 2"
//! );
//! println!("{report}"); // With identifier, objects, explanation and a link.
//! ```
//!
//! # How to add a rule
//!
//! 1. Name it: one line in the table of [`RuleId`], a word on what it is about and the number that its identifier ends in.
//! 2. Explain it: one row in the file of its structure or command under `catalog/`.
//! 3. Write it: one function `what_number` in the file of that name in the room that knows enough, called from that file's `check`.
//! 4. If no [`ViolationKind`] fits, add one that carries the values found and required, and its two lines of text.
//! 5. Show it: a failing and a passing case in `tests/rules/`; a test there fails as long as a rule lacks either.

pub mod catalog;
mod content;
mod context;
mod implicit;
mod location;
mod own;
mod report;
mod rule;
pub mod state;
mod stateless;
mod tracked;
mod validator;
mod value;
mod violation;

pub use location::{Location, Object};
pub use own::finding::OwnFinding;
pub use report::Report;
pub use rule::RuleId;
pub use validator::Validator;
pub use value::{Constant, Flags, Found};
pub use violation::{Origin, Severity, Violation, ViolationKind};
