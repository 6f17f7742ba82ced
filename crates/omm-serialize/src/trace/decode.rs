//! From bytes to values of the model, one number at a time.
//!
//! bincode's own reader would follow values inside each other for as long as the bytes say so, and says of an error neither where it
//! is nor in what. This one reads the same bytes; a test holds the two against each other.

use omm_layout::error::{ReadError, ReadErrorKind};
use serde::de::{
    self, Deserialize, DeserializeSeed, Deserializer, EnumAccess, IntoDeserializer, SeqAccess, VariantAccess, Visitor,
};

use crate::codec::Input;

/// How deep structures, enums, lists and the like may lie in each other. A build with a micromap attached takes 16.
pub const DEPTH_LIMIT: u32 = 64;

/// The value that takes all of `bytes`.
pub(super) fn value<'de, T: Deserialize<'de>>(bytes: &'de [u8]) -> Result<T, ReadError> {
    let mut input = Input::new(bytes);
    let value = T::deserialize(Reader { input: &mut input, depth: 0 });
    let value = value.map_err(|failure| failure.within(format_args!("contents")).0)?;
    input.finish().map(|()| value)
}

/// An error of `serde`, which is one of reading. Its field begins empty and gets its parents put before it.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
struct Failure(ReadError);

impl Failure {
    fn within(self, step: std::fmt::Arguments<'_>) -> Self {
        let field = format!("{step}{}", self.0.field).into();
        Self(ReadError { field, ..self.0 })
    }
}

impl de::Error for Failure {
    /// What is made of the numbers refuses them. No type of the model does.
    fn custom<T: std::fmt::Display>(_: T) -> Self {
        let kind = ReadErrorKind::Unknown { found: 0, required: "a value of its type" };
        Self(ReadError { field: "".into(), offset: 0, kind })
    }
}

struct Reader<'a, 'de> {
    input: &'a mut Input<'de>,
    depth: u32,
}

impl<'de> Reader<'_, 'de> {
    /// A number of `size` bytes.
    fn number<T: bincode::BorrowDecode<'de, ()>>(&mut self, size: u64) -> Result<T, Failure> {
        self.input.value("", size).map_err(Failure)
    }

    /// A number that is to be below `count`, `size` bytes before the end of what was read.
    fn below(&self, found: u64, count: u64, size: u64) -> Result<(), Failure> {
        if found < count {
            return Ok(());
        }
        let kind = ReadErrorKind::Above { found, limit: count.saturating_sub(1) };
        Err(Failure(ReadError { field: "".into(), offset: self.input.position() - size, kind }))
    }

    /// One byte that is 0 or 1.
    fn flag(&mut self) -> Result<bool, Failure> {
        let flag: u8 = self.number(1)?;
        self.below(flag.into(), 2, 1)?;
        Ok(flag == 1)
    }

    /// The reader of what lies in this value.
    fn inner(&mut self) -> Result<Reader<'_, 'de>, Failure> {
        let depth = self.depth + 1;
        if depth > DEPTH_LIMIT {
            let kind = ReadErrorKind::Above { found: depth.into(), limit: DEPTH_LIMIT.into() };
            return Err(Failure(ReadError { field: ".depth".into(), offset: self.input.position(), kind }));
        }
        Ok(Reader { input: self.input, depth })
    }

    /// Values one after the other, as many as `steps` has names or numbers for.
    fn values<V: Visitor<'de>>(mut self, steps: Steps, visitor: V) -> Result<V::Value, Failure> {
        visitor.visit_seq(Values { reader: self.inner()?, steps, next: 0 })
    }
}

/// What the values of a list or structure are called.
enum Steps {
    Fields(&'static [&'static str]),
    Items(u64),
}

struct Values<'a, 'de> {
    reader: Reader<'a, 'de>,
    steps: Steps,
    next: u64,
}

