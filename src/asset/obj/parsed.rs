//! Parses the geometry of an OBJ file. The crate `obj` reads numbers and resolves indices; here statements are chosen, and
//! the lines known to which its errors belong.

use std::collections::HashMap;
use std::io::{BufRead, Read};

use obj::raw::object::{Polygon, RawObj};
use obj::{LoadErrorKind, ObjError};

use super::statements::{Statement, Statements};
use crate::InputError;
use crate::asset::mesh::COORDINATE_LIMIT;

/// Stands for texture coordinates or a normal that a corner does not have.
pub(super) const NONE: u32 = u32::MAX;

/// A corner of a face: the numbers of its position, texture coordinates and normal, counted from 0.
pub(super) type Corner = [u32; 3];

/// Consecutive faces of one object, group and material.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Run {
    /// The number of its first face.
    pub first: usize,
    /// The object, if one is named.
    pub object: Option<String>,
    /// The group, if one is named.
    pub group: Option<String>,
    /// The name of the material.
    pub material: Option<String>,
}

/// What a file contains.
pub(super) struct Parsed {
    pub positions: Vec<[f32; 3]>,
    /// v down the image.
    pub uv: Vec<[f32; 2]>,
    /// As in the file, of any length.
    pub normals: Vec<[f32; 3]>,
    /// The corners of each face, at least three.
    pub faces: Vec<Vec<Corner>>,
    /// The line of each face.
    pub lines: Vec<usize>,
    pub runs: Vec<Run>,
    /// The material libraries that the file names, each in a statement.
    pub libraries: Vec<(usize, String)>,
}

/// Hands the statements of geometry to the parser, one line at a time, and keeps the others.
struct Feed<'a> {
    statements: Statements<'a>,
    /// The statement that the parser reads.
    current: Option<Statement<'a>>,
    line: Vec<u8>,
    read: usize,
    object: Option<String>,
    group: Option<String>,
    material: Option<String>,
    /// Whether faces continue the last run.
    is_same_run: bool,
    uv: Vec<[f32; 2]>,
    lines: Vec<usize>,
    runs: Vec<Run>,
    libraries: Vec<(usize, String)>,
}

impl<'a> Feed<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self {
            statements: Statements::new(bytes),
            current: None,
            line: Vec::new(),
            read: 0,
            object: None,
            group: None,
            material: None,
            is_same_run: false,
            uv: Vec::new(),
            lines: Vec::new(),
            runs: Vec::new(),
            libraries: Vec::new(),
        }
    }

    /// Prepares the next line for the parser. Numbers that this crate does not use are left out: weights and colours of
    /// positions, and third texture coordinates.
    fn advance(&mut self) {
        (self.current, self.read) = (None, 0);
        self.line.clear();
        while let Some(statement) = self.statements.next() {
            let most = match &*statement.keyword {
                "v" | "vn" => 3,
                "vt" => 2,
                "f" | "fo" => usize::MAX,
                _ => {
                    self.keep(&statement);
                    continue;
                }
            };
            match &*statement.keyword {
                "vt" => self.keep_coordinates(&statement),
                "f" | "fo" => self.keep_face(&statement),
                _ => {}
            }
            self.line.extend_from_slice(statement.keyword.as_bytes());
            for word in statement.words().take(most) {
                self.line.push(b' ');
                // Some exporters end corners without a normal with a slash.
                self.line.extend_from_slice(word.trim_end_matches('/').as_bytes());
            }
            self.line.push(b'\n');
            self.current = Some(statement);
            return;
        }
    }

    fn keep(&mut self, statement: &Statement<'_>) {
        let text = (!statement.rest.is_empty()).then(|| statement.rest.trim_end().to_owned());
        match &*statement.keyword {
            // A group lies in the object that it follows.
            "o" => (self.object, self.group) = (text, None),
            "g" => self.group = text,
            "usemtl" => self.material = text,
            "mtllib" => {
                self.libraries.extend(text.map(|text| (statement.line, text)));
                return;
            }
            _ => return,
        }
        self.is_same_run = false;
    }

    /// v is turned over in double precision, before it is rounded to `f32`, so that what this crate writes is read back
    /// unchanged. The parser of the crate `obj` refuses what is no number, and this list is not used then.
    fn keep_coordinates(&mut self, statement: &Statement<'_>) {
        let mut words = statement.words();
        let u = words.next().and_then(|word| word.parse::<f32>().ok()).unwrap_or(0.0);
        let v = words.next().and_then(|word| word.parse::<f64>().ok()).unwrap_or(0.0);
        self.uv.push([u, (1.0 - v) as f32]);
    }

    fn keep_face(&mut self, statement: &Statement<'_>) {
        if !std::mem::replace(&mut self.is_same_run, true) {
            let [object, group, material] =
                [&self.object, &self.group, &self.material].map(|name| name.clone());
            self.runs.push(Run { first: self.lines.len(), object, group, material });
        }
        self.lines.push(statement.line);
    }
}

