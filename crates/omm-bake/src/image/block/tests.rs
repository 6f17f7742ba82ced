//! Every decoder against a second construction: the specification's sentences in rational arithmetic, written the other way round,
//! or another library.

use proptest::prelude::*;

use super::*;

const CHANNELS: [Channel; 4] = [Channel::Red, Channel::Green, Channel::Blue, Channel::Alpha];

fn options(channel: Channel) -> ImageOptions {
    ImageOptions { channel, ..ImageOptions::default() }
}

/// The 16 texels of a block, decoded as a texture of 4 x 4.
fn alphas(format: BlockFormat, channel: Channel, block: &[u8]) -> [f64; 16] {
    let texture = texture(format, 4, 4, options(channel), block).unwrap();
    std::array::from_fn(|texel| texture.alpha(texel as u32 % 4, texel as u32 / 4).unwrap())
}

/// A half block of BC3 alpha or BC4 whose texels have the codes 0 to 7, twice.
pub(super) fn all_codes(a: u8, b: u8) -> [u8; 8] {
    let bits = (0..16_u64).fold(0, |bits, texel| bits | ((texel % 8) << (3 * texel)));
    let [c, d, e, f, g, h, ..] = bits.to_le_bytes();
    [a, b, c, d, e, f, g, h]
}

/// All 65,536 pairs of ends: the positions of the eight values between the ends, as the specification lists them.
#[test]
fn interpolated_alpha_of_all_ends() {
    for (a, b) in (0..=255_u8).flat_map(|a| (0..=255_u8).map(move |b| (a, b))) {
        let [low, high] = [a, b].map(f64::from);
        let blend = |of: f64, part: f64| (low + (high - low) * part / of) / 255.0;
        let expected = if a > b {
            [
                blend(7.0, 0.0),
                blend(7.0, 7.0),
                blend(7.0, 1.0),
                blend(7.0, 2.0),
                blend(7.0, 3.0),
                blend(7.0, 4.0),
                blend(7.0, 5.0),
                blend(7.0, 6.0),
            ]
        } else {
            [
                blend(5.0, 0.0),
                blend(5.0, 5.0),
                blend(5.0, 1.0),
                blend(5.0, 2.0),
                blend(5.0, 3.0),
                blend(5.0, 4.0),
                0.0,
                1.0,
            ]
        };
        let block = all_codes(a, b);
        let found = interpolated(&block, unsigned_ends);
        for (texel, (&found, expected)) in found.iter().zip(expected.iter().cycle()).enumerate() {
            let found = f64::from(found) / f64::from(255 * SEVENTHS_AND_FIFTHS);
            assert!((found - expected).abs() < 1e-12, "{a} {b} texel {texel}: {found} {expected}");
        }
        if a % 16 == 0 && b % 5 == 0 {
            // The same through the texture, whose floats are the nearest.
            let through = alphas(BlockFormat::Bc4 { signed: false }, Channel::Red, &block);
            let near = |(&found, &expected): (&f64, &f64)| (found - expected).abs() <= expected / 16_777_216.0;
            assert!(through.iter().zip(expected.iter().cycle()).all(near), "{a} {b}");
            assert_eq!(alphas(BlockFormat::Bc3, Channel::Alpha, &[block, [0; 8]].concat()), through);
        }
    }
}

#[test]
fn whole_255ths_stay_bytes_and_others_do_not() {
    let texture =
        |a, b| texture(BlockFormat::Bc4 { signed: false }, 4, 4, options(Channel::Red), &all_codes(a, b)).unwrap();
    // Sevenths of 7 are whole; those of 255 are not, but fifths of it are.
    assert!(texture(7, 0).is_integral() && texture(0, 255).is_integral() && !texture(255, 0).is_integral());
    assert_eq!(texture(255, 0).alpha(2, 0), Some(f64::from(6.0_f32 / 7.0)));
}

