//! What has to be done, found without looking at a texel: which triangles are the same, their levels, and how much work they are.

use std::collections::BTreeMap;
use std::hash::BuildHasher;

use hashbrown::{DefaultHashBuilder, HashTable};
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;

use crate::classify::cell_budget;
use crate::error::BakeError;
use crate::merge::MAX_ARRAY_BYTES;
use crate::options::{BakeInput, BakeOptions, TriangleOverride};
use crate::statistics::BakeStatistics;
use crate::texel_triangle::{TexelTriangle, TexelTriangleError};
use crate::texture::Texture;

/// The most triangles that an index buffer of 32-bit integers can number beside its special values.
const MAX_TRIANGLES: usize = i32::MAX as usize;

/// How much work a bake is, found without looking at the texture's texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WorkEstimate {
    /// Triangles that must be baked: without repeated ones if they are merged, and without those that cannot be baked.
    pub baked_triangles: u64,
    /// Their microtriangles, once for each mip that is read.
    pub microtriangles: u64,
    /// Texels that they cover, about, over all mips.
    pub texels: u64,
    /// Bytes of their data before special indices, merging and a budget make it less.
    pub array_bytes: u64,
}

impl WorkEstimate {
    /// Steps of work: each microtriangle has to be written, and each texel below has to be seen, at most once. Time is less where
    /// texels around a microtriangle are all alike.
    #[must_use]
    pub const fn work(&self) -> u64 {
        self.microtriangles.saturating_add(self.texels)
    }
}

/// What a job's data comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Source {
    /// The texture.
    Texels,
    /// Nothing: it has this state throughout.
    Uniform(OpacityState),
}

/// Something that must be baked, once.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Job {
    /// The first triangle of the mesh that it stands for.
    pub(crate) triangle: u32,
    /// Its texture coordinates.
    pub(crate) uvs: [[f32; 2]; 3],
    /// How many triangles of the mesh it stands for.
    pub(crate) uses: u32,
    pub(crate) level: SubdivisionLevel,
    pub(crate) format: OpacityMicromapFormat,
    pub(crate) source: Source,
}

/// Everything that is known before a texel is looked at.
#[derive(Debug)]
pub(crate) struct Schedule<'a> {
    /// The mips that are read, the finest first.
    pub(crate) mips: Vec<&'a Texture>,
    /// The job of each triangle of the mesh.
    pub(crate) job_of: Vec<u32>,
    pub(crate) jobs: Vec<Job>,
    pub(crate) not_finite: u64,
    pub(crate) out_of_range: u64,
    /// Triangles of the mesh that a byte budget lowered.
    pub(crate) lowered: u64,
    /// Jobs with texels.
    baked_triangles: u64,
    /// Texels that the jobs cover, about, over all mips.
    texels: u64,
}

/// The texture coordinates of the corners of a triangle.
pub(crate) fn corner_uvs(input: &BakeInput<'_>, triangle: usize) -> Result<[[f32; 2]; 3], BakeError> {
    let BakeInput { texture: _, uvs, triangles } = *input;
    let mut corner_uvs = [[0.0; 2]; 3];
    let corners = triangles.get(triangle).into_iter().flatten();
    for (corner, (uv, &found)) in corner_uvs.iter_mut().zip(corners).enumerate() {
        let missing = BakeError::IndexOutOfRange { triangle, corner, found, count: uvs.len() };
        *uv = *uvs.get(found as usize).ok_or(missing)?;
    }
    Ok(corner_uvs)
}

/// What is the same for triangles that are. Level and format follow from the coordinates and the override, so these say it.
#[derive(PartialEq)]
struct Key {
    uvs: [[u32; 2]; 3],
    own: TriangleOverride,
}

/// Finds triangles that are the same.
struct SameTriangles<'a> {
    options: &'a BakeOptions,
    hasher: DefaultHashBuilder,
    /// Jobs by the coordinates of their first triangle, of which the hash comes first.
    jobs: HashTable<(u64, u32)>,
}

impl SameTriangles<'_> {
    /// The hash of `key`, and the job of a triangle with it.
    fn find(&self, jobs: &[Job], key: &Key) -> (u64, Option<u32>) {
        let hash = self.hasher.hash_one(key.uvs);
        let same = |&(other, job): &(u64, u32)| {
            let Job { triangle, uvs, .. } = jobs[job as usize];
            other == hash && self.key(triangle as usize, uvs) == *key
        };
        (hash, self.jobs.find(hash, same).map(|&(_, job)| job))
    }

    fn insert(&mut self, hash: u64, job: u32) {
        self.jobs.insert_unique(hash, (hash, job), |&(hash, _)| hash);
    }

    fn key(&self, triangle: usize, uvs: [[f32; 2]; 3]) -> Key {
        // Both zeros are the same number.
        let bits = |uv: [f32; 2]| uv.map(|coordinate| (coordinate + 0.0).to_bits());
        Key { uvs: uvs.map(bits), own: self.options.override_of(triangle) }
    }
}

