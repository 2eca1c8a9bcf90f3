//! The header of a package, and its checks.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use sha2::{Digest as _, Sha256};

use crate::InputError;

/// The first bytes of every package.
pub(super) const MAGIC: [u8; 4] = *b"RLV\n";

/// Version of the format. A reader refuses packages of a later version.
pub const VERSION: u32 = 1;

/// Number of bytes before the header: [`MAGIC`], the header's length, and its SHA-256.
const PRELUDE: usize = MAGIC.len() + 4 + 32;

/// Largest number of bytes of a header.
const MOST_BYTES: usize = 1 << 20;

/// Vertices that every package may have, and bytes of chunks for each further one.
const VERTICES: usize = 1 << 17;
const BYTES_A_VERTEX: usize = 3;

/// Triangles of all levels of all meshes that every package may have, and those that each byte of chunks adds.
const TRIANGLES: usize = 1 << 18;
const TRIANGLES_A_BYTE: usize = 2;

/// Triangles of all levels that no package may exceed: numbers of their edges fit 32 bits.
const MOST_TRIANGLES: usize = 1 << 29;

/// Vertices times morph targets that each triangle of [`TRIANGLES`] and each byte of chunks allows.
const TESTS: usize = 32;

/// The header of a package: what its chunks are, and where they lie. It is JSON, with the names of the fields.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PackageHeader {
    /// Version of the format.
    pub version: u32,
    /// The program that wrote the package, and its version.
    pub generator: String,
    /// Largest distance in the model's units by which quantization moved a vertex, in any examined pose. It is contained in
    /// the errors of all levels but the finest, whose error it is.
    pub quantization: f32,
    /// Skeleton, skins, clips, materials, and the fields of meshes without vertices.
    pub model: PackageChunk,
    /// Levels of detail, the coarsest first.
    pub levels: Vec<PackageLevel>,
    /// Images, as PNG, JPEG or WebP.
    pub images: Vec<PackageChunk>,
}

/// A range of a package's bytes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PackageChunk {
    /// Index of the first byte in the file.
    pub start: usize,
    /// Index after the last byte.
    pub end: usize,
    /// SHA-256 of the bytes, in hexadecimal digits.
    pub sha256: String,
}

/// A level of detail of a package. Its chunk refines the level before.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PackageLevel {
    /// Number of triangles of all meshes at this level.
    pub triangles: usize,
    /// Number of vertices of all meshes at this level.
    pub vertices: usize,
    /// Largest distance between the level and the source, in the model's units; see
    /// [`MeshLevel::error`](crate::asset::MeshLevel::error).
    pub error: f32,
    /// The bytes that refine the level before.
    pub chunk: PackageChunk,
    /// SHA-256 of the vertices and triangles of all meshes at this level ([`Package::hash`](super::Package::hash)).
    pub hash: String,
}

/// The only field that every version has.
#[derive(Deserialize)]
struct Versioned {
    version: u32,
}

impl PackageHeader {
    /// Reads the header at the start of a package. The rest of the package may be missing. Returns the header, and the number
    /// of bytes before the first chunk.
    ///
    /// # Errors
    /// [`InputError`] for bytes that are not the start of a package, for a later version, for fields that contradict each
    /// other, and for more vertices or triangles than chunks of this size can have.
    pub fn read(bytes: &[u8]) -> Result<(Self, usize), InputError> {
        let refused = |field: &str, value: String, bound: String| {
            Err(InputError::new(format!("package.{field}"), value, bound))
        };
        if !bytes.starts_with(&MAGIC) {
            return refused("magic", "other bytes".to_owned(), "must be RLV and a line feed".to_owned());
        }
        let Some((prelude, rest)) = bytes.split_at_checked(PRELUDE) else {
            return refused("len", bytes.len().to_string(), format!("must be at least {PRELUDE}"));
        };
        let (length, sum) = prelude[MAGIC.len()..].split_at(4);
        let length = length.iter().rev().fold(0, |length, byte| length << 8 | usize::from(*byte));
        if length > MOST_BYTES {
            return refused("header.len", length.to_string(), format!("must be at most {MOST_BYTES}"));
        }
        let Some(json) = rest.get(..length) else {
            let bound = format!("must be at most {}, the bytes that are there", rest.len());
            return refused("header.len", length.to_string(), bound);
        };
        if Sha256::digest(json).as_slice() != sum {
            return refused("header", "other bytes".to_owned(), "must have the SHA-256 before it".to_owned());
        }
        let unreadable = |error: serde_json::Error| {
            InputError::new("package.header", "JSON", format!("cannot be read: {error}"))
        };
        let Versioned { version } = serde_json::from_slice(json).map_err(unreadable)?;
        if version > VERSION {
            let bound = format!("must be at most {VERSION}: a later version of relievo reads this package");
            return refused("version", version.to_string(), bound);
        }
        let header: Self = serde_json::from_slice(json).map_err(unreadable)?;
        header.check(PRELUDE + length).map_err(|error| error.below("package"))?;
        Ok((header, PRELUDE + length))
    }

    /// All chunks, each with its path.
    fn chunks(&self) -> impl Iterator<Item = (String, &PackageChunk)> {
        let levels = self.levels.iter().enumerate();
        let images = self.images.iter().enumerate();
        std::iter::once(("model".to_owned(), &self.model))
            .chain(levels.map(|(at, level)| (format!("levels[{at}].chunk"), &level.chunk)))
            .chain(images.map(|(at, chunk)| (format!("images[{at}]"), chunk)))
    }

