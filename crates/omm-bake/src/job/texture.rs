//! The texture of a job.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::{FieldError, JobErrorKind, Size, part};
use crate::texture::{MAX_SIDE, Texture, TextureError};

/// Where a texture lies, and how.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TextureFile {
    path: PathBuf,
    width: u32,
    height: u32,
    format: TexelFormat,
    #[serde(default)]
    row_pitch: Option<u64>,
    #[serde(default)]
    mips: Vec<PathBuf>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum TexelFormat {
    Unorm8,
    Fp32,
}

impl TextureFile {
    /// The files that it names.
    pub(super) fn files(&self) -> impl Iterator<Item = &PathBuf> {
        std::iter::once(&self.path).chain(&self.mips)
    }

    pub(super) fn read(&self, folder: &Path) -> Result<Texture, FieldError> {
        let &Self { ref path, width, height, format: _, row_pitch, ref mips } = self;
        let texture = self.read_mip(folder, "texture.path", path, [width, height], row_pitch)?;
        let half = |side: u32, mip: usize| side.checked_shr(mip as u32).unwrap_or(0).max(1);
        let mip = |(mip, path): (usize, &PathBuf)| {
            let size = [half(width, mip), half(height, mip)];
            self.read_mip(folder, "texture.mips", path, size, None)
        };
        let mips = (1..).zip(mips).map(mip).collect::<Result<_, _>>()?;
        texture.with_mips(mips).map_err(|error| ("texture.mips", error.into()))
    }

    fn read_mip(
        &self,
        folder: &Path,
        field: &'static str,
        path: &Path,
        [width, height]: [u32; 2],
        row_pitch: Option<u64>,
    ) -> Result<Texture, FieldError> {
        // Sizes that make no texture are told before they are held against the file's.
        if width == 0 || height == 0 {
            return Err(("texture", TextureError::Empty { width, height }.into()));
        }
        if width > MAX_SIDE || height > MAX_SIDE {
            return Err(("texture", TextureError::TooLarge { width, height }.into()));
        }
        let texel = match self.format {
            TexelFormat::Unorm8 => 1,
            TexelFormat::Fp32 => 4,
        };
        let size = match row_pitch {
            None => Size::Exactly(texel * u64::from(width) * u64::from(height)),
            // The texture says what it lacks.
            Some(_) => Size::MultipleOf(texel),
        };
        let found = row_pitch.unwrap_or(texel * u64::from(width));
        if !found.is_multiple_of(texel) {
            return Err(("texture.row_pitch", JobErrorKind::RowPitch { found, texel }));
        }
        let bytes = part(folder, path, field, size)?;
        // No file is longer than a pitch that does not fit.
        let row_pitch = usize::try_from(found / texel).unwrap_or(usize::MAX);
        let texture = match self.format {
            TexelFormat::Unorm8 => Texture::unorm8_with_row_pitch(width, height, row_pitch, bytes),
            TexelFormat::Fp32 => {
                let floats = bytes.as_chunks().0.iter().copied().map(f32::from_le_bytes).collect();
                Texture::fp32_with_row_pitch(width, height, row_pitch, floats)
            }
        };
        texture.map_err(|error| (field, error.into()))
    }
}
