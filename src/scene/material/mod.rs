//! Materials of a mesh's parts on the device: a table that vertices index, and texture arrays with one layer per image.

mod looks;
mod relief;
mod textures;

pub(crate) use looks::Looks;
pub(crate) use relief::{ReliefBindings, ReliefLook};

use crate::asset::material::{Alpha, Material, Sampling, Texture};
use crate::gpu::bindings::render::scene_mesh::Group2;
use crate::gpu::{Buffer, Gpu, Group, Staged, Upload as _};
use crate::scene::layouts::SceneLayouts;
use crate::shared::render::scene_mesh::{CUTOFF_DITHERED, CUTOFF_OPAQUE, NO_LAYER, SceneMaterial};
use crate::surface::color::sampler_of;
use crate::{Error, InputError};
pub(crate) use textures::check_image;
use textures::{Texels, texture_array};

/// Materials of one part of a mesh. The triangles of a part share a pipeline and samplers.
#[derive(Debug, Clone)]
pub(crate) struct PartMaterials {
    /// Bind group 2 of `render/scene_mesh`.
    pub group: Group,
    /// Whether any material has a normal map.
    pub normal_mapped: bool,
    /// Whether any material is cut out, so that alpha decides which pixels are drawn.
    pub cut_out: bool,
    /// Whether any material has a texture.
    pub textured: bool,
    /// For each table entry, the index of the object's material; `None` for opaque white.
    materials: Vec<Option<usize>>,
    entries: Buffer<SceneMaterial>,
    colors: Layers,
    normals: Layers,
    /// Sampling of the colour textures, then of the normal maps.
    samplings: [Sampling; 2],
}

/// A function that returns one of a material's textures: its colours or its normal map.
type TextureOf = fn(&Material) -> Option<Texture>;

impl PartMaterials {
    /// Uploads the materials of a part: a table with one entry per element of `materials`, and two texture arrays. The
    /// elements are indices of the object's materials; the entry for `None` is opaque white. The first of `samplings`
    /// filters colours, the second filters normal maps.
    ///
    /// Each image is one layer of a texture array. All layers are as wide as the widest image and as high as the
    /// highest one. Smaller images are enlarged.
    ///
    /// # Errors
    /// [`InputError`] for a material or an image that the object does not have; [`crate::gpu::GpuError`], also if there
    /// are more images than a texture array may have layers.
    pub fn new(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        looks: &Looks,
        materials: &[Option<usize>],
        samplings: [Sampling; 2],
    ) -> Result<Self, Error> {
        let (mut colors, mut normals) = (Layers::default(), Layers::default());
        let table = table(looks, materials, &mut colors, &mut normals)?;
        let entries = Buffer::from_slice(gpu, "scene materials", &table)?;
        let arrays = [(&colors, Texels::Color), (&normals, Texels::Normal)];
        let mut views = Vec::with_capacity(2);
        for ((layers, texels), sampling) in arrays.into_iter().zip(&samplings) {
            let has_mips = sampling.mips.is_some();
            views.push(texture_array(gpu, &looks.images, &layers.images, texels, has_mips)?);
        }
        let [color_sampling, normal_sampling] = &samplings;
        let group = Group2 {
            materials: entries.slice(),
            albedo: &views[0],
            normals: &views[1],
            filtering: &sampler_of(gpu, color_sampling)?,
            normal_filtering: &sampler_of(gpu, normal_sampling)?,
        };
        let all = Self {
            group: group.bind(gpu, &layouts.mesh)?,
            normal_mapped: false,
            cut_out: false,
            textured: false,
            materials: materials.to_vec(),
            entries,
            colors,
            normals,
            samplings,
        };
        Ok(all.with_kinds(&table))
    }

    /// The same materials, with pipeline flags computed from `table`.
    fn with_kinds(self, table: &[SceneMaterial]) -> Self {
        Self {
            normal_mapped: table.iter().any(|entry| entry.normal_layer != NO_LAYER),
            cut_out: table.iter().any(|entry| entry.cutoff != CUTOFF_OPAQUE),
            textured: table.iter().any(|entry| entry.layer != NO_LAYER),
            ..self
        }
    }

    /// Whether this part uses the object's material with index `material`.
    pub fn has(&self, material: usize) -> bool {
        self.materials.contains(&Some(material))
    }

    /// Whether a material of this part shows the object's image with index `image`.
    pub fn shows(&self, image: usize) -> bool {
        self.colors.images.contains(&image) || self.normals.images.contains(&image)
    }

    /// Recreates the part's materials after `looks` has changed. If a texture or sampling is new, or if `anew` is true,
    /// all textures are uploaded again. Otherwise, only the table changes.
    ///
    /// # Errors
    /// As for [`PartMaterials::new`].
    pub fn changed(
        &self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        looks: &Looks,
        samplings: [Sampling; 2],
        anew: bool,
    ) -> Result<Changed, Error> {
        let (mut colors, mut normals) = (self.colors.clone(), self.normals.clone());
        let table = table(looks, &self.materials, &mut colors, &mut normals)?;
        let has_all = (&colors, &normals) == (&self.colors, &self.normals);
        if anew || !has_all || samplings != self.samplings {
            let materials = Self::new(gpu, layouts, looks, &self.materials, samplings)?;
            return Ok(Changed { materials, table: None });
        }
        Ok(Changed { materials: self.clone().with_kinds(&table), table: Some(table) })
    }

