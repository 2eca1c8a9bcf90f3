//! Output files that appear whole or not at all: they are written beside their place, then renamed.

use std::fmt::Display;
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use relievo::Error;

/// Files of one folder, staged until all are written.
pub struct Staged {
    folder: PathBuf,
    stage: tempfile::TempDir,
    names: Vec<String>,
    removed: Vec<String>,
}

impl Staged {
    /// Stages files for `folder`, which is made when they are published.
    pub fn new(folder: &Path) -> Result<Self, Error> {
        if folder.exists() && !folder.is_dir() {
            return Err(Error::file(folder, "is not a folder"));
        }
        // In the folder or above it, on the same file system, so that renaming is atomic.
        let parent = folder.ancestors().find(|parent| parent.is_dir() || parent.as_os_str().is_empty());
        let parent = parent.filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let stage = tempfile::Builder::new().prefix(".relievo-").tempdir_in(parent);
        let stage = stage.map_err(|error| Error::output(parent, error))?;
        Ok(Self { folder: folder.to_owned(), stage, names: Vec::new(), removed: Vec::new() })
    }

    /// Where to write the file that will be `name`.
    pub fn path(&mut self, name: impl Into<String>) -> PathBuf {
        let name = name.into();
        let path = self.stage.path().join(&name);
        self.names.push(name);
        path
    }

    /// Removes a file of an earlier run when the others are published.
    pub fn remove(&mut self, name: &str) {
        self.removed.push(name.to_owned());
    }

    /// Moves every file to its place.
    pub fn publish(self) -> Result<(), Error> {
        std::fs::create_dir_all(&self.folder).map_err(|error| Error::output(&self.folder, error))?;
        // What cannot be replaced is found before anything is.
        for name in self.names.iter().chain(&self.removed) {
            let to = self.folder.join(name);
            if to.is_dir() {
                return Err(Error::file(&to, "is a folder, and a file belongs there"));
            }
        }
        for name in &self.removed {
            let stale = self.folder.join(name);
            if stale.exists() {
                std::fs::remove_file(&stale).map_err(|error| Error::output(&stale, error))?;
            }
        }
        for name in &self.names {
            let to = self.folder.join(name);
            std::fs::rename(self.stage.path().join(name), &to).map_err(|error| Error::output(&to, error))?;
        }
        Ok(())
    }
}

/// Writes one file whole or not at all. What is no file, such as `/dev/stdout`, is written to, not replaced.
#[cfg(feature = "gpu")]
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    if path.metadata().is_ok_and(|data| !data.is_file() && !data.is_dir()) {
        return relievo::terrain::export::write_bytes(path, bytes);
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let name = path.file_name().ok_or_else(|| Error::file(path, "is not a file name"))?;
    let mut staged = Staged::new(folder)?;
    let name = name.to_string_lossy().into_owned();
    relievo::terrain::export::write_bytes(&staged.path(name), bytes)?;
    staged.publish()
}

/// Prints a line. Whoever closed the pipe has read enough: the work goes on without a word.
pub fn say(line: impl Display) -> Result<(), Error> {
    match writeln!(std::io::stdout(), "{line}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Error::output("standard output", error)),
        _ => Ok(()),
    }
}

/// A value as indented JSON.
pub fn json(value: &impl serde::Serialize) -> Result<Vec<u8>, Error> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(|error| Error::output("JSON", error))?;
    bytes.push(b'\n');
    Ok(bytes)
}
