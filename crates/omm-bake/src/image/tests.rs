//! DDS and KTX2 files.

use std::io::Write;

use ddsfile::{AlphaMode, D3D10ResourceDimension, D3DFormat, Dds, DxgiFormat, NewD3dParams, NewDxgiParams};
use ktx2::{Format, Header, Index, LevelIndex, SupercompressionScheme};
use proptest::prelude::*;

use super::*;

const ALPHA: ImageOptions = options(Channel::Alpha, 0);

const fn options(channel: Channel, last_mip: u32) -> ImageOptions {
    ImageOptions { channel, last_mip, block_decoding: BlockDecoding::Specification }
}

fn dxgi(format: DxgiFormat, width: u32, height: u32, levels: u32, data: &[u8]) -> Vec<u8> {
    let mut dds = Dds::new_dxgi(NewDxgiParams {
        height,
        width,
        depth: None,
        format,
        mipmap_levels: Some(levels),
        array_layers: None,
        caps2: None,
        is_cubemap: false,
        resource_dimension: D3D10ResourceDimension::Texture2D,
        alpha_mode: AlphaMode::Straight,
    })
    .unwrap();
    dds.data = data.to_vec();
    let mut bytes = Vec::new();
    dds.write(&mut bytes).unwrap();
    bytes
}

fn d3d(format: D3DFormat, width: u32, height: u32, data: &[u8]) -> Vec<u8> {
    let params = NewD3dParams { height, width, depth: None, format, mipmap_levels: None, caps2: None };
    let mut dds = Dds::new_d3d(params).unwrap();
    dds.data = data.to_vec();
    let mut bytes = Vec::new();
    dds.write(&mut bytes).unwrap();
    bytes
}

/// A KTX2 file of the given levels, with a colour model in its descriptor.
fn ktx(format: Option<Format>, size: [u32; 2], scheme: Option<SupercompressionScheme>, levels: &[&[u8]]) -> Vec<u8> {
    let model = if format.is_none() { ktx2::ColorModel::UASTC.value() } else { 1 };
    let descriptor_at = 80 + 24 * levels.len();
    let header = Header {
        format,
        type_size: 1,
        pixel_width: size[0],
        pixel_height: size[1],
        pixel_depth: 0,
        layer_count: 0,
        face_count: 1,
        level_count: levels.len() as u32,
        supercompression_scheme: scheme,
        index: Index {
            dfd_byte_offset: descriptor_at as u32,
            dfd_byte_length: 28,
            kvd_byte_offset: 0,
            kvd_byte_length: 0,
            sgd_byte_offset: 0,
            sgd_byte_length: 0,
        },
    };
    let mut bytes = header.as_bytes().to_vec();
    let mut offset = descriptor_at as u64 + 28;
    for level in levels {
        let length = level.len() as u64;
        let index = LevelIndex { byte_offset: offset, byte_length: length, uncompressed_byte_length: length };
        bytes.extend(index.as_bytes());
        offset += length;
    }
    let mut descriptor = [0; 28];
    descriptor[12] = model;
    bytes.extend(descriptor);
    levels.iter().for_each(|level| bytes.extend(*level));
    bytes
}

fn value(bytes: &[u8], channel: Channel, mip_level: u32, x: u32) -> Option<f64> {
    let texture = read(bytes, options(channel, mip_level)).unwrap();
    texture.mip(mip_level).unwrap().alpha(x, 0).map(|value| (value * 255.0).round())
}

fn refused(bytes: &[u8], options: ImageOptions) -> String {
    read(bytes, options).unwrap_err().to_string()
}

/// BC2 alpha of 4 bits: 15 in the first texel, 0 elsewhere.
const BC2: [u8; 16] = [15, 0, 0, 0, 0, 0, 0, 0, 255, 255, 0, 0, 0, 0, 0, 0];

#[test]
fn dds_files_of_both_kinds() {
    for bytes in [
        dxgi(DxgiFormat::BC2_UNorm, 4, 4, 1, &BC2),
        dxgi(DxgiFormat::BC2_UNorm_sRGB, 4, 4, 1, &BC2),
        d3d(D3DFormat::DXT3, 4, 4, &BC2),
    ] {
        assert_eq!(
            (value(&bytes, Channel::Alpha, 0, 0), value(&bytes, Channel::Alpha, 0, 1)),
            (Some(255.0), Some(0.0))
        );
    }
    assert_eq!(value(&d3d(D3DFormat::DXT3, 4, 4, &BC2), Channel::Red, 0, 0), Some(255.0));
    let bgra = d3d(D3DFormat::A8R8G8B8, 1, 1, &[1, 2, 3, 4]);
    assert_eq!([Channel::Red, Channel::Alpha].map(|channel| value(&bgra, channel, 0, 0)), [Some(3.0), Some(4.0)]);
    assert_eq!(
        refused(&dxgi(DxgiFormat::BC2_UNorm_sRGB, 4, 4, 1, &BC2), options(Channel::Red, 0)),
        "colours of BC2_UNorm_sRGB go through the sRGB curve, which no device computes alike: choose alpha or a linear format"
    );
}

