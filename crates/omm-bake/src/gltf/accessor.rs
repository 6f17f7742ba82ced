//! Accessors: typed arrays in buffers, with every range checked before it is read.

use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;

use super::container::{Container, slice};
use super::error::{GltfError, GltfErrorKind};

/// An accessor's elements, packed without gaps, and how they are to be read.
pub(super) struct Elements {
    bytes: Vec<u8>,
    pub(super) count: usize,
    component: ComponentType,
    components: Type,
    normalized: bool,
}

impl Elements {
    /// The elements of accessor `index`; `at` is the place that names it.
    ///
    /// No element is held before the data that backs it was found: a count is a claim.
    pub(super) fn read(container: &Container, index: usize, at: &str) -> Result<Self, GltfError> {
        let accessor = container.item(&container.root.accessors, index, at)?;
        let at = format!("accessors[{index}]");
        let value = |field: &str| container.error(format!("{at}.{field}"), GltfErrorKind::Value);
        let Checked::Valid(component) = accessor.component_type else { return Err(value("componentType")) };
        let Checked::Valid(components) = accessor.type_ else { return Err(value("type")) };
        let component = component.0;
        let size = component.size() * components.multiplicity();
        let bytes = base(container, accessor, size, &at)?;
        let count = bytes.len() / size;
        let mut elements = Self { bytes, count, component, components, normalized: accessor.normalized };
        if accessor.sparse.is_some() {
            elements.displace(container, accessor, size, &at)?;
        }
        Ok(elements)
    }

    /// Replaces the elements that a sparse accessor lists.
    fn displace(&mut self, container: &Container, accessor: &Accessor, size: usize, at: &str) -> Result<(), GltfError> {
        let Some(sparse) = &accessor.sparse else { return Ok(()) };
        let at = format!("{at}.sparse");
        let Checked::Valid(component) = sparse.indices.component_type else {
            return Err(container.error(format!("{at}.indices.componentType"), GltfErrorKind::Value));
        };
        let index_size = component.0.size();
        let part = |field: &str, view: usize, offset: u64, size: usize| {
            let at = format!("{at}.{field}");
            let (bytes, _) = container.view(view, &format!("{at}.bufferView"))?;
            let length = sparse.count.0.saturating_mul(size as u64);
            slice(bytes, offset, length, "buffer view").map_err(|kind| container.error(at, kind))
        };
        let (indices, values) = (&sparse.indices, &sparse.values);
        let indices = part("indices", indices.buffer_view.value(), indices.byte_offset.0, index_size)?;
        let values = part("values", values.buffer_view.value(), values.byte_offset.0, size)?;
        for (position, (index, value)) in indices.chunks_exact(index_size).zip(values.chunks_exact(size)).enumerate() {
            let index = unsigned(component.0, index);
            let slot =
                (index as usize).checked_mul(size).and_then(|start| self.bytes.get_mut(start..)?.get_mut(..size));
            let Some(slot) = slot else {
                let kind = GltfErrorKind::Index { index: index as usize, count: self.count };
                return Err(container.error(format!("{at}.indices[{position}]"), kind));
            };
            slot.copy_from_slice(value);
        }
        Ok(())
    }

    /// The kind of the elements, for people.
    fn kind(&self) -> String {
        let normalized = if self.normalized { "normalized " } else { "" };
        format!("{:?} {normalized}{:?}", self.components, self.component)
    }

    /// The elements as pairs of floats, if they are pairs and their type is one for coordinates.
    ///
    /// Integers that are not normalized count as they are (`KHR_mesh_quantization`).
    pub(super) fn pairs(&self) -> Result<Vec<[f32; 2]>, GltfErrorKind> {
        self.coordinates(Type::Vec2, "VEC2 of F32 or of 8-bit or 16-bit integers")
    }

    /// The elements as triples of floats, likewise.
    pub(super) fn triples(&self) -> Result<Vec<[f32; 3]>, GltfErrorKind> {
        self.coordinates(Type::Vec3, "VEC3 of F32 or of 8-bit or 16-bit integers")
    }

    fn coordinates<const N: usize>(
        &self,
        components: Type,
        required: &'static str,
    ) -> Result<Vec<[f32; N]>, GltfErrorKind> {
        if self.components != components || self.component == ComponentType::U32 {
            return Err(GltfErrorKind::AccessorType { found: self.kind(), required });
        }
        let size = self.component.size();
        let float = |bytes: &[u8]| float(self.component, self.normalized, bytes);
        let element =
            |bytes: &[u8]| std::array::from_fn(|at| float(bytes.get(at * size..(at + 1) * size).unwrap_or_default()));
        Ok(self.bytes.chunks_exact(N * size).map(element).collect())
    }

