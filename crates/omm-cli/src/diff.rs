//! `omm diff`: how two serialized structures or two bundles differ, in words.

use std::collections::HashMap;
use std::io::Write;
use std::path::PathBuf;

use clap::Args;
use omm_serialize::{Blob, Field};
use serde::Serialize;

use crate::bundle;
use crate::cli::Format;
use crate::error::{CliError, Outcome};
use crate::inspect;
use crate::output;

/// Arguments of `omm diff`.
#[derive(Debug, Args)]
#[command(after_help = HELP)]
pub(crate) struct DiffArgs {
    /// Serialized data.
    a: PathBuf,
    /// Serialized data to hold against it.
    b: PathBuf,
}

/// One thing that differs.
#[derive(Debug, Serialize)]
struct Difference {
    /// The part: a field of the header, a reference, or a part of the payload.
    what: String,
    /// What is there in the first; nothing if it lacks the part.
    a: Option<String>,
    /// What is there in the second.
    b: Option<String>,
}

/// Runs `omm diff`.
pub(crate) fn run(args: &DiffArgs, format: Format) -> Result<Outcome, CliError> {
    let DiffArgs { a, b } = args;
    if bundle::is_bundle(a)? && bundle::is_bundle(b)? {
        return bundle::diff(a, b, format);
    }
    let (a_bytes, b_bytes) = (inspect::load(a)?, inspect::load(b)?);
    let differences = compare(&a_bytes, &inspect::read(a, &a_bytes)?.0, &b_bytes, &inspect::read(b, &b_bytes)?.0);
    match format {
        Format::Text => output::print(|out| print(&differences, out))?,
        Format::Json => output::print_json(&differences)?,
    }
    Ok(if differences.is_empty() { Outcome::Clean } else { Outcome::Violations })
}

fn print(differences: &[Difference], out: &mut dyn Write) -> std::io::Result<()> {
    for Difference { what, a, b } in differences {
        match (a, b) {
            (Some(a), Some(b)) => writeln!(out, "{what}: {a} in the first, {b} in the second")?,
            (Some(a), None) => writeln!(out, "{what}: {a} in the first, absent from the second")?,
            (None, Some(b)) => writeln!(out, "{what}: absent from the first, {b} in the second")?,
            (None, None) => writeln!(out, "{what}")?,
        }
    }
    match differences.len() {
        0 => writeln!(out, "no difference"),
        1 => writeln!(out, "1 difference"),
        count => writeln!(out, "{count} differences"),
    }
}

/// All fields that differ, in the order of the first and then those that only the second has.
fn compare(a_bytes: &[u8], a: &Blob<'_>, b_bytes: &[u8], b: &Blob<'_>) -> Vec<Difference> {
    let mut differences = Vec::new();
    if a.order() != b.order() {
        let text = |blob: &Blob<'_>| Some(blob.order().to_string());
        differences.push(Difference { what: "byte order".to_owned(), a: text(a), b: text(b) });
    }
    if a_bytes == b_bytes {
        return differences;
    }
    let mut others = HashMap::new();
    let mut order = Vec::new();
    b.describe(&mut |field| {
        order.push(field.name.clone());
        others.insert(field.name.clone(), field);
    });
    // The order of the bytes was reported; so numbers are compared as such.
    let same_order = a.order() == b.order();
    a.describe(&mut |field| match others.remove(&field.name) {
        None => differences.push(Difference { what: field.name, a: Some(field.value), b: None }),
        Some(other) => {
            let (a, b) = (bytes_of(a_bytes, &field), bytes_of(b_bytes, &other));
            let opaque = same_order || field.name == "payload";
            if field.value != other.value {
                differences.push(Difference { what: field.name, a: Some(field.value), b: Some(other.value) });
            } else if opaque && a != b {
                differences.push(Difference { what: difference_of_bytes(&field, a, &other, b), a: None, b: None });
            }
        }
    });
    for name in order {
        if let Some(field) = others.remove(&name) {
            differences.push(Difference { what: name, a: None, b: Some(field.value) });
        }
    }
    differences
}

fn bytes_of<'a>(bytes: &'a [u8], field: &Field) -> &'a [u8] {
    let range = (usize::try_from(field.offset), usize::try_from(field.offset.saturating_add(field.size)));
    match range {
        (Ok(start), Ok(end)) => bytes.get(start..end).unwrap_or_default(),
        _ => &[],
    }
}

/// Says how the bytes of fields differ that read the same.
fn difference_of_bytes(a_field: &Field, a: &[u8], b_field: &Field, b: &[u8]) -> String {
    let name = &a_field.name;
    let count = a.iter().zip(b).filter(|(a, b)| a != b).count();
    let first = a.iter().zip(b).take_while(|(a, b)| a == b).count() as u64;
    let lengths = if a.len() == b.len() {
        format!("of {} bytes", a.len())
    } else {
        format!("of the {} bytes that both have ({} and {})", a.len().min(b.len()), a.len(), b.len())
    };
    if count == 0 {
        return format!("{name}: the same {} bytes, then only the longer goes on", a.len().min(b.len()));
    }
    let (at, other) = (a_field.offset + first, b_field.offset + first);
    let at = if at == other { format!("byte {at}") } else { format!("byte {at} of the first, {other} of the second") };
    format!("{name}: {count} {lengths} differ, the first at {at}")
}

const HELP: &str = "\
Fields of the header, references and, for the simulated device's own data, every field of the
payload are compared by name; the payload of a driver as bytes. Two bundles are compared as by
omm bundle diff.

Examples:
  omm diff before.blob after.blob
  omm diff --format json before.blob after.blob

Exit status:
  0  no difference
  1  they differ
  2  could not run: no such file, or one that does not decode";
