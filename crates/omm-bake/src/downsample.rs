//! Micromaps of lower levels from those that are baked already, without the texture.
//!
//! A microtriangle one level up is what its four children have in common, and unknown if they differ or one is unknown. That is what baking at
//! that level would say, too: a closed triangle is opaque exactly if its four quarters are. Only which of the two unknown
//! states it gets, and what 2-state data makes of it, is estimated from the children instead of from the texture.

use omm_model::level::SubdivisionLevel;
use omm_model::special_index::TriangleMap;

use crate::bake::BakeOutput;
use crate::block::{Block, Tally};
use crate::collect::Collector;
use crate::error::BakeError;
use crate::options::BakeOptions;
use crate::packed;
use crate::statistics::BakeStatistics;

/// `output` with each micromap triangle `levels` levels lower, at least at level 0.
///
/// Of `options` those count that say how blocks are stored: `promotion`, `special_indices`, `rejection_threshold`, `merge`, `merge_distance` and
/// `block_alignment`. [`Nearest`](crate::UnknownStatePromotion::Nearest) makes what differs opaque, or unknown opaque, if two
/// of the four children are. Array, triangles and indices may come from anywhere; counts of what a bake could not do are taken
/// over, and a triangle with a special index counts as one microtriangle.
///
/// # Errors
/// [`BakeError`] if an option has no meaning, or if a micromap triangle or an index lies beyond the array.
pub fn downsample(output: &BakeOutput, levels: u32, options: &BakeOptions) -> Result<BakeOutput, BakeError> {
    let options = &BakeOptions { overrides: Vec::new(), ..options.clone() };
    options.check(output.indices.len())?;
    let mut uses = vec![0_u64; output.triangles.len()];
    for (triangle, map) in output.triangle_maps().enumerate() {
        if let TriangleMap::Triangle(found) = map {
            let count = uses.len();
            *uses.get_mut(found as usize).ok_or(BakeError::IndexBeyond { triangle, found, count })? += 1;
        }
    }
    let mut collector = Collector::new(options);
    let mut entries = Vec::with_capacity(output.triangles.len());
    for (number, (&triangle, &uses)) in output.triangles.iter().zip(&uses).enumerate() {
        let range = triangle.data_range();
        let (end, available) = (range.end, output.array.len() as u64);
        let data = output.array.get(range.start as usize..range.end as usize);
        let data = data.ok_or(BakeError::BlockBeyond { number, end, available })?;
        let mut level = triangle.subdivision_level;
        let mut data = data.to_vec();
        for _ in 0..levels.min(level.get()) {
            data = packed::coarser(&data, triangle.format, level, options.promotion);
            level = level.coarser().unwrap_or(SubdivisionLevel::ZERO);
        }
        let states = packed::count(&data, triangle.format, level);
        let block = Block { data, tally: Tally { states, undecided: 0 } };
        entries.push(collector.add(&block, level, triangle.format, uses)?);
    }
    let mut indices = Vec::with_capacity(output.indices.len());
    for map in output.triangle_maps() {
        indices.push(match map {
            TriangleMap::SpecialIndex(special) => {
                collector.add_special(special);
                special.value()
            }
            // Checked above.
            TriangleMap::Triangle(index) => entries[index as usize],
        });
    }
    let BakeStatistics { baked_triangles, not_finite, out_of_range, undecided, .. } = output.statistics;
    let facts = BakeStatistics { baked_triangles, not_finite, out_of_range, undecided, ..BakeStatistics::default() };
    Ok(collector.finish(indices, facts))
}
