//! Alpha textures: one channel, 8-bit normalised or 32-bit float.

mod error;

pub use error::TextureError;

/// The longest side of a texture, in texels.
pub const MAX_SIDE: u32 = 65_536;

/// An alpha channel, row by row from *v* = 0 upwards, and perhaps its smaller mips.
///
/// Sizes and texels are those of the texture itself, which is mip 0; [`mip`](Self::mip) has the others.
///
/// Texel (i, j) is centred at ((i + 0.5) / width, (j + 0.5) / height).
#[derive(Clone, Debug)]
pub struct Texture {
    width: u32,
    height: u32,
    /// Texels from the start of one row to the start of the next, at least `width`.
    row_pitch: usize,
    texels: Texels,
    /// The least and the greatest stored value.
    extremes: [f64; 2],
    /// Mips 1 and on.
    mips: Vec<Texture>,
    /// What other devices read instead of these texels.
    readings: Vec<Texture>,
}

#[derive(Clone, Debug)]
enum Texels {
    /// Alpha is the value divided by 255.
    Unorm8(Vec<u8>),
    /// Alpha is the value; every value is finite.
    Fp32(Vec<f32>),
}

impl Texture {
    /// A texture of `width` x `height` bytes without gaps between rows; alpha is the byte divided by 255, as a rational number.
    ///
    /// # Errors
    /// [`TextureError`] says which size does not fit.
    pub fn unorm8(width: u32, height: u32, data: Vec<u8>) -> Result<Self, TextureError> {
        Self::unorm8_with_row_pitch(width, height, width as usize, data)
    }

    /// As [`unorm8`](Self::unorm8), with `row_pitch` bytes from the start of one row to the start of the next.
    ///
    /// What lies between rows is not looked at. The data may end with the last row's texels or with its pitch.
    ///
    /// # Errors
    /// [`TextureError`] says which size does not fit.
    pub fn unorm8_with_row_pitch(
        width: u32,
        height: u32,
        row_pitch: usize,
        data: Vec<u8>,
    ) -> Result<Self, TextureError> {
        check_sizes(width, height, row_pitch, data.len())?;
        let mut extremes = [u8::MAX, u8::MIN];
        for row in rows(&data, width, row_pitch) {
            extremes = row.iter().fold(extremes, |[least, most], &value| [least.min(value), most.max(value)]);
        }
        Ok(Self {
            width,
            height,
            row_pitch,
            texels: Texels::Unorm8(data),
            extremes: extremes.map(f64::from),
            mips: Vec::new(),
            readings: Vec::new(),
        })
    }

    /// A texture of `width` x `height` floats without gaps between rows; alpha is the float, which need not be in 0..=1.
    ///
    /// # Errors
    /// [`TextureError`] says which size does not fit, or names the first texel that is NaN or infinite.
    pub fn fp32(width: u32, height: u32, data: Vec<f32>) -> Result<Self, TextureError> {
        Self::fp32_with_row_pitch(width, height, width as usize, data)
    }

    /// As [`fp32`](Self::fp32), with `row_pitch` floats (not bytes) from the start of one row to the start of the next.
    ///
    /// What lies between rows is not looked at. The data may end with the last row's texels or with its pitch.
    ///
    /// # Errors
    /// [`TextureError`] says which size does not fit, or names the first texel that is NaN or infinite.
    pub fn fp32_with_row_pitch(
        width: u32,
        height: u32,
        row_pitch: usize,
        data: Vec<f32>,
    ) -> Result<Self, TextureError> {
        check_sizes(width, height, row_pitch, data.len())?;
        let mut extremes = [f32::INFINITY, f32::NEG_INFINITY];
        for (y, row) in (0..).zip(rows(&data, width, row_pitch)) {
            for (x, &value) in (0..).zip(row) {
                if !value.is_finite() {
                    return Err(TextureError::NotFinite { x, y, value });
                }
                extremes = [extremes[0].min(value), extremes[1].max(value)];
            }
        }
        Ok(Self {
            width,
            height,
            row_pitch,
            texels: Texels::Fp32(data),
            extremes: extremes.map(f64::from),
            mips: Vec::new(),
            readings: Vec::new(),
        })
    }

