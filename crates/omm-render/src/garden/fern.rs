//! The garden's alpha texture: a fern frond, grown by an iterated function system.
//!
//! Only additions, multiplications and divisions are used, so that every machine grows the same frond.

use crate::random::Random;

/// Side of the square texture in texels.
pub const SIZE: u32 = 4096;

/// One of the four maps that a frond is made of: `x' = a x + b y + shift`, `y' = c x + d y + rise`, chosen with a weight out
/// of 100.
struct Map {
    a: f64,
    b: f64,
    shift: f64,
    c: f64,
    d: f64,
    rise: f64,
    weight: u64,
}

/// Michael Barnsley's fern with the numbers that are told of marsh ferns (Thelypteridaceae): stem, the smaller frond above, left
/// leaflet, right leaflet.
const MAPS: [Map; 4] = [
    Map { a: 0.0, b: 0.0, shift: 0.0, c: 0.0, d: 0.25, rise: -0.4, weight: 2 },
    Map { a: 0.95, b: 0.005, shift: -0.002, c: -0.005, d: 0.93, rise: 0.5, weight: 84 },
    Map { a: 0.035, b: -0.2, shift: -0.09, c: 0.16, d: 0.04, rise: 0.02, weight: 7 },
    Map { a: -0.04, b: 0.2, shift: 0.083, c: 0.16, d: 0.04, rise: 0.12, weight: 7 },
];

/// Points plotted.
const POINTS: u32 = 48_000_000;

/// The texture's alpha, row by row from the top (v = 0) down; the frond's root is at the bottom middle.
pub fn alpha() -> Vec<u8> {
    soften(&plot())
}

/// Marks the texels that the frond's points fall into, with 255.
fn plot() -> Vec<u8> {
    let size = SIZE as usize;
    let mut texels = vec![0; size * size];
    let mut random = Random::new(0xfe12);
    let (mut x, mut y) = (0.0, 0.0);
    for _ in 0..POINTS {
        let mut pick = random.below(100);
        let map = MAPS.iter().find(|map| {
            let hit = pick < map.weight;
            pick = pick.saturating_sub(map.weight);
            hit
        });
        let Some(map) = map else { continue };
        (x, y) = (map.a * x + map.b * y + map.shift, map.c * x + map.d * y + map.rise);
        // The attractor lies in -1.5..1.5 by -0.6..7.1; a margin keeps the border transparent.
        let column = (x + 1.8) / 3.6 * f64::from(SIZE);
        let row = (7.3 - y) / 8.0 * f64::from(SIZE);
        if let Some(texel) = texels.get_mut(row as usize * size + column as usize) {
            *texel = 255;
        }
    }
    texels
}

/// Closes the gaps between points and gives the frond a soft edge, as a filtered texture has: a 5 by 5 box, then amplified.
fn soften(texels: &[u8]) -> Vec<u8> {
    let size = SIZE as usize;
    let (mut across, mut soft) = (vec![0; texels.len()], vec![0; texels.len()]);
    for (sums, row) in across.chunks_exact_mut(size).zip(texels.chunks_exact(size)) {
        for (sum, near) in sums.iter_mut().skip(2).zip(row.windows(5)) {
            *sum = near.iter().map(|&texel| u16::from(texel)).sum::<u16>();
        }
    }
    for (row, soft) in soft.chunks_exact_mut(size).enumerate().skip(2).take(size - 4) {
        for (column, soft) in soft.iter_mut().enumerate() {
            let sum: u32 = (row - 2..=row + 2).map(|row| u32::from(across[row * size + column])).sum();
            *soft = (sum * 2 / 25).min(255) as u8;
        }
    }
    soft
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frond_covers_some_of_the_texture_and_none_of_its_border() {
        let alpha = alpha();
        let size = SIZE as usize;
        assert_eq!(alpha.len(), size * size);
        let opaque = alpha.iter().filter(|&&texel| texel > 127).count();
        assert!((alpha.len() / 10..alpha.len() / 2).contains(&opaque), "{opaque}");
        let border = (0..size).flat_map(|i| [i, i * size, i * size + size - 1, (size - 1) * size + i]);
        assert!(border.into_iter().all(|texel| alpha[texel] == 0));
    }
}
