//! What the readers of files share: reading a file that is one, and names that are safe as file names.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The bytes of the regular file at `path`.
///
/// Devices and pipes, which may have no end, are refused, and no more is read than the file's size promises.
pub(crate) fn read(path: &Path) -> io::Result<Vec<u8>> {
    let (file, length) = open(path)?;
    let mut bytes = Vec::new();
    file.take(length).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The regular file at `path` and its size.
pub(crate) fn open(path: &Path) -> io::Result<(File, u64)> {
    // The kind is asked before opening: to open a pipe is to wait for its other end.
    if !path.metadata()?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a regular file"));
    }
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    Ok((file, length))
}

/// Longest name that [`safe_name`] gives, in characters.
const LONGEST: usize = 100;

/// `name` as the start of a file name: whatever is not a letter, a digit, `-`, `_` or `.` becomes `_`, as does a leading dot.
pub(crate) fn safe_name(name: &str) -> String {
    let safe = |(position, c): (usize, char)| match c {
        '.' if position == 0 => '_',
        '-' | '_' | '.' => c,
        _ if c.is_alphanumeric() => c,
        _ => '_',
    };
    name.chars().take(LONGEST).enumerate().map(safe).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_hold_no_separators() {
        assert_eq!(safe_name("Árvore 2.5-b"), "Árvore_2.5-b");
        assert_eq!(safe_name("../../etc/passwd"), "_._.._etc_passwd");
        assert_eq!(safe_name("a\\b:c\0d"), "a_b_c_d");
        assert_eq!(safe_name(&"x".repeat(1000)).len(), 100);
    }

    #[test]
    fn only_regular_files_are_read() {
        let here = Path::new(env!("CARGO_MANIFEST_DIR"));
        assert_eq!(read(here).unwrap_err().to_string(), "not a regular file");
        assert!(read(&here.join("Cargo.toml")).unwrap().starts_with(b"[package]"));
        assert_eq!(read(&here.join("absent")).unwrap_err().kind(), io::ErrorKind::NotFound);
    }
}