impl Read for Feed<'_> {
    fn read(&mut self, to: &mut [u8]) -> std::io::Result<usize> {
        let here = self.fill_buf()?;
        let count = here.len().min(to.len());
        to[..count].copy_from_slice(&here[..count]);
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Feed<'_> {
    fn fill_buf(&mut self) -> std::io::Result<&[u8]> {
        if self.read == self.line.len() {
            self.advance();
        }
        Ok(&self.line[self.read..])
    }

    fn consume(&mut self, count: usize) {
        self.read += count;
    }
}

impl Parsed {
    /// Reads the text of an OBJ file.
    ///
    /// # Errors
    /// [`InputError`] with the line, for a statement that cannot be read, an index of something that does not exist, and a
    /// coordinate out of range; and for a file without faces.
    pub fn new(bytes: &[u8]) -> Result<Self, InputError> {
        let mut feed = Feed::new(bytes);
        let raw = obj::raw::parse_obj(&mut feed);
        let raw = raw.map_err(|error| match &feed.current {
            Some(statement) => statement.refused(None, bound(statement, &error)),
            None => InputError::new("OBJ", format!("[{} bytes]", bytes.len()), error.to_string()),
        })?;
        let Feed { uv, lines, runs, libraries, .. } = feed;
        if raw.polygons.is_empty() {
            let bound = "must have at least one face (points, lines and free-form surfaces are not read)";
            return Err(InputError::new("OBJ", format!("[{} bytes]", bytes.len()), bound));
        }
        let RawObj { positions, normals, polygons, .. } = raw;
        let positions: Vec<_> = positions.into_iter().map(|(x, y, z, _)| [x, y, z]).collect();
        let normals: Vec<_> = normals.into_iter().map(|(x, y, z)| [x, y, z]).collect();
        in_range(bytes, "v", &positions)?;
        in_range(bytes, "vt", &uv)?;
        in_range(bytes, "vn", &normals)?;
        let faces = polygons.into_iter().map(corners).collect();
        Ok(Self { positions, uv, normals, faces, lines, runs, libraries })
    }

    /// The runs, equal ones together: faces of one object, group and material, in the order of their first faces.
    pub fn parts(&self) -> Vec<(&Run, Vec<std::ops::Range<usize>>)> {
        let mut parts: Vec<(&Run, Vec<_>)> = Vec::new();
        let mut known = HashMap::new();
        for (at, run) in self.runs.iter().enumerate() {
            let end = self.runs.get(at + 1).map_or(self.faces.len(), |next| next.first);
            let place = *known.entry((&run.object, &run.group, &run.material)).or_insert_with(|| {
                parts.push((run, Vec::new()));
                parts.len() - 1
            });
            parts[place].1.push(run.first..end);
        }
        parts
    }
}

fn corners(polygon: Polygon) -> Vec<Corner> {
    match polygon {
        Polygon::P(all) => all.into_iter().map(|v| [v as u32, NONE, NONE]).collect(),
        Polygon::PT(all) => all.into_iter().map(|(v, vt)| [v as u32, vt as u32, NONE]).collect(),
        Polygon::PN(all) => all.into_iter().map(|(v, vn)| [v as u32, NONE, vn as u32]).collect(),
        Polygon::PTN(all) => all.into_iter().map(|(v, vt, vn)| [v as u32, vt as u32, vn as u32]).collect(),
    }
}

/// What a statement must be that the parser refuses.
fn bound(statement: &Statement<'_>, error: &ObjError) -> String {
    let is_index = matches!(error, ObjError::Load(error) if *error.kind() == LoadErrorKind::IndexOutOfRange);
    match &*statement.keyword {
        "v" | "vn" => "must have three numbers".to_owned(),
        "vt" => "must have one to three numbers".to_owned(),
        _ if is_index => {
            "must name v, vt and vn of the lines before it, counted from 1, or backwards from -1".to_owned()
        }
        _ => "must have three or more corners, all like 1, all like 1/1, all like 1//1 or all like 1/1/1"
            .to_owned(),
    }
}

/// Refuses numbers that are not finite or too large, and names their line.
fn in_range<const N: usize>(bytes: &[u8], keyword: &str, vectors: &[[f32; N]]) -> Result<(), InputError> {
    // The comparison is false for NaN.
    let is_within = |vector: &[f32; N]| vector.iter().all(|number| number.abs() <= COORDINATE_LIMIT);
    let Some(at) = vectors.iter().position(|vector| !is_within(vector)) else { return Ok(()) };
    let bound = format!("must be finite and within ±{COORDINATE_LIMIT:e}");
    let statement = Statements::new(bytes).filter(|statement| statement.keyword == keyword).nth(at);
    Err(match statement {
        Some(statement) => statement.refused(None, bound),
        None => InputError::new(format!("{keyword} {at}"), format!("{:?}", vectors[at]), bound),
    })
}