#[test]
fn as_which_device_is_a_choice() {
    let value = |block_decoding, format, channel| {
        let options = ImageOptions { channel, block_decoding, ..ImageOptions::default() };
        let block = [all_codes(0, 255), all_codes(0, 255)].concat();
        texture(format, 4, 4, options, &block).unwrap().alpha(3, 0).unwrap()
    };
    let (bc3, bc5) = (BlockFormat::Bc3, BlockFormat::Bc5 { signed: false });
    let (nvidia, fractions) = (BlockDecoding::Nvidia, BlockDecoding::Specification);
    assert_eq!(value(fractions, bc3, Channel::Alpha), 0.4);
    assert_eq!(value(nvidia, bc3, Channel::Alpha), 96.0 / 255.0);
    assert_eq!(value(nvidia, bc5, Channel::Green), f64::from(24_480.0_f32 / 65_535.0));
    assert_eq!(value(nvidia, bc3, Channel::Red), value(fractions, bc3, Channel::Red));
    let both = |channel| {
        let options = ImageOptions { channel, block_decoding: BlockDecoding::All, ..ImageOptions::default() };
        texture(bc3, 4, 4, options, &[all_codes(0, 255), all_codes(0, 255)].concat()).unwrap()
    };
    assert_eq!(both(Channel::Alpha).alpha(3, 0), Some(0.4));
    assert_eq!(both(Channel::Alpha).readings()[0].alpha(3, 0), Some(96.0 / 255.0));
    assert!(both(Channel::Red).readings().is_empty(), "nothing else was measured");
}

#[test]
fn signed_ends_run_from_minus_one_to_one() {
    let signed = |a: i8, b: i8| {
        let block = all_codes(a.cast_unsigned(), b.cast_unsigned());
        alphas(BlockFormat::Bc4 { signed: true }, Channel::Red, &block)
    };
    assert_eq!(signed(-127, 127)[..2], [-1.0, 1.0]);
    // As many ends as 127 and -128 reach one less than a byte does.
    assert_eq!(signed(127, -128)[..2], [1.0, -1.0]);
    assert_eq!(signed(-128, 0)[6..8], [-1.0, 1.0]);
    assert_eq!(signed(127, -127)[2], f64::from((5.0_f64 / 7.0) as f32));
    let two = [all_codes(1, 2), all_codes(127, 0)].concat();
    assert_eq!(alphas(BlockFormat::Bc5 { signed: true }, Channel::Green, &two)[0], 1.0);
}

#[test]
fn explicit_and_punch_through_alpha() {
    let block: [u8; 16] =
        std::array::from_fn(|byte| if byte < 8 { ((2 * byte) | ((2 * byte + 1) << 4)) as u8 } else { 0 });
    let fifteenths = alphas(BlockFormat::Bc2, Channel::Alpha, &block).map(|alpha| (alpha * 15.0).round());
    assert_eq!(fifteenths, std::array::from_fn(|texel| texel as f64));
    // Colour 0 is not above colour 1: three colours and black.
    let bits = [0b11_10_01_00; 4];
    let three = [[0, 0, 1, 0], bits].concat();
    let four = [[1, 0, 0, 0], bits].concat();
    let with = |block| alphas(BlockFormat::Bc1 { punch_through: true }, Channel::Alpha, block);
    assert_eq!(with(&three)[..4], [1.0, 1.0, 1.0, 0.0]);
    assert_eq!(with(&four), [1.0; 16]);
    assert_eq!(alphas(BlockFormat::Bc1 { punch_through: false }, Channel::Alpha, &three), [1.0; 16]);
    for opaque in
        [BlockFormat::Bc4 { signed: true }, BlockFormat::Bc5 { signed: false }, BlockFormat::Bc6h { signed: true }]
    {
        assert_eq!(alphas(opaque, Channel::Alpha, &[77; 16][..opaque.bytes()]), [1.0; 16]);
    }
}

/// A writer of bits, the lowest first.
#[derive(Default)]
struct Bits(u128, u32);

impl Bits {
    fn put(mut self, value: u32, bits: u32) -> Self {
        self.0 |= u128::from(value) << self.1;
        self.1 += bits;
        self
    }
}

/// The weights, in 64ths, of 4-bit indices of BC7.
const WEIGHTS_4: [i32; 16] = [0, 4, 9, 13, 17, 21, 26, 30, 34, 38, 43, 47, 51, 55, 60, 64];

/// BC7 mode 6: one subset, ends of 7 bits and a shared lowest bit, 4-bit indices.
#[test]
fn bc7_alpha_of_mode_6() {
    for (first, second, p, q) in (0..128_u32).flat_map(|a| [0_u32, 1, 63, 127].map(|b| (a, b, a & 1, b >> 6))) {
        // The first index has no highest bit: 0 to 7.
        let head = Bits::default().put(1 << 6, 7);
        let colours = (0..6).fold(head, |bits, _| bits.put(0, 7));
        let ends = colours.put(first, 7).put(second, 7).put(p, 1).put(q, 1).put(0, 3);
        let block = (1..16).fold(ends, |bits, index| bits.put(index, 4));
        assert_eq!(block.1, 128);
        let [low, high] = [((first << 1) | p) as i32, ((second << 1) | q) as i32];
        let expected = WEIGHTS_4.map(|weight| f64::from(((64 - weight) * low + weight * high + 32) >> 6) / 255.0);
        assert_eq!(alphas(BlockFormat::Bc7, Channel::Alpha, &block.0.to_le_bytes()), expected, "{first} {second}");
    }
}

