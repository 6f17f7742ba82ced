//! One bit for each texel: whether it is above the cutoff.

use crate::surface::Surface;

/// Texels in a word.
const WORD: u32 = u64::BITS;

/// One bit for each texel of a surface's texture, rows of whole words; bit *k* of a word is the *k*-th of its texels.
#[derive(Clone, Debug)]
pub(crate) struct Planes {
    words: Vec<u64>,
    words_per_row: usize,
}

impl Planes {
    pub(crate) fn new(surface: &Surface<'_>) -> Self {
        let texture = surface.texture();
        let words_per_row = texture.width().div_ceil(WORD) as usize;
        let words = texture.above(surface.threshold());
        Self { words, words_per_row }
    }

    /// The word `word` of row `row`; texels beyond the texture are not above.
    fn word(&self, row: u32, word: usize) -> u64 {
        let at = row as usize * self.words_per_row + word;
        if word < self.words_per_row { self.words.get(at).copied().unwrap_or(0) } else { 0 }
    }

    /// For each of `lines`, a row of the texture from `row` on, 64 texels from column `column` on.
    pub(crate) fn load<'a>(&self, row: u32, column: u32, lines: impl Iterator<Item = &'a mut u64>) {
        let (word, shift) = ((column / WORD) as usize, column % WORD);
        let rows = self.words.chunks_exact(self.words_per_row).skip(row as usize);
        for (line, words) in lines.zip(rows) {
            let at = |word: usize| words.get(word).copied().unwrap_or(0);
            // A shift by 64 in two steps, as one has no meaning.
            *line = at(word) >> shift | (at(word + 1) << 1) << (WORD - 1 - shift);
        }
    }

    /// Whether texel (`column`, `row`) is above the cutoff.
    pub(crate) fn bit(&self, row: u32, column: u32) -> bool {
        self.word(row, (column / WORD) as usize) >> (column % WORD) & 1 == 1
    }

    /// The side of all texels in columns `left..=right` and rows `top..=bottom` of the texture, if they have one.
    pub(crate) fn side(&self, [left, right]: [u32; 2], [top, bottom]: [u32; 2]) -> Option<bool> {
        let side = self.bit(top, left);
        // What must be flipped for bits of this side to be 0.
        let flip = if side { u64::MAX } else { 0 };
        let (first, last) = ((left / WORD) as usize, (right / WORD) as usize);
        let (from_left, to_right) = (u64::MAX << (left % WORD), u64::MAX >> (WORD - 1 - right % WORD));
        let rows = self.words.chunks_exact(self.words_per_row).skip(top as usize).take((bottom + 1 - top) as usize);
        for row in rows {
            let other = match row.get(first..=last) {
                Some(&[word]) => (word ^ flip) & from_left & to_right,
                Some(&[start, ref between @ .., end]) => {
                    let between = between.iter().fold(0, |other, word| other | (word ^ flip));
                    between | (start ^ flip) & from_left | (end ^ flip) & to_right
                }
                _ => 0,
            };
            if other != 0 {
                return None;
            }
        }
        Some(side)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampler::Sampler;
    use crate::texture::Texture;

    /// Bits, runs of bits and boxes of a texture with texels of both sides, for a byte and a float texture with gaps between rows.
    #[test]
    fn bits_are_texels_above_the_cutoff() {
        let (width, height, pitch) = (150_u32, 7_u32, 160_usize);
        let values: Vec<u8> = (0..pitch * height as usize).map(|k| if k * k % 97 < 5 { 51 } else { 52 }).collect();
        let floats = values.iter().map(|&value| f32::from(value) / 255.0).collect();
        let bytes = Texture::unorm8_with_row_pitch(width, height, pitch, values).unwrap();
        let floats = Texture::fp32_with_row_pitch(width, height, pitch, floats).unwrap();
        for texture in [bytes, floats] {
            let surface = Surface::new(&texture, Sampler::default(), 0.2).unwrap();
            let planes = Planes::new(&surface);
            for row in 0..height {
                for column in 0..width {
                    let above = surface.is_above(column.into(), row.into());
                    assert_eq!(planes.bit(row, column), above);
                    let mut bits = 0;
                    planes.load(row, column, std::iter::once(&mut bits));
                    assert_eq!(bits & 1 == 1, above);
                    let far = (column + 63 < width).then(|| surface.is_above(i64::from(column) + 63, row.into()));
                    assert_eq!(bits >> 63 == 1, far.unwrap_or(false));
                    for right in [column, (column + 2).min(width - 1), (column + 70).min(width - 1)] {
                        let side =
                            surface.side(column.into()..=right.into(), row.into()..=(row + 1).min(height - 1).into());
                        assert_eq!(planes.side([column, right], [row, (row + 1).min(height - 1)]), side);
                    }
                }
            }
        }
    }
}
