//! How a shader reads the texture: filter and address mode.

use serde::{Deserialize, Serialize};

/// What lies outside the texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AddressMode {
    /// The texture repeats.
    #[default]
    Wrap,
    /// The texture repeats, every other copy mirrored.
    Mirror,
    /// The texels at the edge go on for ever.
    Clamp,
    /// A constant, [`Sampler::border_alpha`].
    Border,
    /// The texture is mirrored once at 0; beyond that, the texels at the edge go on for ever.
    MirrorOnce,
}

/// How the surface between texel centres is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Filter {
    /// The texel floor(u * width), floor(v * height).
    Nearest,
    /// The bilinear surface through the texel centres.
    #[default]
    Linear,
}

/// How a shader reads the texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sampler {
    /// What lies outside the texture along *u*.
    pub address_mode_u: AddressMode,
    /// What lies outside the texture along *v*.
    pub address_mode_v: AddressMode,
    /// How the surface between texel centres is made.
    pub filter: Filter,
    /// The alpha outside the texture under [`AddressMode::Border`], finite. Other modes do not look at it.
    #[serde(default)]
    pub border_alpha: f32,
}

impl Sampler {
    /// A sampler with the same address mode in both directions.
    #[must_use]
    pub const fn new(address_mode: AddressMode, filter: Filter, border_alpha: f32) -> Self {
        Self { address_mode_u: address_mode, address_mode_v: address_mode, filter, border_alpha }
    }

    /// Whether the border can be seen.
    pub(crate) fn shows_border(self) -> bool {
        [self.address_mode_u, self.address_mode_v].contains(&AddressMode::Border)
    }
}

impl AddressMode {
    /// All five.
    pub const ALL: [Self; 5] = [Self::Wrap, Self::Mirror, Self::Clamp, Self::Border, Self::MirrorOnce];

    /// The texel of `0..size` that stands at texel coordinate `coordinate`; `None` is the border.
    ///
    /// This is the wrapping operation that Vulkan defines on integer texel coordinates. `coordinate` is at most 2^31 away from 0
    /// and `size` is not 0.
    #[must_use]
    pub fn texel(self, coordinate: i64, size: u32) -> Option<u32> {
        let size = i64::from(size);
        let mirror = |value: i64| if value >= 0 { value } else { -1 - value };
        let texel = match self {
            // The common case needs no division.
            _ if (0..size).contains(&coordinate) => coordinate,
            Self::Wrap => coordinate.rem_euclid(size),
            Self::Mirror => (size - 1) - mirror(coordinate.rem_euclid(2 * size) - size),
            Self::Clamp => coordinate.clamp(0, size - 1),
            Self::Border => return None,
            Self::MirrorOnce => mirror(coordinate).clamp(0, size - 1),
        };
        // In 0..size by every branch, and a size fits.
        Some(texel as u32)
    }
}

/// One axis of the grid on which the surface is piecewise simple: unit cells, and at most two *end cells* without an outer bound,
/// in which the address mode repeats one texel for ever.
///
/// Cell `k` spans from `k` to `k + 1`: between the centres of the texels `k` and `k + 1` for a linear filter, the texel `k` itself
/// for a nearest one. The cells `first` and `last` go on to infinity, so however far a triangle reaches beyond the texture,
/// it touches a bounded number of cells unless the texture repeats.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axis {
    /// Texels along the axis.
    size: u32,
    mode: AddressMode,
    first: i64,
    last: i64,
}

impl Axis {
    pub(crate) fn new(size: u32, mode: AddressMode, filter: Filter) -> Self {
        let n = i64::from(size);
        let (first, last) = match (mode, filter) {
            (AddressMode::Wrap | AddressMode::Mirror, _) => (i64::MIN, i64::MAX),
            // A linear filter mixes the texels k and k + 1: both must be the repeated one.
            (AddressMode::Clamp, Filter::Linear) => (-1, n - 1),
            (AddressMode::Border, Filter::Linear) => (-2, n),
            (AddressMode::MirrorOnce, Filter::Linear) => (-n - 1, n - 1),
            (AddressMode::Clamp | AddressMode::Border, Filter::Nearest) => (-1, n),
            (AddressMode::MirrorOnce, Filter::Nearest) => (-n - 1, n),
        };
        Self { size, mode, first, last }
    }

    /// Texels along the axis.
    pub(crate) fn size(&self) -> u32 {
        self.size
    }

    /// The cell that holds coordinate `k`, or the end cell in whose direction it lies.
    pub(crate) fn cell(&self, k: i64) -> i64 {
        k.clamp(self.first, self.last)
    }