    /// The texture with `mips` behind it: each as large as half of the one before, rounded down, but no smaller than a texel. They need
    /// not go on to the last.
    ///
    /// # Errors
    /// [`TextureError::MipSize`] or [`TextureError::MipChain`] names the first mip that cannot be one.
    pub fn with_mips(mut self, mips: Vec<Self>) -> Result<Self, TextureError> {
        let mut before = &self;
        for (mip, next) in (1..).zip(&mips) {
            let [width, height] = [before.width, before.height];
            if (width, height) == (1, 1) || !next.mips.is_empty() {
                return Err(TextureError::MipChain { mip });
            }
            let (found, required) = ([next.width, next.height], [(width / 2).max(1), (height / 2).max(1)]);
            if found != required {
                return Err(TextureError::MipSize { mip, found, required });
            }
            before = next;
        }
        self.mips = mips;
        Ok(self)
    }

    /// The texture with other `readings` of its file: what devices that decode it otherwise read in place of these texels. A
    /// microtriangle is opaque, or transparent, only if it is for all of them. The mips bring readings of their own.
    ///
    /// # Errors
    /// [`TextureError::Reading`] names the sizes if one is not as large as this texture, or has mips or readings itself.
    pub fn with_readings(mut self, readings: Vec<Self>) -> Result<Self, TextureError> {
        let required = [self.width, self.height];
        let fits = |reading: &&Self| {
            [reading.width, reading.height] == required && reading.mips.is_empty() && reading.readings.is_empty()
        };
        if let Some(wrong) = readings.iter().find(|reading| !fits(reading)) {
            return Err(TextureError::Reading { found: [wrong.width, wrong.height], required });
        }
        self.readings = readings;
        Ok(self)
    }

    /// What other devices read in place of this texture.
    #[must_use]
    pub fn readings(&self) -> &[Self] {
        &self.readings
    }

    /// How many mips there are, this one included: at least 1.
    #[must_use]
    pub const fn mip_count(&self) -> u32 {
        // No more than 17 by their sizes.
        1 + self.mips.len() as u32
    }

    /// Mip `mip`, 0 being this texture.
    #[must_use]
    pub fn mip(&self, mip: u32) -> Option<&Self> {
        match mip.checked_sub(1) {
            None => Some(self),
            Some(behind) => self.mips.get(behind as usize),
        }
    }

