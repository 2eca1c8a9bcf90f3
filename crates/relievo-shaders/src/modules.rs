//! Joins modules for shaders outside the crate. A module consists of a folder's file `module.wgsl` and all of its imports. The
//! joined text needs no WESL, and it keeps the comments.

use std::path::{Path, PathBuf};

use crate::packed::expanded;

/// Text of a module: the root file, then every imported file once.
pub fn joined(root: &Path, file: &Path) -> String {
    let mut files = vec![file.to_owned()];
    let mut text = String::new();
    let mut next = 0;
    while next < files.len() {
        let file = files[next].clone();
        let source = std::fs::read_to_string(&file).map_err(|error| error.to_string()).and_then(expanded);
        let source = source.unwrap_or_else(|why| panic!("{}: {why}", file.display()));
        let relative = file.strip_prefix(root).unwrap_or(&file);
        text += &format!("// From relievo's {}.\n", relative.display());
        for line in source.lines() {
            match line.strip_prefix("import ") {
                Some(import) => add(&mut files, imported_file(root, &file, import)),
                None => text += &format!("{line}\n"),
            }
        }
        text += "\n";
        next += 1;
    }
    text.trim_end().to_owned() + "\n"
}

fn add(files: &mut Vec<PathBuf>, file: PathBuf) {
    if !files.contains(&file) {
        files.push(file);
    }
}

/// File of an import such as `package::wgsl::folder::file::name;`. The import may also list several names in braces.
fn imported_file(root: &Path, importing: &Path, import: &str) -> PathBuf {
    let path = (import.trim_end().strip_suffix(';'))
        .and_then(|import| import.strip_prefix("package::")?.rsplit_once("::"))
        .map(|(path, _)| path.replace("::", "/"));
    let path =
        path.unwrap_or_else(|| panic!("{}: teach relievo-shaders `import {import}`", importing.display()));
    root.join(path).with_extension("wgsl")
}

/// Reason why a module's text cannot be put before other shaders; `None` if it can.
pub fn unfit(module: &naga::Module) -> Option<String> {
    let bound = module.global_variables.iter().find(|(_, variable)| variable.binding.is_some());
    let entry = module.entry_points.first().map(|entry| entry.name.as_str());
    let constant = module.overrides.iter().next().and_then(|(_, constant)| constant.name.as_deref());
    let found = bound.and_then(|(_, variable)| variable.name.as_deref()).or(entry).or(constant)?;
    Some(format!("`{found}`: a module has no bindings, entry points or override constants"))
}
