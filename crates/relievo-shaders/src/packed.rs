//! Words that pack several fields. They are declared by comments such as `// packed Decision: list 8, morph 12`, which give each
//! field's width in bits, lowest field first. In WGSL and in Rust, `decision_word(list, morph)` packs a word, and
//! `decision_list(word)` and `decision_morph(word)` read its fields. A sum of widths above 32 bits is refused. On the host,
//! a value that exceeds its field panics.

use std::fmt::Write as _;

/// A packed word: its name, and the name, first bit and width of every field.
pub struct Packed<'a> {
    /// Name of the word.
    pub name: String,
    comment: &'a str,
    fields: Vec<Field<'a>>,
}

struct Field<'a> {
    name: &'a str,
    first: u32,
    width: u32,
}

impl Field<'_> {
    fn most(&self) -> u32 {
        u32::MAX >> (32 - self.width)
    }
}

/// Packed words that a WGSL file declares.
///
/// # Errors
/// The reason why a declaration is invalid.
pub fn packed(text: &str) -> Result<Vec<Packed<'_>>, String> {
    text.lines().filter_map(|line| line.strip_prefix("// packed ")).map(Packed::parse).collect()
}

/// Appends the WGSL functions of a file's packed words to the file's text. They come last, so that line numbers stay the same.
///
/// # Errors
/// The reason why a declaration is invalid, as for [`packed`].
pub fn expanded(text: String) -> Result<String, String> {
    let words: String = packed(&text)?.iter().map(Packed::wgsl).collect();
    Ok(text + &words)
}

impl<'a> Packed<'a> {
    fn parse(comment: &'a str) -> Result<Self, String> {
        let refused = |why: &str| format!("packed {comment}: {why}");
        let (name, list) =
            comment.split_once(": ").ok_or_else(|| refused("needs a name, `: ` and fields"))?;
        let (mut fields, mut first) = (Vec::new(), 0);
        for field in list.split(", ") {
            let (name, width) = field.split_once(' ').ok_or_else(|| refused("a field needs a width"))?;
            let width = width.parse().ok().filter(|width| (1..=32).contains(width));
            let width = width.ok_or_else(|| refused("a width is a number from 1 to 32"))?;
            fields.push(Field { name, first, width });
            first += width;
        }
        if first > 32 {
            return Err(refused(&format!("has {first} bits, and must have at most 32")));
        }
        Ok(Self { name: snake(name), comment, fields })
    }

    /// Expression that packs all fields into a word. `suffix` is the suffix of integer literals: `u` in WGSL, empty in Rust.
    fn packed(&self, suffix: &str) -> String {
        self.list(" | ", |field| match field.first {
            0 => field.name.to_owned(),
            first => format!("({} << {first}{suffix})", field.name),
        })
    }

    /// Expression that reads a field from the variable `word`. `suffix` is the suffix of integer literals: `u` in WGSL, empty in
    /// Rust.
    fn unpacked(field: &Field<'_>, suffix: &str) -> String {
        let value = match field.first {
            0 => "word".to_owned(),
            first => format!("(word >> {first}{suffix})"),
        };
        match field.first + field.width {
            32 => value.trim_matches(['(', ')']).to_owned(),
            _ => format!("{value} & {}{suffix}", field.most()),
        }
    }

    fn wgsl(&self) -> String {
        let name = &self.name;
        let arguments = self.list(", ", |field| format!("{}: u32", field.name));
        let packed = self.packed("u");
        let mut text = format!(
            "\n// Packs a word: {}.\nfn {name}_word({arguments}) -> u32 {{\n    return {packed};\n}}\n",
            self.comment
        );
        for field in &self.fields {
            let value = Self::unpacked(field, "u");
            let Field { name: of, first, width } = field;
            write!(
                text,
                "\n// The {width} bits of a {name} word from bit {first} on.\nfn {name}_{of}(word: u32) -> u32 {{\n    return {value};\n}}\n"
            )
            .expect("a string");
        }
        text
    }

    /// Rust functions that pack the word and read its fields, as (name, text).
    pub fn rust(&self) -> Vec<(String, String)> {
        let (name, comment) = (&self.name, self.comment);
        let arguments = self.list(", ", |field| format!("{}: u32", field.name));
        let fits = self.list(" && ", |field| format!("{} <= {:#x}", field.name, field.most()));
        let packed = self.packed("");
        let mut functions = vec![(
            format!("{name}_word"),
            format!(
                "/// Packs a word: {comment} bits, the lowest first.\npub const fn {name}_word({arguments}) -> u32 {{\n    \
                 assert!({fits}, \"a value exceeds its bits: {comment}\");\n    {packed}\n}}\n"
            ),
        )];
        for field in &self.fields {
            let (value, Field { name: field, first, width }) = (Self::unpacked(field, ""), field);
            functions.push((
                format!("{name}_{field}"),
                format!(
                    "/// The {width} bits of a {name} word from bit {first} on.\npub const fn {name}_{field}(word: u32) -> u32 {{\n    {value}\n}}\n"
                ),
            ));
        }
        functions
    }

    fn list(&self, separator: &str, text: impl Fn(&Field<'_>) -> String) -> String {
        self.fields.iter().map(text).collect::<Vec<_>>().join(separator)
    }
}

/// Converts a name in camel case to snake case: `ListEntry` to `list_entry`.
fn snake(name: &str) -> String {
    let mut text = String::new();
    for (at, letter) in name.char_indices() {
        if letter.is_uppercase() && at > 0 {
            text.push('_');
        }
        text.extend(letter.to_lowercase());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::packed;

    #[test]
    fn fields_that_a_word_has_no_room_for_are_refused() {
        let refused = |comment: &str| packed(&format!("// packed {comment}")).err().expect("refused");
        assert_eq!(
            refused("Word: a 20, b 13"),
            "packed Word: a 20, b 13: has 33 bits, and must have at most 32"
        );
        assert!(refused("Word: a 0").contains("a width is a number from 1 to 32"));
        assert!(refused("Word: a").contains("a field needs a width"));
        assert!(refused("a 3").contains("needs a name"));
    }
}
