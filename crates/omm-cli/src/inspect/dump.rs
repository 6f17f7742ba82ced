//! Every byte of serialized data or of a bundle with its name.

use std::io::{self, Write};

use omm_serialize::Field;
use serde::Serialize;

use crate::error::{CliError, Outcome};
use crate::output;

/// Bytes in a line.
const LINE: usize = 16;

/// Gives every field of some bytes to what it is lent.
pub(crate) type Fields<'v> = &'v mut dyn FnMut(Field);

/// Prints all fields of `bytes` and whether they end with it.
pub(crate) fn print(bytes: &[u8], describe: impl FnOnce(Fields<'_>)) -> Result<Outcome, CliError> {
    let mut whole = true;
    output::print(|out| {
        let (mut end, mut result) = (0, Ok(()));
        describe(&mut |field| {
            whole &= field.offset == end;
            end = field.offset.saturating_add(field.size);
            if result.is_ok() {
                result = print_field(bytes, &field, out);
            }
        });
        result?;
        whole &= end == bytes.len() as u64;
        writeln!(out, "{end:08x}: end; every byte of {} was named: {whole}", bytes.len())
    })?;
    Ok(if whole { Outcome::Clean } else { Outcome::Violations })
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
pub(crate) struct Row {
    offset: u64,
    size: u64,
    name: String,
    value: String,
}

/// All fields of some bytes.
pub(crate) fn rows(describe: impl FnOnce(Fields<'_>)) -> Vec<Row> {
    let mut rows = Vec::new();
    describe(&mut |Field { offset, size, name, value }| rows.push(Row { offset, size, name, value }));
    rows
}
