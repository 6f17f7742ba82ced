//! Blocks that are almost the same become one: what differs becomes unknown.
//!
//! Two microtriangles differ unless both are transparent, both opaque, or both unknown on whatever side. Blocks of the same level
//! are merged only if the result leaves no more than *d* microtriangles unknown that either of them knew, and that holds for everything
//! that is merged into the same block later. So no triangle of the mesh loses more than *d*, and as states only ever become
//! unknown nothing becomes wrong.
//!
//! # How candidates are found
//!
//! Comparing all pairs would be quadratic. Instead a block's bytes are dealt out to up to [`MOST_BANDS`] bands, and blocks are
//! compared only if they agree on all of a band. Blocks that differ in fewer microtriangles than there are bands agree on
//! one, whichever it is; others may. In each band blocks are sorted by a hash of it, and each is compared with the
//! [`MOST_LEADERS`] first of those that share it: n log n steps for n blocks. The order is that of the array, so the
//! result does not depend on anything but the blocks.

use omm_model::format::OpacityMicromapFormat;
use omm_model::triangle::MicromapTriangle;

use crate::options::BakeOptions;

/// No block is cut into more bands.
const MOST_BANDS: usize = 16;

/// Blocks that a block is compared with in one band.
const MOST_LEADERS: usize = 8;

/// Merges blocks of 4-state data in place. The result has the new index of each micromap triangle; it is empty if nothing changed.
pub(crate) fn merge_near(
    array: &mut Vec<u8>,
    triangles: &mut Vec<MicromapTriangle>,
    options: &BakeOptions,
) -> Vec<u32> {
    let distance = options.merge_distance;
    if distance <= 0.0 {
        return Vec::new();
    }
    // Each block's leader. There are no more than 2^32 blocks.
    let mut leaders: Vec<u32> = (0..triangles.len() as u32).collect();
    let mut rest = triangles.as_slice();
    let mut first = 0;
    while let Some(&MicromapTriangle { subdivision_level: level, format, .. }) = rest.first() {
        let same = |triangle: &MicromapTriangle| (triangle.subdivision_level, triangle.format) == (level, format);
        let count = rest.iter().take_while(|triangle| same(triangle)).count();
        let (now, later) = rest.split_at(count);
        let allowed = (f64::from(distance) * f64::from(level.microtriangles())).floor() as u32;
        if format == OpacityMicromapFormat::FourState && allowed > 0 {
            let mut group = Group { array, triangles: now, allowed, worst: vec![0; count], led: vec![false; count] };
            for (leader, new) in leaders.iter_mut().skip(first).zip(group.merge()) {
                *leader = first as u32 + new;
            }
        }
        first += count;
        rest = later;
    }
    compact(array, triangles, &leaders, options.block_alignment)
}

/// Blocks of one level.
struct Group<'a> {
    array: &'a mut [u8],
    triangles: &'a [MicromapTriangle],
    /// Microtriangles that a block may lose.
    allowed: u32,
    /// The most that a block has lost to which it is merged, or that was merged to it.
    worst: Vec<u32>,
    /// Whether others were merged to it.
    led: Vec<bool>,
}

impl Group<'_> {
    /// The leader of each block.
    fn merge(&mut self) -> Vec<u32> {
        let mut leaders: Vec<u32> = (0..self.triangles.len() as u32).collect();
        let size = self.triangles.first().map_or(0, |triangle| triangle.data_size() as usize);
        // Fewer differences than bands cannot spoil them all.
        let bands = MOST_BANDS.min(self.allowed as usize + 1).min(size);
        let unit = [8, 4, 2].into_iter().find(|unit| size >= 2 * unit * bands).unwrap_or(1);
        let mut by_hash: Vec<(u64, u32)> = Vec::new();
        for band in 0..bands {
            let alive = (0..leaders.len() as u32).filter(|&block| leaders[block as usize] == block);
            by_hash.clear();
            by_hash.extend(alive.map(|block| (self.band_hash(block, band, bands, unit), block)));
            by_hash.sort_unstable();
            for same in by_hash.chunk_by(|a, b| a.0 == b.0) {
                let mut candidates: Vec<u32> = Vec::new();
                for &(_, block) in same {
                    let is_free = !self.led[block as usize];
                    let leader = candidates.iter().find(|&&leader| is_free && self.join(leader, block));
                    match leader {
                        Some(&leader) => leaders[block as usize] = leader,
                        None if candidates.len() < MOST_LEADERS => candidates.push(block),
                        None => {}
                    }
                }
            }
        }
        leaders
    }

    fn data(&self, block: u32) -> &[u8] {
        let range = self.triangles.get(block as usize).map(|triangle| triangle.data_range()).unwrap_or_default();
        self.array.get(range.start as usize..range.end as usize).unwrap_or_default()
    }

    /// A hash of the units of a block whose number is `band` by the modulus `bands`; unknown states are one.
    fn band_hash(&self, block: u32, band: usize, bands: usize, unit: usize) -> u64 {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        for bytes in self.data(block).chunks(unit).skip(band).step_by(bands) {
            let word = bytes.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte));
            let known = word & !((word & UNKNOWN) >> 1);
            // The middle bits of a product depend on all bits of the factors below.
            hash = (hash ^ known).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            hash ^= hash >> 32;
        }
        hash
    }

    /// Merges `block` into `leader` if neither, nor what the leader stands for, loses too much.
    fn join(&mut self, leader: u32, block: u32) -> bool {
        let (mut leader_loses, mut block_loses) = (self.worst[leader as usize], 0);
        for (a, b) in words(self.data(leader)).zip(words(self.data(block))) {
            let (a_knows, b_knows) = (!(a >> 1) & SIDES, !(b >> 1) & SIDES);
            let differ = (a ^ b) & SIDES;
            leader_loses += (a_knows & (!b_knows | differ)).count_ones();
            block_loses += (b_knows & (!a_knows | differ)).count_ones();
            if leader_loses > self.allowed || block_loses > self.allowed {
                return false;
            }
        }
        self.worst[leader as usize] = leader_loses.max(block_loses);
        self.led[leader as usize] = true;
        let [to, from] = [leader, block].map(|index| self.triangles[index as usize].data_range());
        let [to, from] = [to, from].map(|range| range.start as usize..range.end as usize);
        // Leaders come before the blocks that join them.
        if let Some((before, behind)) = self.array.split_at_mut_checked(from.start)
            && let (Some(to), Some(from)) = (before.get_mut(to), behind.get(..from.len()))
        {
            crate::packed::combine(to, from);
        }
        true
    }
}

