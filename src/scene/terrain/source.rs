//! Sources of terrain: a recipe or the caller's heights, with the patches to show and their appearance.

use std::collections::HashSet;
use std::sync::Arc;

use super::endless::{EndlessLimits, TerrainHole};
use crate::InputError;
use crate::scene::options::TerrainStyle;
use crate::terrain::blend::Shading;
use crate::terrain::config::TerrainConfig;
use crate::terrain::elevation::ElevationSource;
use crate::terrain::fields::Fields;
use crate::terrain::morph::{Morph, check_target};
use crate::terrain::recipe::Recipe;
use crate::terrain::texture::TerrainTexture;

/// The source of a terrain's heights.
#[derive(Debug, Clone)]
pub(super) enum Origin {
    /// The scene generates the heights from a recipe.
    Recipe(Box<Recipe>),
    /// The caller computes the heights.
    Fields { config: Box<TerrainConfig>, fields: Fields },
}

/// Relief of the ground's textures, by the heights in them: stones and tufts cover what is behind them, and have their own shading.
/// It changes colours and normals alone: depth, positions, velocities and outlines are those of the ground. Colour maps
/// ([`ops::terrain::blend`](crate::ops::terrain::blend)) and parallel views show flat textures.
///
/// A fragment shows the relief of the texture that prevails there, found by a search in 16 to 56 equal steps with four
/// bisections, which may pass through details that are thinner. Where textures blend into each other, the relief becomes flat. Rays that meet the ground at less
/// than 9° are searched as if they met it at 9°.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundRelief {
    /// From the highest to the lowest texel, in world units: above 0, at most 1000.
    pub depth: f32,
    /// The distance from the eye, in world units, from which on textures are flat; the relief fades from half of it on. Above 0,
    /// finite.
    pub distance: f32,
}

impl GroundRelief {
    /// Checks both numbers.
    ///
    /// # Errors
    /// [`InputError`] that names the field.
    pub fn validate(&self) -> Result<(), InputError> {
        let Self { depth, distance } = *self;
        let is_good = depth > 0.0 && depth <= 1000.0;
        InputError::check(is_good, "relief.depth", depth, || "must be above 0 and at most 1000")?;
        let is_good = distance > 0.0 && distance.is_finite();
        InputError::check(is_good, "relief.distance", distance, || "must be above 0 and finite")
    }
}

/// Terrain for [`Scene::add_terrain`](crate::scene::Scene::add_terrain): heights, the patches to show, and the textures
/// of the terrain's zones. The world's origin is the first sample of patch (0, 0), in that patch's north-west corner. A
/// patch's edge is [`TerrainConfig::terrain_scale`] · ([`TerrainConfig::patch_size`] − 1) world units long. A height
/// unit is a world unit.
#[derive(Debug, Clone)]
pub struct TerrainSource {
    pub(super) origin: Origin,
    pub(super) patches: Vec<[i32; 2]>,
    pub(super) textures: Option<Vec<TerrainTexture>>,
    pub(super) shading: Shading,
    pub(super) style: TerrainStyle,
    /// The relief of textures; `None` for flat ones.
    pub(super) relief: Option<GroundRelief>,
    /// The recipe towards which the heights are blended, and the progress of the blend.
    pub(super) target: Option<(Box<Recipe>, Morph)>,
    /// Extent and memory of endless terrain; `None` for a list of patches.
    pub(super) endless: Option<EndlessLimits>,
    /// Holes of endless terrain; `None` for terrain that can have none.
    pub(super) holes: Option<Vec<TerrainHole>>,
    /// The elevation map of endless terrain.
    pub(super) elevation: Option<Arc<dyn ElevationSource>>,
}

impl TerrainSource {
    /// Terrain that shows patch (0, 0) of a configuration, with the textures that the zones name.
    pub fn new(config: TerrainConfig) -> Self {
        Recipe::new(config).into()
    }

