//! Renames all declarations of a flat shader at module scope, so that they cannot clash with names in a caller's text.

use std::collections::BTreeSet;
use std::ops::Range;

/// Prefix of the crate's names in shaders to which a caller's text is added.
pub const PREFIX: &str = "relievo_";

/// Names that stay without a prefix, because the caller's text uses or replaces them.
const KEPT: &[&str] = &["Surface", "View", "shade"];

/// Start of the function that the caller's text may replace.
const REPLACED: &str = "fn shade(";

/// Adds the prefix to all names of module scope except those in `KEPT`. Moves the function that the caller may replace to the
/// end of the text.
pub fn prefixed(flat: &str) -> String {
    let text = replaced_last(flat);
    let names = declared(&text, &words(&text)).into_iter().filter(|name| !KEPT.contains(name));
    renamed(&text, &names.collect())
}

/// Inserts `more` into a prefixed text, before the function that the caller may replace. `more` uses the names without prefix;
/// they get the prefix here. Names in `kept` stay without prefix.
pub fn prefixed_with(prefixed: &str, more: &str, kept: &[String]) -> String {
    let (ours, replaced) = prefixed.split_at(prefixed.rfind(REPLACED).unwrap_or(prefixed.len()));
    format!("{ours}\n{}\n{replaced}", prefixed_behind(prefixed, more, kept))
}

fn prefixed_behind(prefixed: &str, more: &str, kept: &[String]) -> String {
    let (before, own) = (declared(prefixed, &words(prefixed)), declared(more, &words(more)));
    let names = before.into_iter().filter_map(|name| name.strip_prefix(PREFIX)).chain(own);
    renamed(more, &names.filter(|name| !kept.iter().any(|kept| kept == name)).collect())
}

/// Adds the prefix to every occurrence of the given names, except where the name denotes a member or an attribute.
fn renamed(text: &str, names: &BTreeSet<&str>) -> String {
    let words = words(text);
    let mut out = String::with_capacity(text.len() + 8 * words.len());
    let mut end = 0;
    for word in &words {
        let name = &text[word.range.clone()];
        if !word.is_local && names.contains(name) {
            out += &text[end..word.range.start];
            out += PREFIX;
            end = word.range.start;
        }
    }
    out + &text[end..]
}

/// Moves the function that the caller may replace to the end of the text.
fn replaced_last(flat: &str) -> String {
    let Some(start) = flat.find(REPLACED) else { return flat.to_owned() };
    let end = flat[start..].find("\n}").map_or(flat.len(), |end| start + end + 2);
    format!("{}{}\n\n{}\n", &flat[..start], flat[end..].trim_start(), &flat[start..end])
}

/// Positions of the names that a text declares at module scope, as byte ranges. The text must not contain comments.
#[allow(dead_code)] // build.rs needs it only inside `prefixed`
pub fn declarations(text: &str) -> Vec<Range<usize>> {
    let start = text.as_ptr() as usize;
    let range = |name: &str| name.as_ptr() as usize - start..name.as_ptr() as usize - start + name.len();
    declared(text, &words(text)).into_iter().map(range).collect()
}

/// Names that a text declares at module scope. The text must not contain comments.
#[allow(dead_code)] // build.rs needs it only inside `prefixed`
pub fn declared_names(text: &str) -> Vec<String> {
    declarations(text).into_iter().map(|range| text[range].to_owned()).collect()
}

/// An identifier or a keyword in a WGSL text.
struct Word {
    range: Range<usize>,
    /// Whether the word is a member, an attribute or an attribute's value. Such a word never names a declaration of module scope.
    is_local: bool,
    /// Number of braces that are open at the word; 0 at module scope.
    depth: usize,
}

/// All identifiers and keywords of a WGSL text.
fn words(text: &str) -> Vec<Word> {
    let bytes = text.as_bytes();
    let is_part =
        |at: usize| bytes.get(at).is_some_and(|c| c.is_ascii_alphanumeric() || *c == b'_' || !c.is_ascii());
    let (mut words, mut depth, mut at, mut last) = (Vec::new(), 0_usize, 0, b' ');
    let (mut in_struct, mut attribute) = (false, false);
    while at < bytes.len() {
        if bytes[at..].starts_with(b"//") {
            at += bytes[at..].iter().position(|byte| *byte == b'\n').unwrap_or(bytes.len() - at);
            continue;
        }
        let start = at;
        while is_part(at) || bytes[start].is_ascii_digit() && bytes.get(at) == Some(&b'.') {
            at += 1;
        }
        if at == start {
            match bytes[at] {
                b'{' => depth += 1,
                b'}' => depth = depth.saturating_sub(1),
                b')' => attribute = false,
                _ => {}
            }
            in_struct &= bytes[at] != b'}';
            last = if bytes[at].is_ascii_whitespace() { last } else { bytes[at] };
            at += 1;
            continue;
        }
        let name = &text[start..at];
        in_struct |= name == "struct";
        let is_member = in_struct && depth == 1 && bytes[at..].trim_ascii_start().starts_with(b":");
        if !bytes[start].is_ascii_digit() {
            let is_local = matches!(last, b'.' | b'@') || attribute || is_member;
            words.push(Word { range: start..at, is_local, depth });
        }
        attribute |= last == b'@' && matches!(name, "builtin" | "interpolate");
        last = b'a';
    }
    words
}

/// Names that a text declares at module scope. `words` are the words of the text.
fn declared<'a>(text: &'a str, words: &[Word]) -> Vec<&'a str> {
    let mut names = Vec::new();
    for (at, word) in words.iter().enumerate().filter(|(_, word)| word.depth == 0 && !word.is_local) {
        let keyword = &text[word.range.clone()];
        if !["fn", "struct", "const", "override", "alias", "var"].contains(&keyword) {
            continue;
        }
        // `var` may be followed by an address space in angle brackets. The name comes after it.
        let bracket = text[word.range.end..].trim_start().starts_with('<');
        let from =
            if bracket { text[word.range.end..].find('>').map_or(0, |end| word.range.end + end) } else { 0 };
        let name = words[at + 1..].iter().find(|next| next.range.start >= from);
        names.extend(name.map(|name| &text[name.range.clone()]));
    }
    names
}