impl<'de> SeqAccess<'de> for Values<'_, 'de> {
    type Error = Failure;

    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Failure> {
        let index = self.next;
        self.next += 1;
        let name = match self.steps {
            Steps::Items(count) if index < count => None,
            Steps::Fields(names) if index < names.len() as u64 => names.get(index as usize),
            _ => return Ok(None),
        };
        let value = seed.deserialize(Reader { input: self.reader.input, depth: self.reader.depth });
        value.map(Some).map_err(|error| match name {
            Some(name) => error.within(format_args!(".{name}")),
            None => error.within(format_args!("[{index}]")),
        })
    }
}

macro_rules! numbers {
    ($($method:ident $visit:ident $type:ty;)*) => {$(
        fn $method<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Failure> {
            visitor.$visit(self.number::<$type>(size_of::<$type>() as u64)?)
        }
    )*};
}

impl<'de> Deserializer<'de> for Reader<'_, 'de> {
    type Error = Failure;

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
        deserialize_f32 visit_f32 f32;
        deserialize_f64 visit_f64 f64;
    }

    fn deserialize_bool<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Failure> {
        visitor.visit_bool(self.flag()?)
    }

    fn deserialize_option<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Failure> {
        if self.flag()? { visitor.visit_some(self.inner()?) } else { visitor.visit_none() }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(mut self, _: &'static str, visitor: V) -> Result<V::Value, Failure> {
        visitor.visit_newtype_struct(self.inner()?)
    }

    fn deserialize_seq<V: Visitor<'de>>(mut self, visitor: V) -> Result<V::Value, Failure> {
        let count: u64 = self.number(8)?;
        // Everything takes a byte at least, so a count that the bytes cannot hold is told at once.
        let available = self.input.remaining();
        if count > available {
            let kind = ReadErrorKind::Truncated { available, required: count };
            return Err(Failure(ReadError { field: "".into(), offset: self.input.position(), kind }));
        }
        self.values(Steps::Items(count), visitor)
    }

    fn deserialize_tuple<V: Visitor<'de>>(self, count: usize, visitor: V) -> Result<V::Value, Failure> {
        self.values(Steps::Items(count as u64), visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Failure> {
        self.values(Steps::Fields(fields), visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        mut self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Failure> {
        let number: u32 = self.number(4)?;
        self.below(number.into(), variants.len() as u64, 4)?;
        let Reader { input, depth } = self.inner()?;
        visitor.visit_enum(Variant { number, reader: Reader { input, depth } })
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        visitor.visit_borrowed_str(self.input.text("").map_err(Failure)?)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        self.deserialize_str(visitor)
    }

    fn deserialize_bytes<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        visitor.visit_borrowed_bytes(self.input.bytes("").map_err(Failure)?)
    }

    fn deserialize_byte_buf<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Failure> {
        self.deserialize_bytes(visitor)
    }

    // The bytes do not say what they are, and nothing in the model needs them to.
    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Failure> {
        Err(de::Error::custom("not in the model"))
    }

    serde::forward_to_deserialize_any! { i128 u128 char unit unit_struct tuple_struct map identifier ignored_any }
}

struct Variant<'a, 'de> {
    number: u32,
    reader: Reader<'a, 'de>,
}

impl<'a, 'de> EnumAccess<'de> for Variant<'a, 'de> {
    type Error = Failure;
    type Variant = Reader<'a, 'de>;

    fn variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<(T::Value, Self::Variant), Failure> {
        Ok((seed.deserialize(self.number.into_deserializer())?, self.reader))
    }
}

impl<'de> VariantAccess<'de> for Reader<'_, 'de> {
    type Error = Failure;

    fn unit_variant(self) -> Result<(), Failure> {
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, seed: T) -> Result<T::Value, Failure> {
        seed.deserialize(self)
    }

    fn tuple_variant<V: Visitor<'de>>(self, count: usize, visitor: V) -> Result<V::Value, Failure> {
        self.deserialize_tuple(count, visitor)
    }

    fn struct_variant<V: Visitor<'de>>(self, fields: &'static [&'static str], visitor: V) -> Result<V::Value, Failure> {
        self.values(Steps::Fields(fields), visitor)
    }
}

