//! The checked contents of a scene file, before the files that it names are read.

use std::path::{Path, PathBuf};

use glam::{DVec3, Quat, Vec3};
use relievo::ops::animation::Wrap;
use relievo::ops::surface::ReliefShadow;
use relievo::ops::surface::relief::ReliefMethod;
use relievo::ops::terrain::fixed::FeatureMode;
use relievo::ops::terrain::morph::Morph;
use relievo::ops::terrain::recipe::Recipe;
use relievo::scene::{EndlessLimits, GroundRelief, LevelOfDetail, TerrainHole, Transition};

use super::parse_character::CharacterDetail;

/// The terrain of a scene file.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TerrainEntry {
    pub recipe: Recipe,
    pub patches: Vec<[i32; 2]>,
    /// The target heights of a morph, and the progress of the morph.
    pub target: Option<(Recipe, Morph)>,
    /// Extent of endless terrain; `None` if `patches` are the terrain.
    pub endless: Option<EndlessLimits>,
    /// Holes of endless terrain.
    pub holes: Option<Vec<HoleEntry>>,
    /// The elevation map of endless terrain.
    pub elevation: Option<ElevationEntry>,
    /// The relief of textures.
    pub relief: Option<GroundRelief>,
    /// Files of injected heights, and how these are injected.
    pub features: Vec<PathBuf>,
    pub feature_mode: FeatureMode,
}

/// A hole, whose image is read later.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum HoleEntry {
    Circle(TerrainHole),
    /// An image whose dark pixels are samples of the hole, and column and row of its first pixel.
    Image {
        file: PathBuf,
        first: [i32; 2],
    },
}

/// An elevation map: an image, and where it lies.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ElevationEntry {
    pub file: PathBuf,
    /// The heights that black and white stand for.
    pub range: [f32; 2],
    /// Column and row of the first sample, in samples of the map.
    pub first: [i32; 2],
    pub spacing: u32,
    pub margin: u32,
}

/// An entry of `meshes` or `characters`: a model with its instances.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ObjectEntry {
    /// Path of the entry in the scene file, such as `meshes[0]`.
    pub path: String,
    /// What the scene file calls the object.
    pub name: Option<String>,
    pub source: ModelSource,
    pub kind: EntryKind,
    /// Level of detail of a character's bones; the default for a mesh.
    pub detail: CharacterDetail,
    /// Transition of the object's levels of detail; `None` for the scene's transition.
    pub transition: Option<Transition>,
    /// How the object's levels of detail are chosen. With `None`, they are chosen by error.
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
    /// The path of the package that the object shows. Reliefs do not change later, so theirs is none.
    pub fn package(&self) -> Option<&Path> {
        let ModelSource::One(Source::File(path)) = &self.source else { return None };
        let is_package = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("rlv"));
        let changes = !matches!(self.kind, EntryKind::Relief(_));
        Some(&**path).filter(|_| is_package && changes)
    }

    /// Number of listed and scattered instances.
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

/// The source of an object's model.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) enum ModelSource {
    /// One name, from the field `file`.
    One(Source),
    /// One name for each level of detail, the finest first, from the field `levels`.
    Levels(Vec<Source>),
}

impl ModelSource {
    /// Path in the scene file of the name of a level. `entry` is the path of the object's entry.
    pub fn path(&self, entry: &str, level: usize) -> String {
        match self {
            Self::One(_) => format!("{entry}.file"),
            Self::Levels(_) => format!("{entry}.levels[{level}]"),
        }
    }

    /// All names, the finest level first.
    pub fn names(&self) -> &[Source] {
        match self {
            Self::One(source) => std::slice::from_ref(source),
            Self::Levels(all) => all,
        }
    }

    /// The name of a level. The levels of one file have one name.
    pub fn name(&self, level: usize) -> &Source {
        let names = self.names();
        &names[level.min(names.len() - 1)]
    }
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

impl std::fmt::Display for ModelSource {
    fn fmt(&self, text: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names: Vec<String> = self.names().iter().map(Source::to_string).collect();
        write!(text, "{}", names.join(", "))
    }
}

/// The relief material of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ReliefEntry {
    pub heights: Source,
    /// Whether the image's alpha channel has the heights. Otherwise, the brightness has them.
    pub is_alpha: bool,
    pub albedo: Option<Source>,
    pub normals: Option<Source>,
    /// Depth of the relief in tiles (repeats of its texture).
    pub scale: f32,
    /// Factor by which the mesh's texture coordinates are multiplied.
    pub tiles: f32,
    pub method: ReliefMethod,
    pub shadow: ReliefShadow,
}

/// A character's animation.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PlayEntry {
    /// Name or index of the clip; `None` for the first clip.
    pub clip: Option<String>,
    pub rate: f32,
    pub start: f64,
    pub wrap: Wrap,
}

/// A listed instance of a mesh or a character.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct InstanceEntry {
    pub spot: Spot,
    pub turn: Quat,
    pub scale: Vec3,
    /// Animation of a character's instance; `None` for a mesh.
    pub play: Option<PlayEntry>,
}

/// An instance's position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Spot {
    /// A position in the world.
    At(DVec3),
    /// A position `lift` model units above the drawn ground.
    On { x: f64, z: f64, lift: f64 },
}

/// Instances at pseudorandom positions, which depend on a seed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scatter {
    pub count: u32,
    pub seed: String,
    /// Area as two corners: the smallest x and z, and the largest x and z. `None`: the patches of the terrain.
    pub area: Option<[[f64; 2]; 2]>,
    /// The smallest and the largest scale of the instances.
    pub scale: [f32; 2],
    /// Height above the ground in model units.
    pub lift: f64,
}
