//! The whole way from triangles to an array, its triangles and an index buffer.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use omm_layout::index::IndexType;
use omm_layout::index_buffer;
use omm_model::special_index::{OpacityMicromapSpecialIndex, TriangleMap};
use omm_model::triangle::MicromapTriangle;
use omm_model::usage::MicromapUsage;
use rayon::prelude::*;

use crate::block::Block;
use crate::budget::Budget;
use crate::collect::Collector;
use crate::error::BakeError;
use crate::layers::Layers;
use crate::options::{BakeInput, BakeOptions};
use crate::patch::Patch;
use crate::schedule::{Job, Schedule};
use crate::statistics::BakeStatistics;

pub use crate::schedule::WorkEstimate;

/// Bytes of data that each thread bakes, at least a block, while those before it are added to the array.
const BYTES_PER_THREAD: usize = 1 << 18;

/// What a bake made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BakeOutput {
    /// The micromap's data: the finest level first, 4-state before 2-state within a level, and blocks of both in the order that
    /// [`BakeOptions::order`] chooses. As sizes of blocks are powers of 2 that never grow, each is aligned to its size; gaps are only where
    /// [`BakeOptions::block_alignment`] asks for more.
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
            // A negative one that is not special is larger than any count, and so lies beyond the triangles.
            None => TriangleMap::Triangle(index.cast_unsigned()),
        })
    }

    /// The index buffer in the first of `types` that can hold it, and that type: the smallest of 8, 16 and 32 bits for
    /// `&[IndexType::Uint8, IndexType::Uint16, IndexType::Uint32]`, a forced one for a list of one.
    ///
    /// A type's four largest values are special indices, so 8 bits number 252 micromap triangles.
    ///
    /// # Errors
    /// [`BakeError::IndexType`] if none of them can hold the indices.
    pub fn index_buffer(&self, types: &[IndexType]) -> Result<(IndexType, Vec<u8>), BakeError> {
        let maps: Vec<TriangleMap> = self.triangle_maps().collect();
        let fitting = index_buffer::fitting_type(&maps, 0, types);
        let bytes = |ty| index_buffer::write(&maps, ty, 0).ok().map(|bytes| (ty, bytes));
        fitting.and_then(bytes).ok_or(BakeError::IndexType { micromap_triangles: self.triangles.len() })
    }
}

/// How far a bake is, in microtriangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Microtriangles that are decided, at all mips.
    pub done: u64,
    /// Microtriangles of all triangles that must be baked, at all mips. It changes once if a byte budget makes a second pass necessary.
    pub total: u64,
}

/// What a progress callback may answer: nothing, or whether to go on.
pub trait ProgressAnswer {
    /// [`ControlFlow::Break`] to cancel the bake.
    fn flow(self) -> ControlFlow<()>;
}

