//! Relative paths of the files that a model names.

use std::path::{Component, Path, PathBuf};

/// Converts a file name to a relative path that stays inside its folder. `None` for an empty name, for a name with a scheme or
/// a drive letter, and for a path that leads out of the folder.
pub(super) fn path_below(name: &str) -> Option<PathBuf> {
    let is_plain = |part: &Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    let parts = || Path::new(name).components();
    let path: PathBuf = parts().filter(|part| *part != Component::CurDir).collect();
    let is_below = !name.contains(':') && parts().all(|part| is_plain(&part));
    (is_below && !path.as_os_str().is_empty()).then_some(path)
}
