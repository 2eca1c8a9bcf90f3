//! The checked contents of a scene file, before the files that it names are read.

use std::path::PathBuf;

use glam::{DVec3, Quat, Vec3};

use crate::animation::Wrap;
use crate::scene::{LevelOfDetail, Transition};
use crate::surface::ReliefShadow;
use crate::surface::relief::ReliefMethod;
use crate::terrain::morph::Morph;
use crate::terrain::recipe::Recipe;

/// The terrain.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TerrainEntry {
    pub recipe: Recipe,
    pub patches: Vec<[i32; 2]>,
    /// The target heights, and how far the morph has progressed.
    pub target: Option<(Recipe, Morph)>,
}

/// A model with its instances.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ObjectEntry {
    /// Its path in the scene file, such as `meshes[0]`.
    pub path: String,
    pub source: Source,
    pub kind: EntryKind,
    /// Transition of its levels of detail; `None`: the scene's.
    pub transition: Option<Transition>,
    /// How its levels of detail are chosen; `None`: by error.
    pub level_of_detail: Option<LevelOfDetail>,
    pub instances: Vec<InstanceEntry>,
    pub scatter: Option<Scatter>,
}

/// The kind of an object.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum EntryKind {
    Mesh,
    Relief(ReliefEntry),
    Character(PlayEntry),
}

impl ObjectEntry {
    /// Number of instances.
    pub fn count(&self) -> usize {
        self.instances.len() + self.scatter.as_ref().map_or(0, |scatter| scatter.count as usize)
    }
}

/// The source of a model or a map.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Source {
    /// The name after `builtin:`.
    BuiltIn(String),
    /// A path relative to the scene file.
    File(PathBuf),
}

/// The prefix of built-in names.
pub(super) const BUILT_IN: &str = "builtin:";

impl std::fmt::Display for Source {
    fn fmt(&self, text: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::BuiltIn(name) => write!(text, "{BUILT_IN}{name}"),
            Self::File(path) => write!(text, "{}", path.display()),
        }
    }
}

/// The relief on a mesh.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ReliefEntry {
    pub heights: Source,
    /// Whether heights are the alpha channel instead of the brightness.
    pub is_alpha: bool,
    pub albedo: Option<Source>,
    pub normals: Option<Source>,
    /// Depth in tiles.
    pub scale: f32,
    /// Factor of the mesh's texture coordinates.
    pub tiles: f32,
    pub method: ReliefMethod,
    pub shadow: ReliefShadow,
}

/// A character's animation.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PlayEntry {
    /// Name or index of the clip; `None`: the first one.
    pub clip: Option<String>,
    pub rate: f32,
    pub start: f64,
    pub wrap: Wrap,
}

/// An instance.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct InstanceEntry {
    pub spot: Spot,
    pub turn: Quat,
    pub scale: Vec3,
    /// Its animation, if it is a character.
    pub play: Option<PlayEntry>,
}

/// An instance's position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Spot {
    /// A position in the world.
    At(DVec3),
    /// A position on the drawn ground, `lift` model units above it.
    On { x: f64, z: f64, lift: f64 },
}

/// Instances at pseudorandom places drawn from a seed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scatter {
    pub count: u32,
    pub seed: String,
    /// Two corners: smallest and largest x and z. `None`: the patches of the terrain.
    pub area: Option<[[f64; 2]; 2]>,
    /// The smallest and the largest scale.
    pub scale: [f32; 2],
    /// Height above the ground in model units.
    pub lift: f64,
}