#[test]
fn mip_levels_lie_one_after_the_other() {
    // 8 x 4, 4 x 2 and 2 x 1 texels.
    let levels: Vec<u8> = [vec![10; 32], vec![20; 8], vec![30; 2]].concat();
    let dds = dxgi(DxgiFormat::R8_UNorm, 8, 4, 3, &levels);
    let ktx = ktx(Some(Format::R8_UNORM), [8, 4], None, &[&levels[..32], &levels[32..40], &levels[40..]]);
    for bytes in [dds, ktx] {
        for (level, expected) in [(0, 10.0), (1, 20.0), (2, 30.0)] {
            assert_eq!(value(&bytes, Channel::Red, level, 0), Some(expected));
        }
        let texture = read(&bytes, options(Channel::Red, 2)).unwrap();
        assert_eq!((texture.width(), texture.height(), texture.mip_count()), (8, 4, 3));
        let last = texture.mip(2).unwrap();
        assert_eq!((last.width(), last.height()), (2, 1));
        for absent in [3, u32::MAX] {
            assert_eq!(refused(&bytes, options(Channel::Red, absent)), "there is no mip level 3: the image has 3");
        }
    }
    // A claim of more levels than a size can have is no reason to read on.
    let mut all = dxgi(DxgiFormat::R8_UNorm, 8, 4, 4, &[levels.as_slice(), &[40; 9]].concat());
    // The count of levels.
    all[28..32].fill(0xff);
    assert_eq!(value(&all, Channel::Red, 3, 0), Some(40.0));
    assert_eq!(refused(&all, options(Channel::Red, u32::MAX)), "there is no mip level 4: the image has 4");
}

#[test]
fn ktx_files_plain_and_compressed() {
    let plain = ktx(Some(Format::BC2_SRGB_BLOCK), [4, 4], None, &[&BC2]);
    assert_eq!(value(&plain, Channel::Alpha, 0, 0), Some(255.0));
    let mut zlib = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    zlib.write_all(&BC2).unwrap();
    let zlib =
        ktx(Some(Format::BC2_UNORM_BLOCK), [4, 4], Some(SupercompressionScheme::ZLIB), &[&zlib.finish().unwrap()]);
    assert_eq!(value(&zlib, Channel::Alpha, 0, 0), Some(255.0));
    let level = ruzstd::encoding::CompressionLevel::Fastest;
    let frame = ruzstd::encoding::compress_to_vec(BC2.as_slice(), level);
    let zstd = |size| ktx(Some(Format::BC2_UNORM_BLOCK), size, Some(SupercompressionScheme::Zstandard), &[&frame]);
    assert_eq!(value(&zstd([4, 4]), Channel::Alpha, 0, 0), Some(255.0));
    assert!(
        refused(&zstd([16_384, 16_384]), ALPHA).contains("does not decompress to 268435456 bytes: it ends after 16")
    );
    let grey = ktx(Some(Format::R8_UNORM), [4, 1], Some(SupercompressionScheme::Zstandard), &[&frame]);
    assert!(refused(&grey, ALPHA).ends_with("does not decompress to 4 bytes: there is more"));
}

#[test]
fn what_is_not_read_is_said() {
    let basis = [ktx(None, [4, 4], None, &[&BC2]), ktx(None, [4, 4], Some(SupercompressionScheme::BasisLZ), &[&BC2])];
    for bytes in basis {
        assert!(refused(&bytes, ALPHA).contains("transcode to the format that your engine uploads"));
    }
    let astc = ktx(Some(Format::ASTC_4x4_UNORM_BLOCK), [4, 4], None, &[&BC2]);
    assert!(refused(&astc, ALPHA).starts_with("texel format ASTC_4x4_UNORM_BLOCK is not read"));
    assert!(
        refused(&dxgi(DxgiFormat::R8_UInt, 4, 1, 1, &[0; 4]), ALPHA).starts_with("texel format R8_UInt is not read")
    );
    for (field, what) in [(24, "a line"), (28, "a volume"), (32, "an array"), (36, "a cube map")] {
        let mut bytes = ktx(Some(Format::BC2_UNORM_BLOCK), [4, 4], None, &[&BC2]);
        bytes[field] = if field == 24 { 0 } else { 6 };
        assert_eq!(refused(&bytes, ALPHA), format!("the image is {what}; only single 2D textures are read"));
    }
}

