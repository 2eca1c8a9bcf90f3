//! Writes the materials of a document, with their textures, samplers and images.

use serde_json::{Value, json};

use super::binary::{Binary, push};
use crate::InputError;
use crate::asset::images::png;
use crate::asset::material::{Alpha, Filter, Pbr, PbrTexture, Sampling, Texture, UvSet, Wrapping};
use crate::asset::{Material, Mesh, Model};

/// The materials that meshes use, each written once, with their textures, samplers and images.
#[derive(Default)]
pub(super) struct Materials {
    pub materials: Vec<Value>,
    pub textures: Vec<Value>,
    pub samplers: Vec<Value>,
    pub images: Vec<Value>,
    /// Key of each material written so far: the index in the model, and whether triangles are visible from inside.
    known: Vec<(Option<usize>, bool)>,
    known_textures: Vec<Texture>,
    known_images: Vec<usize>,
}

impl Materials {
    /// Returns the index of a mesh's material in the document. A double-sided mesh without a material gets an empty material,
    /// because glTF states in the material whether triangles are double-sided.
    pub fn index(
        &mut self,
        model: &Model,
        mesh: &Mesh,
        binary: &mut Binary,
    ) -> Result<Option<usize>, InputError> {
        let key = (mesh.material, mesh.double_sided);
        if key == (None, false) {
            return Ok(None);
        }
        if let Some(known) = self.known.iter().position(|known| *known == key) {
            return Ok(Some(known));
        }
        let mut written = match model.material(mesh)? {
            Some(material) => self.material(model, material, binary)?,
            None => json!({}),
        };
        if mesh.double_sided {
            written["doubleSided"] = true.into();
        }
        self.known.push(key);
        Ok(Some(push(&mut self.materials, written)))
    }

    fn material(
        &mut self,
        model: &Model,
        material: &Material,
        binary: &mut Binary,
    ) -> Result<Value, InputError> {
        let mut written = json!({
            "name": material.name,
            "pbrMetallicRoughness": {
                "baseColorFactor": material.color,
                "metallicFactor": material.pbr.metallic,
                "roughnessFactor": material.pbr.roughness,
            },
        });
        let Pbr { metallic_roughness, occlusion, occlusion_strength, emissive, emission, .. } = &material.pbr;
        let mut info = |one: &PbrTexture| -> Result<Value, InputError> {
            let index = self.texture(model, one.texture, binary)?;
            Ok(json!({ "index": index, "texCoord": u32::from(one.uv == UvSet::Second) }))
        };
        if let Some(texture) = metallic_roughness {
            written["pbrMetallicRoughness"]["metallicRoughnessTexture"] = info(texture)?;
        }
        if let Some(texture) = occlusion {
            written["occlusionTexture"] = info(texture)?;
            written["occlusionTexture"]["strength"] = json!(occlusion_strength);
        }
        if let Some(texture) = emission {
            written["emissiveTexture"] = info(texture)?;
        }
        if *emissive != [0.0; 3] {
            written["emissiveFactor"] = json!(emissive);
        }
        if let Some(texture) = material.texture {
            let index = self.texture(model, texture, binary)?;
            written["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": index });
        }
        if let Some(texture) = material.normal {
            let index = self.texture(model, texture, binary)?;
            written["normalTexture"] = json!({ "index": index, "scale": material.normal_scale });
        }
        match material.alpha {
            Alpha::Opaque => {}
            Alpha::Mask(cutoff) => {
                written["alphaMode"] = "MASK".into();
                written["alphaCutoff"] = json!(cutoff);
            }
            Alpha::Dithered | Alpha::Blended => written["alphaMode"] = "BLEND".into(),
        }
        Ok(written)
    }

    fn texture(&mut self, model: &Model, texture: Texture, binary: &mut Binary) -> Result<usize, InputError> {
        if let Some(known) = self.known_textures.iter().position(|known| *known == texture) {
            return Ok(known);
        }
        let source = match self.known_images.iter().position(|known| *known == texture.image) {
            Some(known) => known,
            None => {
                let view = binary.view(png(model, texture.image)?);
                self.known_images.push(texture.image);
                push(&mut self.images, json!({ "bufferView": view, "mimeType": "image/png" }))
            }
        };
        let sampler = sampler(&texture.sampling);
        let sampler = match self.samplers.iter().position(|known| *known == sampler) {
            Some(known) => known,
            None => push(&mut self.samplers, sampler),
        };
        self.known_textures.push(texture);
        Ok(push(&mut self.textures, json!({ "source": source, "sampler": sampler })))
    }
}

/// Writes a sampler with OpenGL's enum values, which glTF uses.
fn sampler(sampling: &Sampling) -> Value {
    const NEAREST: u32 = 9728;
    const LINEAR: u32 = 9729;
    const NEAREST_MIPMAP_NEAREST: u32 = 9984;
    let filter = |filter: Filter| if filter == Filter::Linear { LINEAR } else { NEAREST };
    let minified = match (sampling.minified, sampling.mips) {
        (minified, None) => filter(minified),
        // Bit 0: filter between texels; bit 1: filter between mip levels.
        (minified, Some(mips)) => {
            NEAREST_MIPMAP_NEAREST
                + u32::from(minified == Filter::Linear)
                + 2 * u32::from(mips == Filter::Linear)
        }
    };
    let [s, t] = sampling.wrap.map(|wrapping| match wrapping {
        Wrapping::Repeat => 10497,
        Wrapping::Mirror => 33648,
        Wrapping::Clamp => 33071,
    });
    json!({ "magFilter": filter(sampling.magnified), "minFilter": minified, "wrapS": s, "wrapT": t })
}
