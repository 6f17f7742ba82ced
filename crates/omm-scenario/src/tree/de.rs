//! From a tree to the value.

use serde::de::value::{MapDeserializer, SeqDeserializer, StrDeserializer};
use serde::de::{self, DeserializeSeed, Deserializer, EnumAccess, IntoDeserializer, VariantAccess, Visitor};
use serde::forward_to_deserialize_any;

use super::{Tree, TreeError};

impl de::Error for TreeError {
    fn custom<T: std::fmt::Display>(message: T) -> Self {
        Self(message.to_string())
    }
}

impl<'de> IntoDeserializer<'de, TreeError> for &'de Tree {
    type Deserializer = Self;
    fn into_deserializer(self) -> Self {
        self
    }
}

impl<'de> Deserializer<'de> for &'de Tree {
    type Error = TreeError;

    fn is_human_readable(&self) -> bool {
        false
    }

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TreeError> {
        match self {
            Tree::Bool(value) => visitor.visit_bool(*value),
            Tree::Integer(number) => match (u64::try_from(*number), i64::try_from(*number)) {
                (Ok(number), _) => visitor.visit_u64(number),
                (_, Ok(number)) => visitor.visit_i64(number),
                _ => Err(TreeError(format!("{number} does not fit into 64 bits"))),
            },
            Tree::Float(number) => visitor.visit_f64(*number),
            Tree::Text(text) => visitor.visit_borrowed_str(text),
            Tree::None => visitor.visit_unit(),
            Tree::Some(inner) => visitor.visit_some(&**inner),
            Tree::List(items) => {
                let mut items = SeqDeserializer::new(items.iter());
                let value = visitor.visit_seq(&mut items)?;
                items.end().map(|()| value)
            }
            Tree::Newtype(_, inner) => inner.deserialize_any(visitor),
            Tree::Struct(_, fields) => {
                let mut fields = MapDeserializer::new(fields.iter().map(|(name, value)| (*name, value)));
                let value = visitor.visit_map(&mut fields)?;
                fields.end().map(|()| value)
            }
            Tree::Variant(..) => visitor.visit_enum(self),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, TreeError> {
        match self {
            Tree::None => visitor.visit_none(),
            Tree::Some(inner) => visitor.visit_some(&**inner),
            other => visitor.visit_some(other),
        }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        visitor: V,
    ) -> Result<V::Value, TreeError> {
        match self {
            Tree::Newtype(found, _) if *found != name => Err(TreeError(format!("{found} is no {name}"))),
            Tree::Newtype(_, inner) => visitor.visit_newtype_struct(&**inner),
            other => visitor.visit_newtype_struct(other),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        _fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TreeError> {
        match self {
            Tree::Struct(found, _) if *found != name => Err(TreeError(format!("{found} is no {name}"))),
            Tree::Struct(..) => self.deserialize_any(visitor),
            _ => Err(TreeError(format!("this is no {name}"))),
        }
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        name: &'static str,
        _variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TreeError> {
        match self {
            Tree::Variant(found, ..) if *found == name => visitor.visit_enum(self),
            _ => Err(TreeError(format!("this is no {name}"))),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct map identifier ignored_any
    }
}

impl<'de> EnumAccess<'de> for &'de Tree {
    type Error = TreeError;
    type Variant = Body<'de>;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self::Variant), TreeError> {
        let Tree::Variant(_, variant, body) = self else {
            return Err(TreeError("this is no variant".to_owned()));
        };
        let name: StrDeserializer<'_, TreeError> = (*variant).into_deserializer();
        Ok((seed.deserialize(name)?, Body(body.as_deref())))
    }
}

/// What a variant holds.
pub(crate) struct Body<'de>(Option<&'de Tree>);

impl<'de> VariantAccess<'de> for Body<'de> {
    type Error = TreeError;

    fn unit_variant(self) -> Result<(), TreeError> {
        match self.0 {
            None => Ok(()),
            Some(_) => Err(TreeError("the variant holds nothing".to_owned())),
        }
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, TreeError> {
        match self.0 {
            Some(body) => seed.deserialize(body),
            None => Err(TreeError("the variant holds something".to_owned())),
        }
    }

    fn tuple_variant<V: Visitor<'de>>(self, _length: usize, visitor: V) -> Result<V::Value, TreeError> {
        self.newtype_variant_seed(std::marker::PhantomData::<de::IgnoredAny>)?;
        visitor.visit_unit()
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        _fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, TreeError> {
        match self.0 {
            Some(body) => body.deserialize_any(visitor),
            None => Err(TreeError("the variant holds something".to_owned())),
        }
    }
}
