//! Measurements: what is baked, how time is taken, and the same work done by a peer.
//!
//! | room | holds |
//! |---|---|
//! | [`foliage`] | an alpha texture of leaves, from arithmetic alone |
//! | [`workload`] | the texture and the triangles of one measurement |
//! | [`clock`] | processor time of the thread, which other processes disturb less than wall time |
//! | [`peers`] | the same bake by this baker and by meshoptimizer, and how many states of each contradict the texture |
//! | [`plot`] | a figure of curves |
//!
//! ```
//! use omm_bench::workload::Workload;
//!
//! let workload = Workload::PEERS[0].scaled_down(16);
//! assert_eq!(workload.microtriangles(), 16 * 4096);
//! assert_eq!(workload.uvs().len(), 3 * 16);
//! ```

pub mod clock;
pub mod foliage;
pub mod peers;
pub mod plot;
pub mod workload;
