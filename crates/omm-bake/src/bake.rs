//! The whole way from triangles to an array, its triangles and an index buffer.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};

use omm_model::level::SubdivisionLevel;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::triangle::MicromapTriangle;
use omm_model::usage::{self, MicromapUsage};
use rayon::prelude::*;

use crate::block::{Block, BlockBaker};
use crate::error::BakeError;
use crate::level::LevelChoice;
use crate::merge::{ArrayBuilder, MAX_ARRAY_BYTES};
use crate::options::{BakeInput, BakeOptions};
use crate::patch::Patch;
use crate::planes::Planes;
use crate::statistics::BakeStatistics;
use crate::surface::Surface;
use crate::texel_triangle::{TexelTriangle, TexelTriangleError};

/// The most triangles that an index buffer of 32-bit integers can number beside its special values.
const MAX_TRIANGLES: usize = i32::MAX as usize;

/// Bytes of data that each thread bakes, at least a block, before blocks are added to the array.
const BYTES_PER_THREAD: usize = 1 << 16;

/// What a bake made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BakeOutput {
    /// The micromap's data: blocks without gaps, the finest level first, within a level by the first triangle of the mesh that
    /// uses them, those of triangles that cannot be baked last. As sizes of blocks are powers of 4, each from 4-state level 1 and 2-state level 2 on is aligned to its size.
    pub array: Vec<u8>,
    /// Where each block lies and how it is to be read: the micromap's triangle array.
    pub triangles: Vec<MicromapTriangle>,
    /// For each triangle of the mesh, the entry of the index buffer: an index into `triangles`, or a special index.
    pub indices: Vec<i32>,
    /// How many of `triangles` have each level and format, as a micromap build asks for it.
    pub usage_counts: Vec<MicromapUsage>,
    /// How many triangles of the mesh refer to a micromap triangle of each level and format, as the build of the geometry may ask
    /// for it. Special indices are not counted.
    pub index_usage_counts: Vec<MicromapUsage>,
    /// What was counted.
    pub statistics: BakeStatistics,
}

impl BakeOutput {
    /// What the index buffer says about each triangle of the mesh.
    pub fn triangle_maps(&self) -> impl ExactSizeIterator<Item = TriangleMap> + '_ {
        self.indices.iter().map(|&index| match OpacityMicromapSpecialIndex::from_value(index) {
            Some(special) => TriangleMap::SpecialIndex(special),
            // Other than special indices, none is negative.
            None => TriangleMap::Triangle(index.unsigned_abs()),
        })
    }
}

/// How far a bake is, in microtriangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Microtriangles that are decided.
    pub done: u64,
    /// Microtriangles of all triangles that must be baked.
    pub total: u64,
}

/// How much work a bake is, found without looking at the texture's texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WorkEstimate {
    /// Triangles that must be baked: without repeated ones if they are merged, and without those that cannot be baked.
    pub baked_triangles: u64,
    /// Their microtriangles.
    pub microtriangles: u64,
    /// Bytes of their data before special indices and merging make it less.
    pub array_bytes: u64,
}

/// What becomes of a triangle of the mesh.
enum Plan {
    /// It is job number so-and-so.
    Job(u32),
    /// It has no texture coordinates to bake from.
    Unbakeable(SubdivisionLevel),
}

/// A triangle that must be baked.
#[derive(Clone, Copy)]
struct Job {
    /// The first triangle of the mesh that it stands for.
    triangle: u32,
    /// How many triangles of the mesh it stands for.
    uses: u32,
    level: SubdivisionLevel,
}

/// Everything that is known before a texel is looked at.
struct Schedule {
    plans: Vec<Plan>,
    jobs: Vec<Job>,
    not_finite: u64,
    out_of_range: u64,
}

/// How much work [`bake`] will have with the same arguments.
///
/// # Errors
/// [`BakeError`], as from [`bake`], for input that cannot be baked.
pub fn estimate(input: &BakeInput<'_>, options: &BakeOptions) -> Result<WorkEstimate, BakeError> {
    let schedule = Schedule::new(input, options)?;
    Ok(schedule.estimate(options))
}

