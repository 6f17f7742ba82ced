//! Rules on the index buffer of a micromap attached to triangles.

use omm_layout::index::IndexType;
use omm_layout::index_buffer::MicromapIndexBuffer;
use omm_model::memory::MemoryView;
use omm_model::special_index::TriangleMap;
use omm_model::vk;

use super::span;
use crate::context::OpacityMicromapContext;
use crate::report::Report;
use crate::rule::RuleId;
use crate::state::State;
use crate::violation::ViolationKind;

pub(super) fn check(
    attached: &OpacityMicromapContext<'_>,
    state: &State,
    memory: &dyn MemoryView,
    report: &mut Report,
) {
    let Some(indices) = Indices::read(attached, memory) else { return };
    index_11575(attached, &indices, state, report);
    special_index_11578(attached, &indices, report);
}

/// An index buffer that is there.
struct Indices<'m> {
    buffer: MicromapIndexBuffer<'m>,
    index_type: IndexType,
    /// The bytes of the indices, if nothing lies between them.
    packed: Option<&'m [u8]>,
}

impl<'m> Indices<'m> {
    /// The indices of the triangles that are built, if there is a buffer and it is readable.
    fn read(attached: &OpacityMicromapContext<'_>, memory: &'m dyn MemoryView) -> Option<Self> {
        let vk::TrianglesOpacityMicromap { index_type, index_buffer, index_stride: stride, .. } = *attached.attached;
        let index_type = IndexType::try_from(index_type).ok().filter(|found| *found != IndexType::None)?;
        let count = u64::from(attached.geometry.primitive_count?);
        // A stride of 0 gives every triangle the same index: one look is enough.
        let count = if stride == 0 { count.min(1) } else { count };
        let bytes = memory.read(index_buffer, span(count, stride, index_type.size().into())?).ok()?;
        // Indices are wanted as stored, so nothing is added to them.
        let buffer = MicromapIndexBuffer::new(bytes, index_type, stride, 0, count).ok()?;
        let packed = (stride == u64::from(index_type.size())).then_some(bytes);
        Some(Self { buffer, index_type, packed })
    }

    /// Whether there may be an index that is not special and is at least `least`; certain where indices are packed.
    fn may_have(&self, least: u32) -> bool {
        let is_wrong = |index: u32| (least..=self.index_type.max() - 4).contains(&index);
        match (self.packed, self.index_type) {
            (Some(bytes), IndexType::Uint8) => any(bytes.as_chunks::<1>().0, |[byte]| is_wrong((*byte).into())),
            (Some(bytes), IndexType::Uint16) => {
                any(bytes.as_chunks().0, |bytes| is_wrong(u16::from_le_bytes(*bytes).into()))
            }
            (Some(bytes), IndexType::Uint32) => any(bytes.as_chunks().0, |bytes| is_wrong(u32::from_le_bytes(*bytes))),
            (None, _) | (_, IndexType::None) => true,
        }
    }

    /// The first index that is not special and is at least `least`, with its place.
    fn first_from(&self, least: u64) -> Option<(usize, u32)> {
        // Nearly always there is none, and that is seen faster.
        if !self.may_have(u32::try_from(least).ok()?) {
            return None;
        }
        self.buffer.iter().enumerate().find_map(|(place, index)| match index {
            Ok(TriangleMap::Triangle(index)) if u64::from(index) >= least => Some((place, index)),
            _ => None,
        })
    }
}

/// Whether any index is wrong, asked of a block at a time so that its indices are looked at side by side.
fn any<const N: usize>(indices: &[[u8; N]], is_wrong: impl Fn(&[u8; N]) -> bool) -> bool {
    indices.chunks(256).any(|block| block.iter().fold(false, |wrong, index| wrong | is_wrong(index)))
}

/// Every index that is not special names a triangle of the micromap.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-indexBuffer-11575
fn index_11575(attached: &OpacityMicromapContext<'_>, indices: &Indices<'_>, state: &State, report: &mut Report) {
    if attached.attached.micromap.is_null() {
        return;
    }
    let Some(triangles) = attached.micromap_triangles(state) else { return };
    let base_triangle = u64::from(attached.attached.base_triangle);
    if let Some((place, index)) = indices.first_from(triangles.saturating_sub(base_triangle)) {
        let kind = ViolationKind::TriangleOutOfRange { index: index.into(), base_triangle, triangles };
        report.push(RuleId::Index11575, &attached.at.element("indexBuffer", place), kind);
    }
}

/// Without a micromap every index is special.
///
/// VUID-vkCmdBuildAccelerationStructuresKHR-indexBuffer-11578
fn special_index_11578(attached: &OpacityMicromapContext<'_>, indices: &Indices<'_>, report: &mut Report) {
    if !attached.attached.micromap.is_null() {
        return;
    }
    if let Some((place, found)) = indices.first_from(0) {
        let kind = ViolationKind::NotSpecialIndex { found, lowest: indices.index_type.max() - 3 };
        report.push(RuleId::SpecialIndex11578, &attached.at.element("indexBuffer", place), kind);
    }
}