    /// The number of bytes of the whole package.
    pub fn bytes(&self) -> usize {
        self.chunks().map(|(_, chunk)| chunk.end).max().unwrap_or(0)
    }

    fn check(&self, first: usize) -> Result<(), InputError> {
        InputError::check_same("version", self.version, VERSION, "the only version so far")?;
        if !(0.0..f32::INFINITY).contains(&self.quantization) {
            let bound = "must be finite, and at least 0";
            return Err(InputError::new("quantization", self.quantization, bound));
        }
        InputError::check(!self.levels.is_empty(), "levels.len", 0, || "must be at least 1")?;
        InputError::check_most("levels.len", self.levels.len(), crate::asset::mesh::MAX_LEVELS)?;
        let (mut vertices, mut error) = (0, f32::INFINITY);
        for (at, level) in self.levels.iter().enumerate() {
            let path = |field: &str| format!("levels[{at}].{field}");
            let bound = || format!("must be at least {vertices}, which the level before has");
            InputError::check(level.vertices >= vertices, path("vertices"), level.vertices, bound)?;
            if !(0.0..=error).contains(&level.error) || !level.error.is_finite() {
                let bound = "must be finite, at least 0, and at most that of the level before";
                return Err(InputError::new(path("error"), level.error, bound));
            }
            (vertices, error) = (level.vertices, level.error);
        }
        let bytes = self.level_bytes();
        let triangles = self.levels.iter().map(|level| level.triangles).max().unwrap_or(0);
        let fits = vertices <= most_vertices(bytes) && triangles <= most_triangles(bytes);
        InputError::check(fits, "levels", format!("{vertices} vertices and {triangles} triangles"), || {
            let [vertices, triangles] = [most_vertices(bytes), most_triangles(bytes)];
            format!("must be at most {vertices} and {triangles} in {bytes} bytes")
        })?;
        let mut before = first;
        for (path, chunk) in self.chunks() {
            InputError::check_same(
                format!("{path}.start"),
                chunk.start,
                before,
                "the end of the chunk before",
            )?;
            let bound = || format!("must be at least {before}, its start");
            InputError::check(chunk.end >= before, format!("{path}.end"), chunk.end, bound)?;
            before = chunk.end;
        }
        Ok(())
    }

    /// Number of bytes of all levels.
    pub(super) fn level_bytes(&self) -> usize {
        self.levels
            .iter()
            .map(|level| level.chunk.end.saturating_sub(level.chunk.start))
            .fold(0, usize::saturating_add)
    }

    /// Number of vertices of the finest level.
    pub(super) fn vertices(&self) -> usize {
        self.levels.last().map_or(0, |level| level.vertices)
    }

    /// The header as bytes, with all that stands before the first chunk. Chunks must begin at 0: they are moved to their place.
    pub(super) fn written(mut self) -> Result<Vec<u8>, InputError> {
        let unwritable =
            |error: serde_json::Error| InputError::new("package.header", "JSON", error.to_string());
        // Longer numbers make the header longer, so the places are found in a few rounds.
        let mut first = 0;
        loop {
            let json = serde_json::to_vec(&self).map_err(unwritable)?;
            let wanted = PRELUDE + json.len();
            if wanted == first {
                let length = (json.len() as u32).to_le_bytes();
                let sum = Sha256::digest(&json);
                return Ok([&MAGIC[..], &length, sum.as_slice(), &json].concat());
            }
            let levels = self.levels.iter_mut().map(|level| &mut level.chunk);
            for chunk in std::iter::once(&mut self.model).chain(levels).chain(&mut self.images) {
                chunk.start = chunk.start - first + wanted;
                chunk.end = chunk.end - first + wanted;
            }
            first = wanted;
        }
    }
}

/// Largest number of vertices of levels with this number of bytes. It bounds what a reader allocates.
pub(super) fn most_vertices(bytes: usize) -> usize {
    VERTICES + bytes / BYTES_A_VERTEX
}

/// Largest number of triangles of all levels of all meshes together.
pub(super) fn most_triangles(bytes: usize) -> usize {
    (TRIANGLES + bytes * TRIANGLES_A_BYTE).min(MOST_TRIANGLES)
}

/// Largest number of displacements by morph targets.
pub(super) fn most_moves(bytes: usize) -> usize {
    TRIANGLES + bytes / BYTES_A_VERTEX
}

/// Largest number of vertices times morph targets.
pub(super) fn most_tests(bytes: usize) -> usize {
    (TRIANGLES + bytes).saturating_mul(TESTS)
}

impl PackageChunk {
    /// A chunk that begins at `start`.
    pub(super) fn new(start: usize, bytes: &[u8]) -> Self {
        Self { start, end: start + bytes.len(), sha256: sha256(bytes) }
    }

    /// The bytes of the chunk in the file.
    pub fn range(&self) -> Range<usize> {
        self.start..self.end
    }

    /// Refuses bytes that are not those of the chunk. `path` names the chunk in errors.
    ///
    /// # Errors
    /// [`InputError`] for another number of bytes, and for another SHA-256.
    pub fn check(&self, path: &str, bytes: &[u8]) -> Result<(), InputError> {
        let length = self.end - self.start;
        InputError::check_same(format!("{path}.len"), bytes.len(), length, "the length in the header")?;
        let sum = sha256(bytes);
        let bound = || format!("must be {}, the SHA-256 in the header", self.sha256);
        InputError::check(sum == self.sha256, format!("{path}.sha256"), &sum, bound)
    }
}

/// SHA-256 of bytes, as 64 hexadecimal digits, as in headers of packages.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