    /// Width in texels, `1..=MAX_SIDE`.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.width
    }

    /// Height in texels, `1..=MAX_SIDE`.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.height
    }

    /// The alpha of texel (`x`, `y`), rounded to `f64`; `None` outside the texture.
    #[must_use]
    pub fn alpha(&self, x: u32, y: u32) -> Option<f64> {
        (x < self.width && y < self.height).then(|| self.stored(x, y) / self.unit())
    }

    /// The stored value that stands for an alpha of 1. Stored values are exact in `f64`, alpha values need not be.
    pub(crate) const fn unit(&self) -> f64 {
        match self.texels {
            Texels::Unorm8(_) => 255.0,
            Texels::Fp32(_) => 1.0,
        }
    }

    /// Whether all stored values are integers.
    pub(crate) const fn is_integral(&self) -> bool {
        matches!(self.texels, Texels::Unorm8(_))
    }

    /// The least and the greatest stored value.
    pub(crate) const fn extremes(&self) -> [f64; 2] {
        self.extremes
    }

    /// A bit for each texel, whether its stored value is above `threshold`: rows of whole words, bit *k* of a word for the *k*-th of
    /// its texels.
    pub(crate) fn above(&self, threshold: f64) -> Vec<u64> {
        match &self.texels {
            Texels::Unorm8(texels) => {
                // The least value that is above: in order, so the values themselves tell. There is one, or nothing is above.
                let least = (0..=u8::MAX).find(|&value| f64::from(value) > threshold);
                let above = |value: u8| least.is_some_and(|least| value >= least);
                self.words(texels, above)
            }
            Texels::Fp32(texels) => self.words(texels, |value| f64::from(value) > threshold),
        }
    }

    fn words<T: Copy>(&self, texels: &[T], above: impl Fn(T) -> bool) -> Vec<u64> {
        let words_per_row = self.width.div_ceil(u64::BITS) as usize;
        let mut words = Vec::with_capacity(words_per_row * self.height as usize);
        for row in rows(texels, self.width, self.row_pitch) {
            let (whole, rest) = row.as_chunks::<64>();
            words.extend(whole.iter().map(|values| {
                let mut flags = [0; 64];
                flags.iter_mut().zip(values).for_each(|(flag, &value)| *flag = above(value).into());
                word(&flags)
            }));
            if !rest.is_empty() {
                let mut flags = [0; 64];
                flags.iter_mut().zip(rest).for_each(|(flag, &value)| *flag = above(value).into());
                words.push(word(&flags));
            }
        }
        words
    }

    /// The stored values of the texels (`x`, `y`), (`x` + 1, `y`), (`x`, `y` + 1) and (`x` + 1, `y` + 1), exactly; `None` if the data
    /// ends before the last.
    pub(crate) fn square(&self, x: u32, y: u32) -> Option<[f64; 4]> {
        let at = y as usize * self.row_pitch + x as usize;
        let next = at + self.row_pitch;
        match &self.texels {
            Texels::Unorm8(texels) => match (texels.get(at..at + 2)?, texels.get(next..next + 2)?) {
                (&[a, b], &[c, d]) => Some([a.into(), b.into(), c.into(), d.into()]),
                _ => None,
            },
            Texels::Fp32(texels) => match (texels.get(at..at + 2)?, texels.get(next..next + 2)?) {
                (&[a, b], &[c, d]) => Some([a.into(), b.into(), c.into(), d.into()]),
                _ => None,
            },
        }
    }

    /// For each of `lines`, a row from `y` on, the stored values of the texels from column `x` on, less `threshold` and times `scale`,
    /// rounded; `false` if the data ends before the last. Beyond the end of a row is whatever comes next.
    #[inline]
    pub(crate) fn differences<const N: usize>(
        &self,
        [x, y]: [u32; 2],
        threshold: f64,
        scale: f64,
        lines: &mut [[f32; N]],
    ) -> bool {
        let at = y as usize * self.row_pitch + x as usize;
        match &self.texels {
            Texels::Unorm8(texels) => {
                let (threshold, scale) = (threshold as f32, scale as f32);
                fill(texels, at, self.row_pitch, lines, |texel| (f32::from(texel) - threshold) * scale)
            }
            Texels::Fp32(texels) => {
                fill(texels, at, self.row_pitch, lines, |texel| ((f64::from(texel) - threshold) * scale) as f32)
            }
        }
    }

    /// The stored value of texel (`x`, `y`), exactly. The caller has proved `x < width` and `y < height`.
    pub(crate) fn stored(&self, x: u32, y: u32) -> f64 {
        let at = y as usize * self.row_pitch + x as usize;
        match &self.texels {
            Texels::Unorm8(texels) => texels[at].into(),
            Texels::Fp32(texels) => texels[at].into(),
        }
    }
}

/// The lowest bits of 64 bytes, the first in the least significant bit.
fn word(flags: &[u8; 64]) -> u64 {
    let mut word = 0;
    for (bit, &flags) in (0_u32..).step_by(8).zip(flags.as_chunks::<8>().0) {
        // Gathers the lowest bits of eight bytes in the top byte of the product: no two terms meet in a bit.
        word |= (u64::from_le_bytes(flags).wrapping_mul(0x0102_0408_1020_4080) >> 56) << bit;
    }
    word
}

/// The starts of rows of `row_pitch` texels from `at` on, into `lines`; `false` if there are not as many texels.
#[inline]
fn fill<T: Copy, const N: usize>(
    texels: &[T],
    at: usize,
    row_pitch: usize,
    lines: &mut [[f32; N]],
    value: impl Fn(T) -> f32,
) -> bool {
    let mut rows = texels.get(at..).unwrap_or_default().chunks(row_pitch);
    for line in lines {
        let Some(texels) = rows.next().and_then(<[T]>::first_chunk::<N>) else { return false };
        for (to, &from) in line.iter_mut().zip(texels) {
            *to = value(from);
        }
    }
    true
}

/// The texels of each row. The sizes have been checked.
fn rows<T>(data: &[T], width: u32, row_pitch: usize) -> impl Iterator<Item = &[T]> {
    data.chunks(row_pitch).map(move |row| &row[..width as usize])
}