    /// The lower bound of cell `k`; none for the first cell.
    pub(crate) fn lower(&self, k: i64) -> Option<i64> {
        (k > self.first).then_some(k)
    }

    /// The upper bound of cell `k`; none for the last cell.
    pub(crate) fn upper(&self, k: i64) -> Option<i64> {
        (k < self.last).then_some(k + 1)
    }

    /// The texel at coordinate `k`; `None` is the border.
    pub(crate) fn texel(&self, k: i64) -> Option<u32> {
        self.mode.texel(k, self.size)
    }

    /// After how many texels the texture repeats, if it does.
    pub(crate) fn period(&self) -> Option<i64> {
        match self.mode {
            AddressMode::Wrap => Some(self.size.into()),
            AddressMode::Mirror => Some(2 * i64::from(self.size)),
            AddressMode::Clamp | AddressMode::Border | AddressMode::MirrorOnce => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The texels at coordinates -7..=8 of a texture of three, written out; `x` is the border.
    #[test]
    fn address_modes_on_three_texels() {
        let line = |mode: AddressMode| -> String {
            (-7..=8).map(|k| mode.texel(k, 3).map_or('x', |t| char::from_digit(t, 10).unwrap())).collect()
        };
        assert_eq!(line(AddressMode::Wrap), "2012012012012012");
        assert_eq!(line(AddressMode::Mirror), "0012210012210012");
        assert_eq!(line(AddressMode::Clamp), "0000000012222222");
        assert_eq!(line(AddressMode::Border), "xxxxxxx012xxxxxx");
        assert_eq!(line(AddressMode::MirrorOnce), "2222210012222222");
    }

    /// The same by walking outwards one texel at a time.
    #[test]
    fn address_modes_by_walking() {
        for size in 1..=6 {
            // A ball that bounces between the edges, showing each edge texel twice.
            let bounce: Vec<u32> = (0..size).chain((0..size).rev()).collect();
            for k in 0..100_i64 {
                let up = k as usize;
                assert_eq!(AddressMode::Mirror.texel(k, size), Some(bounce[up % bounce.len()]));
                assert_eq!(AddressMode::Mirror.texel(-1 - k, size), Some(bounce[up % bounce.len()]));
                assert_eq!(AddressMode::Wrap.texel(k, size), Some((up % size as usize) as u32));
                assert_eq!(AddressMode::Wrap.texel(-1 - k, size), Some(size - 1 - (up % size as usize) as u32));
                let clamped = (k as u32).min(size - 1);
                assert_eq!(AddressMode::Clamp.texel(k, size), Some(clamped));
                assert_eq!(AddressMode::Clamp.texel(-1 - k, size), Some(0));
                assert_eq!(AddressMode::MirrorOnce.texel(k, size), Some(clamped));
                assert_eq!(AddressMode::MirrorOnce.texel(-1 - k, size), Some(clamped));
                assert_eq!(AddressMode::Border.texel(k, size), (k < size.into()).then_some(k as u32));
                assert_eq!(AddressMode::Border.texel(-1 - k, size), None);
            }
        }
    }

    /// Beyond the end cells every texel that a cell mixes is the same.
    #[test]
    fn end_cells_are_constant() {
        for mode in [AddressMode::Clamp, AddressMode::Border, AddressMode::MirrorOnce] {
            for (filter, mixed) in [(Filter::Linear, 1), (Filter::Nearest, 0)] {
                for size in 1..=4 {
                    let axis = Axis::new(size, mode, filter);
                    assert!(axis.first < axis.last);
                    assert_eq!((axis.lower(axis.first), axis.upper(axis.last)), (None, None));
                    for k in axis.first - 9..=axis.first + mixed {
                        assert_eq!(axis.texel(k), axis.texel(axis.first), "{mode:?} {filter:?} {size} {k}");
                    }
                    for k in axis.last..axis.last + 9 {
                        assert_eq!(axis.texel(k), axis.texel(axis.last), "{mode:?} {filter:?} {size} {k}");
                    }
                }
            }
        }
    }

    #[test]
    fn names_in_files() {
        let names = serde_json::to_string(&AddressMode::ALL).unwrap();
        assert_eq!(names, r#"["wrap","mirror","clamp","border","mirror_once"]"#);
        let sampler: Sampler =
            serde_json::from_str(r#"{"address_mode_u":"mirror","address_mode_v":"mirror","filter":"nearest"}"#)
                .unwrap();
        assert_eq!(sampler, Sampler::new(AddressMode::Mirror, Filter::Nearest, 0.0));
    }
}
