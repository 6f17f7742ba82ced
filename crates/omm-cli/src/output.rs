//! Everything that `omm` writes: reports on the standard output, and files that appear all together or not at all.

use std::fs::{self, File};
use std::io::{self, BufWriter, Read, Write};
use std::path::{Path, PathBuf};

use image::{ImageBuffer, ImageFormat, PixelWithColorType};
use serde::Serialize;
use tempfile::TempPath;

use crate::error::CliError;

/// Lets `write` print to the standard output.
///
/// A reader that has gone away (`omm … | head`) is no error: what is left is not printed.
pub(crate) fn print(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), CliError> {
    let mut out = BufWriter::new(io::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        result => result.map_err(CliError::StandardOutput),
    }
}

/// Prints `value` as one indented JSON document.
pub(crate) fn print_json(value: &impl Serialize) -> Result<(), CliError> {
    print(|out| {
        serde_json::to_writer_pretty(&mut *out, value)?;
        out.write_all(b"\n")
    })
}

/// The bytes of the regular file at `path`, no more than its size promises.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, CliError> {
    let (file, length) = open(path)?;
    let mut bytes = Vec::new();
    file.take(length).read_to_end(&mut bytes).map_err(CliError::read(path))?;
    Ok(bytes)
}

/// Whether the regular file at `path` starts with `magic`.
pub(crate) fn starts_with(path: &Path, magic: &[u8]) -> Result<bool, CliError> {
    Ok(start(path, magic.len())? == magic)
}

/// The first bytes of the regular file at `path`, fewer than `size` if it has fewer.
pub(crate) fn start(path: &Path, size: usize) -> Result<Vec<u8>, CliError> {
    let mut start = Vec::new();
    let (file, _) = open(path)?;
    file.take(size as u64).read_to_end(&mut start).map_err(CliError::read(path))?;
    Ok(start)
}

/// The regular file at `path` and its size. Devices and pipes, which may have no end, are refused.
pub(crate) fn open(path: &Path) -> Result<(File, u64), CliError> {
    let open = || {
        // Asked before opening: to open a pipe is to wait for its other end.
        if !path.metadata()?.is_file() {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "not a regular file"));
        }
        let file = File::open(path)?;
        let length = file.metadata()?.len();
        Ok((file, length))
    };
    open().map_err(CliError::read(path))
}

/// Writes a line to the standard error, if anybody listens.
pub(crate) fn complain(line: &str) {
    // Nobody is left to be told if this fails.
    let _ = writeln!(io::stderr().lock(), "{line}");
}

/// Files of one folder that appear under their names all together in [`commit`](Self::commit), or not at all.
///
/// Until then each lies in the folder under a temporary name; dropping the set removes them, and every folder that it made.
#[derive(Debug)]
pub(crate) struct OutputSet {
    folder: PathBuf,
    /// Folders that this set made, outermost first. `None` before the first file.
    made: Option<Vec<PathBuf>>,
    /// Closed, as a process may have few files open at a time.
    files: Vec<(PathBuf, TempPath)>,
    committed: bool,
}

impl OutputSet {
    /// An empty set for `folder`, which is made (with its parents) when the first file is written.
    pub(crate) fn new(folder: &Path) -> Self {
        Self { folder: folder.into(), made: None, files: Vec::new(), committed: false }
    }

    /// An empty set for the folder in which the file `path` is to lie.
    pub(crate) fn of_file(path: &Path) -> Result<Self, CliError> {
        let named = path.file_name().ok_or_else(|| io::Error::from(io::ErrorKind::InvalidFilename));
        named.map_err(CliError::write(path))?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        Ok(Self::new(folder.unwrap_or(Path::new("."))))
    }

    /// Adds the file `path`, of whose folder this set is, with what `write` writes.
    pub(crate) fn add_file(
        &mut self,
        path: &Path,
        write: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>,
    ) -> Result<(), CliError> {
        self.add(path.file_name().unwrap_or_default(), write)
    }

