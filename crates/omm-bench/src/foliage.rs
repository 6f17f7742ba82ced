//! A texture of leaves, from arithmetic alone: the same bytes on every machine.

/// A generator of numbers, splitmix64.
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number in 0..1, a multiple of 2^-24.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 40) as f64 / 16_777_216.0
    }

    /// A direction: a point of the unit circle, all of which can come up. Twice the angle whose tangent is t has cosine
    /// (1 - t²)/(1 + t²) and sine 2t/(1 + t²).
    pub fn direction(&mut self) -> (f64, f64) {
        let t = 2.0 * self.unit() - 1.0;
        let (cosine, sine) = ((1.0 - t * t) / (1.0 + t * t), 2.0 * t / (1.0 + t * t));
        if self.bits() & 1 == 0 { (cosine, sine) } else { (-cosine, -sine) }
    }
}

/// A leaf between two arcs, its halves cut into teeth.
struct Leaf {
    /// Centre, 0..1.
    at: (f64, f64),
    direction: (f64, f64),
    /// Half the length and half the width, in textures.
    length: f64,
    width: f64,
    teeth: f64,
}

impl Leaf {
    fn random(random: &mut Random) -> Self {
        let length = 0.03 + 0.07 * random.unit();
        Self {
            at: (random.unit(), random.unit()),
            direction: random.direction(),
            length,
            width: length * (0.25 + 0.2 * random.unit()),
            teeth: 4.0 + 6.0 * random.unit(),
        }
    }

    /// About how far inside the outline a point is that lies (`x`, `y`) from the centre, in textures.
    fn depth(&self, x: f64, y: f64) -> f64 {
        let (along, across) =
            (x * self.direction.0 + y * self.direction.1, (y * self.direction.0 - x * self.direction.1).abs());
        let t = along / self.length;
        let saw = t * self.teeth;
        let tooth = 0.8 + 0.2 * (saw - saw.floor());
        self.width * (1.0 - t * t) * tooth - across
    }
}

/// How many leaves there are.
const LEAVES: usize = 90;

/// The alpha of `side` x `side` texels: leaves scattered over a transparent ground, seamless, their outlines one texel soft.
#[must_use]
pub fn alpha(side: u32) -> Vec<u8> {
    let mut random = Random(0x1eaf);
    let size = f64::from(side);
    let mut texels = vec![0_u8; side as usize * side as usize];
    for _ in 0..LEAVES {
        let leaf = Leaf::random(&mut random);
        let reach = (leaf.length * size) as i64 + 2;
        let centre = ((leaf.at.0 * size) as i64, (leaf.at.1 * size) as i64);
        for j in centre.1 - reach..=centre.1 + reach {
            for i in centre.0 - reach..=centre.0 + reach {
                let (x, y) = ((i as f64 + 0.5) / size - leaf.at.0, (j as f64 + 0.5) / size - leaf.at.1);
                let value = (leaf.depth(x, y) * size * 255.0 + 127.5).clamp(0.0, 255.0) as u8;
                let (column, row) = (i.rem_euclid(side.into()), j.rem_euclid(side.into()));
                let texel = &mut texels[row as usize * side as usize + column as usize];
                *texel = value.max(*texel);
            }
        }
    }
    texels
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Part ground, part leaf, little between; and always the same.
    #[test]
    fn leaves() {
        let texels = alpha(256);
        let count = |of: fn(u8) -> bool| texels.iter().filter(|&&value| of(value)).count() as f64 / 65_536.0;
        assert!((0.2..0.6).contains(&count(|value| value > 127)));
        assert!((0.01..0.15).contains(&count(|value| value > 0 && value < 255)));
        let sum = texels.iter().fold(0_u64, |sum, &value| sum.wrapping_mul(31).wrapping_add(value.into()));
        assert_eq!(sum, alpha(256).iter().fold(0_u64, |sum, &v| sum.wrapping_mul(31).wrapping_add(v.into())));
    }

    #[test]
    fn directions_have_length_one() {
        let mut random = Random(1);
        for _ in 0..100 {
            let (x, y) = random.direction();
            assert!((x * x + y * y - 1.0).abs() < 1e-12);
        }
    }
}
