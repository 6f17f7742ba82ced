//! From a value to its tree.

use serde::Serialize;
use serde::ser::{self, Serializer};

use super::{Tree, TreeError};

impl ser::Error for TreeError {
    fn custom<T: std::fmt::Display>(message: T) -> Self {
        Self(message.to_string())
    }
}

/// Writes trees. Not for people, so that flags are numbers and not text.
pub(crate) struct Writer;

/// A list or a structure in the making.
pub(crate) struct Parts {
    /// What becomes of the parts.
    finish: Finish,
    names: Vec<&'static str>,
    parts: Vec<Tree>,
}

enum Finish {
    List,
    Struct(&'static str),
    Variant(&'static str, &'static str),
}

impl Parts {
    const fn new(finish: Finish) -> Self {
        Self { finish, names: Vec::new(), parts: Vec::new() }
    }

    fn push<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), TreeError> {
        self.parts.push(Tree::of(value)?);
        Ok(())
    }

    fn push_named<T: Serialize + ?Sized>(&mut self, name: &'static str, value: &T) -> Result<(), TreeError> {
        self.names.push(name);
        self.push(value)
    }

    fn finish(self) -> Tree {
        let Self { finish, names, parts } = self;
        match finish {
            Finish::List => Tree::List(parts),
            Finish::Struct(name) => Tree::Struct(name, names.into_iter().zip(parts).collect()),
            Finish::Variant(name, variant) => {
                let body = Tree::Struct(variant, names.into_iter().zip(parts).collect());
                Tree::Variant(name, variant, Some(Box::new(body)))
            }
        }
    }
}

impl Serializer for Writer {
    type Ok = Tree;
    type Error = TreeError;
    type SerializeSeq = Parts;
    type SerializeTuple = Parts;
    type SerializeTupleStruct = Parts;
    type SerializeTupleVariant = ser::Impossible<Tree, TreeError>;
    type SerializeMap = ser::Impossible<Tree, TreeError>;
    type SerializeStruct = Parts;
    type SerializeStructVariant = Parts;

    fn is_human_readable(&self) -> bool {
        false
    }

    fn serialize_bool(self, value: bool) -> Result<Tree, TreeError> {
        Ok(Tree::Bool(value))
    }

    fn serialize_i8(self, value: i8) -> Result<Tree, TreeError> {
        Ok(Tree::Integer(value.into()))
    }

    fn serialize_i16(self, value: i16) -> Result<Tree, TreeError> {
        Ok(Tree::Integer(value.into()))
    }

    fn serialize_i32(self, value: i32) -> Result<Tree, TreeError> {
        Ok(Tree::Integer(value.into()))
    }

    fn serialize_i64(self, value: i64) -> Result<Tree, TreeError> {
        Ok(Tree::Integer(value.into()))
    }

    fn serialize_u8(self, value: u8) -> Result<Tree, TreeError> {
        Ok(Tree::Integer(value.into()))
    }

    fn serialize_u16(self, value: u16) -> Result<Tree, TreeError> {
        Ok(Tree::Integer(value.into()))
    }

    fn serialize_u32(self, value: u32) -> Result<Tree, TreeError> {
        Ok(Tree::Integer(value.into()))
    }

    fn serialize_u64(self, value: u64) -> Result<Tree, TreeError> {
        Ok(Tree::Integer(value.into()))
    }

    fn serialize_f32(self, value: f32) -> Result<Tree, TreeError> {
        Ok(Tree::Float(value.into()))
    }

    fn serialize_f64(self, value: f64) -> Result<Tree, TreeError> {
        Ok(Tree::Float(value))
    }

    fn serialize_char(self, value: char) -> Result<Tree, TreeError> {
        Ok(Tree::Text(value.to_string()))
    }

    fn serialize_str(self, value: &str) -> Result<Tree, TreeError> {
        Ok(Tree::Text(value.to_owned()))
    }

    fn serialize_bytes(self, value: &[u8]) -> Result<Tree, TreeError> {
        Ok(Tree::List(value.iter().map(|byte| Tree::Integer((*byte).into())).collect()))
    }

