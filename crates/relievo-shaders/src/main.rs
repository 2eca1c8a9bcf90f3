//! Writes `generated/` anew, after a change of `kernels/`, `wgsl/` or of this generator.

use std::path::Path;

fn main() -> std::io::Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folder = root.join("generated");
    let files = relievo_shaders::generated(&root);
    std::fs::create_dir_all(&folder)?;
    for entry in std::fs::read_dir(&folder)? {
        let path = entry?.path();
        if path.file_name().and_then(|name| name.to_str()).is_none_or(|name| !files.contains_key(name)) {
            std::fs::remove_file(path)?;
        }
    }
    let mut changed = 0;
    for (name, text) in &files {
        let path = folder.join(name);
        if std::fs::read_to_string(&path).is_ok_and(|known| known == *text) {
            continue;
        }
        std::fs::write(path, text)?;
        changed += 1;
    }
    println!("{changed} of {} files in generated/ have changed", files.len());
    Ok(())
}
