//! The options of `omm bake` that few bakes need.

use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use omm_bake::{BakeOptions, BlockOrder, CutoffStates, MipChoice, TriangleOverride};
use omm_layout::index::IndexType;
use omm_model::format::OpacityMicromapFormat;
use omm_model::level::SubdivisionLevel;
use omm_model::opacity::OpacityState;

use crate::error::CliError;
use crate::output;

/// In a file of levels or formats: as for the other triangles.
const AS_OTHERS: u8 = 255;

/// Arguments of `omm bake` beside the common ones.
#[derive(Debug, Args)]
#[command(next_help_heading = "Tuning")]
pub(super) struct Tuning {
    /// Mips that the shader may read, such as 2 or 0-3. If absent, mip 0 of a glTF file's images and all that a job has; only DDS
    /// and KTX2 images have others.
    #[arg(long, value_name = "FIRST-LAST", value_parser = mips)]
    pub(super) mips: Option<MipChoice>,
    /// The state where alpha is above the cutoff: uo for smoke that a shader must see.
    #[arg(long, value_name = "STATE")]
    greater: Option<State>,
    /// The state where alpha is at most the cutoff.
    #[arg(long, value_name = "STATE")]
    less_or_equal: Option<State>,
    /// A byte for each triangle: its level, or 255 for that of the others.
    #[arg(long, value_name = "FILE")]
    levels: Option<PathBuf>,
    /// A byte for each triangle: 1 for 2-state, 2 for 4-state, or 255 for the format of the others.
    #[arg(long, value_name = "FILE")]
    formats: Option<PathBuf>,
    /// Give a triangle an unknown special index if less than this part of it is known, 0 to 1.
    #[arg(long, value_name = "PART")]
    reject: Option<f32>,
    /// Let triangles share data that is almost the same: this part of one, 0 to 1, may become unknown for it.
    #[arg(long, value_name = "PART")]
    merge_distance: Option<f32>,
    /// Store data for each triangle, even if it is the same.
    #[arg(long)]
    no_merge: bool,
    /// In which order blocks of one level lie: by place in the texture, or by first use in the mesh.
    #[arg(long, value_name = "HOW")]
    order: Option<Order>,
    /// Start each block at a multiple of so many bytes, a power of two.
    #[arg(long, value_name = "BYTES")]
    block_alignment: Option<u32>,
    /// Lower levels, where that costs least, until the array has no more bytes.
    #[arg(long, value_name = "BYTES")]
    max_array_bytes: Option<u64>,
    /// Refuse a bake of more steps of work: microtriangles and the texels below them.
    #[arg(long, value_name = "STEPS")]
    max_work: Option<u64>,
    /// How indices are stored; auto is the smallest that fits.
    #[arg(long, value_enum, value_name = "TYPE", default_value_t = IndexSize::Uint32)]
    pub(super) index_type: IndexSize,
    /// Also write which part of each triangle is known.
    #[arg(long)]
    pub(super) coverage: bool,
    /// Say what would be baked, with sizes, levels and predicted coverage, and write nothing.
    #[arg(long, conflicts_with_all = ["picture", "coverage"])]
    pub(super) dry_run: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum State {
    /// Transparent.
    T,
    /// Opaque.
    O,
    /// Unknown transparent.
    Ut,
    /// Unknown opaque.
    Uo,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Order {
    Spatial,
    Mesh,
}

/// How indices are stored.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(super) enum IndexSize {
    /// The smallest that fits.
    Auto,
    Uint8,
    Uint16,
    Uint32,
}

impl From<State> for OpacityState {
    fn from(state: State) -> Self {
        match state {
            State::T => Self::Transparent,
            State::O => Self::Opaque,
            State::Ut => Self::UnknownTransparent,
            State::Uo => Self::UnknownOpaque,
        }
    }
}

impl IndexSize {
    /// The types that an index buffer may have, in the order in which they are tried.
    pub(super) const fn types(self) -> &'static [IndexType] {
        match self {
            Self::Auto => &[IndexType::Uint8, IndexType::Uint16, IndexType::Uint32],
            Self::Uint8 => &[IndexType::Uint8],
            Self::Uint16 => &[IndexType::Uint16],
            Self::Uint32 => &[IndexType::Uint32],
        }
    }
}

/// A mip or a range of them as an argument.
fn mips(text: &str) -> Result<MipChoice, String> {
    let (first, last) = text.split_once('-').unwrap_or((text, text));
    match (first.parse(), last.parse()) {
        (Ok(first), Ok(last)) => Ok(MipChoice::Range { first, last }),
        _ => Err("neither a mip, such as 2, nor a range of them, such as 0-3".to_owned()),
    }
}

impl Tuning {
    /// `options` with those of the command line in their place.
    pub(super) fn apply(&self, options: BakeOptions) -> Result<BakeOptions, CliError> {
        let CutoffStates { greater, less_or_equal } = options.cutoff_states;
        let order = self.order.map(|order| match order {
            Order::Spatial => BlockOrder::Spatial,
            Order::Mesh => BlockOrder::Mesh,
        });
        Ok(BakeOptions {
            overrides: self.overrides()?,
            mips: self.mips.unwrap_or(options.mips),
            cutoff_states: CutoffStates {
                greater: self.greater.map_or(greater, Into::into),
                less_or_equal: self.less_or_equal.map_or(less_or_equal, Into::into),
            },
            rejection_threshold: self.reject.unwrap_or(options.rejection_threshold),
            merge: options.merge && !self.no_merge,
            merge_distance: self.merge_distance.unwrap_or(options.merge_distance),
            order: order.unwrap_or(options.order),
            block_alignment: self.block_alignment.unwrap_or(options.block_alignment),
            max_array_bytes: self.max_array_bytes.or(options.max_array_bytes),
            max_work: self.max_work.or(options.max_work),
            ..options
        })
    }

    /// Levels and formats of the triangles, from their files.
    fn overrides(&self) -> Result<Vec<TriangleOverride>, CliError> {
        let mut overrides = Vec::new();
        if let Some(path) = &self.levels {
            let level = |level| SubdivisionLevel::new(u32::from(level)).map_err(|error| error.to_string());
            let own = |level| TriangleOverride { level, format: None };
            overrides = read(path, level)?.into_iter().map(own).collect();
        }
        if let Some(path) = &self.formats {
            let unknown = |format| format!("{format} is no format: neither 1, for 2-state, nor 2, for 4-state");
            let format = |format| OpacityMicromapFormat::from_value(u32::from(format)).ok_or_else(|| unknown(format));
            let formats = read(path, format)?;
            if self.levels.is_none() {
                overrides = vec![TriangleOverride::default(); formats.len()];
            } else if overrides.len() != formats.len() {
                let reason = format!("{} formats for {} levels", formats.len(), overrides.len());
                return Err(CliError::Elements { path: path.clone(), reason });
            }
            overrides.iter_mut().zip(formats).for_each(|(own, format)| own.format = format);
        }
        Ok(overrides)
    }
}

/// What `value` makes of each byte of a file.
fn read<T>(path: &Path, value: impl Fn(u8) -> Result<T, String>) -> Result<Vec<Option<T>>, CliError> {
    let bytes = output::read(path)?;
    let values = bytes.into_iter().enumerate().map(|(triangle, byte)| match byte {
        AS_OTHERS => Ok(None),
        _ => value(byte).map(Some).map_err(|reason| {
            let reason = format!("byte {triangle}: {reason}");
            CliError::Elements { path: path.into(), reason }
        }),
    });
    values.collect()
}
