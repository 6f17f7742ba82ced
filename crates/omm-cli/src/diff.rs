//! `omm diff`: how two serialized structures or two bundles differ, in words.

use std::cell::RefCell;
use std::collections::{HashMap, VecDeque};
use std::io::Write;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, sync_channel};
use std::thread::{self, Scope};

use clap::Args;
use omm_serialize::{Blob, ByteOrder, Field};
use serde::{Serialize, Serializer};

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
    let (a, b) = (inspect::read(a, &a_bytes)?.0, inspect::read(b, &b_bytes)?.0);
    thread::scope(|scope| {
        let (a, b) = (Side::new(scope, &a_bytes, a), Side::new(scope, &b_bytes, b));
        let mut differences = Differences::new(a, b);
        match format {
            Format::Text => output::print(|out| print(&mut differences, out))?,
            Format::Json => output::print_json(&Sequence(RefCell::new(&mut differences)))?,
        }
        Ok(if differences.count == 0 { Outcome::Clean } else { Outcome::Violations })
    })
}

fn print(differences: &mut Differences<'_>, out: &mut dyn Write) -> std::io::Result<()> {
    for Difference { what, a, b } in differences.by_ref() {
        match (a, b) {
            (Some(a), Some(b)) => writeln!(out, "{what}: {a} in the first, {b} in the second")?,
            (Some(a), None) => writeln!(out, "{what}: {a} in the first, absent from the second")?,
            (None, Some(b)) => writeln!(out, "{what}: absent from the first, {b} in the second")?,
            (None, None) => writeln!(out, "{what}")?,
        }
    }
    match differences.count {
        0 => writeln!(out, "no difference"),
        1 => writeln!(out, "1 difference"),
        count => writeln!(out, "{count} differences"),
    }
}

/// Differences written as they are found.
struct Sequence<'a, 'b>(RefCell<&'a mut Differences<'b>>);

impl Serialize for Sequence<'_, '_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.borrow_mut().by_ref())
    }
}

/// One of the two.
struct Side<'a> {
    bytes: &'a [u8],
    order: ByteOrder,
    /// Its fields as another thread describes them, which waits when nobody takes them.
    fields: Receiver<Field>,
    /// Fields that the other has not had yet.
    waiting: HashMap<String, Field>,
}

impl<'a> Side<'a> {
    fn new<'scope>(scope: &'scope Scope<'scope, '_>, bytes: &'a [u8], blob: Blob<'scope>) -> Self {
        let (send, fields) = sync_channel(1 << 10);
        let order = blob.order();
        // Nobody listens any more once the output is closed.
        scope.spawn(move || blob.describe(&mut |field| drop(send.send(field))));
        Self { bytes, order, fields, waiting: HashMap::new() }
    }

    /// The fields that the other never had, in the order of the bytes.
    fn rest(&mut self) -> Vec<Field> {
        let mut rest: Vec<_> = self.waiting.drain().map(|(_, field)| field).collect();
        rest.sort_by_key(|field| field.offset);
        rest
    }
}

/// All that differs.
///
/// Both are walked at the same pace and only fields that one of them has and the other has not (yet) are kept: no more than are
/// reported in the end.
struct Differences<'a> {
    a: Side<'a>,
    b: Side<'a>,
    found: VecDeque<Difference>,
    /// How many were handed out.
    count: u64,
}

impl<'a> Differences<'a> {
    fn new(a: Side<'a>, b: Side<'a>) -> Self {
        let mut found = VecDeque::new();
        if a.order != b.order {
            let text = |side: &Side<'_>| Some(side.order.to_string());
            found.push_back(Difference { what: "byte order".to_owned(), a: text(&a), b: text(&b) });
        }
        Self { a, b, found, count: 0 }
    }

    /// Takes the next field of both; `false` if there is none.
    fn step(&mut self) -> bool {
        match (self.a.fields.recv().ok(), self.b.fields.recv().ok()) {
            (None, None) => return false,
            (Some(a), Some(b)) if a.name == b.name => self.compare(a, b),
            (a, b) => {
                if let Some(a) = a {
                    match self.b.waiting.remove(&a.name) {
                        Some(b) => self.compare(a, b),
                        None => drop(self.a.waiting.insert(a.name.clone(), a)),
                    }
                }
                if let Some(b) = b {
                    match self.a.waiting.remove(&b.name) {
                        Some(a) => self.compare(a, b),
                        None => drop(self.b.waiting.insert(b.name.clone(), b)),
                    }
                }
            }
        }
        true
    }

    /// Compares two fields of one name.
    fn compare(&mut self, a: Field, b: Field) {
        let (a_bytes, b_bytes) = (bytes_of(self.a.bytes, &a), bytes_of(self.b.bytes, &b));
        // The order of the bytes was reported; so numbers are compared as such.
        let opaque = self.a.order == self.b.order || a.name == "payload";
        if a.value != b.value {
            self.found.push_back(Difference { what: a.name, a: Some(a.value), b: Some(b.value) });
        } else if opaque && a_bytes != b_bytes {
            let what = difference_of_bytes(&a, a_bytes, &b, b_bytes);
            self.found.push_back(Difference { what, a: None, b: None });
        }
    }
}

impl Iterator for Differences<'_> {
    type Item = Difference;

    fn next(&mut self) -> Option<Difference> {
        while self.found.is_empty() && self.step() {}
        if self.found.is_empty() {
            let only_a = self.a.rest().into_iter();
            let only_b = self.b.rest().into_iter();
            self.found.extend(only_a.map(|Field { name, value, .. }| Difference {
                what: name,
                a: Some(value),
                b: None,
            }));
            self.found.extend(only_b.map(|Field { name, value, .. }| Difference {
                what: name,
                a: None,
                b: Some(value),
            }));
        }
        let difference = self.found.pop_front()?;
        self.count += 1;
        Some(difference)
    }
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
