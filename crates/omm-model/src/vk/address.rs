//! Addresses in device and host memory, and other base values.

use serde::{Deserialize, Serialize};

use super::enumerant::open_flags;

/// A size or offset in bytes in device memory:
/// [`VkDeviceSize`](https://docs.vulkan.org/refpages/latest/refpages/source/VkDeviceSize.html).
pub type DeviceSize = u64;

/// A truth value as the API passes it:
/// [`VkBool32`](https://docs.vulkan.org/refpages/latest/refpages/source/VkBool32.html).
///
/// Only 0 and 1 are valid, and any `u32` can be held.
#[doc(alias = "VkBool32")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Bool32(pub u32);

impl Bool32 {
    /// `VK_FALSE`.
    #[doc(alias = "VK_FALSE")]
    pub const FALSE: Self = Self(0);

    /// `VK_TRUE`.
    #[doc(alias = "VK_TRUE")]
    pub const TRUE: Self = Self(1);

    /// Whether the value is anything but [`FALSE`](Self::FALSE).
    pub const fn is_true(self) -> bool {
        self.0 != 0
    }
}

impl From<bool> for Bool32 {
    fn from(value: bool) -> Self {
        Self(u32::from(value))
    }
}

/// An address in device memory:
/// [`VkDeviceAddress`](https://docs.vulkan.org/refpages/latest/refpages/source/VkDeviceAddress.html).
#[doc(alias = "VkDeviceAddress")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct DeviceAddress(pub u64);

impl DeviceAddress {
    /// The address 0, which is no address of anything.
    pub const NULL: Self = Self(0);

    /// Whether this is the address of nothing.
    pub const fn is_null(self) -> bool {
        self.0 == 0
    }

    /// The address this many bytes further on, or `None` past the end of the address space.
    pub const fn checked_add(self, bytes: DeviceSize) -> Option<Self> {
        match self.0.checked_add(bytes) {
            Some(address) => Some(Self(address)),
            None => None,
        }
    }

    /// Whether the address is a multiple of `alignment`; an alignment of 0 holds for every address.
    pub const fn is_aligned_to(self, alignment: u64) -> bool {
        alignment == 0 || self.0.is_multiple_of(alignment)
    }
}

/// An address in the application's memory, as a number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub struct HostAddress(pub u64);

impl HostAddress {
    /// The null pointer.
    pub const NULL: Self = Self(0);

    /// Whether this is the null pointer.
    pub const fn is_null(self) -> bool {
        self.0 == 0
    }
}

/// An address in device memory or in host memory:
/// [`VkDeviceOrHostAddressKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkDeviceOrHostAddressKHR.html) and
/// [`VkDeviceOrHostAddressConstKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkDeviceOrHostAddressConstKHR.html).
///
/// The API's union does not tell which of the two it holds; the variant does, so that a command that reads the other one can
/// be found.
#[doc(alias = "VkDeviceOrHostAddressKHR")]
#[doc(alias = "VkDeviceOrHostAddressConstKHR")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum DeviceOrHostAddress {
    /// An address in device memory, which device commands read.
    DeviceAddress(DeviceAddress),
    /// An address in host memory, which host commands read.
    HostAddress(HostAddress),
}

impl DeviceOrHostAddress {
    /// The number that the union holds.
    pub const fn raw(self) -> u64 {
        match self {
            Self::DeviceAddress(address) => address.0,
            Self::HostAddress(address) => address.0,
        }
    }

    /// Whether the union holds 0.
    pub const fn is_null(self) -> bool {
        self.raw() == 0
    }

    /// The device address, or `None` where this is an address in host memory.
    pub const fn device_address(self) -> Option<DeviceAddress> {
        match self {
            Self::DeviceAddress(address) => Some(address),
            Self::HostAddress(_) => None,
        }
    }

    /// The host address, or `None` where this is an address in device memory.
    pub const fn host_address(self) -> Option<HostAddress> {
        match self {
            Self::DeviceAddress(_) => None,
            Self::HostAddress(address) => Some(address),
        }
    }
}

impl Default for DeviceOrHostAddress {
    fn default() -> Self {
        Self::DeviceAddress(DeviceAddress::NULL)
    }
}

impl From<DeviceAddress> for DeviceOrHostAddress {
    fn from(address: DeviceAddress) -> Self {
        Self::DeviceAddress(address)
    }
}

impl From<HostAddress> for DeviceOrHostAddress {
    fn from(address: HostAddress) -> Self {
        Self::HostAddress(address)
    }
}

/// A range of device memory:
/// [`VkDeviceAddressRangeKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkDeviceAddressRangeKHR.html).
#[doc(alias = "VkDeviceAddressRangeKHR")]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct DeviceAddressRange {
    /// The first address of the range.
    pub address: DeviceAddress,
    /// Bytes in the range.
    pub size: DeviceSize,
}

impl DeviceAddressRange {
    /// The first address behind the range, or `None` where that lies past the end of the address space.
    pub const fn end(self) -> Option<DeviceAddress> {
        self.address.checked_add(self.size)
    }
}

open_flags! {
    /// What an application promises about the memory behind an address range:
    /// [`VkAddressCommandFlagBitsKHR`](https://docs.vulkan.org/refpages/latest/refpages/source/VkAddressCommandFlagBitsKHR.html).
    #[doc(alias = "VkAddressCommandFlagBitsKHR")]
    #[doc(alias = "VkAddressCommandFlagsKHR")]
    pub struct AddressCommandFlags: u32 {
        /// It is protected memory.
        PROTECTED = 1 << 0, "VK_ADDRESS_COMMAND_PROTECTED_BIT_KHR";
        /// All of the range is bound to memory when it is accessed, so that no part belongs to an unbound part of a sparse buffer.
        FULLY_BOUND = 1 << 1, "VK_ADDRESS_COMMAND_FULLY_BOUND_BIT_KHR";
        /// Every buffer that overlaps the range has [`STORAGE_BUFFER`](super::BufferUsageFlags::STORAGE_BUFFER) usage.
        STORAGE_BUFFER_USAGE = 1 << 2, "VK_ADDRESS_COMMAND_STORAGE_BUFFER_USAGE_BIT_KHR";
        /// It is not known which buffers that overlap the range have storage usage.
        UNKNOWN_STORAGE_BUFFER_USAGE = 1 << 3, "VK_ADDRESS_COMMAND_UNKNOWN_STORAGE_BUFFER_USAGE_BIT_KHR";
        /// Every buffer that overlaps the range has
        /// [`TRANSFORM_FEEDBACK_BUFFER`](super::BufferUsageFlags::TRANSFORM_FEEDBACK_BUFFER) usage.
        TRANSFORM_FEEDBACK_BUFFER_USAGE = 1 << 4, "VK_ADDRESS_COMMAND_TRANSFORM_FEEDBACK_BUFFER_USAGE_BIT_KHR";
        /// It is not known which buffers that overlap the range have transform feedback usage.
        UNKNOWN_TRANSFORM_FEEDBACK_BUFFER_USAGE = 1 << 5, "VK_ADDRESS_COMMAND_UNKNOWN_TRANSFORM_FEEDBACK_BUFFER_USAGE_BIT_KHR";
    }
}
