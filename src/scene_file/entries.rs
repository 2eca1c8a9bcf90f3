//! What a scene file says, checked, before any file that it names is read.

use std::path::PathBuf;

use glam::{DVec3, Quat, Vec3};

use crate::animation::Wrap;
use crate::scene::Transition;
use crate::surface::Shadow;
use crate::surface::relief::Method;
use crate::terrain::morph::Morph;
use crate::terrain::recipe::Recipe;

/// The terrain.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TerrainEntry {
    pub recipe: Recipe,
    pub patches: Vec<[i32; 2]>,
    /// What the heights become, and how far they are on the way.
    pub target: Option<(Recipe, Morph)>,
}

/// A model with its instances.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ObjectEntry {
    /// Its path in the scene file: `meshes[0]`.
    pub path: String,
    pub source: Source,
    pub kind: EntryKind,
    /// How its levels of detail change; as the scene's if it does not say.
    pub transition: Option<Transition>,
    pub instances: Vec<InstanceEntry>,
    pub scatter: Option<Scatter>,
}

/// What an object is.
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

/// Where a model or a map comes from.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum Source {
    /// The name after `builtin:`.
    BuiltIn(String),
    /// A path relative to the scene file.
    File(PathBuf),
}

/// The prefix of what needs no file.
pub(super) const BUILT_IN: &str = "builtin:";

impl std::fmt::Display for Source {
    fn fmt(&self, text: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::BuiltIn(name) => write!(text, "{BUILT_IN}{name}"),
            Self::File(path) => write!(text, "{}", path.display()),
        }
    }
}

/// The relief that a mesh carries.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ReliefEntry {
    pub heights: Source,
    /// Whether heights are the alpha channel, and not the brightness.
    pub is_alpha: bool,
    pub albedo: Option<Source>,
    pub normals: Option<Source>,
    /// Depth in tiles.
    pub scale: f32,
    /// The factor of the mesh's texture coordinates.
    pub tiles: f32,
    pub method: Method,
    pub shadow: Shadow,
}

/// What a character plays.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PlayEntry {
    /// Name or index; the first clip without.
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
    /// What it plays, if it is a character.
    pub play: Option<PlayEntry>,
}

/// Where an instance stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Spot {
    /// In the world.
    At(DVec3),
    /// On the ground that is drawn, `lift` model units above it.
    On { x: f64, z: f64, lift: f64 },
}

/// Instances in places that a seed draws.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scatter {
    pub count: u32,
    pub seed: String,
    /// Two corners: least and largest x and z. Without it, the patches of the terrain.
    pub area: Option<[[f64; 2]; 2]>,
    /// The least and the largest scale.
    pub scale: [f32; 2],
    /// Model units above the ground.
    pub lift: f64,
}