impl ProgressAnswer for () {
    fn flow(self) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

impl ProgressAnswer for ControlFlow<()> {
    fn flow(self) -> ControlFlow<()> {
        self
    }
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
/// result, memory holds a bit for each texel, a few words for each triangle, and for each thread about two blocks or half a megabyte.
/// `progress` is called from any thread, now and then, in no order; to ignore it give `&|_| {}`. If it answers
/// [`ControlFlow::Break`], no further triangle is begun.
///
/// # Errors
/// [`BakeError`] if an option or an index has no meaning, if a budget cannot be met, if the data would be larger than offsets can
/// reach, or if `progress` cancelled the bake.
pub fn bake<A: ProgressAnswer>(
    input: &BakeInput<'_>,
    options: &BakeOptions,
    progress: &(dyn Fn(Progress) -> A + Sync),
) -> Result<BakeOutput, BakeError> {
    let mut schedule = Schedule::new(input, options)?;
    let layers = Layers::new(&schedule, options)?;
    let estimate = schedule.estimate(options);
    let watch = Watch::new(progress, estimate.microtriangles);
    let over_budget = options.max_array_bytes.filter(|&limit| schedule.most_bytes(options) > limit);
    let Some(limit) = over_budget else { return collect(&schedule, &layers, options, &watch) };

    let mut budget = Budget::new(schedule.jobs.len(), options, limit);
    let baked = |job: usize, block: &Block| budget.measure(&schedule, &layers, job, block);
    for_each_block(&schedule, &layers, options, &watch, baked)?;
    if let Some(output) = budget.fit(&mut schedule)? {
        return Ok(output);
    }
    watch.total.fetch_add(schedule.estimate(options).microtriangles, Ordering::Relaxed);
    let output = collect(&schedule, &layers, options, &watch)?;
    // Only if blocks that were taken to be the same are not.
    let least = output.statistics.array_bytes;
    if least > limit { Err(BakeError::ArrayBudget { least, limit }) } else { Ok(output) }
}

/// Bakes all jobs and puts them together.
fn collect<A: ProgressAnswer>(
    schedule: &Schedule<'_>,
    layers: &Layers<'_>,
    options: &BakeOptions,
    watch: &Watch<'_, A>,
) -> Result<BakeOutput, BakeError> {
    let mut collector = Collector::new(options);
    let mut entries = vec![0; schedule.jobs.len()];
    for_each_block(schedule, layers, options, watch, |job, block| {
        let Job { level, format, uses, .. } = schedule.jobs[job];
        entries[job] = collector.add(block, level, format, uses.into())?;
        Ok(())
    })?;
    Ok(collector.finish(schedule.indices(&entries), schedule.facts()))
}

/// Gives `baked` every job's block, in the order in which they are to lie in the array.
fn for_each_block<A: ProgressAnswer>(
    schedule: &Schedule<'_>,
    layers: &Layers<'_>,
    options: &BakeOptions,
    watch: &Watch<'_, A>,
    mut baked: impl FnMut(usize, &Block) -> Result<(), BakeError> + Send,
) -> Result<(), BakeError> {
    let key = |(number, job): (u32, &Job)| (options.order.key(job, schedule.mips[0], options.sampler), number);
    let mut order: Vec<(u64, u32)> = (0..).zip(&schedule.jobs).map(key).collect();
    order.sort_unstable();
    let finished = |count| watch.advance(count);
    // While one batch is baked the one before it is taken, so that no thread waits for that.
    let mut rest = order.as_slice();
    let (mut before, mut blocks) = (rest.get(..0).unwrap_or_default(), Vec::new());
    while !rest.is_empty() || !before.is_empty() {
        let batch = rest.first().map_or(0, |&(_, first)| {
            let Job { level, format, .. } = schedule.jobs[first as usize];
            rayon::current_num_threads() * (BYTES_PER_THREAD / format.data_size(level) as usize).max(1)
        });
        let (now, later) = rest.split_at(batch.min(rest.len()));
        let bake = |patch: &mut Patch, &(_, job): &(u64, u32)| {
            if watch.is_cancelled() {
                return Block::default();
            }
            layers.bake(&schedule.jobs[job as usize], patch, &finished)
        };
        let take = || before.iter().zip(&blocks).try_for_each(|(&(_, job), block)| baked(job as usize, block));
        let (baked_now, taken) = rayon::join(|| now.par_iter().map_init(Patch::new, bake).collect(), take);
        taken?;
        if watch.is_cancelled() {
            return Err(BakeError::Cancelled);
        }
        (before, blocks, rest) = (now, baked_now, later);
    }
    Ok(())
}

/// Counts what is done, and listens whether to go on.
struct Watch<'a, A> {
    progress: &'a (dyn Fn(Progress) -> A + Sync),
    done: AtomicU64,
    total: AtomicU64,
    cancelled: AtomicBool,
}

impl<'a, A: ProgressAnswer> Watch<'a, A> {
    fn new(progress: &'a (dyn Fn(Progress) -> A + Sync), total: u64) -> Self {
        Self { progress, done: AtomicU64::new(0), total: AtomicU64::new(total), cancelled: AtomicBool::new(false) }
    }

    fn advance(&self, count: u64) {
        let before = self.done.fetch_add(count, Ordering::Relaxed);
        let (done, total) = (before.saturating_add(count), self.total.load(Ordering::Relaxed));
        // Who shows it may need a lock: some thousand times are enough.
        let step = total / 4096 + 1;
        if before / step == done / step && done != total {
            return;
        }
        if (self.progress)(Progress { done, total }).flow().is_break() {
            self.cancelled.store(true, Ordering::Relaxed);
        }
    }

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}
