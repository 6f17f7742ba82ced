//! Takes finished blocks in their final order, and counts.

use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::special_index::OpacityMicromapSpecialIndex;
use omm_model::triangle::MicromapTriangle;
use omm_model::usage;
use rayon::prelude::*;

use crate::bake::BakeOutput;
use crate::block::{Block, Tally};
use crate::error::BakeError;
use crate::merge::ArrayBuilder;
use crate::near::merge_near;
use crate::options::BakeOptions;
use crate::packed;
use crate::statistics::{BakeStatistics, StateCounts};

/// Takes finished blocks in their final order.
#[derive(Debug)]
pub(crate) struct Collector<'a> {
    options: &'a BakeOptions,
    array: ArrayBuilder,
    statistics: BakeStatistics,
}

impl<'a> Collector<'a> {
    pub(crate) fn new(options: &'a BakeOptions) -> Self {
        let array = ArrayBuilder::new(options.merge, options.block_alignment);
        Self { options, array, statistics: BakeStatistics::default() }
    }

    /// Bytes of the array so far.
    pub(crate) fn array_bytes(&self) -> u64 {
        self.array.len()
    }

    /// The entry of the index buffer for a block that `uses` triangles of the mesh have.
    pub(crate) fn add(
        &mut self,
        block: &Block,
        level: SubdivisionLevel,
        format: OpacityMicromapFormat,
        uses: u64,
    ) -> Result<i32, BakeError> {
        let Block { data, tally: Tally { states, undecided } } = block;
        self.statistics.undecided += undecided * uses;
        if let Some(special) = self.options.replaces(*states) {
            self.statistics.rejected += if states.only_state().is_none() { uses } else { 0 };
            self.statistics.special_indices.add(special.state(), uses);
            self.statistics.triangle_states.add(special.state(), states.total() * uses);
            return Ok(special.value());
        }
        // There are no more micromap triangles than triangles, of which there are at most i32::MAX.
        Ok(self.array.add(level, format, data)? as i32)
    }

    /// One triangle of the mesh has a special index from the start; it counts as one microtriangle.
    pub(crate) fn add_special(&mut self, special: OpacityMicromapSpecialIndex) {
        self.statistics.special_indices.add(special.state(), 1);
        self.statistics.triangle_states.add(special.state(), 1);
    }

    /// Everything that was collected, for a mesh with these entries. `facts` are counts that the collector cannot know.
    pub(crate) fn finish(self, mut indices: Vec<i32>, facts: BakeStatistics) -> BakeOutput {
        let Self { options, array, statistics: BakeStatistics { undecided, rejected, special_indices, .. } } = self;
        let mut triangle_states = self.statistics.triangle_states;
        let (mut array, mut triangles) = array.finish();
        let before = triangles.len();
        let merged = merge_near(&mut array, &mut triangles, options);
        let mut uses = vec![0_u32; triangles.len()];
        for index in &mut indices {
            // What is negative is a special index.
            if let Ok(old) = usize::try_from(*index) {
                let new = merged.get(old).copied().unwrap_or(old as u32);
                *index = new as i32;
                if let Some(uses) = uses.get_mut(new as usize) {
                    *uses += 1;
                }
            }
        }
        let counted = |[mut in_array, mut in_mesh]: [StateCounts; 2], (triangle, uses): (&MicromapTriangle, &u32)| {
            let data = array.get(triangle.data_offset as usize..).unwrap_or_default();
            let data = data.get(..triangle.data_size() as usize).unwrap_or_default();
            let states = packed::count(data, triangle.format, triangle.subdivision_level);
            in_array.add_all(states, 1);
            in_mesh.add_all(states, (*uses).into());
            [in_array, in_mesh]
        };
        // Sums of whole numbers, the same in any order.
        let parts = triangles.par_iter().zip(&uses).fold(Default::default, counted);
        let both: Vec<[StateCounts; 2]> = parts.collect();
        let mut array_states = StateCounts::default();
        for [in_array, in_mesh] in both {
            array_states.add_all(in_array, 1);
            triangle_states.add_all(in_mesh, 1);
        }
        let referred = indices.iter().filter_map(|&index| triangles.get(usize::try_from(index).ok()?)).copied();
        let statistics = BakeStatistics {
            triangles: indices.len() as u64,
            micromap_triangles: triangles.len() as u64,
            array_states,
            known_fraction: triangle_states.known_fraction(),
            triangle_states,
            special_indices,
            rejected,
            undecided: facts.undecided + undecided,
            near_merged: (before - triangles.len()) as u64,
            array_bytes: array.len() as u64,
            ..facts
        };
        BakeOutput {
            usage_counts: usage::histogram(triangles.iter().copied()),
            index_usage_counts: usage::histogram(referred),
            array,
            triangles,
            indices,
            statistics,
        }
    }
}
