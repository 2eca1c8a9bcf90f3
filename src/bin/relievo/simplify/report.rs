//! report.json of `relievo simplify`.

use std::fmt::{Display, Formatter};

use relievo::files::sha256;
use relievo::measure::reduction::MeasuredLevel;
use serde::Serialize;

#[derive(Serialize)]
pub struct Report<'a> {
    pub model: &'a str,
    pub reducer: &'a str,
    /// Of the reducer alone.
    pub seconds: f64,
    pub levels: Vec<LevelReport>,
}

#[derive(Serialize)]
pub struct LevelReport {
    file: String,
    triangles: usize,
    vertices: usize,
    error_rms: f64,
    error_max: f64,
    /// SHA-256 of the file.
    hash: String,
}

impl LevelReport {
    /// Of a level that is written as a file.
    pub fn new(file: &str, bytes: &[u8], level: &MeasuredLevel) -> Self {
        Self {
            file: file.to_owned(),
            triangles: level.reduced.triangles(),
            vertices: level.reduced.vertices(),
            error_rms: level.distance.rms(),
            error_max: level.distance.max(),
            hash: sha256(bytes),
        }
    }
}

impl Display for LevelReport {
    fn fmt(&self, out: &mut Formatter<'_>) -> std::fmt::Result {
        let Self { file, triangles, vertices, error_rms, error_max, .. } = self;
        write!(
            out,
            "{file}: {triangles} triangles, {vertices} vertices, {error_rms:.4e} rms, {error_max:.4e} at most"
        )
    }
}