impl<'a> Schedule<'a> {
    pub(crate) fn new(input: &BakeInput<'a>, options: &BakeOptions) -> Result<Self, BakeError> {
        let triangles = input.triangles.len();
        options.check(triangles)?;
        if triangles > MAX_TRIANGLES {
            return Err(BakeError::TooManyTriangles { found: triangles, limit: MAX_TRIANGLES });
        }
        let mips = options.mips.of(input.texture)?;
        let job_of = Vec::with_capacity(triangles);
        let mut schedule = Self {
            mips,
            job_of,
            jobs: Vec::new(),
            not_finite: 0,
            out_of_range: 0,
            lowered: 0,
            baked_triangles: 0,
            texels: 0,
        };
        let mut known = SameTriangles { options, hasher: DefaultHashBuilder::default(), jobs: HashTable::new() };
        let mut unbakeable = BTreeMap::new();
        for triangle in 0..triangles {
            let uvs = corner_uvs(input, triangle)?;
            let mut hash = 0;
            if options.merge {
                let (of_key, same) = known.find(&schedule.jobs, &known.key(triangle, uvs));
                if let Some(job) = same {
                    schedule.jobs[job as usize].uses += 1;
                    schedule.job_of.push(job);
                    continue;
                }
                hash = of_key;
            }
            // There are no more jobs than triangles, and no more of these than i32::MAX.
            let mut job = schedule.jobs.len() as u32;
            let found = schedule.job(triangle, uvs, options);
            if options.merge && found.source != Source::Texels {
                job = *unbakeable.entry((found.level, found.format)).or_insert(job);
            }
            schedule.add(job, found);
            if options.merge && found.source == Source::Texels {
                known.insert(hash, job);
            }
        }
        schedule.check_size(options)?;
        Ok(schedule)
    }

    /// The next triangle has job `job`, which is `found` if it is new.
    fn add(&mut self, job: u32, found: Job) {
        match self.jobs.get_mut(job as usize) {
            Some(known) => known.uses += 1,
            None => self.jobs.push(found),
        }
        self.job_of.push(job);
    }

    /// The job of a triangle that is like none before.
    fn job(&mut self, triangle: usize, uvs: [[f32; 2]; 3], options: &BakeOptions) -> Job {
        let own = options.override_of(triangle);
        let texels = TexelTriangle::new(uvs, self.mips[0]);
        let level = own.level.unwrap_or_else(|| options.level.level(texels.as_ref().ok()));
        let source = match texels {
            Ok(texels) => {
                self.baked_triangles += 1;
                self.texels = self.texels.saturating_add(self.texels_of(&texels, level));
                Source::Texels
            }
            Err(error) => {
                *match error {
                    TexelTriangleError::NotFinite => &mut self.not_finite,
                    TexelTriangleError::OutOfRange => &mut self.out_of_range,
                } += 1;
                Source::Uniform(options.unbakeable.state())
            }
        };
        Job { triangle: triangle as u32, uvs, uses: 1, level, format: own.format.unwrap_or(options.format), source }
    }

    /// Texels that a triangle covers in all mips, no more than the classifier would look at.
    fn texels_of(&self, texels: &TexelTriangle, level: SubdivisionLevel) -> u64 {
        let count = |mip: &Texture| u64::from(mip.width()) * u64::from(mip.height());
        let [first, ..] = self.mips[..] else { return 0 };
        let in_mip = |mip: &&Texture| {
            let most = u64::from(level.microtriangles()) * cell_budget(mip);
            // Rounded up: a line, too, lies on some.
            ((texels.area() * count(mip) as f64 / count(first) as f64).ceil() as u64).min(most)
        };
        self.mips.iter().map(in_mip).sum()
    }

    /// Better to refuse now than after hours.
    fn check_size(&self, options: &BakeOptions) -> Result<(), BakeError> {
        let estimate = self.estimate(options);
        if let Some(limit) = options.max_work
            && estimate.work() > limit
        {
            return Err(BakeError::WorkBudget { estimate, limit });
        }
        // Without special indices, merging and a budget the size is known.
        let is_known = !options.merge && !options.special_indices && options.max_array_bytes.is_none();
        let required = self.most_bytes(options);
        if is_known && required > MAX_ARRAY_BYTES {
            return Err(BakeError::ArrayTooLarge { required, limit: MAX_ARRAY_BYTES });
        }
        Ok(())
    }

    /// No array is larger.
    pub(crate) fn most_bytes(&self, options: &BakeOptions) -> u64 {
        let has_data = |job: &&Job| job.source == Source::Texels || !options.special_indices;
        self.jobs.iter().filter(has_data).map(|job| padded_size(job.format, job.level, options)).sum()
    }

    /// The entry of each triangle of the mesh, from those of the jobs.
    pub(crate) fn indices(&self, entries: &[i32]) -> Vec<i32> {
        self.job_of.iter().map(|&job| entries[job as usize]).collect()
    }

    /// What only the schedule knows.
    pub(crate) fn facts(&self) -> BakeStatistics {
        let &Self { baked_triangles, not_finite, out_of_range, lowered, .. } = self;
        BakeStatistics { baked_triangles, not_finite, out_of_range, lowered, ..BakeStatistics::default() }
    }

    pub(crate) fn estimate(&self, options: &BakeOptions) -> WorkEstimate {
        let baked = || self.jobs.iter().filter(|job| job.source == Source::Texels);
        let mips = self.mips.len() as u64;
        WorkEstimate {
            baked_triangles: baked().count() as u64,
            microtriangles: baked().map(|job| mips * u64::from(job.level.microtriangles())).sum(),
            texels: self.texels,
            array_bytes: baked().map(|job| padded_size(job.format, job.level, options)).sum(),
        }
    }
}

/// Bytes that a block takes in the array, with what it takes to align the next.
pub(crate) fn padded_size(format: OpacityMicromapFormat, level: SubdivisionLevel, options: &BakeOptions) -> u64 {
    u64::from(format.data_size(level)).next_multiple_of(options.block_alignment.into())
}
