/// Digest of all WGSL files in `kernels/` and `wgsl/`: FNV-1a of their paths and lines.
pub fn digest(root: &std::path::Path) -> std::io::Result<String> {
    fn files(folder: &std::path::Path, all: &mut Vec<std::path::PathBuf>) -> std::io::Result<()> {
        for entry in std::fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_dir() {
                files(&path, all)?;
            } else if path.extension().is_some_and(|extension| extension == "wgsl") {
                all.push(path);
            }
        }
        Ok(())
    }
    let mut all = Vec::new();
    for folder in ["kernels", "wgsl"] {
        files(&root.join(folder), &mut all)?;
    }
    all.sort();
    let mut digest = 0xcbf2_9ce4_8422_2325_u64;
    for path in all {
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