    /// The elements as vertex indices.
    pub(super) fn indices(&self) -> Result<Vec<u32>, GltfErrorKind> {
        let unsigned_type = matches!(self.component, ComponentType::U8 | ComponentType::U16 | ComponentType::U32);
        if self.components != Type::Scalar || !unsigned_type || self.normalized {
            return Err(GltfErrorKind::AccessorType { found: self.kind(), required: "SCALAR of U8, U16 or U32" });
        }
        let size = self.component.size();
        Ok(self.bytes.chunks_exact(size).map(|bytes| unsigned(self.component, bytes)).collect())
    }

    /// The first element whose alpha is not 1, if the elements are colours with alpha, and that alpha.
    pub(super) fn first_alpha(&self) -> Result<Option<(usize, f32)>, GltfErrorKind> {
        let known = matches!(self.component, ComponentType::F32)
            || (self.normalized && matches!(self.component, ComponentType::U8 | ComponentType::U16));
        match self.components {
            Type::Vec3 if known => Ok(None),
            Type::Vec4 if known => {
                let size = self.component.size();
                let alpha = |element: &[u8]| {
                    float(self.component, self.normalized, element.get(3 * size..).unwrap_or_default())
                };
                let mut alphas = self.bytes.chunks_exact(4 * size).map(alpha).enumerate();
                Ok(alphas.find(|&(_, alpha)| alpha != 1.0))
            }
            _ => {
                let required = "VEC3 or VEC4 of F32 or normalized U8 or U16";
                Err(GltfErrorKind::AccessorType { found: self.kind(), required })
            }
        }
    }
}

/// The elements before sparse ones replace some: those of the buffer view, or zeros.
fn base(container: &Container, accessor: &Accessor, size: usize, at: &str) -> Result<Vec<u8>, GltfError> {
    let count = accessor.count.0;
    let Some(view) = accessor.buffer_view else {
        // Zeros without data. A mesh whose zeros outnumber all bytes of the input is none that anybody made.
        if count > container.total_bytes {
            return Err(container.error(format!("{at}.count"), GltfErrorKind::Unbacked { count }));
        }
        return Ok(vec![0; usize::try_from(count).unwrap_or_default().saturating_mul(size)]);
    };
    let (bytes, stride) = container.view(view.value(), &format!("{at}.bufferView"))?;
    let stride = stride.unwrap_or(size);
    if stride < size {
        return Err(container.error(format!("bufferViews[{}].byteStride", view.value()), GltfErrorKind::Value));
    }
    // The last element need not be followed by the rest of a stride.
    let length = match count.checked_sub(1) {
        Some(gaps) => gaps.saturating_mul(stride as u64).saturating_add(size as u64),
        None => 0,
    };
    let start = accessor.byte_offset.unwrap_or_default().0;
    let bytes = slice(bytes, start, length, "buffer view").map_err(|kind| container.error(at, kind))?;
    Ok(bytes.chunks(stride).filter_map(|element| element.get(..size)).flatten().copied().collect())
}

/// An unsigned integer of the given type; 0 if the bytes are not as many as it has.
fn unsigned(component: ComponentType, bytes: &[u8]) -> u32 {
    match (component, bytes) {
        (ComponentType::U8, &[a]) => a.into(),
        (ComponentType::U16, &[a, b]) => u16::from_le_bytes([a, b]).into(),
        (ComponentType::U32, &[a, b, c, d]) => u32::from_le_bytes([a, b, c, d]),
        _ => 0,
    }
}

/// A component as a float, as glTF converts it; 0 if the bytes are not as many as the type has.
fn float(component: ComponentType, normalized: bool, bytes: &[u8]) -> f32 {
    let (value, one) = match (component, bytes) {
        (ComponentType::F32, &[a, b, c, d]) => return f32::from_le_bytes([a, b, c, d]),
        (ComponentType::U8, &[a]) => (f32::from(a), 255.0),
        (ComponentType::I8, &[a]) => (f32::from(a.cast_signed()), 127.0),
        (ComponentType::U16, &[a, b]) => (f32::from(u16::from_le_bytes([a, b])), 65_535.0),
        (ComponentType::I16, &[a, b]) => (f32::from(i16::from_le_bytes([a, b])), 32_767.0),
        _ => return 0.0,
    };
    // The least signed value lies beyond -1 and counts as -1.
    if normalized { (value / one).max(-1.0) } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_become_floats() {
        use ComponentType::{F32, I8, I16, U8, U16, U32};
        assert_eq!(float(U8, true, &[255]), 1.0);
        assert_eq!(float(U8, true, &[51]), 0.2);
        assert_eq!(float(U8, false, &[51]), 51.0);
        assert_eq!(float(I8, true, &[0x80]), -1.0);
        assert_eq!(float(U16, true, &[0xff, 0xff]), 1.0);
        assert_eq!(float(I16, true, &[0x01, 0x80]), -1.0);
        assert_eq!(float(F32, false, &1.5_f32.to_le_bytes()), 1.5);
        assert_eq!(unsigned(U16, &[1, 2]), 0x201);
        assert_eq!(unsigned(U32, &[1, 2, 3, 4]), 0x0403_0201);
    }
}