    /// Terrain without end: around each camera, as far as the limits say ([`TerrainSource::with_limits`]), at the resolution that the
    /// views need.
    ///
    /// The ground is divided into nodes of `patch_size` samples. A node of level l has every 2^l-th sample and covers 4^l patches.
    /// The levels reach from 0 to `coarse_levels`. The scene makes nodes on the device as views need them, nearest first, at most
    /// [`EndlessLimits::nodes_per_frame`] in a frame; until then coarser nodes are drawn. Each view draws nodes whose vertices lie
    /// within [`Quality::pixels`](crate::scene::Quality::pixels) of the terrain's finest heights. Between two levels, vertices move
    /// continuously. [`Scene::terrain_statistics`](crate::scene::Scene::terrain_statistics) tells how much of the detail is there.
    ///
    /// Views that permit less than 1/16 pixel are drawn as with 1/16, and state no bound.
    ///
    /// The configuration must be `seamless`. Despiking is not possible. [`Scene::ground`] and
    /// [`Scene::pick`] answer for the finest heights everywhere, whatever is drawn; the host makes those patches when it is asked.
    ///
    /// [`Scene::ground`]: crate::scene::Scene::ground
    /// [`Scene::pick`]: crate::scene::Scene::pick
    ///
    /// ```no_run
    /// use relievo::scene::{EndlessLimits, Scene, TerrainConfig, TerrainSource};
    ///
    /// # fn load(scene: &mut Scene) -> Result<(), relievo::Error> {
    /// let config = TerrainConfig { coarse_levels: 8, ..TerrainConfig::new(65, 900.0, "any text")? };
    /// let limits = EndlessLimits { view_distance: Some(12_000.0), ..EndlessLimits::default() };
    /// let land = scene.add_terrain(&TerrainSource::endless(config).with_limits(limits))?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn endless(config: TerrainConfig) -> Self {
        Self { endless: Some(EndlessLimits::default()), ..Self::new(config) }
    }

    /// Sets extent and memory of endless terrain ([`TerrainSource::endless`]). Terrain from a list of patches becomes endless.
    #[must_use]
    pub fn with_limits(self, limits: EndlessLimits) -> Self {
        Self { endless: Some(limits), ..self }
    }

    /// Leaves holes in endless terrain, for caves whose ground and roof are meshes of the caller. Triangles with a corner in a hole
    /// are left out, also for [`Scene::ground`](crate::scene::Scene::ground) and [`Scene::pick`](crate::scene::Scene::pick). From
    /// afar, a hole narrower than the view's pixels is closed. [`Scene::set_terrain_holes`](crate::scene::Scene::set_terrain_holes)
    /// changes the holes; give an empty list if there are none at first. Terrain with holes is drawn a little slower.
    #[must_use]
    pub fn with_holes(self, holes: Vec<TerrainHole>) -> Self {
        Self { holes: Some(holes), ..self }
    }

    /// Gives endless terrain heights of the caller: an elevation map ([`ElevationTiles`](crate::terrain::elevation::ElevationTiles)), or
    /// tiles that arrive one by one. Around the map and between its samples, heights are generated from the configuration. Injected
    /// heights of the recipe lie on the map. Nodes whose heights are on their way are not drawn yet; coarser ones are.
    /// [`Scene::ground`](crate::scene::Scene::ground) answers `None` there.
    #[must_use]
    pub fn with_elevation(self, elevation: Arc<dyn ElevationSource>) -> Self {
        Self { elevation: Some(elevation), ..self }
    }

    /// Terrain from heights that the caller's passes have computed or will compute. The first field shows the first
    /// patch, and so on. Only these parts of the configuration are used: `patch_size`, `terrain_scale`, `texture_tile`,
    /// `triplanar`, `variation` and `zones`. Shading reads samples around each patch. So each field needs a margin of
    /// at least one sample, with the same width on every side.
    ///
    /// The scene shares the buffer of the fields without a copy. Each frame draws the heights that are in the buffer
    /// when the frame executes. After passes have changed the heights, call
    /// [`Scene::read_ground`](crate::scene::Scene::read_ground). It updates the heights on the host. These heights decide
    /// which patches are culled, and how queries about the ground are answered. To show other patches, call
    /// [`Scene::set_patches`](crate::scene::Scene::set_patches).
    ///
    /// A [`Generator`](crate::terrain::generator::Generator) or a [`HeightBatch`](crate::terrain::regions::HeightBatch)
    /// splits fields that exceed a binding of the device. Add each part as a terrain of its own.
    ///
    /// ```no_run
    /// use relievo::ops::terrain::generator::Generator;
    /// use relievo::scene::{Scene, TerrainConfig, TerrainRecipe, TerrainSource};
    ///
    /// # fn load(gpu: &relievo::gpu::Gpu, scene: &mut Scene) -> Result<(), relievo::Error> {
    /// let (config, patches) = (TerrainConfig::new(129, 40.0, "any text")?, [[0, 0], [1, 0]]);
    /// let generator = Generator::new(gpu, TerrainRecipe::new(config.clone()))?;
    /// let fields = generator.generate(gpu, &patches, 1, &mut |_| ())?.remove(0); // and further passes over them
    /// let land = scene.add_terrain(&TerrainSource::from_fields(config, fields, &patches))?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn from_fields(config: TerrainConfig, fields: Fields, patches: &[[i32; 2]]) -> Self {
        let origin = Origin::Fields { config: Box::new(config), fields };
        Self::of(origin).with_patches(patches)
    }

    fn of(origin: Origin) -> Self {
        let (shading, style) = (Shading::default(), TerrainStyle::Textured);
        Self {
            origin,
            patches: vec![[0, 0]],
            textures: None,
            shading,
            style,
            relief: None,
            target: None,
            endless: None,
            holes: None,
            elevation: None,
        }
    }

    /// Replaces the patches to show. Each patch is given by its column, counted to the east, and its row, counted to
    /// the south. No patch may be given twice.
    #[must_use]
    pub fn with_patches(self, patches: &[[i32; 2]]) -> Self {
        Self { patches: patches.to_vec(), ..self }
    }

    /// Replaces the textures. There must be one texture per zone of the configuration.
    #[must_use]
    pub fn with_textures(self, textures: Vec<TerrainTexture>) -> Self {
        Self { textures: Some(textures), ..self }
    }

    /// Sets how zones are blended and shaded. The light of `shading` is ignored, because a scene has one light.
    #[must_use]
    pub fn with_shading(self, shading: Shading) -> Self {
        Self { shading, ..self }
    }

    /// Gives the textures a relief near the eye.
    #[must_use]
    pub fn with_relief(self, relief: GroundRelief) -> Self {
        Self { relief: Some(relief), ..self }
    }

    /// Sets the appearance of the terrain.
    #[must_use]
    pub fn with_style(self, style: TerrainStyle) -> Self {
        Self { style, ..self }
    }

    /// Adds a second recipe, towards which the heights are blended. Its samples must be in the same places as the
    /// samples of the first recipe. `morph` is the initial blend; [`Scene::morph_terrain`](crate::scene::Scene::morph_terrain)
    /// changes it. Each recipe has its own erosion. Zones and textures are taken from the first recipe. Endless terrain with a target takes
    /// three times the memory for heights, none for finer normals, and no elevation map; both recipes have the same `coarse_levels`.
    #[must_use]
    pub fn with_target(self, target: Recipe, morph: Morph) -> Self {
        Self { target: Some((Box::new(target), morph)), ..self }
    }

    /// Checks the second recipe and the blend, if there are any.
    ///
    /// # Errors
    /// [`InputError`] with a path below `target` for a second recipe with samples in other places, and for a second
    /// recipe of terrain made from fields. [`InputError`] also if [`Morph::validate`] refuses the blend.
    pub(super) fn check_target(&self) -> Result<(), InputError> {
        let Some((target, morph)) = &self.target else { return Ok(()) };
        let bound = || "must not be given for terrain made from fields: blend them with a pass";
        InputError::check(self.fields().is_none(), "target", "a recipe", bound)?;
        let below = |error: InputError| error.below("target");
        check_target(self.config(), &target.config).map_err(below)?;
        target.validate(&self.patches, 1).map_err(below)?;
        morph.validate()
    }

    /// The recipe and the limits of endless terrain; `None` for a list of patches.
    ///
    /// # Errors
    /// [`InputError`] for endless terrain from fields, for holes in patches, and for a relief out of its ranges.
    pub(in crate::scene) fn endless_recipe(&self) -> Result<Option<(&Recipe, EndlessLimits)>, InputError> {
        if let Some(relief) = self.relief {
            relief.validate()?;
        }
        let Some(limits) = self.endless else {
            let bound = || "must not be given unless terrain is endless";
            InputError::check(self.holes.is_none(), "holes", "given", bound)?;
            InputError::check(self.elevation.is_none(), "elevation", "given", bound)?;
            return Ok(None);
        };
        match &self.origin {
            Origin::Fields { .. } => {
                Err(InputError::new("fields", "given", "must not be given where terrain is endless"))
            }
            Origin::Recipe(recipe) => Ok(Some((recipe, limits))),
        }
    }

    /// The terrain's configuration.
    pub(in crate::scene) fn config(&self) -> &TerrainConfig {
        match &self.origin {
            Origin::Recipe(recipe) => &recipe.config,
            Origin::Fields { config, .. } => config,
        }
    }

    /// The fields that the caller provided; `None` if the scene generates the heights.
    pub(super) fn fields(&self) -> Option<&Fields> {
        match &self.origin {
            Origin::Recipe(_) => None,
            Origin::Fields { fields, .. } => Some(fields),
        }
    }
}