/// Bakes opacity micromaps for the triangles of `input`.
///
/// The result depends on the arguments alone, not on the number of threads: rayon's current pool is used. Beside the input and the
/// result, memory holds a few words for each triangle and about one block for each thread. `progress` is called from any
/// thread, now and then, in no order; to ignore it give `&|_| {}`.
///
/// # Errors
/// [`BakeError`] if an option or an index has no meaning, or if the data would be larger than offsets can reach.
pub fn bake(
    input: &BakeInput<'_>,
    options: &BakeOptions,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<BakeOutput, BakeError> {
    let schedule = Schedule::new(input, options)?;
    let surface = Surface::new(input.texture, options.sampler, options.alpha_cutoff)?;
    let total = schedule.estimate(options).microtriangles;
    let done = AtomicU64::new(0);
    let finished = |count: u64| {
        let done = done.fetch_add(count, Ordering::Relaxed).saturating_add(count);
        progress(Progress { done, total });
    };
    let planes = Planes::new(&surface);
    let baker = BlockBaker { surface: &surface, planes: &planes, format: options.format, promotion: options.promotion };
    let mut collector = Collector::new(options);

    let mut entries = vec![0; schedule.jobs.len()];
    // By level, the finest first, and within a level by first use: the order in which blocks lie in the array.
    let mut order: Vec<usize> = (0..schedule.jobs.len()).collect();
    order.sort_by_key(|&job| std::cmp::Reverse(schedule.jobs[job].level));
    let mut rest = order.as_slice();
    while let Some(&first) = rest.first() {
        let block_bytes = options.format.data_size(schedule.jobs[first].level) as usize;
        let batch = rayon::current_num_threads() * (BYTES_PER_THREAD / block_bytes).max(1);
        let (now, later) = rest.split_at(batch.min(rest.len()));
        let bake = |patch: &mut Patch, &job: &usize| {
            let Job { triangle, level, .. } = schedule.jobs[job];
            // Jobs are made of triangles for which both have been found to succeed.
            let uvs = corner_uvs(input, triangle as usize).unwrap_or_default();
            match TexelTriangle::new(uvs, input.texture) {
                Ok(triangle) => baker.bake(&triangle, level, patch, &finished),
                Err(_) => baker.uniform(options.unbakeable.state(), level),
            }
        };
        let blocks: Vec<Block> = now.par_iter().map_init(Patch::new, bake).collect();
        for (&job, block) in now.iter().zip(&blocks) {
            let Job { level, uses, .. } = schedule.jobs[job];
            entries[job] = collector.add(block, level, uses.into())?;
        }
        rest = later;
    }
    collector.finish(schedule, &entries, &baker)
}

/// The texture coordinates of the corners of a triangle.
fn corner_uvs(input: &BakeInput<'_>, triangle: usize) -> Result<[[f32; 2]; 3], BakeError> {
    let BakeInput { texture: _, uvs, triangles } = *input;
    let mut corner_uvs = [[0.0; 2]; 3];
    let corners = triangles.get(triangle).into_iter().flatten();
    for (corner, (uv, &found)) in corner_uvs.iter_mut().zip(corners).enumerate() {
        let missing = BakeError::IndexOutOfRange { triangle, corner, found, count: uvs.len() };
        *uv = *uvs.get(found as usize).ok_or(missing)?;
    }
    Ok(corner_uvs)
}

impl Schedule {
    fn new(input: &BakeInput<'_>, options: &BakeOptions) -> Result<Self, BakeError> {
        let BakeInput { texture, uvs: _, triangles } = *input;
        if let LevelChoice::Dynamic { scale, max: _ } = options.level
            && !(scale.is_finite() && scale > 0.0)
        {
            return Err(BakeError::DynamicScale { found: scale });
        }
        if triangles.len() > MAX_TRIANGLES {
            return Err(BakeError::TooManyTriangles { found: triangles.len(), limit: MAX_TRIANGLES });
        }
        let mut schedule = Self { plans: Vec::new(), jobs: Vec::new(), not_finite: 0, out_of_range: 0 };
        // The level follows from the coordinates, so these alone tell whether two triangles are the same.
        let mut jobs_by_uvs = HashMap::<_, u32>::with_capacity(if options.merge { triangles.len() } else { 0 });
        for triangle in 0..triangles.len() {
            let corner_uvs = corner_uvs(input, triangle)?;
            // Both zeros are the same number.
            let key = corner_uvs.map(|uv| uv.map(|coordinate| (coordinate + 0.0).to_bits()));
            if options.merge
                && let Some(&job) = jobs_by_uvs.get(&key)
            {
                schedule.plans.push(Plan::Job(job));
                schedule.jobs[job as usize].uses += 1;
                continue;
            }
            match TexelTriangle::new(corner_uvs, texture) {
                Ok(texels) => {
                    // There are no more jobs than triangles, and no more of these than i32::MAX.
                    let job = schedule.jobs.len() as u32;
                    let level = options.level.level(Some(&texels));
                    schedule.jobs.push(Job { triangle: triangle as u32, uses: 1, level });
                    schedule.plans.push(Plan::Job(job));
                    if options.merge {
                        jobs_by_uvs.insert(key, job);
                    }
                }
                Err(error) => {
                    *match error {
                        TexelTriangleError::NotFinite => &mut schedule.not_finite,
                        TexelTriangleError::OutOfRange => &mut schedule.out_of_range,
                    } += 1;
                    schedule.plans.push(Plan::Unbakeable(options.level.level(None)));
                }
            }
        }
        schedule.check_array_size(options)?;
        Ok(schedule)
    }

    /// Without special indices and merging the size is known: better to refuse now than after hours.
    fn check_array_size(&self, options: &BakeOptions) -> Result<(), BakeError> {
        let unbakeable = self.plans.iter().map(|plan| match plan {
            Plan::Job(_) => 0,
            Plan::Unbakeable(level) => options.format.data_size(*level).into(),
        });
        let required = self.estimate(options).array_bytes + unbakeable.sum::<u64>();
        if !options.merge && !options.special_indices && required > MAX_ARRAY_BYTES {
            return Err(BakeError::ArrayTooLarge { required, limit: MAX_ARRAY_BYTES });
        }
        Ok(())
    }

    fn estimate(&self, options: &BakeOptions) -> WorkEstimate {
        let sum = |of: &dyn Fn(SubdivisionLevel) -> u32| self.jobs.iter().map(|job| u64::from(of(job.level))).sum();
        WorkEstimate {
            baked_triangles: self.jobs.len() as u64,
            microtriangles: sum(&SubdivisionLevel::microtriangles),
            array_bytes: sum(&|level| options.format.data_size(level)),
        }
    }
}

/// Takes finished blocks in their final order.
struct Collector<'a> {
    options: &'a BakeOptions,
    array: ArrayBuilder,
    statistics: BakeStatistics,
}

