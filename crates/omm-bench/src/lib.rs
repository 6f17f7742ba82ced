//! Measurements: what is baked, how time is taken, and the same work done by a peer.
//!
//! | room | holds |
//! |---|---|
//! | [`calls`] | valid calls for a validator to look at |
//! | [`foliage`] | an alpha texture of leaves, from arithmetic alone |
//! | [`workload`] | the texture and the triangles of one measurement |
//! | [`clock`] | processor time of the thread, which other processes disturb less than wall time |
//! | [`arguments`] | what the programs are asked |
//! | [`copies`] | serialized data and bundles, written, read and relocated beside a copy of the same bytes |
//! | [`peers`] | the same bake by this baker and by meshoptimizer, and how many states of each contradict the texture |
//! | [`rays`] | traversal beside its hierarchy crate's own, and with micromaps beside without |
//!
//! ```
//! use omm_bench::workload::Workload;
//!
//! let workload = Workload::PEERS[0].scaled_down(16);
//! assert_eq!(workload.microtriangles(), 16 * 4096);
//! assert_eq!(workload.uvs().len(), 3 * 16);
//! ```

pub mod arguments;
pub mod calls;
pub mod clock;
pub mod copies;
pub mod foliage;
pub mod peers;
pub mod rays;
pub mod workload;
