//! The WGSL files that a shader is composed of, as text: which of them declares a name, and the comments above it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::packed::{Packed, packed};
use crate::shaders::refuse;

/// The files of which a shader is composed, its own first.
pub struct Sources(Vec<(PathBuf, String)>);

impl Sources {
    pub fn of(root: &Path, file: &Path) -> Self {
        let mut found = Self(Vec::new());
        found.follow(root, file);
        found
    }

    fn follow(&mut self, root: &Path, file: &Path) {
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
                // The last one or two names are items; the longest prefix that is a file counts.
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

    /// The file that declares `name`, the text before its name, and the comment above it.
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

    /// The packed words of all files, with the path of their module. Refuses a comment that declares none.
    pub fn packed(&self, root: &Path) -> Vec<(String, Packed<'_>)> {
        let mut all = Vec::new();
        for (file, text) in &self.0 {
            let words = packed(text).unwrap_or_else(|why| refuse(file, &why));
            all.extend(words.into_iter().map(|word| (module_of(root, file), word)));
        }
        all
    }

    /// The comment above the binding of that name, and its `// length…: …` line.
    pub fn binding_comment(&self, name: &str) -> (Vec<&str>, Option<Length<'_>>) {
        let marks = [format!("> {name}:"), format!(" {name}:")];
        for (_, text) in &self.0 {
            let mut comment = Vec::new();
            for line in text.lines() {
                if line.starts_with("@group") && marks.iter().any(|mark| line.contains(mark.as_str())) {
                    // Other bindings, of modules, have their numbers in comments.
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

/// The least length of a storage buffer, from `// length: 3 * instances` or, where the caller knows the buffer by another
/// name, `// length of crowd.weights: instances * targets`.
pub struct Length<'a> {
    /// What errors call the buffer, if not by the binding's name.
    pub path: Option<&'a str>,
    /// Number of elements: products and sums of counts (lower case) and constants of the shader (upper case).
    pub count: &'a str,
}

impl<'a> Length<'a> {
    fn parse(comment: &'a str) -> Option<Self> {
        let (head, count) = comment.strip_prefix("length")?.split_once(": ")?;
        let path = if head.is_empty() { None } else { Some(head.strip_prefix(" of ")?) };
        Some(Self { path, count })
    }
}

/// `domain/file`, or `file`.
fn module_of(root: &Path, file: &Path) -> String {
    let relative = file.strip_prefix(root).expect("below the root").with_extension("");
    let path = relative.display().to_string();
    path.split_once('/').map_or(path.clone(), |(_, rest)| rest.to_owned())
}

/// Where a struct or a constant is declared.
pub struct Declaration<'a> {
    file: &'a Path,
    text: &'a str,
    line: usize,
    pub comment: Vec<&'a str>,
}

impl Declaration<'_> {
    /// `domain/file`, or `file`.
    pub fn module(&self, root: &Path) -> String {
        module_of(root, self.file)
    }

    /// Whether a member is aligned to 16 bytes by an attribute, of which the host's layout must know.
    pub fn aligns(&self, field: &str) -> bool {
        let lines = self.text.lines().map(str::trim);
        let mut aligned = lines.filter(|line| line.starts_with("@align(16)"));
        aligned.any(|line| line.contains(&format!(" {field}:")))
    }

    /// The comments above the members of a struct, in order.
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
