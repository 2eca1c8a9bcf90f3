//! report.json of `relievo simplify`.

use std::fmt::{Display, Formatter};

use relievo::ops::mesh::Stopped;
use relievo_lab::files::sha256;
use relievo_lab::measure::reduction::MeasuredLevel;
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
    /// Why the reducer stopped: [`Stopped::name`].
    stopped: &'static str,
    /// SHA-256 of the file.
    hash: String,
    /// The reason in words, where the reducer missed its target.
    #[serde(skip)]
    hindrance: Option<&'static str>,
}

/// The reason in words why a reducer missed its target; `None` if it reached it.
fn hindrance(stopped: Stopped) -> Option<&'static str> {
    match stopped {
        Stopped::Triangles | Stopped::Error => None,
        Stopped::Seams => Some("held by seams of texture coordinates: see --texture-seams"),
        Stopped::Borders => Some("held by borders"),
        Stopped::Flips => Some("the next step would turn a triangle"),
        Stopped::Topology => Some("held by the topology: closed parts keep four triangles"),
        Stopped::Distance => Some("held by the distance allowed"),
        Stopped::Exhausted => Some("the reducer finds no further step"),
    }
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
            stopped: level.reduced.stopped.name(),
            hash: sha256(bytes),
            hindrance: hindrance(level.reduced.stopped),
        }
    }
}

impl Display for LevelReport {
    fn fmt(&self, out: &mut Formatter<'_>) -> std::fmt::Result {
        let Self { file, triangles, vertices, error_rms, error_max, hindrance, .. } = self;
        write!(
            out,
            "{file}: {triangles} triangles, {vertices} vertices, {error_rms:.4e} rms, {error_max:.4e} at most"
        )?;
        hindrance.map_or(Ok(()), |hindrance| write!(out, " ({hindrance})"))
    }
}
