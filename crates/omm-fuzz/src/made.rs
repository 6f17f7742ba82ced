//! Values of any type that can be read, made of choices.

use arbitrary::Unstructured;
use serde::de::value::U32Deserializer;
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, EnumAccess, Error as _, IntoDeserializer, SeqAccess, VariantAccess,
    Visitor,
};

type Error = serde::de::value::Error;

/// How deep lists and pointers lie in each other.
const DEPTH: u32 = 24;

/// A value that the bytes choose: whoever reads it is told whatever fits. Numbers are often small or at the ends of their range, so
/// that handles meet and limits are met; lists are short. Without bytes left everything is zero and empty.
///
/// # Errors
/// The type refuses what it is told.
pub fn made<T: for<'de> Deserialize<'de>>(choices: &mut Unstructured<'_>) -> Result<T, Error> {
    T::deserialize(Maker { choices, depth: 0 })
}

struct Maker<'a, 'u> {
    choices: &'a mut Unstructured<'u>,
    depth: u32,
}

impl<'u> Maker<'_, 'u> {
    fn number(&mut self) -> Result<u64, Error> {
        let number = match self.below(4)? {
            0 => self.below(20)?,
            1 => 1 << self.below(64)?,
            2 => u64::MAX >> self.below(64)?,
            _ => self.choices.arbitrary().map_err(Error::custom)?,
        };
        Ok(number)
    }

    fn below(&mut self, end: u64) -> Result<u64, Error> {
        self.choices.int_in_range(0..=end - 1).map_err(Error::custom)
    }

    fn inner(&mut self) -> Maker<'_, 'u> {
        Maker { choices: self.choices, depth: self.depth + 1 }
    }

    fn values<'de, V: Visitor<'de>>(mut self, count: usize, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_seq(Values { maker: self.inner(), count })
    }
}

struct Values<'a, 'u> {
    maker: Maker<'a, 'u>,
    count: usize,
}

impl<'de> SeqAccess<'de> for Values<'_, '_> {
    type Error = Error;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Error> {
        let Some(left) = self.count.checked_sub(1) else { return Ok(None) };
        self.count = left;
        seed.deserialize(Maker { choices: self.maker.choices, depth: self.maker.depth }).map(Some)
    }
}

macro_rules! numbers {
    ($($method:ident $visit:ident $type:ty;)*) => {$(
        fn $method<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Error> {
            visitor.$visit(self.number()? as $type)
        }
    )*};
}

impl<'de> Deserializer<'de> for Maker<'_, '_> {
    type Error = Error;

    fn is_human_readable(&self) -> bool {
        false
    }

    numbers! {
        deserialize_u8 visit_u8 u8;
        deserialize_u16 visit_u16 u16;
        deserialize_u32 visit_u32 u32;
        deserialize_u64 visit_u64 u64;
        deserialize_i8 visit_i8 i8;
        deserialize_i16 visit_i16 i16;
        deserialize_i32 visit_i32 i32;
        deserialize_i64 visit_i64 i64;
    }

    fn deserialize_bool<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_bool(self.below(2)? == 1)
    }

    fn deserialize_f32<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_f32(f32::from_bits(self.number()? as u32))
    }

    fn deserialize_f64<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_f64(f64::from_bits(self.number()?))
    }

    fn deserialize_option<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Error> {
        if self.depth < DEPTH && self.below(2)? == 1 { visitor.visit_some(self.inner()) } else { visitor.visit_none() }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(mut self, _: &'static str, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_newtype_struct(self.inner())
    }

    fn deserialize_seq<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Error> {
        let count = if self.depth < DEPTH { self.below(4)? as usize } else { 0 };
        self.values(count, visitor)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, count: usize, visitor: V) -> Result<V::Value, Error> {
        self.values(count, visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.values(fields.len(), visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        mut self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        let number = self.below(variants.len() as u64)? as u32;
        visitor.visit_enum(Variant { number, maker: self.inner() })
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_string(self.choices.arbitrary().map_err(Error::custom)?)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_str(visitor)
    }

    fn deserialize_bytes<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        visitor.visit_byte_buf(self.choices.arbitrary().map_err(Error::custom)?)
    }

    fn deserialize_byte_buf<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Error> {
        self.deserialize_bytes(visitor)
    }

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Error> {
        Err(Error::custom("the type does not say what it is"))
    }

    serde::forward_to_deserialize_any! { i128 u128 char unit unit_struct tuple_struct map identifier ignored_any }
}

struct Variant<'a, 'u> {
    number: u32,
    maker: Maker<'a, 'u>,
}

impl<'a, 'u, 'de> EnumAccess<'de> for Variant<'a, 'u> {
    type Error = Error;
    type Variant = Maker<'a, 'u>;

    fn variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<(T::Value, Self::Variant), Error> {
        let number: U32Deserializer<Error> = self.number.into_deserializer();
        Ok((seed.deserialize(number)?, self.maker))
    }
}

impl<'de> VariantAccess<'de> for Maker<'_, '_> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Error> {
        seed.deserialize(self)
    }

    fn tuple_variant<V: Visitor<'de>>(self, count: usize, visitor: V) -> Result<V::Value, Error> {
        self.values(count, visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, fields: &'static [&'static str], visitor: V) -> Result<V::Value, Error> {
        self.values(fields.len(), visitor)
    }
}
