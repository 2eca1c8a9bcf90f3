//! The WGSL source files of a shader as text. They tell which file declares a name, and give the comments above declarations.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::packed::{Packed, packed};
use crate::shaders::refuse;

/// Path and text of all files from which a shader is composed. The shader's own file comes first.
pub struct Sources(Vec<(PathBuf, String)>);

impl Sources {
    pub fn of(root: &Path, file: &Path) -> Self {
        let mut found = Self(Vec::new());
        found.follow(root, file);
        found
    }

    /// Adds a file and, recursively, all files that it imports.
    pub fn follow(&mut self, root: &Path, file: &Path) {
        if self.0.iter().any(|(known, _)| known == file) {
            return;
        }
        let Ok(text) = std::fs::read_to_string(file) else { return };
        let imports: Vec<PathBuf> = text
            .lines()
            .filter_map(|line| line.trim().strip_prefix("import package::"))
            .filter_map(|path| {
                let names = path.trim_end_matches(';').split("::").map(str::trim);
                let mut file = root.to_path_buf();
                // An import ends with one or two names of items. The path before them is the file.
                names.filter(|name| !name.starts_with('{')).find_map(|name| {
                    file.push(name);
                    let module = file.with_extension("wgsl");
                    module.exists().then_some(module)
                })
            })
            .collect();
        self.0.push((file.to_path_buf(), text));
        imports.iter().for_each(|file| self.follow(root, file));
    }

    /// Finds the declaration of `name` after `keyword`, such as `const` or `struct`, with the comment above it.
    pub fn declaring(&self, keyword: &str, name: &str) -> Option<Declaration<'_>> {
        self.0.iter().find_map(|(file, text)| {
            let mut comment = Vec::new();
            for (number, line) in text.lines().enumerate() {
                let rest = line.strip_prefix(keyword).map(str::trim_start).unwrap_or_default();
                let word = rest.split(|c: char| !c.is_alphanumeric() && c != '_').next();
                if word == Some(name) {
                    return Some(Declaration { file, text, line: number, comment });
                }
                match line.strip_prefix("//") {
                    Some(words) => comment.push(words.trim_start_matches('/').trim()),
                    None => comment.clear(),
                }
            }
            None
        })
    }

    /// Packed words that all files declare, each with its module's path. An invalid declaration is refused.
    pub fn packed(&self, root: &Path) -> Vec<(String, Packed<'_>)> {
        let mut all = Vec::new();
        for (file, text) in &self.0 {
            let words = packed(text).unwrap_or_else(|why| refuse(file, &why));
            all.extend(words.into_iter().map(|word| (module_of(root, file), word)));
        }
        all
    }

    /// Comment above the binding with the given name, and the binding's `// length` line.
    pub fn binding_comment(&self, name: &str) -> (Vec<&str>, Option<Length<'_>>) {
        let marks = [format!("> {name}:"), format!(" {name}:")];
        for (_, text) in &self.0 {
            let mut comment = Vec::new();
            for line in text.lines() {
                if line.starts_with("@group") && marks.iter().any(|mark| line.contains(mark.as_str())) {
                    // In modules, comments give the bindings' numbers; such comments are left out.
                    comment.retain(|words: &&str| !words.starts_with("Binding "));
                    let length = comment.iter().find_map(|words| Length::parse(words));
                    comment.retain(|words| Length::parse(words).is_none());
                    return (comment, length);
                }
                match line.strip_prefix("//") {
                    Some(words) => comment.push(words.trim_start_matches('/').trim()),
                    None => comment.clear(),
                }
            }
        }
        (Vec::new(), None)
    }
}

/// Least length of a storage buffer, from a comment such as `// length: 3 * instances`. If the caller knows the buffer by another
/// name, the form is `// length of crowd.weights: instances * targets`.
pub struct Length<'a> {
    /// Name of the buffer in errors; `None` for the binding's own name.
    pub path: Option<&'a str>,
    /// Formula for the number of elements. It consists of products and sums of counts (lower case), numbers, and the shader's
    /// constants (upper case).
    pub count: &'a str,
}

impl<'a> Length<'a> {
    fn parse(comment: &'a str) -> Option<Self> {
        let (head, count) = comment.strip_prefix("length")?.split_once(": ")?;
        let path = if head.is_empty() { None } else { Some(head.strip_prefix(" of ")?) };
        Some(Self { path, count })
    }
}

/// Path of a WGSL file's module: the file's path without its top folder and extension, such as `domain/file`.
fn module_of(root: &Path, file: &Path) -> String {
    let relative = file.strip_prefix(root).expect("below the root").with_extension("");
    let path = relative.display().to_string();
    path.split_once('/').map_or(path.clone(), |(_, rest)| rest.to_owned())
}

/// The place where a struct or a constant is declared.
pub struct Declaration<'a> {
    file: &'a Path,
    text: &'a str,
    line: usize,
    pub comment: Vec<&'a str>,
}

impl Declaration<'_> {
    /// Path of the module that declares the item, such as `domain/file`.
    pub fn module(&self, root: &Path) -> String {
        module_of(root, self.file)
    }

    /// Whether a member has the attribute `@align(16)`, which the layout on the host must follow.
    pub fn aligns(&self, field: &str) -> bool {
        let lines = self.text.lines().map(str::trim);
        let mut aligned = lines.filter(|line| line.starts_with("@align(16)"));
        aligned.any(|line| line.contains(&format!(" {field}:")))
    }

    /// Comments above the members of a struct, by member name.
    pub fn members(&self) -> BTreeMap<String, Vec<&str>> {
        let mut members = BTreeMap::new();
        let mut comment = Vec::new();
        for line in self.text.lines().skip(self.line + 1).map(str::trim) {
            if line.starts_with('}') {
                break;
            }
            if let Some(words) = line.strip_prefix("//") {
                comment.push(words.trim_start_matches('/').trim());
            } else if let Some((before, _)) = line.split_once(':') {
                let name = before.rsplit(' ').next().unwrap_or_default();
                members.insert(name.to_owned(), std::mem::take(&mut comment));
            }
        }
        members
    }
}
