//! What a `uri` names: data in itself, or a file beside the glTF file.

use std::io;
use std::path::{Component, Path, PathBuf};

use super::error::{GltfError, GltfErrorKind};
use crate::files;

/// The bytes that the `uri` found at `at` in the glTF file `file` stands for.
pub(super) fn read(file: &Path, at: &str, uri: &str) -> Result<Vec<u8>, GltfError> {
    let refuse = |why| {
        let shown = uri.chars().take(60).collect();
        GltfError::new(file, at, GltfErrorKind::Uri { uri: shown, why })
    };
    if is_data(uri) {
        return data(uri.get(5..).unwrap_or_default()).map_err(refuse);
    }
    let path = beside(file, uri).map_err(refuse)?;
    files::read(&path).map_err(|error| {
        let error = io::Error::new(error.kind(), format!("{}: {error}", path.display()));
        GltfError::new(file, at, GltfErrorKind::Read(error))
    })
}

fn is_data(uri: &str) -> bool {
    uri.get(..5).is_some_and(|scheme| scheme.eq_ignore_ascii_case("data:"))
}

/// The path of the file that the `uri` found in the glTF file `file` names, if it names one.
pub(super) fn file(file: &Path, uri: &str) -> Option<PathBuf> {
    if is_data(uri) { None } else { beside(file, uri).ok() }
}

/// The path of the file that a relative URI names. It must lie in the glTF file's folder or below it.
fn beside(file: &Path, uri: &str) -> Result<PathBuf, &'static str> {
    let decoded = percent_decode(uri).ok_or("is not percent-encoded UTF-8")?;
    // Of a relative reference, a colon in the first segment would make a scheme; so would a Windows drive letter.
    if decoded.split('/').next().is_some_and(|first| first.contains(':')) {
        return Err("only data: and relative references are followed");
    }
    if decoded.contains('\0') {
        return Err("holds a zero byte");
    }
    let relative = Path::new(&decoded);
    if decoded.contains('\\') || relative.has_root() {
        return Err("is not a relative path with forward slashes");
    }
    let mut depth = 0_i64;
    for component in relative.components() {
        match component {
            Component::Normal(_) => depth += 1,
            Component::CurDir => {}
            Component::ParentDir => depth -= 1,
            Component::Prefix(_) | Component::RootDir => return Err("is not a relative path with forward slashes"),
        }
        if depth < 0 {
            return Err("leaves the folder of the glTF file");
        }
    }
    Ok(file.parent().unwrap_or(Path::new("")).join(relative))
}

/// The data of a `data:` URI from behind its scheme on: `[type][;parameter…][;base64],data`.
fn data(uri: &str) -> Result<Vec<u8>, &'static str> {
    let (header, body) = uri.split_once(',').ok_or("has no comma before its data")?;
    if header.to_ascii_lowercase().ends_with(";base64") {
        base64(body).ok_or("is not base64")
    } else {
        percent_decode_bytes(body).ok_or("is not percent-encoded")
    }
}

fn percent_decode(text: &str) -> Option<String> {
    String::from_utf8(percent_decode_bytes(text)?).ok()
}

fn percent_decode_bytes(text: &str) -> Option<Vec<u8>> {
    let mut bytes = text.bytes();
    let mut decoded = Vec::with_capacity(text.len());
    while let Some(byte) = bytes.next() {
        decoded.push(match byte {
            b'%' => {
                let mut digit = || char::from(bytes.next()?).to_digit(16);
                // Two hexadecimal digits make a byte.
                (digit()? * 16 + digit()?) as u8
            }
            _ => byte,
        });
    }
    Some(decoded)
}

/// Decodes base64 with the `+/` alphabet, padded or not.
fn base64(text: &str) -> Option<Vec<u8>> {
    let text = text.trim_end_matches('=').as_bytes();
    let mut decoded = Vec::with_capacity(text.len() / 4 * 3 + 2);
    for group in text.chunks(4) {
        let mut bits = 0_u32;
        for &digit in group {
            bits = bits << 6 | base64_digit(digit)?;
        }
        // Two digits carry one byte, three carry two, four carry three; one alone carries none.
        let bytes = match group.len() {
            4 => 3,
            3 => 2,
            2 => 1,
            _ => return None,
        };
        let aligned = bits << (8 + 6 * (4 - group.len()));
        decoded.extend(aligned.to_be_bytes().into_iter().take(bytes));
    }
    Some(decoded)
}

fn base64_digit(digit: u8) -> Option<u32> {
    Some(u32::from(match digit {
        b'A'..=b'Z' => digit - b'A',
        b'a'..=b'z' => digit - b'a' + 26,
        b'0'..=b'9' => digit - b'0' + 52,
        b'+' => 62,
        b'/' => 63,
        _ => return None,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_every_length() {
        // RFC 4648, section 10.
        for (text, bytes) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            ("Zm9vYmFy", "foobar"),
        ] {
            assert_eq!(base64(text).unwrap(), bytes.as_bytes());
            assert_eq!(base64(text.trim_end_matches('=')).unwrap(), bytes.as_bytes());
        }
        for bad in ["Z", "Zm9vY", "Zm9*", "Zm 9v"] {
            assert_eq!(base64(bad), None, "{bad}");
        }
    }

    #[test]
    fn data_uris() {
        let file = Path::new("f");
        assert_eq!(read(file, "x", "data:application/octet-stream;base64,AQID").unwrap(), [1, 2, 3]);
        assert_eq!(read(file, "x", "DATA:,a%20b").unwrap(), b"a b");
        let refused = read(file, "images[0].uri", "data:image/png;base64").unwrap_err().to_string();
        assert_eq!(refused, "f: images[0].uri: uri \"data:image/png;base64\": has no comma before its data");
    }

    #[test]
    fn files_beside_and_below() {
        let path = |uri| beside(Path::new("a/b.gltf"), uri);
        assert_eq!(path("leaf%20alpha.png"), Ok("a/leaf alpha.png".into()));
        assert_eq!(path("textures/../leaf.png"), Ok("a/textures/../leaf.png".into()));
        assert!(path("../leaf.png").is_err());
        assert!(path("t/../../leaf.png").is_err());
        assert!(path("%2e%2e/leaf.png").is_err());
        assert!(path("/etc/passwd").is_err());
        assert!(path("C:/x.png").is_err());
        assert!(path("..\\x.png").is_err());
        assert!(path("https://example.org/x.png").is_err());
        assert!(path("file:///etc/passwd").is_err());
        assert!(path("%zz").is_err());
        assert!(path("%ff").is_err());
        assert!(path("a%00b").is_err());
    }
}
