//! Parses the geometry of an OBJ file.

use std::collections::HashMap;
use std::ops::Range;

use super::statements::{Statement, Statements};
use crate::InputError;
use crate::asset::mesh::COORDINATE_LIMIT;

/// Index that stands for missing texture coordinates or a missing normal of a corner.
pub(super) const NONE: u32 = u32::MAX;

/// A corner of a face: the indices of its position, texture coordinates and normal, counted from 0.
pub(super) type Corner = [u32; 3];

/// The object, group and material to which a face belongs.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub(super) struct Owner {
    /// Name of the object; `None` if the face has none.
    pub object: Option<String>,
    /// Name of the group; `None` if the face has none.
    pub group: Option<String>,
    /// Name of the material; `None` if the face has none.
    pub material: Option<String>,
}

/// Geometry of an OBJ file.
#[derive(Default)]
pub(super) struct Parsed {
    pub positions: Vec<[f32; 3]>,
    /// Texture coordinates; v points down the image.
    pub uv: Vec<[f32; 2]>,
    /// Normals as in the file, of any length.
    pub normals: Vec<[f32; 3]>,
    /// The corners of each face, at least three.
    pub faces: Vec<Vec<Corner>>,
    /// For each face, its line in the file.
    pub lines: Vec<usize>,
    /// Runs of consecutive faces with the same owner. Each has the index of its first face, and the owner.
    runs: Vec<(usize, Owner)>,
    /// Material libraries that the file names, with the line of each statement.
    pub libraries: Vec<(usize, String)>,
}

/// Error text for a face whose corners cannot be read.
const CORNERS: &str =
    "must have three or more corners, all like 1, all like 1/1, all like 1//1 or all like 1/1/1";

impl Parsed {
    /// Reads the text of an OBJ file.
    ///
    /// # Errors
    /// [`InputError`] with the line, for a statement that cannot be read, an index of an element that does not exist, or a
    /// coordinate out of range. Also for a file without faces.
    pub fn new(bytes: &[u8]) -> Result<Self, InputError> {
        let mut parsed = Self::default();
        let mut owner = Owner::default();
        for statement in Statements::new(bytes) {
            let name = || Some(statement.rest().to_owned()).filter(|name| !name.is_empty());
            match statement.keyword() {
                "v" => parsed.positions.push(vector(&statement)?),
                "vn" => parsed.normals.push(vector(&statement)?),
                "vt" => parsed.uv.push(coordinates(&statement)?),
                "f" | "fo" => parsed.add_face(&statement, &owner)?,
                // A new object ends the group, because a group belongs to one object.
                "o" => (owner.object, owner.group) = (name(), None),
                "g" => owner.group = name(),
                "usemtl" => owner.material = name(),
                "mtllib" => parsed.libraries.extend(name().map(|name| (statement.line, name))),
                _ => {}
            }
        }
        if parsed.faces.is_empty() {
            let bound = "must have at least one face (points, lines and free-form surfaces are not read)";
            return Err(InputError::new("OBJ", format!("[{} bytes]", bytes.len()), bound));
        }
        Ok(parsed)
    }

    /// Adds a face to the last run of faces, or to a new run if the owner differs.
    fn add_face(&mut self, statement: &Statement<'_>, owner: &Owner) -> Result<(), InputError> {
        let corners: Result<Vec<Corner>, &str> = statement.words().map(|word| self.corner(word)).collect();
        let corners = corners.map_err(|bound| statement.refused(None, bound))?;
        let lacks = |corner: &Corner| [corner[1] == NONE, corner[2] == NONE];
        if corners.len() < 3 || corners.iter().any(|corner| lacks(corner) != lacks(&corners[0])) {
            return Err(statement.refused(None, CORNERS));
        }
        if self.runs.last().is_none_or(|(_, last)| last != owner) {
            self.runs.push((self.faces.len(), owner.clone()));
        }
        self.faces.push(corners);
        self.lines.push(statement.line);
        Ok(())
    }

    /// Parses the indices of a corner, such as `1/2/3`. The error says what the word must be.
    fn corner(&self, word: &str) -> Result<Corner, &'static str> {
        // Some exporters write a slash at the end of a corner without a normal.
        let parts: Vec<&str> = word.trim_end_matches('/').split('/').collect();
        let [v, vt, vn] = [self.positions.len(), self.uv.len(), self.normals.len()];
        match parts[..] {
            [a] => Ok([number(a, v)?, NONE, NONE]),
            [a, b] => Ok([number(a, v)?, number(b, vt)?, NONE]),
            [a, "", c] => Ok([number(a, v)?, NONE, number(c, vn)?]),
            [a, b, c] => Ok([number(a, v)?, number(b, vt)?, number(c, vn)?]),
            _ => Err(CORNERS),
        }
    }

    /// For each owner, the ranges of its faces. Owners are in the order of their first faces.
    pub fn parts(&self) -> Vec<(&Owner, Vec<Range<usize>>)> {
        let mut parts: Vec<(&Owner, Vec<_>)> = Vec::new();
        let mut known = HashMap::new();
        for (at, (first, owner)) in self.runs.iter().enumerate() {
            let end = self.runs.get(at + 1).map_or(self.faces.len(), |(next, _)| *next);
            let place = *known.entry(owner).or_insert_with(|| {
                parts.push((owner, Vec::new()));
                parts.len() - 1
            });
            parts[place].1.push(*first..end);
        }
        parts
    }
}

/// Converts an index of the file to an index that counts from 0 and is below `count`. In the file, positive indices count from
/// 1, and negative indices count backwards from −1. The error says what the word must be.
fn number(word: &str, count: usize) -> Result<u32, &'static str> {
    let given: i64 = word.parse().map_err(|_| CORNERS)?;
    let at = if given < 0 { given + count as i64 } else { given - 1 };
    let bound = "must name v, vt and vn of the lines before it, counted from 1, or backwards from -1";
    if (0..count as i64).contains(&at) { Ok(at as u32) } else { Err(bound) }
}

/// Reads three numbers. Further numbers, such as the weight or colour of a position, are ignored.
fn vector(statement: &Statement<'_>) -> Result<[f32; 3], InputError> {
    let numbers: Option<Vec<f32>> = statement.words().take(3).map(|word| word.parse().ok()).collect();
    let vector = numbers.and_then(|numbers| numbers.try_into().ok());
    in_range(statement, vector.ok_or_else(|| statement.refused(None, "must have three numbers"))?)
}

/// Reads texture coordinates. v is flipped in double precision before rounding to `f32`, so that files written by this crate
/// are read back unchanged.
fn coordinates(statement: &Statement<'_>) -> Result<[f32; 2], InputError> {
    let mut words = statement.words();
    let u = words.next().and_then(|word| word.parse().ok());
    let v = words.next().map_or(Some(0.0), |word| word.parse::<f64>().ok());
    let (u, v) = u.zip(v).ok_or_else(|| statement.refused(None, "must have one to three numbers"))?;
    in_range(statement, [u, (1.0 - v) as f32])
}

/// Refuses numbers that are not finite or whose absolute value exceeds [`COORDINATE_LIMIT`].
fn in_range<const N: usize>(statement: &Statement<'_>, vector: [f32; N]) -> Result<[f32; N], InputError> {
    // NaN is refused, too, because comparisons with it are false.
    match vector.iter().all(|number| number.abs() <= COORDINATE_LIMIT) {
        true => Ok(vector),
        false => Err(statement.refused(None, format!("must be finite and within ±{COORDINATE_LIMIT:e}"))),
    }
}