    fn serialize_none(self) -> Result<Tree, TreeError> {
        Ok(Tree::None)
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<Tree, TreeError> {
        Ok(Tree::Some(Box::new(Tree::of(value)?)))
    }

    fn serialize_unit(self) -> Result<Tree, TreeError> {
        Ok(Tree::None)
    }

    fn serialize_unit_struct(self, name: &'static str) -> Result<Tree, TreeError> {
        Ok(Tree::Struct(name, Vec::new()))
    }

    fn serialize_unit_variant(self, name: &'static str, _index: u32, variant: &'static str) -> Result<Tree, TreeError> {
        Ok(Tree::Variant(name, variant, None))
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(self, name: &'static str, value: &T) -> Result<Tree, TreeError> {
        Ok(Tree::Newtype(name, Box::new(Tree::of(value)?)))
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        name: &'static str,
        _index: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<Tree, TreeError> {
        Ok(Tree::Variant(name, variant, Some(Box::new(Tree::of(value)?))))
    }

    fn serialize_seq(self, _length: Option<usize>) -> Result<Parts, TreeError> {
        Ok(Parts::new(Finish::List))
    }

    fn serialize_tuple(self, _length: usize) -> Result<Parts, TreeError> {
        Ok(Parts::new(Finish::List))
    }

    fn serialize_tuple_struct(self, _name: &'static str, _length: usize) -> Result<Parts, TreeError> {
        Ok(Parts::new(Finish::List))
    }

    fn serialize_tuple_variant(
        self,
        name: &'static str,
        _index: u32,
        variant: &'static str,
        _length: usize,
    ) -> Result<Self::SerializeTupleVariant, TreeError> {
        Err(TreeError(format!("{name}::{variant} has no names for its values")))
    }

    fn serialize_map(self, _length: Option<usize>) -> Result<Self::SerializeMap, TreeError> {
        Err(TreeError("maps are no part of calls".to_owned()))
    }

    fn serialize_struct(self, name: &'static str, _length: usize) -> Result<Parts, TreeError> {
        Ok(Parts::new(Finish::Struct(name)))
    }

    fn serialize_struct_variant(
        self,
        name: &'static str,
        _index: u32,
        variant: &'static str,
        _length: usize,
    ) -> Result<Parts, TreeError> {
        Ok(Parts::new(Finish::Variant(name, variant)))
    }
}

impl ser::SerializeSeq for Parts {
    type Ok = Tree;
    type Error = TreeError;
    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), TreeError> {
        self.push(value)
    }
    fn end(self) -> Result<Tree, TreeError> {
        Ok(self.finish())
    }
}

impl ser::SerializeTuple for Parts {
    type Ok = Tree;
    type Error = TreeError;
    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), TreeError> {
        self.push(value)
    }
    fn end(self) -> Result<Tree, TreeError> {
        Ok(self.finish())
    }
}

impl ser::SerializeTupleStruct for Parts {
    type Ok = Tree;
    type Error = TreeError;
    fn serialize_field<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), TreeError> {
        self.push(value)
    }
    fn end(self) -> Result<Tree, TreeError> {
        Ok(self.finish())
    }
}

impl ser::SerializeStruct for Parts {
    type Ok = Tree;
    type Error = TreeError;
    fn serialize_field<T: Serialize + ?Sized>(&mut self, name: &'static str, value: &T) -> Result<(), TreeError> {
        self.push_named(name, value)
    }
    fn end(self) -> Result<Tree, TreeError> {
        Ok(self.finish())
    }
}

impl ser::SerializeStructVariant for Parts {
    type Ok = Tree;
    type Error = TreeError;
    fn serialize_field<T: Serialize + ?Sized>(&mut self, name: &'static str, value: &T) -> Result<(), TreeError> {
        self.push_named(name, value)
    }
    fn end(self) -> Result<Tree, TreeError> {
        Ok(self.finish())
    }
}