impl<'a> Collector<'a> {
    fn new(options: &'a BakeOptions) -> Self {
        Self { options, array: ArrayBuilder::new(options.merge), statistics: BakeStatistics::default() }
    }

    /// The entry of the index buffer for a block that `uses` triangles of the mesh have.
    fn add(&mut self, block: &Block, level: SubdivisionLevel, uses: u64) -> Result<i32, BakeError> {
        let Block { data, tally } = block;
        self.statistics.triangle_states.add_all(tally.states, uses);
        self.statistics.undecided += tally.undecided * uses;
        if self.options.special_indices
            && let Some(state) = tally.states.only_state()
        {
            self.statistics.special_indices.add(state, uses);
            return Ok(OpacityMicromapSpecialIndex::of_state(state).value());
        }
        let (index, is_new) = self.array.add(level, self.options.format, data)?;
        if is_new {
            self.statistics.array_states.add_all(tally.states, 1);
        }
        // There are no more micromap triangles than triangles, of which there are at most i32::MAX.
        Ok(index as i32)
    }

    /// The entry of the index buffer for a triangle that cannot be baked.
    fn add_unbakeable(&mut self, level: SubdivisionLevel, baker: &BlockBaker<'_>) -> Result<i32, BakeError> {
        let special = self.options.unbakeable;
        if self.options.special_indices {
            self.statistics.triangle_states.add(special.state(), level.microtriangles().into());
            self.statistics.special_indices.add(special.state(), 1);
            return Ok(special.value());
        }
        self.add(&baker.uniform(special.state(), level), level, 1)
    }

    fn finish(mut self, schedule: Schedule, entries: &[i32], baker: &BlockBaker<'_>) -> Result<BakeOutput, BakeError> {
        let mut indices = Vec::with_capacity(schedule.plans.len());
        for plan in &schedule.plans {
            indices.push(match *plan {
                Plan::Job(job) => entries[job as usize],
                Plan::Unbakeable(level) => self.add_unbakeable(level, baker)?,
            });
        }
        let (array, triangles) = self.array.finish();
        let referred = indices.iter().filter_map(|&index| triangles.get(usize::try_from(index).ok()?)).copied();
        let statistics = BakeStatistics {
            triangles: schedule.plans.len() as u64,
            baked_triangles: schedule.jobs.len() as u64,
            micromap_triangles: triangles.len() as u64,
            known_fraction: self.statistics.triangle_states.known_fraction(),
            not_finite: schedule.not_finite,
            out_of_range: schedule.out_of_range,
            array_bytes: array.len() as u64,
            ..self.statistics
        };
        Ok(BakeOutput {
            usage_counts: usage::histogram(triangles.iter().copied()),
            index_usage_counts: usage::histogram(referred),
            array,
            triangles,
            indices,
            statistics,
        })
    }
}