/// The low bits of the elements of a word of 4-state data.
const SIDES: u64 = 0x5555_5555_5555_5555;
/// The high bits.
const UNKNOWN: u64 = !SIDES;

/// Data as words, the last one filled up with zeros: known, and the same in all.
fn words(data: &[u8]) -> impl Iterator<Item = u64> {
    let (words, rest) = data.as_chunks::<8>();
    let rest = rest.iter().rev().fold(0, |word, &byte| word << 8 | u64::from(byte));
    words.iter().map(|word| u64::from_le_bytes(*word)).chain([rest])
}

/// Moves the blocks that lead together, and returns the new index of each. Nothing grows, so what is still to be moved lies behind.
fn compact(array: &mut Vec<u8>, triangles: &mut Vec<MicromapTriangle>, leaders: &[u32], alignment: u32) -> Vec<u32> {
    let mut new = vec![0; leaders.len()];
    let (mut end, mut kept) = (0_usize, 0_usize);
    for (old, &leader) in leaders.iter().enumerate() {
        if leader as usize != old {
            // Leaders come first, so theirs is known.
            new[old] = new[leader as usize];
            continue;
        }
        let mut triangle = triangles[old];
        let range = triangle.data_range();
        let start = end.next_multiple_of(alignment as usize);
        array.copy_within(range.start as usize..range.end as usize, start);
        if let Some(gap) = array.get_mut(end..start) {
            gap.fill(0);
        }
        end = start + triangle.data_size() as usize;
        triangle.data_offset = start as u32;
        triangles[kept] = triangle;
        new[old] = kept as u32;
        kept += 1;
    }
    array.truncate(end);
    array.shrink_to_fit();
    triangles.truncate(kept);
    new
}

#[cfg(test)]
mod tests {
    use omm_model::level::SubdivisionLevel;

    use super::*;

    /// `count` distinct blocks of `level`, in groups of eight that differ in at most two microtriangles.
    fn blocks(count: u32, level: SubdivisionLevel) -> (Vec<u8>, Vec<MicromapTriangle>) {
        const FORMAT: OpacityMicromapFormat = OpacityMicromapFormat::FourState;
        let size = FORMAT.data_size(level);
        let random = |seed: u64| {
            let z = (seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z ^ (z >> 27)
        };
        let mut array = Vec::new();
        for block in 0..count {
            let start = array.len();
            let group = u64::from(block / 8) << 32;
            array.extend((0..u64::from(size)).map(|byte| random(group | byte) as u8 & 0x55));
            for change in 0..u64::from(block % 8).min(2) {
                let at = random(u64::from(block) << 8 | change) % u64::from(size);
                array[start + at as usize] ^= 1;
            }
        }
        let triangle = |k| MicromapTriangle { data_offset: k * size, subdivision_level: level, format: FORMAT };
        (array, (0..count).map(triangle).collect())
    }

    /// As many as a large scene has: minutes if all pairs were compared.
    #[test]
    fn many_blocks_are_merged_soon() {
        for level in [4, 5] {
            let level = SubdivisionLevel::new(level).unwrap();
            let (mut array, mut triangles) = blocks(65_536, level);
            let before = array.clone();
            let options = BakeOptions { merge_distance: 8.0 / level.microtriangles() as f32, ..BakeOptions::default() };
            let start = std::time::Instant::now();
            let new = merge_near(&mut array, &mut triangles, &options);
            println!("65536 blocks of level {} became {} in {:?}", level.get(), triangles.len(), start.elapsed());
            // Members of a group differ from its first in up to two places each, so at most four can be left over.
            assert!(triangles.len() < 65_536 / 8 * 5 / 2, "{}", triangles.len());
            let size = triangles[0].data_size() as usize;
            for (old, &new) in new.iter().enumerate() {
                let (old, new) = (&before[old * size..][..size], &array[new as usize * size..][..size]);
                for (old, new) in old.iter().zip(new) {
                    let known = !(new >> 1) & 0x55;
                    assert_eq!((old ^ new) & known, 0, "a state became another that is known");
                }
            }
        }
    }
}
