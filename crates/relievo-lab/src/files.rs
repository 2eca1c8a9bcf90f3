//! Writes reports and pictures so that all files of a run appear together and complete, or not at all: files
//! are written to a temporary folder beside their destination, and then renamed.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use image::EncodableLayout;
use relievo::Error;
use relievo::asset::encode_png;
pub use relievo::asset::package::sha256;

/// Files of one folder, staged until all are written. Staged files that are never published are deleted.
#[derive(Debug)]
pub struct Staged {
    folder: PathBuf,
    stage: tempfile::TempDir,
    names: Vec<String>,
    removed: Vec<String>,
}

impl Staged {
    /// Stages files for `folder`, which is created when they are published.
    ///
    /// # Errors
    /// [`Error::File`] if `folder` exists and is no folder, [`Error::Output`] if nothing can be written.
    pub fn new(folder: &Path) -> Result<Self, Error> {
        if folder.exists() && !folder.is_dir() {
            return Err(Error::file(folder, "is not a folder"));
        }
        // The stage is in the folder or above it, on the same file system, so that renaming is atomic.
        let parent = folder.ancestors().find(|parent| parent.is_dir() || parent.as_os_str().is_empty());
        let parent = parent.filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let stage = tempfile::Builder::new().prefix(".relievo-").tempdir_in(parent);
        let stage = stage.map_err(|error| Error::output(parent, error))?;
        Ok(Self { folder: folder.to_owned(), stage, names: Vec::new(), removed: Vec::new() })
    }

    /// The path to write to for the file that will be `name`.
    pub fn path(&mut self, name: impl Into<String>) -> PathBuf {
        let name = name.into();
        let path = self.stage.path().join(&name);
        self.names.push(name);
        path
    }

    /// Stages a file with these bytes.
    ///
    /// # Errors
    /// [`Error::Output`] if the file cannot be written.
    pub fn write(&mut self, name: impl Into<String>, bytes: &[u8]) -> Result<(), Error> {
        write_bytes(&self.path(name), bytes)
    }

    /// Stages a value as indented JSON.
    ///
    /// # Errors
    /// [`Error::Output`] if the file cannot be written.
    pub fn write_json(
        &mut self,
        name: impl Into<String>,
        value: &impl serde::Serialize,
    ) -> Result<(), Error> {
        self.write(name, &json(value)?)
    }

    /// Stages a picture as PNG.
    ///
    /// # Errors
    /// [`Error::Output`] if the file cannot be written.
    pub fn write_png<P>(
        &mut self,
        name: impl Into<String>,
        image: &image::ImageBuffer<P, Vec<P::Subpixel>>,
    ) -> Result<(), Error>
    where
        P: image::Pixel + image::PixelWithColorType,
        [P::Subpixel]: EncodableLayout,
    {
        let path = self.path(name);
        // Encodes in memory first: the image crate drops the error of the last write.
        let (size, texels) = ([image.width(), image.height()], image.as_raw().as_bytes());
        let encoded = encode_png(size, texels, P::COLOR_TYPE).map_err(|error| Error::output(&path, error))?;
        write_bytes(&path, &encoded)
    }

    /// Removes a file of an earlier run when the others are published.
    pub fn remove(&mut self, name: &str) {
        self.removed.push(name.to_owned());
    }