fn check_sizes(width: u32, height: u32, row_pitch: usize, found: usize) -> Result<(), TextureError> {
    if width == 0 || height == 0 {
        return Err(TextureError::Empty { width, height });
    }
    if width > MAX_SIDE || height > MAX_SIDE {
        return Err(TextureError::TooLarge { width, height });
    }
    if row_pitch < width as usize {
        return Err(TextureError::RowPitch { row_pitch, width });
    }
    // An absurd pitch saturates to a length that no slice has.
    let before_last = (row_pitch as u64).saturating_mul(u64::from(height) - 1);
    let least = before_last.saturating_add(width.into());
    let most = before_last.saturating_add(row_pitch as u64);
    if (least..=most).contains(&(found as u64)) { Ok(()) } else { Err(TextureError::DataLength { found, least, most }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_must_fit() {
        let text = |result: Result<Texture, TextureError>| result.unwrap_err().to_string();
        assert_eq!(text(Texture::unorm8(0, 4, vec![])), "a texture of 0 x 4 texels is empty");
        assert_eq!(
            text(Texture::unorm8(1, 65_537, vec![])),
            "a texture of 1 x 65537 texels is too large: no side may exceed 65536"
        );
        assert_eq!(
            text(Texture::unorm8(3, 2, vec![0; 5])),
            "the texture data has 5 texels, but its size asks for 6 to 6"
        );
        assert_eq!(
            text(Texture::fp32_with_row_pitch(3, 2, 2, vec![0.0; 5])),
            "a row pitch of 2 texels is less than the width of 3"
        );
        let absurd = Texture::unorm8_with_row_pitch(3, 3, usize::MAX, vec![0; 5]).unwrap_err();
        assert!(matches!(absurd, TextureError::DataLength { found: 5, least: u64::MAX, .. }));
    }

    #[test]
    fn row_pitch_skips_padding() {
        for length in [8, 9] {
            let data = [10, 20, 99, 30, 40, 99, 50, 60, 99][..length].to_vec();
            let texture = Texture::unorm8_with_row_pitch(2, 3, 3, data).unwrap();
            assert_eq!(texture.stored(1, 2), 60.0);
            assert_eq!(texture.extremes(), [10.0, 60.0]);
        }
        assert_eq!(
            Texture::unorm8_with_row_pitch(2, 3, 3, vec![0; 7]).unwrap_err(),
            TextureError::DataLength { found: 7, least: 8, most: 9 }
        );
        let padding = Texture::fp32_with_row_pitch(1, 2, 2, vec![0.5, f32::NAN, 1.5]).unwrap();
        assert_eq!(padding.extremes(), [0.5, 1.5]);
        assert_eq!((padding.alpha(0, 1), padding.alpha(1, 0)), (Some(1.5), None));
    }

    #[test]
    fn mips_are_half_as_large() {
        let texture = |width, height| Texture::unorm8(width, height, vec![0; (width * height) as usize]).unwrap();
        let chain = texture(5, 3).with_mips(vec![texture(2, 1), texture(1, 1)]).unwrap();
        assert_eq!(chain.mip_count(), 3);
        assert_eq!([0, 1, 2, 3].map(|mip| chain.mip(mip).map(Texture::width)), [Some(5), Some(2), Some(1), None]);
        let error = |texture: Texture, mips| texture.with_mips(mips).unwrap_err().to_string();
        assert_eq!(
            error(texture(5, 3), vec![texture(2, 1), texture(1, 2)]),
            "mip 2 has 1 x 2 texels, but half of the mip before is 1 x 1"
        );
        let cannot = "mip 1 cannot be: the one before has a single texel, or brings mips of its own";
        assert_eq!(error(texture(1, 1), vec![texture(1, 1)]), cannot);
        assert_eq!(error(texture(10, 6), vec![chain]), cannot);
    }

    #[test]
    fn floats_must_be_finite() {
        let error = Texture::fp32(2, 2, vec![0.0, 1.0, f32::NEG_INFINITY, f32::NAN]).unwrap_err();
        assert_eq!(error.to_string(), "texel (0, 1) is -inf, which is not a finite number");
    }
}