    /// Adds a file `name` with what `write` writes. Where that is a link, the file that it leads to is meant.
    pub(crate) fn add(
        &mut self,
        name: impl AsRef<Path>,
        write: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>,
    ) -> Result<(), CliError> {
        self.make_folder()?;
        let path = self.folder.join(name);
        let stage = || {
            let target = replaceable(&path)?;
            // A file can only take the place of one in the same file system.
            let mut file = builder().tempfile_in(target.parent().unwrap_or(&self.folder))?;
            let mut writer = BufWriter::new(file.as_file_mut());
            write(&mut writer)?;
            writer.flush()?;
            drop(writer);
            Ok((target, file.into_temp_path()))
        };
        let staged = stage().map_err(CliError::write(&path))?;
        self.files.push(staged);
        Ok(())
    }

    /// Adds a file `name` that holds `value` as indented JSON.
    pub(crate) fn add_json(&mut self, name: &str, value: &impl Serialize) -> Result<(), CliError> {
        self.add(name, |out| {
            serde_json::to_writer_pretty(&mut *out, value)?;
            out.write_all(b"\n")
        })
    }

    /// Adds a file `name` that holds `image` as a PNG.
    pub(crate) fn add_png<P>(&mut self, name: &str, image: &ImageBuffer<P, Vec<u8>>) -> Result<(), CliError>
    where
        P: PixelWithColorType<Subpixel = u8>,
    {
        self.add(name, |out| image.write_to(out, ImageFormat::Png).map_err(io::Error::other))
    }

    /// Makes the folder and tries whether a file can be written there. Otherwise the first file does both.
    pub(crate) fn prepare(&mut self) -> Result<(), CliError> {
        self.make_folder()?;
        builder().tempfile_in(&self.folder).map(drop).map_err(CliError::write(&self.folder))
    }

    /// Gives every file its name, replacing what was there, and returns the paths in the order in which they were added.
    ///
    /// If one cannot be renamed, those renamed before it are removed again, but for those that took the place of another: what was
    /// there is gone, so that what is new stays.
    pub(crate) fn commit(mut self) -> Result<Vec<PathBuf>, CliError> {
        self.make_folder()?;
        let mut done = Vec::with_capacity(self.files.len());
        let mut new = Vec::new();
        for (path, file) in self.files.drain(..) {
            let is_new = !path.exists();
            if let Err(error) = file.persist(&path) {
                for path in &new {
                    // The first failure is the one to report.
                    let _ = fs::remove_file(path);
                }
                return Err(CliError::write(&path)(error.error));
            }
            if is_new {
                new.push(path.clone());
            }
            done.push(path);
        }
        self.committed = true;
        Ok(done)
    }

    fn make_folder(&mut self) -> Result<(), CliError> {
        if self.made.is_some() {
            return Ok(());
        }
        // An empty path is what is left above a relative one: the current folder, which exists.
        let missing = |path: &&Path| !path.as_os_str().is_empty() && !path.exists();
        let mut made: Vec<PathBuf> = self.folder.ancestors().take_while(missing).map(Path::to_path_buf).collect();
        made.reverse();
        self.made = Some(made);
        fs::create_dir_all(&self.folder).map_err(CliError::write(&self.folder))
    }
}

impl Drop for OutputSet {
    fn drop(&mut self) {
        if self.committed {
            return;
        }
        self.files.clear();
        for folder in self.made.iter().flatten().rev() {
            // Fails on a folder that another program has begun to use, which then stays.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// The name that a file gets in place of what is at `path`: a device, pipe or folder there is not replaced.
fn replaceable(path: &Path) -> io::Result<PathBuf> {
    let target = if path.is_symlink() { path.canonicalize()? } else { path.to_path_buf() };
    match target.metadata() {
        Ok(found) if !found.is_file() => {
            Err(io::Error::new(io::ErrorKind::InvalidInput, "what has that name is not a regular file"))
        }
        _ => Ok(target),
    }
}

/// Temporary files get the permissions that ordinary new files get; the library's default is owner only.
#[cfg(unix)]
fn builder() -> tempfile::Builder<'static, 'static> {
    use std::os::unix::fs::PermissionsExt;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".omm-").permissions(fs::Permissions::from_mode(0o666));
    builder
}

/// Temporary files in the output folder.
#[cfg(not(unix))]
fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".omm-");
    builder
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entries(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn files_appear_at_the_commit_and_not_before() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("a/b");
        let mut set = OutputSet::new(&folder);
        assert!(!root.path().join("a").exists());
        set.add("one", |out| out.write_all(b"1")).unwrap();
        set.add_json("two", &[2]).unwrap();
        assert!(entries(&folder).iter().all(|name| name.starts_with(".omm-")));
        assert_eq!(set.commit().unwrap(), [folder.join("one"), folder.join("two")]);
        assert_eq!(entries(&folder), ["one", "two"]);
        assert_eq!(fs::read(folder.join("two")).unwrap(), b"[\n  2\n]\n");
    }