    /// When the others are published, removes those files of earlier runs whose names `ours` accepts and that
    /// this run does not replace.
    pub fn remove_stale(&mut self, ours: impl Fn(&str) -> bool) {
        // A folder that cannot be listed, or does not exist yet, has no earlier run.
        let Ok(entries) = self.folder.read_dir() else { return };
        for name in entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()) {
            if ours(&name) && !self.names.contains(&name) && self.folder.join(&name).is_file() {
                self.removed.push(name);
            }
        }
    }

    /// Moves every file to its destination. If one cannot be moved, the files of an earlier run are restored.
    ///
    /// # Errors
    /// [`Error::File`] if there is a folder in the place of a file, [`Error::Output`] if a file cannot be
    /// moved.
    pub fn publish(self) -> Result<(), Error> {
        std::fs::create_dir_all(&self.folder).map_err(|error| Error::output(&self.folder, error))?;
        let kept = tempfile::tempdir_in(self.stage.path());
        let kept = kept.map_err(|error| Error::output(self.stage.path(), error))?;
        self.keep(kept.path())?;
        self.replace().inspect_err(|_| self.restore(kept.path()))
    }

    /// Links the files that are about to be replaced or removed into `kept`, so that they can be restored.
    fn keep(&self, kept: &Path) -> Result<(), Error> {
        for name in self.names.iter().chain(&self.removed) {
            let (place, copy) = (self.folder.join(name), kept.join(name));
            if place.is_dir() {
                return Err(Error::file(&place, "is a folder, and a file belongs there"));
            }
            if place.exists() {
                // Some file systems have no hard links.
                let linked =
                    std::fs::hard_link(&place, &copy).or_else(|_| std::fs::copy(&place, &copy).map(|_| ()));
                linked.map_err(|error| Error::output(&place, error))?;
            }
        }
        Ok(())
    }

    fn replace(&self) -> Result<(), Error> {
        for name in &self.names {
            let to = self.folder.join(name);
            std::fs::rename(self.stage.path().join(name), &to).map_err(|error| Error::output(&to, error))?;
        }
        for name in &self.removed {
            let stale = self.folder.join(name);
            if stale.exists() {
                std::fs::remove_file(&stale).map_err(|error| Error::output(&stale, error))?;
            }
        }
        Ok(())
    }

    /// Restores the folder as far as the disk allows. It reports no errors: the user sees the first one.
    fn restore(&self, kept: &Path) {
        for name in self.names.iter().chain(&self.removed) {
            let (place, copy) = (self.folder.join(name), kept.join(name));
            let _ = if copy.exists() { std::fs::rename(copy, place) } else { std::fs::remove_file(place) };
        }
    }
}

/// Writes one file completely or not at all. A path that is no regular file, such as `/dev/stdout`, is
/// written to and not replaced.
///
/// # Errors
/// [`Error::File`] if the path cannot be a file, [`Error::Output`] if it cannot be written.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    if path.metadata().is_ok_and(|data| !data.is_file() && !data.is_dir()) {
        return write_bytes(path, bytes);
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let name = path.file_name().ok_or_else(|| Error::file(path, "is not a file name"))?;
    let mut staged = Staged::new(folder)?;
    staged.write(name.to_string_lossy(), bytes)?;
    staged.publish()
}

/// Writes a value as indented JSON, as [`write_file`] writes bytes.
///
/// # Errors
/// As [`write_file`], and [`Error::Output`] for values that JSON cannot represent.
pub fn write_json(path: &Path, value: &impl serde::Serialize) -> Result<(), Error> {
    write_file(path, &json(value)?)
}

fn json(value: &impl serde::Serialize) -> Result<Vec<u8>, Error> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(|error| Error::output("JSON", error))?;
    bytes.push(b'\n');
    Ok(bytes)
}

fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let write = || std::fs::File::create(path)?.write_all(bytes);
    write().map_err(|error: std::io::Error| Error::output(path, error))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(folder: &Path, name: &str) -> Option<String> {
        std::fs::read_to_string(folder.join(name)).ok()
    }

    #[test]
    fn a_run_that_fails_halfway_leaves_the_earlier_one() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let out = folder.path().join("out");
        std::fs::create_dir(&out).expect("writable");
        for name in ["a", "b", "stale"] {
            std::fs::write(out.join(name), "old").expect("writable");
        }
        let stage = |complete: bool| {
            let mut staged = Staged::new(&out).expect("writable");
            for name in ["a", "new", "b"] {
                let path = staged.path(name);
                if complete || name != "b" {
                    std::fs::write(path, "new").expect("writable");
                }
            }
            staged.remove_stale(|name| name == "stale" || name == "a");
            staged
        };
        // Publishing moves `a` and `new`, and then fails because `b` was never written.
        assert!(stage(false).publish().is_err());
        let old = || Some("old".to_owned());
        assert_eq!(["a", "b", "stale", "new"].map(|name| read(&out, name)), [old(), old(), old(), None]);
        stage(true).publish().expect("complete");
        let new = || Some("new".to_owned());
        assert_eq!(["a", "b", "stale", "new"].map(|name| read(&out, name)), [new(), new(), None, new()]);
        assert_eq!(out.read_dir().expect("readable").count(), 3, "nothing is left beside them");
    }
}
