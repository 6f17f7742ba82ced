//! A call as a tree of typed values: what `serde` says about it, names of types included.
//!
//! It is what changes work on. Because a leaf knows its type, a name in a scenario becomes the handle or the address or the
//! enumerant that belongs there.

mod de;
mod ser;

use serde::Serialize;
use serde::de::DeserializeOwned;

/// A value with the names of its types.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Tree {
    Bool(bool),
    Integer(i128),
    Float(f64),
    Text(String),
    /// A null pointer, or nothing.
    None,
    /// What a pointer points to.
    Some(Box<Tree>),
    List(Vec<Tree>),
    /// A type around one value, such as a handle: its name and the value.
    Newtype(&'static str, Box<Tree>),
    /// A structure: its name and its fields.
    Struct(&'static str, Vec<(&'static str, Tree)>),
    /// A variant of an enum: the enum's name, the variant's name and what it holds.
    Variant(&'static str, &'static str, Option<Box<Tree>>),
}

/// Why a tree is not the value that it should be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub(crate) struct TreeError(pub(crate) String);

impl Tree {
    /// The tree of a value.
    pub(crate) fn of<T: Serialize + ?Sized>(value: &T) -> Result<Self, TreeError> {
        value.serialize(ser::Writer)
    }

    /// The value of a tree.
    pub(crate) fn to<T: DeserializeOwned>(&self) -> Result<T, TreeError> {
        T::deserialize(self)
    }

    /// The whole number that a leaf holds.
    pub(crate) fn integer(&self) -> Option<i128> {
        match self {
            Self::Integer(number) => Some(*number),
            Self::Newtype(_, inner) | Self::Some(inner) => inner.integer(),
            Self::Variant(_, _, Some(inner)) => inner.integer(),
            _ => None,
        }
    }

    /// Whether the value is what a structure full of zeros holds.
    pub(crate) fn is_zero(&self) -> bool {
        match self {
            Self::Bool(value) => !value,
            Self::Integer(number) => *number == 0,
            Self::Float(number) => *number == 0.0,
            Self::Text(text) => text.is_empty(),
            Self::None => true,
            Self::List(items) => items.is_empty(),
            Self::Some(_) => false,
            Self::Newtype(_, inner) => inner.is_zero(),
            Self::Struct(_, fields) => fields.iter().all(|(_, field)| field.is_zero()),
            Self::Variant(_, "None", None) => true,
            Self::Variant("DeviceOrHostAddress", _, Some(inner)) => inner.is_zero(),
            Self::Variant(..) => false,
        }
    }

    /// The same value with structures, pointers and variants that stand only for what they hold taken off.
    pub(crate) fn body(&self) -> &Self {
        match self {
            Self::Some(inner) => inner.body(),
            Self::Variant(name, _, Some(inner)) if is_transparent(name) => inner.body(),
            other => other,
        }
    }

    /// [`body`](Self::body), to be changed.
    pub(crate) fn body_mut(&mut self) -> &mut Self {
        match self {
            Self::Variant(name, _, _) if !is_transparent(name) => self,
            Self::Some(inner) | Self::Variant(_, _, Some(inner)) => inner.body_mut(),
            other => other,
        }
    }

    /// Part `index` of what a structure, a list or a union holds.
    pub(crate) fn part(&self, index: usize) -> Option<&Self> {
        match self.body() {
            Self::Struct(_, fields) => fields.get(index).map(|(_, field)| field),
            Self::List(items) => items.get(index),
            Self::Variant(_, _, Some(inner)) if index == 0 => Some(inner),
            _ => None,
        }
    }

    /// [`part`](Self::part), to be changed.
    pub(crate) fn part_mut(&mut self, index: usize) -> Option<&mut Self> {
        match self.body_mut() {
            Self::Struct(_, fields) => fields.get_mut(index).map(|(_, field)| field),
            Self::List(items) => items.get_mut(index),
            Self::Variant(_, _, Some(inner)) if index == 0 => Some(inner),
            _ => None,
        }
    }

    /// The part that a route of indices leads to.
    pub(crate) fn at(&self, route: &[usize]) -> Option<&Self> {
        route.iter().try_fold(self, |tree, index| tree.part(*index))
    }

    /// [`at`](Self::at), to be changed.
    pub(crate) fn at_mut(&mut self, route: &[usize]) -> Option<&mut Self> {
        route.iter().try_fold(self, |tree, index| tree.part_mut(*index))
    }

    /// The field of that name in a structure.
    pub(crate) fn field(&self, name: &str) -> Option<&Self> {
        match self.body() {
            Self::Struct(_, fields) => fields.iter().find(|(field, _)| *field == name).map(|(_, value)| value),
            _ => None,
        }
    }
}

/// Enums whose variant is not a step of a path: a call, and the structures of a chain, which have steps of their own.
fn is_transparent(name: &str) -> bool {
    matches!(name, "Call" | "ChainStructure")
}

#[cfg(test)]
mod tests {
    use omm_model::call::Call;
    use omm_model::vk;

    use super::*;

    #[test]
    fn a_call_survives() {
        let attached = vk::TrianglesOpacityMicromap { base_triangle: 7, ..Default::default() };
        let triangles = vk::GeometryTrianglesData { next: vec![attached.into()], ..Default::default() };
        let geometry = vk::Geometry { geometry: vk::GeometryData::Triangles(triangles), ..Default::default() };
        let call = Call::CmdBuildAccelerationStructures {
            command_buffer: vk::CommandBuffer(u64::MAX),
            infos: vec![vk::BuildGeometryInfo {
                ty: vk::AccelerationStructureType(-17),
                flags: vk::BuildAccelerationStructureFlags::from_bits_retain(0x8000_0001),
                geometries: Some(vec![geometry, vk::Geometry::default()]),
                scratch_data: vk::DeviceOrHostAddress::HostAddress(vk::HostAddress(5)),
                ..Default::default()
            }],
            build_range_infos: vec![None, Some(vec![vk::BuildRangeInfo::default()])],
        };
        let tree = Tree::of(&call).unwrap();
        assert_eq!(tree.to::<Call>().unwrap(), call);
        let info = tree.field("infos").unwrap().part(0).unwrap();
        assert_eq!(info.field("flags"), Some(&Tree::Newtype("BuildAccelerationStructureFlags", 0x8000_0001.into())));
        assert_eq!(info.field("ty").unwrap().integer(), Some(-17));
        assert_eq!(info.field("scratch_data").unwrap().integer(), Some(5));
    }

    #[test]
    fn numbers_that_do_not_fit_are_refused() {
        let wrong = Tree::Newtype("IndexType", Box::new(Tree::Integer(1 << 40)));
        assert!(wrong.to::<vk::IndexType>().unwrap_err().0.contains("expected i32"));
        let wrong = Tree::Newtype("Buffer", Box::new(Tree::Integer(-1)));
        assert!(wrong.to::<vk::Buffer>().is_err());
        let wrong = Tree::Newtype("Buffer", Box::new(Tree::Integer(1 << 64)));
        assert!(wrong.to::<vk::Buffer>().is_err());
        assert!(Tree::List(vec![]).to::<vk::MicromapUsage>().is_err());
        assert!(Tree::None.to::<Call>().is_err());
    }

    impl From<i128> for Box<Tree> {
        fn from(number: i128) -> Self {
            Self::new(Tree::Integer(number))
        }
    }
}