    /// Sampling of the colour textures, then of the normal maps.
    pub fn samplings(&self) -> [Sampling; 2] {
        self.samplings
    }

    /// Sampling of the colour textures, then of the normal maps, after the material at `index` has replaced `old`. If
    /// only this material has a colour texture, it decides the sampling of colour textures. Otherwise, that sampling
    /// does not change. The rule for normal maps is analogous.
    ///
    /// # Errors
    /// [`InputError`] if the new material has another sampling than the other materials of the part.
    pub fn samplings_with(
        &self,
        looks: &Looks,
        index: usize,
        old: &Material,
    ) -> Result<[Sampling; 2], InputError> {
        let new = &looks.materials[index];
        let mut samplings = self.samplings;
        let uses: [(&str, TextureOf); 2] =
            [("texture", |material| material.texture), ("normal", |material| material.normal)];
        for ((field, of), sampling) in uses.into_iter().zip(&mut samplings) {
            let Some(wanted) = of(new).map(|texture| texture.sampling) else { continue };
            let is_old = of(old).is_some_and(|texture| texture.sampling == wanted);
            if wanted == *sampling || is_old {
                continue;
            }
            let mut others = self.materials.iter().flatten().filter(|other| **other != index);
            if others.any(|other| of(&looks.materials[*other]).is_some()) {
                let bound = format!("must be {sampling:?}, as of the materials with which it is drawn");
                let path = format!("material.{field}.sampling");
                return Err(InputError::new(path, format!("{wanted:?}"), bound));
            }
            *sampling = wanted;
        }
        Ok(samplings)
    }
}

/// New materials of a part, as [`PartMaterials::changed`] returns them.
#[derive(Debug)]
pub(crate) struct Changed {
    pub materials: PartMaterials,
    /// The table to write into the existing buffer; `None` if new buffers were made.
    table: Option<Vec<SceneMaterial>>,
}

impl Changed {
    /// Stages the table for the existing buffer. Does nothing if new buffers were made.
    ///
    /// # Errors
    /// [`crate::gpu::GpuError`].
    pub fn stage(&self, staged: &mut Staged) -> Result<(), Error> {
        if let Some(table) = &self.table {
            staged.elements(&self.materials.entries, 0, table)?;
        }
        Ok(())
    }
}

/// The material table of a part. Images that are not yet in `colors` or `normals` are appended to them.
fn table(
    looks: &Looks,
    materials: &[Option<usize>],
    colors: &mut Layers,
    normals: &mut Layers,
) -> Result<Vec<SceneMaterial>, InputError> {
    let entry = |index: &Option<usize>| match index {
        Some(index) => entry(looks, *index, colors, normals),
        None => Ok(WHITE),
    };
    materials.iter().map(entry).collect()
}

/// The table entry for triangles without a material: opaque white.
const WHITE: SceneMaterial = SceneMaterial {
    color: [1.0; 4],
    cutoff: CUTOFF_OPAQUE,
    layer: NO_LAYER,
    normal_layer: NO_LAYER,
    normal_scale: 1.0,
};

/// The layers of a texture array. For each layer: the index of its image among the object's images.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
struct Layers {
    images: Vec<usize>,
}

impl Layers {
    /// The layer of the object's image with index `image`. A new image is appended.
    fn layer(&mut self, image: usize) -> u32 {
        let known = self.images.iter().position(|known| *known == image);
        let layer = known.unwrap_or_else(|| {
            self.images.push(image);
            self.images.len() - 1
        });
        layer as u32
    }
}

/// The table entry of the object's material with this index.
fn entry(
    looks: &Looks,
    index: usize,
    colors: &mut Layers,
    normals: &mut Layers,
) -> Result<SceneMaterial, InputError> {
    let Some(material) = looks.materials.get(index) else {
        let bound = format!("must be below {}", looks.materials.len());
        return Err(InputError::new("mesh.material", index, bound));
    };
    let Material { color, alpha, texture, normal, normal_scale, .. } = material;
    let layer = |image: usize, field: &str, layers: &mut Layers| {
        if looks.images.get(image).is_none_or(|image| image.size().contains(&0)) {
            let bound = format!("must be below {}, and the image must have texels", looks.images.len());
            return Err(InputError::new(format!("materials[{index}].{field}.image"), image, bound));
        }
        Ok(layers.layer(image))
    };
    Ok(SceneMaterial {
        color: *color,
        cutoff: match alpha {
            Alpha::Opaque | Alpha::Blended => CUTOFF_OPAQUE,
            Alpha::Mask(cutoff) => cutoff.max(0.0),
            Alpha::Dithered => CUTOFF_DITHERED,
        },
        layer: texture.map_or(Ok(NO_LAYER), |texture| layer(texture.image, "texture", colors))?,
        normal_layer: normal.map_or(Ok(NO_LAYER), |normal| layer(normal.image, "normal", normals))?,
        normal_scale: *normal_scale,
    })
}
