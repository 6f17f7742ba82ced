//! Lists the scenarios under `spec-tests/`, so that their texts become part of the library.

use std::error::Error;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// The folder of scenarios, seen from the crate.
const FOLDER: &str = "../../spec-tests";

fn main() -> Result<(), Box<dyn Error>> {
    let variable = |name: &str| env::var_os(name).map(PathBuf::from).ok_or_else(|| format!("{name} is not set"));
    let (root, out) = (variable("CARGO_MANIFEST_DIR")?, variable("OUT_DIR")?);
    let mut names = Vec::new();
    list(&root.join(FOLDER), "", &mut names)?;
    names.sort();
    let mut list = String::from("&[\n");
    for name in names {
        writeln!(list, "    ({name:?}, include_str!(concat!(env!(\"CARGO_MANIFEST_DIR\"), \"/{FOLDER}/{name}\"))),")?;
    }
    fs::write(out.join("scenarios.rs"), list + "]\n")?;
    // What cargo reads from a build script is what it prints. The folder stands for all that is below it.
    #[allow(clippy::print_stdout)]
    {
        println!("cargo::rerun-if-changed={FOLDER}");
    }
    Ok(())
}

/// Adds the scenarios below a folder, by their paths with slashes.
fn list(folder: &Path, below: &str, names: &mut Vec<String>) -> Result<(), Box<dyn Error>> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name().into_string().map_err(|name| format!("{} is not text", name.display()))?;
        let name = format!("{below}{name}");
        if entry.file_type()?.is_dir() {
            list(&entry.path(), &format!("{name}/"), names)?;
        } else if name.ends_with(".ron") {
            names.push(name);
        }
    }
    Ok(())
}