    #[test]
    fn a_set_keeps_no_file_open() {
        let root = tempfile::tempdir().unwrap();
        let open = || fs::read_dir("/proc/self/fd").map_or(0, Iterator::count);
        let mut set = OutputSet::new(root.path());
        let before = open();
        for name in 0..500 {
            set.add(name.to_string(), |_| Ok(())).unwrap();
        }
        // Tests beside this one may have opened some meanwhile.
        assert!(open() < before + 100, "{} files are open", open());
        assert_eq!(set.commit().unwrap().len(), 500);
    }

    #[test]
    fn a_set_that_is_dropped_leaves_nothing() {
        let root = tempfile::tempdir().unwrap();
        let mut set = OutputSet::new(&root.path().join("a/b"));
        set.add("one", |out| out.write_all(b"1")).unwrap();
        let refused = set.add("two", |_| Err(io::Error::other("enough"))).unwrap_err().to_string();
        assert!(refused.ends_with("two: cannot write: enough"), "{refused}");
        drop(set);
        assert!(entries(root.path()).is_empty());
    }

    #[test]
    fn a_folder_in_the_way_is_named_and_nothing_is_left() {
        let root = tempfile::tempdir().unwrap();
        fs::create_dir(root.path().join("two")).unwrap();
        let mut set = OutputSet::new(root.path());
        set.add("one", |out| out.write_all(b"1")).unwrap();
        assert!(set.add("two", |_| Ok(())).unwrap_err().to_string().contains("two: cannot write: "));
        drop(set);
        assert_eq!(entries(root.path()), ["two"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_is_followed_and_what_is_no_file_stays() {
        let root = tempfile::tempdir().unwrap();
        let (folder, link) = (root.path().join("folder"), root.path().join("link"));
        fs::create_dir(&folder).unwrap();
        fs::write(folder.join("file"), b"old").unwrap();
        std::os::unix::fs::symlink(folder.join("file"), &link).unwrap();
        let _socket = std::os::unix::net::UnixListener::bind(root.path().join("socket")).unwrap();
        let mut set = OutputSet::new(root.path());
        set.add("link", |out| out.write_all(b"new")).unwrap();
        let refused = set.add("socket", |_| Ok(())).unwrap_err().to_string();
        assert!(refused.ends_with("socket: cannot write: what has that name is not a regular file"), "{refused}");
        set.commit().unwrap();
        assert!(link.is_symlink());
        assert_eq!(fs::read(folder.join("file")).unwrap(), b"new");
        assert_eq!(entries(&folder), ["file"]);
        assert_eq!(entries(root.path()), ["folder", "link", "socket"]);
    }

    #[test]
    fn what_took_the_place_of_another_file_stays_when_a_later_one_fails() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("old"), b"old").unwrap();
        let mut set = OutputSet::new(root.path());
        for name in ["old", "new", "taken"] {
            set.add(name, |out| out.write_all(b"new")).unwrap();
        }
        // Another program was faster.
        fs::create_dir(root.path().join("taken")).unwrap();
        set.commit().unwrap_err();
        assert_eq!(entries(root.path()), ["old", "taken"]);
        assert_eq!(fs::read(root.path().join("old")).unwrap(), b"new");
    }
}