impl From<Recipe> for TerrainSource {
    /// Terrain that shows patch (0, 0) of a recipe, with the recipe's features, despiking and erosion.
    fn from(recipe: Recipe) -> Self {
        Self::of(Origin::Recipe(Box::new(recipe)))
    }
}

/// Checks the caller's fields: the configuration, the margin, and the size of the buffer.
pub(super) fn check_fields(config: &TerrainConfig, fields: &Fields) -> Result<(), InputError> {
    config.validate()?;
    let size = config.patch_size;
    if fields.width < size + 2 || !(fields.width - size).is_multiple_of(2) {
        let bound = format!("must be patchSize = {size} and an even margin of at least 2");
        return Err(InputError::new("fields.width", fields.width, bound));
    }
    fields.check("fields", 0)
}

/// Checks that each patch is given once, has a field, and has sample coordinates within the range of `i32`.
pub(super) fn check_patches(
    config: &TerrainConfig,
    fields: &Fields,
    patches: &[[i32; 2]],
) -> Result<(), InputError> {
    let bound = || format!("must be at most {}, the fields' count", fields.count);
    InputError::check(patches.len() <= fields.count as usize, "patches.len", patches.len(), bound)?;
    let edge = i64::from(config.patch_size) - 1;
    for (at, patch) in patches.iter().enumerate() {
        let is_far = |index: &i32| {
            let first = i64::from(*index) * edge;
            i32::try_from(first).is_err() || i32::try_from(first + edge).is_err()
        };
        if let Some(axis) = patch.iter().position(is_far) {
            let bound = format!("must lie within 2^31 / {edge} patches of the origin");
            return Err(InputError::new(format!("patches[{at}][{axis}]"), patch[axis], bound));
        }
    }
    check_once(patches)
}

/// Checks that no patch is given twice.
pub(super) fn check_once(patches: &[[i32; 2]]) -> Result<(), InputError> {
    let mut known = HashSet::new();
    match patches.iter().position(|patch| !known.insert(patch)) {
        None => Ok(()),
        Some(at) => {
            let value = format!("{:?}", patches[at]);
            Err(InputError::new(format!("patches[{at}]"), value, "must not be given twice"))
        }
    }
}
