//! Splits the text of OBJ and MTL files into statements.

use std::borrow::Cow;

use crate::InputError;

/// A statement: one line, or several lines joined by backslashes at their ends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Statement<'a> {
    /// Number of the statement's first line, counted from 1.
    pub line: usize,
    /// Text of the statement, without surrounding space.
    text: Cow<'a, str>,
}

impl Statement<'_> {
    /// The first word of the statement.
    pub fn keyword(&self) -> &str {
        self.text.split(char::is_whitespace).next().unwrap_or_default()
    }

    /// Text after the keyword, without surrounding space.
    pub fn rest(&self) -> &str {
        self.text[self.keyword().len()..].trim_start()
    }

    /// The words after the keyword, up to a comment.
    pub fn words(&self) -> impl Iterator<Item = &str> {
        self.rest().split('#').take(1).flat_map(str::split_whitespace)
    }

    /// Returns an error at the statement's line. `file` names a material library; `None` stands for the OBJ file.
    pub fn refused(&self, file: Option<&str>, bound: impl Into<String>) -> InputError {
        let path = match file {
            Some(file) => format!("{file} line {}", self.line),
            None => format!("line {}", self.line),
        };
        let text = self.text.split_whitespace().collect::<Vec<_>>().join(" ");
        let mut shown: String = text.chars().take(60).filter(|c| !c.is_control()).collect();
        if text.chars().count() > 60 {
            shown.push('…');
        }
        InputError::new(path, shown, bound)
    }
}

/// Iterates over the statements of a file, without empty lines and comments. Bytes that are not UTF-8, as in some names and
/// comments, become replacement characters.
pub(super) struct Statements<'a> {
    left: &'a [u8],
    line: usize,
}

impl<'a> Statements<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { left: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), line: 0 }
    }

    /// Returns the next line without its line ending (LF, CR LF or CR).
    fn next_line(&mut self) -> Option<&'a [u8]> {
        if self.left.is_empty() {
            return None;
        }
        self.line += 1;
        let end = self.left.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(self.left.len());
        let (line, rest) = self.left.split_at(end);
        let feed = match rest {
            [b'\r', b'\n', ..] => 2,
            [_, ..] => 1,
            [] => 0,
        };
        self.left = &rest[feed..];
        Some(line)
    }
}

impl<'a> Iterator for Statements<'a> {
    type Item = Statement<'a>;

    fn next(&mut self) -> Option<Statement<'a>> {
        loop {
            let mut text = String::from_utf8_lossy(self.next_line()?);
            let line = self.line;
            // A comment never continues on the next line, even if it ends with the backslash of a path.
            while text.ends_with('\\') && !text.trim_start().starts_with('#') {
                let Some(more) = self.next_line() else { break };
                text = format!("{} {}", text.trim_end_matches('\\'), String::from_utf8_lossy(more)).into();
            }
            let text: Cow<'_, str> = match text {
                Cow::Borrowed(text) => text.trim().into(),
                Cow::Owned(text) => text.trim().to_owned().into(),
            };
            if !(text.is_empty() || text.starts_with('#')) {
                return Some(Statement { line, text });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_joined_counted_and_stripped() {
        let text = b"\xef\xbb\xbf# a comment\r\n v 1  2 3 \\\n4 # w\n\n\rusemtl caf\xe9 1\ng\nf 1 2 3\\";
        let found: Vec<_> = Statements::new(text)
            .map(|found| (found.line, found.keyword().to_owned(), found.rest().to_owned()))
            .collect();
        let expected =
            [(2, "v", "1  2 3  4 # w"), (6, "usemtl", "caf\u{fffd} 1"), (7, "g", ""), (8, "f", "1 2 3\\")];
        let expected = expected.map(|(line, keyword, rest)| (line, keyword.to_owned(), rest.to_owned()));
        assert_eq!(found, expected);
        let first = Statements::new(text).next().expect("a statement");
        assert_eq!(first.words().collect::<Vec<_>>(), ["1", "2", "3", "4"]);
    }

    #[test]
    fn errors_show_the_beginning_of_a_line() {
        let text = format!("f {}", "1 ".repeat(100));
        let error =
            Statements::new(text.as_bytes()).next().expect("a statement").refused(Some("a.mtl"), "no");
        assert_eq!(error.path, "a.mtl line 1");
        assert!(error.value.chars().count() == 61 && error.value.ends_with('…'), "{error}");
    }
}