#[cfg(test)]
mod tests {
    use omm_model::call::Call;
    use omm_model::vk;

    use super::*;
    use crate::codec;

    fn error<T: Deserialize<'static> + std::fmt::Debug>(bytes: &'static [u8]) -> String {
        value::<T>(bytes).unwrap_err().to_string()
    }

    /// A build with everything that may be there or not.
    fn build() -> Call {
        let attached = vk::TrianglesOpacityMicromap::default();
        let triangles = vk::GeometryTrianglesData { next: vec![attached.into()], ..Default::default() };
        let geometry = vk::Geometry { geometry: vk::GeometryData::Triangles(triangles), ..Default::default() };
        let info = vk::BuildGeometryInfo {
            ty: vk::AccelerationStructureType(i32::MIN),
            flags: vk::BuildAccelerationStructureFlags::from_bits_retain(!0),
            geometries: Some(vec![geometry]),
            scratch_data: vk::HostAddress(u64::MAX).into(),
            ..Default::default()
        };
        let command_buffer = vk::CommandBuffer(u64::MAX);
        Call::CmdBuildAccelerationStructures { command_buffer, infos: vec![info], build_range_infos: vec![None] }
    }

    #[test]
    fn bincode_reads_the_same() {
        let mut bytes = Vec::new();
        codec::push_value(&mut bytes, &build());
        assert_eq!(value::<Call>(&bytes).as_ref(), Ok(&build()));
        let configuration = bincode::config::standard().with_little_endian().with_fixed_int_encoding();
        let (call, taken): (Call, usize) = bincode::serde::decode_from_slice(&bytes, configuration).unwrap();
        assert_eq!((call, taken), (build(), bytes.len()));
    }

    #[test]
    fn numbers_keep_their_bits() {
        for bits in [0, 0x8000_0000, 1, 0x7f80_0000, 0x7fc0_0001, 0xffbf_ffff, 0x7f80_0001_u32] {
            let mut bytes = Vec::new();
            codec::push_value(&mut bytes, &f32::from_bits(bits));
            assert_eq!(bytes, bits.to_le_bytes());
            assert_eq!(value::<f32>(&bytes).map(f32::to_bits), Ok(bits));
        }
    }

    #[test]
    fn errors_name_the_place() {
        let found = error::<vk::DeviceOrHostAddress>(&[2, 0, 0, 0]);
        assert_eq!(found, "contents at byte 0: found 2, required at most 1");
        assert_eq!(error::<Option<u8>>(&[2]), "contents at byte 0: found 2, required at most 1");
        let found = error::<Vec<u8>>(&[9, 0, 0, 0, 0, 0, 0, 0, 1]);
        assert_eq!(found, "contents at byte 8: 9 bytes are needed, 1 are there");
        assert_eq!(error::<u8>(&[1, 2]), "length at byte 1: found 2, required 1");
        let found = error::<Vec<vk::BuildRangeInfo>>(&[1, 0, 0, 0, 0, 0, 0, 0, 7, 0, 0, 0, 1]);
        assert_eq!(found, "contents[0].primitive_offset at byte 12: 4 bytes are needed, 1 are there");
    }

    #[test]
    fn what_lies_in_itself_is_followed_to_a_limit() {
        let mut chain = vk::Chain::new();
        for _ in 0..40 {
            chain = vec![vk::MemoryAllocateFlagsInfo { next: chain, ..Default::default() }.into()];
        }
        let mut bytes = Vec::new();
        codec::push_value(&mut bytes, &chain);
        let error = value::<vk::Chain>(&bytes).unwrap_err();
        assert!(error.field.ends_with("[0].depth"), "{error}");
        assert_eq!(error.kind, ReadErrorKind::Above { found: 65, limit: 64 });
    }
}
