//! How much a scenario may ask for. Its text is short; what it makes must not be longer than these.

/// Bytes of a scenario's text.
pub(crate) const SOURCE: usize = 1 << 20;
/// Objects in `given`.
pub(crate) const OBJECTS: usize = 1 << 8;
/// Steps in `when`, those inside others included.
pub(crate) const STEPS: usize = 1 << 8;
/// Triangles, boxes and instances that all objects together declare.
pub(crate) const PRIMITIVES: u64 = 1 << 16;
/// Microtriangles that all objects together declare: one triangle of the finest level, or many coarser ones.
pub(crate) const MICROTRIANGLES: u64 = 1 << 24;
/// Bytes that all buffers together get written from the scenario.
pub(crate) const BYTES: u64 = 1 << 24;
/// Bytes of the simulated device's heap.
pub(crate) const HEAP: u64 = 1 << 28;
