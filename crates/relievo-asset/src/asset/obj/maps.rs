//! Map statements of material libraries: each has options and the name of an image.

use std::path::PathBuf;

use super::statements::Statement;
use crate::InputError;
use crate::asset::beside::path_below;

/// A material's reference to an image, with the options of the reference.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Map {
    /// Name of the image as the file states it.
    pub name: String,
    /// Path of the image relative to the library.
    pub path: PathBuf,
    /// Offset added to texture coordinates after they are scaled; v points up.
    pub offset: [f64; 2],
    /// Factors of the texture coordinates u and v.
    pub scale: [f64; 2],
    /// Whether the image is clamped to its edge; otherwise it repeats.
    pub is_clamped: bool,
    /// Strength of a bump map (option `-bm`).
    pub bump: f32,
    /// Location in the file, for errors.
    pub at: InputError,
}

/// Options that are ignored, each with the number of words that follow it.
const SKIPPED: [(&str, usize); 8] = [
    ("-blendu", 1),
    ("-blendv", 1),
    ("-boost", 1),
    ("-cc", 1),
    ("-imfchan", 1),
    ("-mm", 2),
    ("-texres", 1),
    ("-type", 1),
];

impl Map {
    /// Reads a map statement of the library `file`.
    ///
    /// # Errors
    /// [`InputError`] for options without their values, for a missing file name, and for a file outside the library's folder.
    pub fn new(statement: &Statement<'_>, file: &str) -> Result<Self, InputError> {
        let refused = |bound: &str| statement.refused(Some(file), bound);
        let mut words = Words(statement.rest());
        let (mut offset, mut scale) = ([0.0; 2], [1.0; 2]);
        let (mut is_clamped, mut bump) = (false, 1.0);
        let name = loop {
            let here = words.0;
            let word = words.next().ok_or_else(|| refused("must name an image"))?;
            match word {
                "-o" => words.numbers(&mut offset).ok_or_else(|| refused("-o must have numbers"))?,
                "-s" => words.numbers(&mut scale).ok_or_else(|| refused("-s must have numbers"))?,
                "-t" => words.numbers(&mut [0.0; 2]).ok_or_else(|| refused("-t must have numbers"))?,
                "-clamp" => is_clamped = words.next() == Some("on"),
                "-bm" => {
                    let mut number = [1.0];
                    words.numbers(&mut number).ok_or_else(|| refused("-bm must have a number"))?;
                    bump = number[0] as f32;
                }
                _ => match SKIPPED.iter().find(|(option, _)| *option == word) {
                    Some((_, values)) => (0..*values).for_each(|_| {
                        words.next();
                    }),
                    None => break here.trim(),
                },
            }
        };
        let bound = "must be a file in the folder of the library or below";
        let path = path_below(&slashes(name)).ok_or_else(|| refused(bound))?;
        let at = refused("");
        Ok(Self { name: name.to_owned(), path, offset, scale, is_clamped, bump, at })
    }

    /// Returns an error at the map's line; `bound` says what the map must be.
    pub fn refused(&self, bound: impl Into<String>) -> InputError {
        InputError { bound: bound.into(), ..self.at.clone() }
    }
}

/// Replaces backslashes, which MTL files also use to separate folders, by slashes.
pub(super) fn slashes(path: &str) -> String {
    path.replace('\\', "/")
}

/// The words of a statement that have not been read yet.
struct Words<'a>(&'a str);

impl<'a> Words<'a> {
    fn next(&mut self) -> Option<&'a str> {
        let text = self.0.trim_start();
        let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        self.0 = rest;
        (!word.is_empty()).then_some(word)
    }

    /// Reads one to three finite numbers into `to`. Entries without a number keep their values. `None` if there is no number.
    fn numbers(&mut self, to: &mut [f64]) -> Option<()> {
        for at in 0..3 {
            let before = self.0;
            match self.next().and_then(|word| word.parse::<f64>().ok()) {
                Some(number) if number.is_finite() => {
                    if let Some(to) = to.get_mut(at) {
                        *to = number;
                    }
                }
                _ if at == 0 => return None,
                _ => {
                    self.0 = before;
                    break;
                }
            }
            if to.len() == 1 {
                break;
            }
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::statements::Statements;
    use super::*;

    fn map(text: &str) -> Result<Map, InputError> {
        Map::new(&Statements::new(text.as_bytes()).next().expect("a statement"), "a.mtl")
    }

    #[test]
    fn options_come_before_names_with_spaces() {
        let found =
            map("map_Kd -blendu on -o 0.5 -s 2 3 4 -mm 0 1 -clamp on tex\\old oak 1.png ").expect("valid");
        assert_eq!((&*found.name, &*found.path), ("tex\\old oak 1.png", Path::new("tex/old oak 1.png")));
        assert_eq!((found.offset, found.scale, found.is_clamped), ([0.5, 0.0], [2.0, 3.0], true));
        assert_eq!(map("norm -bm 0.25 ./n.png").map(|map| (map.bump, map.path)), Ok((0.25, "n.png".into())));
    }

    #[test]
    fn what_is_no_map_is_refused() {
        for text in [
            "map_Kd",
            "map_Kd -s 1",
            "map_Kd ../a.png",
            "map_Kd /a.png",
            "map_Kd C:\\a.png",
            "bump -bm a.png",
        ] {
            let error = map(text).expect_err(text);
            assert_eq!((&*error.path, &*error.value), ("a.mtl line 1", text));
        }
        assert_eq!(map("map_Kd a.png").expect("valid").refused("why").bound, "why");
    }
}
