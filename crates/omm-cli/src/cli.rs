//! The arguments of `omm`: what is common to all verbs. A verb's own arguments stand in the verb's file.

use clap::{Parser, Subcommand, ValueEnum};

use crate::{bake, blob, bundle, check, curve, demo, diff, downsample, explain, inspect, render, rules, run, trace};

/// Opacity micromaps: bake them, look into them, follow the bird curve, watch them save any-hit calls.
#[derive(Debug, Parser)]
#[command(name = "omm", version, after_help = HELP, disable_help_subcommand = true)]
pub(crate) struct Cli {
    /// How results are printed: for people or for programs.
    #[arg(long, global = true, value_enum, default_value_t)]
    pub(crate) format: Format,
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// How results are printed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Lines and tables for people.
    #[default]
    Text,
    /// One JSON document.
    Json,
}

/// The verbs.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// The whole path from an alpha texture to traced rays, as a summary and two pictures.
    Demo(demo::DemoArgs),
    /// Pictures of a scene, with and without opacity micromaps.
    Render(render::RenderArgs),
    /// Bake opacity micromaps for a glTF file or a job file.
    Bake(bake::BakeArgs),
    /// Lower the levels of micromaps that are baked.
    Downsample(downsample::DownsampleArgs),
    /// Follow the bird curve: barycentrics to index and back.
    Curve(curve::CurveArgs),
    /// Look into a serialized acceleration structure.
    Inspect(inspect::InspectArgs),
    /// Check micromap data against the rules, without a Vulkan device.
    Check(check::CheckArgs),
    /// Execute scenarios and print what happened.
    Run(run::RunArgs),
    /// List the rules and what is done about each.
    Rules(rules::RulesArgs),
    /// Explain a rule: what goes wrong if it is broken, and how to mend it.
    Explain(explain::ExplainArgs),
    /// Relocate what a serialized acceleration structure refers to.
    Blob(blob::BlobArgs),
    /// Say in words how two serialized acceleration structures differ.
    Diff(diff::DiffArgs),
    /// Baked micromaps in one file.
    Bundle(bundle::BundleArgs),
    /// Run, convert and minimize what an application did.
    Trace(trace::TraceArgs),
}

const HELP: &str = "\
Examples:
  omm demo --out out                      see what opacity micromaps do
  omm bake model.glb --out baked          micromaps for every alpha-masked primitive
  omm render --compare --out render.png   the same picture, fewer any-hit calls
  omm curve index --level 3 0.25 0.6      which microtriangle holds this point
  omm inspect --format json blas.blob     the header of a serialized structure
  omm check array --array a.bin --desc d.bin --index i.bin
                                          is this data what a device may be given
  omm explain 11575                       what a rule is about

Exit status:
  0  clean
  1  violations found
  2  could not run: bad arguments, bad input, or output that cannot be written";

#[cfg(test)]
mod tests {
    use clap::{Command, CommandFactory};

    use super::*;

    fn check(command: &Command, path: &str) {
        let help = command.clone().render_long_help().to_string();
        assert!(help.contains("Examples:") && help.contains("Exit status:"), "{path}: {help}");
        for verb in command.get_subcommands() {
            check(verb, &format!("{path} {}", verb.get_name()));
        }
    }

    #[test]
    fn every_help_ends_with_examples_and_exit_status() {
        let mut command = Cli::command();
        command.build();
        command.debug_assert();
        check(&Cli::command(), "omm");
    }
}
