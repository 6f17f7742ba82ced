//! Colours for counts.

/// The colour of `count` on a scale that ends at `most`: black, blue, red, yellow, white.
pub(crate) fn colour(count: u32, most: u32) -> [u8; 3] {
    const STOPS: [[f32; 3]; 5] =
        [[0.0, 0.0, 0.0], [30.0, 40.0, 190.0], [215.0, 40.0, 50.0], [250.0, 205.0, 40.0], [255.0, 255.0, 255.0]];
    let position = count.min(most) as f32 / most.max(1) as f32 * (STOPS.len() - 1) as f32;
    let stop = (position as usize).min(STOPS.len() - 2);
    let rest = position - stop as f32;
    [0, 1, 2].map(|channel| (STOPS[stop][channel] * (1.0 - rest) + STOPS[stop + 1][channel] * rest) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_runs_from_black_to_white() {
        assert_eq!(colour(0, 8), [0, 0, 0]);
        assert_eq!(colour(2, 8), [30, 40, 190]);
        assert_eq!(colour(8, 8), [255, 255, 255]);
        assert_eq!(colour(99, 8), [255, 255, 255]);
        assert_eq!(colour(0, 0), [0, 0, 0]);
    }
}
