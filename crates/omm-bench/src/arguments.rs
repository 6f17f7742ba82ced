//! The arguments that the programs share.

use clap::{Args, ValueEnum};

/// How often is measured, and how results are printed.
#[derive(Clone, Copy, Debug, Args)]
pub struct Common {
    /// How results are printed.
    #[arg(long, value_enum, default_value = "text")]
    pub format: Format,
    /// How often each of two is measured, in turns; the fastest round counts.
    #[arg(long, default_value_t = 5)]
    pub rounds: u32,
}

/// How results are printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// A table for people.
    Text,
    /// One JSON document.
    Json,
}
