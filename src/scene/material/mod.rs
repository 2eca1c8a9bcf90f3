//! Materials of the parts of meshes, on the device: a table that vertices index, and the textures of the table in layers
//! of one array.

mod relief;
mod textures;

pub(crate) use relief::{ReliefLook, ReliefMaterial};

use crate::asset::Model;
use crate::asset::material::{Alpha, Material, Sampling};
use crate::gpu::bindings::render::scene_mesh::Group2;
use crate::gpu::{Buffer, Gpu, Group};
use crate::scene::layouts::SceneLayouts;
use crate::shared::render::scene_mesh::{CUTOFF_DITHERED, CUTOFF_OPAQUE, NO_LAYER, SceneMaterial};
use crate::surface::color::sampler_of;
use crate::{Error, InputError};
use textures::{Texels, texture_array};

/// The materials of the triangles that share a pipeline and a sampler.
#[derive(Debug, Clone)]
pub(crate) struct PartMaterials {
    /// Bind group 2 of `render/scene_mesh`.
    pub group: Group,
    /// Whether one of them has a normal map.
    pub normal_mapped: bool,
    /// Whether the only one has a texture; `None` if there are several.
    pub only_textured: Option<bool>,
}

impl PartMaterials {
    /// Uploads a table with an entry for each of `materials`, indices of the model's materials; an entry without a material
    /// is opaque and white. All textures are filtered by `sampling`. They become layers of one array, whose size is that
    /// of the widest and of the highest image; smaller images are enlarged.
    ///
    /// # Errors
    /// [`InputError`] for a material or an image that the model does not have; [`crate::gpu::GpuError`], also for more
    /// images than an array may have layers.
    pub fn new(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        model: &Model,
        materials: &[Option<usize>],
        sampling: &Sampling,
    ) -> Result<Self, Error> {
        let mut colors = Layers::default();
        let mut normals = Layers::default();
        let mut table = Vec::with_capacity(materials.len());
        for index in materials {
            table.push(match index {
                Some(index) => entry(model, *index, &mut colors, &mut normals)?,
                None => WHITE,
            });
        }
        let has_mips = sampling.mips.is_some();
        let entries = Buffer::from_slice(gpu, "scene materials", &table)?;
        let group = Group2 {
            materials: entries.slice(),
            albedo: &texture_array(gpu, model, &colors.images, Texels::Color, has_mips)?,
            normals: &texture_array(gpu, model, &normals.images, Texels::Normal, has_mips)?,
            filtering: &sampler_of(gpu, sampling)?,
        };
        let normal_mapped = table.iter().any(|entry| entry.normal_layer != NO_LAYER);
        let only_textured = match &table[..] {
            [only] => Some(only.layer != NO_LAYER),
            _ => None,
        };
        Ok(Self { group: group.bind(gpu, &layouts.mesh)?, normal_mapped, only_textured })
    }
}

/// The material of meshes that have none.
const WHITE: SceneMaterial = SceneMaterial {
    color: [1.0; 4],
    cutoff: CUTOFF_OPAQUE,
    layer: NO_LAYER,
    normal_layer: NO_LAYER,
    normal_scale: 1.0,
};

/// Images of a model that share an array, in the order of their layers.
#[derive(Debug, Default)]
struct Layers {
    images: Vec<usize>,
}

impl Layers {
    /// The layer of an image, which is added if it is new.
    fn layer(&mut self, image: usize) -> u32 {
        let known = self.images.iter().position(|known| *known == image);
        let layer = known.unwrap_or_else(|| {
            self.images.push(image);
            self.images.len() - 1
        });
        layer as u32
    }
}

/// The table's entry of a material.
fn entry(
    model: &Model,
    index: usize,
    colors: &mut Layers,
    normals: &mut Layers,
) -> Result<SceneMaterial, InputError> {
    let Some(material) = model.materials.get(index) else {
        let bound = format!("must be below {}", model.materials.len());
        return Err(InputError::new("mesh.material", index, bound));
    };
    let Material { color, alpha, texture, normal, normal_scale, .. } = material;
    let layer = |image: usize, field: &str, layers: &mut Layers| {
        if model.images.get(image).is_none_or(|image| image.is_empty()) {
            let bound = format!("must be below {}, and the image must have texels", model.images.len());
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
