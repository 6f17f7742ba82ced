//! Every byte of serialized data with its name.

use std::io::{self, Write};

use omm_serialize::{Blob, Field};
use serde::Serialize;

/// Bytes in a line.
const LINE: usize = 16;

/// Prints all fields of `blob`, which was read from `bytes`, and whether they end with it.
pub(super) fn print(bytes: &[u8], blob: &Blob<'_>, out: &mut dyn Write) -> io::Result<bool> {
    let (mut end, mut whole, mut result) = (0, true, Ok(()));
    blob.describe(&mut |field| {
        whole &= field.offset == end;
        end = field.offset.saturating_add(field.size);
        if result.is_ok() {
            result = print_field(bytes, &field, out);
        }
    });
    result?;
    whole &= end == bytes.len() as u64;
    writeln!(out, "{end:08x}: end; every byte of {} was named: {whole}", bytes.len())?;
    Ok(whole)
}

fn print_field(bytes: &[u8], field: &Field, out: &mut dyn Write) -> io::Result<()> {
    let start = usize::try_from(field.offset).unwrap_or(usize::MAX);
    let rest = bytes.get(start..).unwrap_or_default();
    let size = usize::try_from(field.size).map_or(rest.len(), |size| size.min(rest.len()));
    let mut at = field.offset;
    for (index, line) in rest.get(..size).unwrap_or_default().chunks(LINE).enumerate() {
        write!(out, "{at:08x}:")?;
        line.iter().try_for_each(|byte| write!(out, " {byte:02x}"))?;
        if index == 0 {
            let gap = 3 * (LINE - line.len());
            write!(out, "{:gap$} | {}: {}", "", field.name, field.value)?;
        }
        writeln!(out)?;
        at += line.len() as u64;
    }
    Ok(())
}

/// One field in JSON.
#[derive(Serialize)]
pub(super) struct Row {
    offset: u64,
    size: u64,
    name: String,
    value: String,
}

/// All fields of `blob`.
pub(super) fn rows(blob: &Blob<'_>) -> Vec<Row> {
    let mut rows = Vec::new();
    blob.describe(&mut |Field { offset, size, name, value }| rows.push(Row { offset, size, name, value }));
    rows
}
