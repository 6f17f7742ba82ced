//! The options of `omm bake` about the images of a glTF file.

use clap::{Args, ValueEnum};
use omm_bake::image::{BlockDecoding, Channel, ImageOptions};

/// Arguments about images.
#[derive(Debug, Args)]
#[command(next_help_heading = "Images")]
pub(super) struct Images {
    /// Which channel of a glTF file's images is alpha.
    #[arg(long, value_name = "CHANNEL", default_value = "alpha")]
    channel: ChannelArgument,
    /// Which mip level of a glTF file's DDS and KTX2 images is baked.
    #[arg(long, value_name = "N", default_value_t = 0)]
    mip_level: u32,
    /// As which device the BC3, BC4 and BC5 texels of a glTF file's images are decoded.
    #[arg(long, value_name = "DEVICE", default_value = "specification")]
    block_decoding: BlockDecodingArgument,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum ChannelArgument {
    /// Red, or grey.
    #[value(alias = "r")]
    Red,
    /// Green.
    #[value(alias = "g")]
    Green,
    /// Blue.
    #[value(alias = "b")]
    Blue,
    /// Alpha.
    #[value(alias = "a")]
    Alpha,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum BlockDecodingArgument {
    /// The fractions that are specified.
    Specification,
    /// As measured on NVIDIA devices.
    Nvidia,
}

impl Images {
    /// What is read of an image.
    pub(super) const fn options(&self) -> ImageOptions {
        let channel = match self.channel {
            ChannelArgument::Red => Channel::Red,
            ChannelArgument::Green => Channel::Green,
            ChannelArgument::Blue => Channel::Blue,
            ChannelArgument::Alpha => Channel::Alpha,
        };
        let block_decoding = match self.block_decoding {
            BlockDecodingArgument::Specification => BlockDecoding::Specification,
            BlockDecodingArgument::Nvidia => BlockDecoding::Nvidia,
        };
        ImageOptions { channel, mip_level: self.mip_level, block_decoding }
    }
}