/// Found by changing bytes: the library multiplies the claimed layers by the six faces of a cube.
#[test]
fn dds_layers_and_faces_are_only_claims() {
    let with = |layers: u32, faces: u8| {
        let mut bytes = dxgi(DxgiFormat::BC2_UNorm, 4, 4, 1, &BC2);
        // Miscellaneous flags and the size of the array, in the header of the newer kind.
        bytes[136] = faces;
        bytes[140..144].copy_from_slice(&layers.to_le_bytes());
        refused(&bytes, ALPHA)
    };
    assert_eq!(with(u32::MAX, 0), "the image is an array; only single 2D textures are read");
    assert_eq!(with(u32::MAX, 4), "the image is a cube map; only single 2D textures are read");
}

#[test]
fn claims_are_held_against_the_data() {
    let dds = dxgi(DxgiFormat::BC7_UNorm, 16_384, 16_384, 1, &BC2);
    assert_eq!(refused(&dds, ALPHA), "16384 x 16384 pixels are claimed, more than 16 bytes can hold");
    let ktx_size = |size| ktx(Some(Format::BC7_UNORM_BLOCK), size, None, &[&BC2]);
    assert_eq!(refused(&ktx_size([8, 8]), ALPHA), "8 x 8 pixels are claimed, more than 16 bytes can hold");
    let mut huge = dxgi(DxgiFormat::BC7_UNorm, 4, 4, 1, &BC2);
    // Height and width.
    huge[12..20].fill(0xff);
    let mut flat = dxgi(DxgiFormat::BC7_UNorm, 4, 4, 1, &BC2);
    flat[16..20].fill(0);
    assert_eq!(refused(&flat, ALPHA), "a texture of 0 x 4 texels is empty");
    for bytes in [ktx_size([u32::MAX; 2]), huge] {
        assert!(refused(&bytes, ALPHA).contains("is too large: no more than 268435456 texels are read"));
    }
    for whole in [dxgi(DxgiFormat::BC2_UNorm, 4, 4, 1, &BC2), ktx(Some(Format::BC2_UNORM_BLOCK), [4, 4], None, &[&BC2])]
    {
        for end in 0..whole.len() {
            assert!(read(&whole[..end], ALPHA).is_err(), "{end}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    /// Whatever bytes are changed, the answer is a texture or an error.
    #[test]
    fn changed_bytes_never_panic(
        which in 0_usize..5,
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
        channel in 0_usize..4,
        mip_level in prop_oneof![0_u32..3, any::<u32>()],
    ) {
        // Repeated and random bytes, so that the frame has literals and sequences.
        let grey: Vec<u8> = (0..4096_u32).map(|n| if n % 100 < 60 { (n % 7) as u8 } else { ((n * n) >> 5) as u8 & 15 }).collect();
        let frame = ruzstd::encoding::compress_to_vec(grey.as_slice(), ruzstd::encoding::CompressionLevel::Fastest);
        let zstd = Some(SupercompressionScheme::Zstandard);
        let mut bytes = match which {
            0 => dxgi(DxgiFormat::BC7_UNorm, 4, 4, 1, &BC2),
            1 => d3d(D3DFormat::DXT5, 4, 4, &BC2),
            2 => ktx(Some(Format::BC6H_SFLOAT_BLOCK), [4, 4], None, &[&BC2]),
            3 => ktx(Some(Format::R8_UNORM), [64, 64], zstd, &[&frame]),
            _ => [&[0, 0, 10, 0, 0, 0, 0, 0, 0, 0, 0, 0, 8, 0, 8, 0, 32, 8][..], &[0x9f, 1, 2, 3, 4, 0x9f, 1, 2, 3, 4]].concat(),
        };
        for (place, value) in changes {
            let place = place.index(bytes.len());
            bytes[place] = value;
        }
        let channel = [Channel::Red, Channel::Green, Channel::Blue, Channel::Alpha][channel];
        if let Ok(texture) = read(&bytes, options(channel, mip_level)) {
            prop_assert!(u64::from(texture.width()) * u64::from(texture.height()) <= MAX_TEXELS);
        }
    }
}
