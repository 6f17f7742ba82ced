//! The vocabulary of [`VK_EXT_opacity_micromap`] as the [ash] crate spells it, converted into ours. Feature `ash`.
//!
//! An engine that calls Vulkan through ash hands the same structures to a validator. Numbers stay as they are, whatever they
//! mean: an unknown enumerant or flag arrives as it was written.
//!
//! What is a value in C is converted by `From`, from a reference where it is a structure. Three things in a structure cannot be
//! looked at without `unsafe`, of which there is none here, so the caller says what they hold:
//!
//! - **Unions.** Where the API has `VkDeviceOrHostAddress…KHR` the caller passes a [`DeviceOrHostAddress`](vk::DeviceOrHostAddress),
//!   which also says what the union leaves open: on which side the address is.
//! - **Arrays behind pointers**, such as `pUsageCounts`, `ppUsageCounts` and `pGeometries`. The caller passes a slice. It goes where
//!   the structure has a pointer that is not null, into both places if both are not; its length has to be the structure's count.
//! - **`pNext`.** The chain of a converted structure is empty; push what the application chained.
//!
//! Structures with unions or arrays are converted by functions named `from_ash`; what they ask for is named as in the structure.
//!
//! ```
//! use ::ash::vk::{self as ash, Handle};
//! use omm_model::ash::MicromapBuildPointers;
//! use omm_model::vk;
//!
//! let usage_counts = [ash::MicromapUsageEXT { count: 3, subdivision_level: 2, format: 2 }];
//! let info = ash::MicromapBuildInfoEXT::default()
//!     .flags(ash::BuildMicromapFlagsEXT::PREFER_FAST_TRACE)
//!     .dst_micromap(ash::MicromapEXT::from_raw(7))
//!     .usage_counts(&usage_counts)
//!     .triangle_array_stride(8);
//! let pointers = MicromapBuildPointers {
//!     usage_counts: &usage_counts,
//!     data: vk::DeviceAddress(0x1000).into(),
//!     scratch_data: vk::DeviceAddress(0x2000).into(),
//!     triangle_array: vk::DeviceAddress(0x3000).into(),
//! };
//! let build = vk::MicromapBuildInfo::from_ash(&info, pointers)?;
//!
//! assert_eq!(build.dst_micromap, vk::Micromap(7));
//! assert_eq!(build.usages().next().map(|usage| usage.count), Some(3));
//! # Ok::<(), omm_model::ash::CountError>(())
//! ```
//!
//! [`VK_EXT_opacity_micromap`]: https://docs.vulkan.org/refpages/latest/refpages/source/VK_EXT_opacity_micromap.html
//! [ash]: https://docs.rs/ash

mod bottom_level;
mod micromap;
mod scalar;
mod structure;

#[cfg(test)]
mod tests;

pub use bottom_level::{BuildGeometryPointers, TrianglesOpacityMicromapPointers, TrianglesPointers};
pub use micromap::MicromapBuildPointers;

use crate::vk;

/// A slice that was passed for an array is longer or shorter than the structure says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{found} elements were passed for {member}, which has {required}")]
pub struct CountError {
    /// The member that points to the array.
    pub member: &'static str,
    /// Elements passed.
    pub found: usize,
    /// Elements of the array, by the structure.
    pub required: u32,
}

/// One array that is given by one of two members, `pArray` or `ppArray`.
struct EitherArray {
    member: &'static str,
    count: u32,
    /// Whether each of the two is null.
    is_null: [bool; 2],
}

impl EitherArray {
    /// The elements, at each member that is not null.
    fn fill<T: Clone>(self, elements: Vec<T>) -> Result<[Option<Vec<T>>; 2], CountError> {
        let Self { member, count, is_null } = self;
        let found = elements.len();
        if !is_null.iter().all(|is_null| *is_null) && usize::try_from(count) != Ok(found) {
            return Err(CountError { member, found, required: count });
        }
        Ok(is_null.map(|is_null| (!is_null).then(|| elements.clone())))
    }
}
