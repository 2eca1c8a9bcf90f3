//! The sources of generated shaders, and their digest. `build.rs` and `relievo-shaders` both use this file.

use std::path::{Path, PathBuf};

/// The WGSL files below a folder, sorted.
pub fn shader_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap_or_else(|e| panic!("{}: {e}", folder.display())) {
        let path = entry.expect("a readable folder").path();
        if path.is_dir() {
            files.extend(shader_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "wgsl") {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// Digest of all WGSL files in `kernels/` and `wgsl/`: FNV-1a of their paths and lines.
pub fn digest(root: &Path) -> std::io::Result<String> {
    let mut digest = 0xcbf2_9ce4_8422_2325_u64;
    for path in ["kernels", "wgsl"].iter().flat_map(|folder| shader_files(&root.join(folder))) {
        let relative = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        // Lines, since some checkouts end them differently.
        for line in std::iter::once(&*relative).chain(std::fs::read_to_string(&path)?.lines()) {
            for byte in line.bytes().chain([b'\n']) {
                digest = (digest ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
            }
        }
    }
    Ok(format!("{digest:016x}\n"))
}
