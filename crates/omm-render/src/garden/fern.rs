//! The garden's alpha texture: a fern frond, grown by an iterated function system.
//!
//! Only additions, multiplications and divisions are used, so that every machine grows the same frond.

use crate::random::Random;

/// Side of the square texture in texels.
pub const SIZE: u32 = 2048;

/// One of the four maps that a frond is made of: `x' = a x + b y`, `y' = c x + d y + rise`, chosen with a weight out of 100.
struct Map {
    a: f64,
    b: f64,
    c: f64,
    d: f64,
    rise: f64,
    weight: u64,
}

/// Michael Barnsley's fern: stem, the smaller frond above, left leaflet, right leaflet.
const MAPS: [Map; 4] = [
    Map { a: 0.0, b: 0.0, c: 0.0, d: 0.16, rise: 0.0, weight: 1 },
    Map { a: 0.85, b: 0.04, c: -0.04, d: 0.85, rise: 1.6, weight: 85 },
    Map { a: 0.20, b: -0.26, c: 0.23, d: 0.22, rise: 1.6, weight: 7 },
    Map { a: -0.15, b: 0.28, c: 0.26, d: 0.24, rise: 0.44, weight: 7 },
];

/// Points plotted.
const POINTS: u32 = 12_000_000;

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
        (x, y) = (map.a * x + map.b * y, map.c * x + map.d * y + map.rise);
        // The attractor lies in -2.2..2.7 by 0..10; a margin of a few texels keeps the border transparent.
        let column = (x + 2.9) / 6.2 * f64::from(SIZE);
        let row = (10.3 - y) / 10.6 * f64::from(SIZE);
        if let Some(texel) = texels.get_mut(row as usize * size + column as usize) {
            *texel = 255;
        }
    }
    texels
}

/// Closes the gaps between points and gives the frond a soft edge, as a filtered texture has: a 5 by 5 box, then amplified.
fn soften(texels: &[u8]) -> Vec<u8> {
    let size = SIZE as usize;
    let at = |row: usize, column: usize| u32::from(texels[row * size + column]);
    let mut soft = vec![0; texels.len()];
    for row in 2..size - 2 {
        for column in 2..size - 2 {
            let mut sum = 0;
            for neighbour_row in row - 2..=row + 2 {
                for neighbour_column in column - 2..=column + 2 {
                    sum += at(neighbour_row, neighbour_column);
                }
            }
            soft[row * size + column] = (sum * 2 / 25).min(255) as u8;
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
