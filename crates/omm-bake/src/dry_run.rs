//! What a bake would make, without baking: sizes, levels and a prediction of the coverage.
//!
//! Sizes and levels are exact. Coverage is predicted from a coarse look at each triangle, at most at level [`LOOK`]. The
//! contour has a length, so each level halves the part of the microtriangles that it passes through, once they are as small as a
//! texel; before that, the part shrinks as it did from the last level to the one looked at.

use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;
use omm_model::triangle::MicromapTriangle;
use omm_model::usage::{self, MicromapUsage};
use rayon::prelude::*;

use crate::error::BakeError;
use crate::layers::Layers;
use crate::lowering::{Choice, Lowering, Profile};
use crate::merge::MAX_ARRAY_BYTES;
use crate::options::{BakeInput, BakeOptions};
use crate::packed;
use crate::patch::Patch;
use crate::promotion::UnknownStatePromotion;
use crate::schedule::{Job, Schedule, Source, WorkEstimate};

/// The level of the coarse look.
pub const LOOK: u32 = 3;

/// What a bake would make.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DryRun {
    /// How much work it would be.
    pub estimate: WorkEstimate,
    /// The level of each triangle of the mesh; none if it would be given up to meet the byte budget, as predicted.
    pub levels: Vec<Option<SubdivisionLevel>>,
    /// How many distinct triangles have each level and format: of these the data is predicted to be made, special indices left out.
    pub usage_counts: Vec<MicromapUsage>,
    /// Bytes of the array as predicted: what special indices replace is left out, but blocks of different triangles may turn out to be
    /// the same. With a byte budget it is met.
    pub array_bytes: u64,
    /// Triangles of the mesh that are predicted to get a special index.
    pub special_triangles: u64,
    /// The known part of the area that the mesh covers in the texture, 0..=1, as predicted.
    pub area_known_fraction: f64,
}

/// What the coarse look says of one job.
struct Look {
    /// A profile for each level, the coarsest first.
    profiles: Vec<Profile>,
    texels: f64,
}

/// What [`bake`](crate::bake()) would make with the same arguments.
///
/// # Errors
/// [`BakeError`], as from [`bake`](crate::bake()), for input that cannot be baked and for budgets that cannot be met.
pub fn dry_run(input: &BakeInput<'_>, options: &BakeOptions) -> Result<DryRun, BakeError> {
    let schedule = Schedule::new(input, options)?;
    let layers = Layers::new(&schedule, options)?;
    let looks = schedule.jobs.par_iter().map_init(Patch::new, |patch, job| look(&layers, job, options, patch));
    let looks: Vec<Look> = looks.collect();
    let mut lowering = Lowering::new(options);
    for (block, (job, Look { profiles, texels })) in schedule.jobs.iter().zip(looks).enumerate() {
        lowering.add(job.format, job.level, profiles);
        lowering.weigh(block, texels * f64::from(job.uses));
    }
    let limit = options.max_array_bytes.unwrap_or(u64::MAX).min(MAX_ARRAY_BYTES);
    // Beyond what offsets reach only a budget helps, and the bake may find enough that is the same.
    let array_bytes = match options.max_array_bytes {
        Some(_) => lowering.lower(limit)?,
        None => (0..schedule.jobs.len()).map(|block| lowering.bytes(block)).sum(),
    };
    Ok(predict(&schedule, options, &lowering, array_bytes))
}

/// Sums up what has become of all jobs.
fn predict(schedule: &Schedule<'_>, options: &BakeOptions, lowering: &Lowering<'_>, array_bytes: u64) -> DryRun {
    let level = |job: &u32| match lowering.choice(*job as usize) {
        Some(Choice::Level(level)) => Some(level),
        Some(Choice::GivenUp) | None => None,
    };
    let mut run = DryRun {
        estimate: schedule.estimate(options),
        levels: schedule.job_of.iter().map(level).collect(),
        array_bytes,
        ..DryRun::default()
    };
    let (mut triangles, mut texels, mut known) = (Vec::new(), 0.0, 0.0);
    for (number, job) in (0..).zip(&schedule.jobs) {
        let block = number as usize;
        let profile = lowering.profile(block);
        if profile.is_none_or(|profile| profile.is_special) {
            run.special_triangles += u64::from(job.uses);
        } else if let Some(subdivision_level) = level(&number) {
            triangles.push(MicromapTriangle { data_offset: 0, subdivision_level, format: job.format });
        }
        let weight = lowering.weight(block);
        texels += weight;
        // 2-state data knows everything; its profile says what it would lose.
        let is_two_state = job.format == OpacityMicromapFormat::TwoState && level(&number).is_some();
        known += weight * profile.map_or(0.0, |profile| if is_two_state { 1.0 } else { f64::from(profile.known) });
    }
    run.usage_counts = usage::histogram(triangles);
    run.area_known_fraction = if texels > 0.0 { known / texels } else { 0.0 };
    run
}

/// Looks at a job at a low level and predicts the others.
fn look(layers: &Layers<'_>, job: &Job, options: &BakeOptions, patch: &mut Patch) -> Look {
    const FORMAT: OpacityMicromapFormat = OpacityMicromapFormat::FourState;
    let levels = job.level.get() as usize + 1;
    if let Source::Uniform(state) = job.source {
        let known = if state.is_known() { 1.0 } else { 0.0 };
        return Look { profiles: vec![Profile { known, is_special: options.special_indices }; levels], texels: 0.0 };
    }
    // Low enough to be a level, whatever it is.
    let mut level = SubdivisionLevel::new(job.level.get().min(LOOK)).unwrap_or_default();
    let mut data = layers.bake(&Job { level, format: FORMAT, ..*job }, patch, &|_| {}).data;
    let special =
        options.special_indices && packed::count(&data, FORMAT, level).only_state().is_some_and(OpacityState::is_known);
    let mut unknown = Vec::with_capacity(levels);
    loop {
        unknown.push(1.0 - packed::count(&data, FORMAT, level).known_fraction());
        let Some(coarser) = level.coarser() else { break };
        data = packed::coarser(&data, FORMAT, level, UnknownStatePromotion::Nearest);
        level = coarser;
    }
    unknown.reverse();
    let texels = layers.triangle(job).map_or(0.0, |triangle| triangle.area());
    let shrinking = match unknown[..] {
        [.., before, last] if before > 0.0 => (last / before).clamp(0.5, 1.0),
        _ => 0.5,
    };
    while unknown.len() < levels {
        let is_texel = texels <= f64::from(1_u32 << (2 * (unknown.len() - 1)));
        let last = unknown.last().copied().unwrap_or_default();
        unknown.push(last * if is_texel { 0.5 } else { shrinking });
    }
    let two_state = job.format == OpacityMicromapFormat::TwoState;
    let profile = |unknown: f64| {
        let known = 1.0 - unknown as f32;
        let rejected = options.special_indices && !two_state && known < options.rejection_threshold;
        Profile { known: if rejected { 0.0 } else { known }, is_special: special || rejected }
    };
    Look { profiles: unknown.into_iter().map(profile).collect(), texels }
}
