//! What terrain of a scene is made from: a recipe or the caller's heights, its patches, and its look.

use std::collections::HashSet;

use crate::InputError;
use crate::scene::options::TerrainStyle;
use crate::terrain::blend::Shading;
use crate::terrain::config::Config;
use crate::terrain::fields::Fields;
use crate::terrain::morph::{Morph, check_target};
use crate::terrain::recipe::Recipe;
use crate::terrain::texture::Texture;

/// Where the heights come from.
#[derive(Debug, Clone)]
pub(super) enum Origin {
    /// The scene generates them.
    Recipe(Box<Recipe>),
    /// The caller computes them.
    Fields { config: Box<Config>, fields: Fields },
}

/// Terrain for [`Scene::add_terrain`](crate::scene::Scene::add_terrain): heights, the patches that they show, and the textures
/// of its zones. The origin of the world is the first sample of patch (0, 0), in the north-west; an edge of a patch is
/// [`Config::terrain_scale`] · ([`Config::patch_size`] − 1) world units long, and a height unit is a world unit.
#[derive(Debug, Clone)]
pub struct TerrainSource {
    pub(super) origin: Origin,
    pub(super) patches: Vec<[i32; 2]>,
    pub(super) textures: Option<Vec<Texture>>,
    pub(super) shading: Shading,
    pub(super) style: TerrainStyle,
    /// What the heights become, and how far they are on the way.
    pub(super) target: Option<(Box<Recipe>, Morph)>,
}

impl TerrainSource {
    /// Patch (0, 0) of a configuration, with the textures that its zones name.
    pub fn new(config: Config) -> Self {
        Recipe::new(config).into()
    }

    /// Heights that the caller's passes computed, or that they will: fields, the first of which shows the first patch. Of the
    /// configuration, `patch_size`, `terrain_scale`, `texture_tile`, `triplanar`,
    /// `variation` and `zones` count. The fields extend by at least one sample
    /// beyond each patch, the same number on every side, which shading reads.
    ///
    /// The scene shares the buffer and copies nothing: each frame draws the heights that the buffer holds when the frame
    /// executes. After passes have changed them, [`Scene::read_ground`](crate::scene::Scene::read_ground) tells the
    /// host, which culls patches by their lowest and highest points, and answers where the ground is; and
    /// [`Scene::set_patches`](crate::scene::Scene::set_patches) says that the fields show other patches. A
    /// [`Generator`](crate::terrain::generator::Generator) and a [`HeightBatch`](crate::terrain::height::HeightBatch) split
    /// fields that exceed a binding: each part is a terrain of its own.
    ///
    /// ```no_run
    /// use relievo::scene::{Scene, TerrainSource};
    /// use relievo::ops::terrain::{config::Config, generator::Generator, recipe::Recipe};
    ///
    /// # fn load(gpu: &relievo::gpu::Gpu, scene: &mut Scene) -> Result<(), relievo::Error> {
    /// let (config, patches) = (Config::new(129, 40.0, "any text")?, [[0, 0], [1, 0]]);
    /// let generator = Generator::new(gpu, Recipe::new(config.clone()))?;
    /// let fields = generator.generate(gpu, &patches, 1, &mut |_| ())?.remove(0); // and further passes over them
    /// let land = scene.add_terrain(&TerrainSource::from_fields(config, fields, &patches))?;
    /// # Ok(())
    /// # }
    /// ```
    pub fn from_fields(config: Config, fields: Fields, patches: &[[i32; 2]]) -> Self {
        let origin = Origin::Fields { config: Box::new(config), fields };
        Self::of(origin).with_patches(patches)
    }

    fn of(origin: Origin) -> Self {
        let (shading, style) = (Shading::default(), TerrainStyle::Textured);
        Self { origin, patches: vec![[0, 0]], textures: None, shading, style, target: None }
    }

    /// Shows these patches instead, each given once: its column, counted to the east, and its row, counted to the south.
    #[must_use]
    pub fn with_patches(self, patches: &[[i32; 2]]) -> Self {
        Self { patches: patches.to_vec(), ..self }
    }

    /// Takes these textures, one for each zone of the configuration.
    #[must_use]
    pub fn with_textures(self, textures: Vec<Texture>) -> Self {
        Self { textures: Some(textures), ..self }
    }

    /// Blends zones as `shading` says. Its light is not used: a scene has one light.
    #[must_use]
    pub fn with_shading(self, shading: Shading) -> Self {
        Self { shading, ..self }
    }

    /// Draws it in this style.
    #[must_use]
    pub fn with_style(self, style: TerrainStyle) -> Self {
        Self { style, ..self }
    }

    /// Lets the heights change to those of another recipe, which has samples in the same places. They are blended by `morph` at
    /// first, and later as [`Scene::morph_terrain`](crate::scene::Scene::morph_terrain) says. Zones and textures are those of
    /// the first recipe.
    #[must_use]
    pub fn with_target(self, target: Recipe, morph: Morph) -> Self {
        Self { target: Some((Box::new(target), morph)), ..self }
    }

    /// Checks the target.
    ///
    /// # Errors
    /// [`InputError`] below `target` for one with samples in other places, and for heights of the caller, and that of `morph`.
    pub(super) fn check_target(&self) -> Result<(), InputError> {
        let Some((target, morph)) = &self.target else { return Ok(()) };
        if self.fields().is_some() {
            let bound = "must not be given for terrain made from fields: blend them with a pass";
            return Err(InputError::new("target", "a recipe", bound));
        }
        let below = |error: InputError| error.below("target");
        check_target(self.config(), &target.config).map_err(below)?;
        target.validate(&self.patches, 1).map_err(below)?;
        morph.validate()
    }

    /// The configuration.
    pub(in crate::scene) fn config(&self) -> &Config {
        match &self.origin {
            Origin::Recipe(recipe) => &recipe.config,
            Origin::Fields { config, .. } => config,
        }
    }

    /// The fields of the caller, if the heights are the caller's.
    pub(super) fn fields(&self) -> Option<&Fields> {
        match &self.origin {
            Origin::Recipe(_) => None,
            Origin::Fields { fields, .. } => Some(fields),
        }
    }
}

impl From<Recipe> for TerrainSource {
    /// Patch (0, 0) of a recipe, with features, despiking and erosion as it says.
    fn from(recipe: Recipe) -> Self {
        Self::of(Origin::Recipe(Box::new(recipe)))
    }
}

/// Checks fields of the caller: their configuration, their margin, and that the buffer holds them.
pub(super) fn check_fields(config: &Config, fields: &Fields) -> Result<(), InputError> {
    config.validate()?;
    let size = config.patch_size;
    if fields.width < size + 2 || !(fields.width - size).is_multiple_of(2) {
        let bound = format!("must be patchSize = {size} and an even margin of at least 2");
        return Err(InputError::new("fields.width", fields.width, bound));
    }
    fields.check("fields", 0)
}

/// Checks that patches are given once each, that there is a field for each, and that `i32` counts their samples.
pub(super) fn check_patches(
    config: &Config,
    fields: &Fields,
    patches: &[[i32; 2]],
) -> Result<(), InputError> {
    if patches.len() > fields.count as usize {
        let bound = format!("must be at most {}, the fields' count", fields.count);
        return Err(InputError::new("patches.len", patches.len(), bound));
    }
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

/// Checks that patches are given once each.
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