/// BC7 mode 5: alpha of 8 bits with 2-bit indices of its own, and a rotation that may put it in another channel.
#[test]
fn bc7_alpha_of_mode_5_with_rotation() {
    const WEIGHTS_2: [i32; 4] = [0, 21, 43, 64];
    for (rotation, channel) in [(0, Channel::Alpha), (1, Channel::Red), (2, Channel::Green), (3, Channel::Blue)] {
        for (first, second) in (0..=255_u32).map(|a| (a, (a * 7 + 3) & 255)) {
            let head = Bits::default().put(1 << 5, 6).put(rotation, 2);
            let ends = (0..6).fold(head, |bits, _| bits.put(0, 7)).put(first, 8).put(second, 8);
            let colours = (0..31).fold(ends, |bits, _| bits.put(0, 1));
            let block = (1..16).fold(colours.put(0, 1), |bits, texel| bits.put(texel % 4, 2));
            assert_eq!(block.1, 128);
            let [low, high] = [first, second].map(|end| end as i32);
            let value = |weight: i32| f64::from(((64 - weight) * low + weight * high + 32) >> 6) / 255.0;
            let expected = std::array::from_fn(|texel| value(WEIGHTS_2[texel % 4]));
            assert_eq!(alphas(BlockFormat::Bc7, channel, &block.0.to_le_bytes()), expected, "{rotation} {first}");
        }
    }
}

proptest! {
    /// BC7 in all modes, as another library decodes it.
    #[test]
    fn bc7_as_another_library_decodes_it(mut block in any::<[u8; 16]>(), mode in 0_u32..8) {
        block[0] = (block[0] >> mode | 1) << mode;
        let mut pixels = [0_u32; 16];
        texture2ddecoder::decode_bc7_block(&block, &mut pixels);
        for channel in CHANNELS {
            let found = alphas(BlockFormat::Bc7, channel, &block).map(|value| (value * 255.0).round() as u8);
            // Stored as blue, green, red, alpha.
            let place = [2, 1, 0, 3][channel as usize];
            prop_assert_eq!(found, pixels.map(|pixel| pixel.to_le_bytes()[place]), "{:?}", channel);
        }
    }

    /// Colours of BC1 and BC3 are what libraries round to 8 bits, within what that rounding can be.
    #[test]
    fn colours_as_another_library_decodes_them(block in any::<[u8; 16]>()) {
        let mut pixels = [0_u32; 16];
        texture2ddecoder::decode_bc1_block(&block[8..], &mut pixels);
        for channel in [Channel::Red, Channel::Green, Channel::Blue] {
            let place = [2, 1, 0, 3][channel as usize];
            let found = alphas(BlockFormat::Bc1 { punch_through: true }, channel, &block[8..]);
            for (found, pixel) in found.iter().zip(pixels) {
                prop_assert!((found * 255.0 - f64::from(pixel.to_le_bytes()[place])).abs() < 1.5);
            }
        }
    }

    /// No block of BC6H holds an infinity or a NaN.
    #[test]
    fn any_bc6h_block_is_finite(block in any::<[u8; 16]>(), signed in any::<bool>()) {
        for channel in CHANNELS {
            let found = alphas(BlockFormat::Bc6h { signed }, channel, &block);
            prop_assert!(found.iter().all(|value| value.is_finite()));
        }
    }

    /// Texels outside of a level that is no multiple of 4 are left out, and the others are where they belong.
    #[test]
    fn sizes_that_are_no_multiple_of_4(width in 1_u32..11, height in 1_u32..11) {
        let across = width.div_ceil(4);
        let blocks: Vec<u8> = (0..across * height.div_ceil(4)).flat_map(|n| [n as u8, 255, 0, 0, 0, 0, 0, 0]).collect();
        let texture = texture(BlockFormat::Bc4 { signed: false }, width, height, options(Channel::Red), &blocks).unwrap();
        for (x, y) in (0..width).flat_map(|x| (0..height).map(move |y| (x, y))) {
            let number = y / 4 * across + x / 4;
            prop_assert_eq!(texture.alpha(x, y), Some(f64::from(number) / 255.0));
        }
    }
}
