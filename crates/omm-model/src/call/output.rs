//! What commands return.

use serde::{Deserialize, Serialize};

use crate::vk;

/// What a command returns beside the handles that it creates.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Output {
    /// Nothing, or success.
    #[default]
    None,
    /// A result code other than success.
    Result(vk::Result),
    /// An address.
    DeviceAddress(vk::DeviceAddress),
    /// Sizes of the build of an acceleration structure.
    BuildSizes(vk::BuildSizesInfo),
    /// Sizes of the build of a micromap object.
    MicromapBuildSizes(vk::MicromapBuildSizesInfo),
    /// Whether serialized data fits the device.
    Compatibility(vk::AccelerationStructureCompatibility),
    /// The values of queries, in order.
    ///
    /// With [`WITH_AVAILABILITY`](vk::QueryResultFlags::WITH_AVAILABILITY) each query has two entries, its value and 1 if it is
    /// available or 0 if not; an unavailable one among them means that the result code was `NOT_READY`. Without that flag, and
    /// without [`PARTIAL`](vk::QueryResultFlags::PARTIAL), one unavailable query makes the answer [`Output::Result`] with
    /// `NOT_READY`, and no value is there.
    QueryResults(Vec<u64>),
    /// The sizes that a host command asked for: one for each object, in order, whatever the stride between them.
    Properties(Vec<u64>),
    /// How many threads can usefully join an operation; 0 once it is complete.
    MaxConcurrency(u32),
    /// The structures of a query of features or limits, in order and filled in.
    Structures(vk::Chain),
}
