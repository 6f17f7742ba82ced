//! The options of `omm bake` about the images of a glTF file.

use clap::{Args, ValueEnum};
use omm_bake::MipChoice;
use omm_bake::image::{BlockDecoding, Channel, ImageOptions};

/// Arguments about images.
#[derive(Debug, Args)]
#[command(next_help_heading = "Images")]
pub(super) struct Images {
    /// Which channel of a glTF file's images is alpha.
    #[arg(long, value_name = "CHANNEL", default_value = "alpha")]
    channel: ChannelArgument,
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
    /// Both: known is what both make of the file.
    All,
}

impl Images {
    /// What is read of an image of whose mips these are wanted: only the largest if that is not said.
    pub(super) fn options(&self, mips: Option<MipChoice>) -> ImageOptions {
        let channel = match self.channel {
            ChannelArgument::Red => Channel::Red,
            ChannelArgument::Green => Channel::Green,
            ChannelArgument::Blue => Channel::Blue,
            ChannelArgument::Alpha => Channel::Alpha,
        };
        let block_decoding = match self.block_decoding {
            BlockDecodingArgument::Specification => BlockDecoding::Specification,
            BlockDecodingArgument::Nvidia => BlockDecoding::Nvidia,
            BlockDecodingArgument::All => BlockDecoding::All,
        };
        let last_mip = match mips {
            Some(MipChoice::Range { last, .. }) => last,
            _ => 0,
        };
        ImageOptions { channel, last_mip, block_decoding }
    }
}
