//! Reads the materials that meshes use: base colour with its texture, normal map, and alpha. Decodes PNG, JPEG and WebP images.

use std::borrow::Cow;
use std::collections::HashMap;

use gltf_json::Index;
use gltf_json::extensions::material::PbrSpecularGlossiness;
use gltf_json::extensions::texture::TextureTransform;
use gltf_json::material::{AlphaMode, Material as GltfMaterial};
use gltf_json::texture::{Info, MagFilter, MinFilter, Sampler, Texture as GltfTexture, WrappingMode};
use gltf_json::validation::Checked;
use image::{ImageFormat, RgbaImage};

use super::budget::Budget;
use super::document::Document;
use super::extensions::DECOMPRESS;
use crate::InputError;
use crate::asset::Image;
use crate::asset::image_file::{stated_size, texels};
use crate::asset::material::{
    Alpha, Filter, MAX_TEXELS, Material, Pbr, PbrTexture, Sampling, Texture, UvSet, Wrapping,
};

/// Materials and images that were read so far, each once, in the order of their first use.
#[derive(Default)]
pub struct Materials {
    pub materials: Vec<Material>,
    pub images: Vec<Image>,
    /// The images as files; `None` if they are not kept.
    pub files: Option<Vec<Vec<u8>>>,
    /// Whether the import leaves out all materials.
    pub is_unread: bool,
    of_materials: HashMap<usize, usize>,
    of_images: HashMap<usize, usize>,
}

impl Materials {
    /// Creates a reader for an import without materials and images.
    pub fn unread() -> Self {
        Self { is_unread: true, ..Self::default() }
    }

    /// Creates a reader that keeps images as files.
    pub fn with_files() -> Self {
        Self { files: Some(Vec::new()), ..Self::default() }
    }

    /// Reads a material on its first use. Returns its index in `materials`.
    pub fn read(&mut self, document: &Document<'_>, index: Index<GltfMaterial>) -> Result<usize, InputError> {
        let at = index.value();
        if let Some(known) = self.of_materials.get(&at) {
            return Ok(*known);
        }
        let path = format!("materials[{at}]");
        let material = &document.root.materials[at];
        let Base { color, texture, name } = Base::of(material);
        let is_fraction = |value: &f32| (0.0..=1.0).contains(value);
        InputError::check_each(&format!("{path}.{name}"), &color, is_fraction, "must be in 0..=1")?;
        let texture = texture.map(|info| self.texture(document, info.index, Decode::Now)).transpose()?;
        let (normal, normal_scale) = self.normal(document, &path, index)?;
        let alpha = alpha(&path, material)?;
        let pbr = self.pbr(document, &path, index)?;
        let name = material.name.clone().unwrap_or_else(|| format!("material_{at}"));
        self.materials.push(Material { name, color, texture, normal, normal_scale, alpha, pbr });
        self.of_materials.insert(at, self.materials.len() - 1);
        Ok(self.materials.len() - 1)
    }

    /// Returns the normal map of a material, and the map's scale. The map is left out if its texture coordinates differ from
    /// the base colour texture's coordinates.
    fn normal(
        &mut self,
        document: &Document<'_>,
        path: &str,
        index: Index<GltfMaterial>,
    ) -> Result<(Option<Texture>, f32), InputError> {
        let material = &document.root.materials[index.value()];
        let coordinates = [Coordinates::of_color(material), Coordinates::of_normals(document, index)];
        let info = match (&material.normal_texture, coordinates) {
            (Some(info), [None, _]) => info,
            (Some(info), [Some(of_color), Some(of_normals)]) if of_color.are_same(&of_normals) => info,
            _ => return Ok((None, 1.0)),
        };
        InputError::check_finite(format!("{path}.normalTexture.scale"), info.scale)?;
        Ok((Some(self.texture(document, info.index, Decode::Now)?), info.scale))
    }

    /// Reads the properties of a material that scenes do not draw. A texture whose coordinates are neither the mesh's first nor its
    /// second ones is left out, and so is one in a format that cannot be read.
    fn pbr(
        &mut self,
        document: &Document<'_>,
        path: &str,
        index: Index<GltfMaterial>,
    ) -> Result<Pbr, InputError> {
        let material = &document.root.materials[index.value()];
        let (metallic, roughness, field) = match glossy(material) {
            Some(glossy) => {
                (0.0, 1.0 - glossy.glossiness_factor.0, "extensions.KHR_materials_pbrSpecularGlossiness")
            }
            None => {
                let rough = &material.pbr_metallic_roughness;
                (rough.metallic_factor.0, rough.roughness_factor.0, "pbrMetallicRoughness")
            }
        };
        let occlusion_strength = material.occlusion_texture.as_ref().map_or(1.0, |one| one.strength.0);
        let emissive = material.emissive_factor.0;
        let is_fraction = |value: &f32| (0.0..=1.0).contains(value);
        for (field, values) in [
            (field, &[metallic, roughness][..]),
            ("occlusionTexture.strength", &[occlusion_strength]),
            ("emissiveFactor", &emissive),
        ] {
            InputError::check_each(&format!("{path}.{field}"), values, is_fraction, "must be in 0..=1")?;
        }
        let (first, second) = (Coordinates::of_mesh(document, index), Coordinates::second(document, index));
        let mut textures = [None; 3];
        for (texture, undrawn) in textures.iter_mut().zip(Coordinates::undrawn(document, index)) {
            let Some((index, coordinates)) = undrawn else { continue };
            let uv = match &second {
                _ if coordinates.are_same(&first) => UvSet::First,
                Some(second) if coordinates.are_same(second) => UvSet::Second,
                _ => continue,
            };
            if document.extensions.unread_images.get(index.value()).is_none_or(Option::is_none) {
                *texture = Some(PbrTexture { texture: self.texture(document, index, Decode::Later)?, uv });
            }
        }
        let [metallic_roughness, occlusion, emission] = textures;
        Ok(Pbr { metallic, roughness, metallic_roughness, occlusion, occlusion_strength, emissive, emission })
    }

    fn texture(
        &mut self,
        document: &Document<'_>,
        index: Index<GltfTexture>,
        decode: Decode,
    ) -> Result<Texture, InputError> {
        let at = index.value();
        let texture = &document.root.textures[at];
        let sampler = texture.sampler.map(|sampler| &document.root.samplers[sampler.value()]);
        let sampling = sampler.map_or_else(Sampling::default, sampling);
        let images = document.root.images.len();
        let webp = document.extensions.webp.get(at).copied().flatten();
        let Some(source) = Some(texture.source.value()).filter(|source| *source < images).or(webp) else {
            return Err(match document.extensions.unread_images.get(at).copied().flatten() {
                Some((name, remedy)) => {
                    let path = format!("textures[{at}].extensions.{name}");
                    InputError::new(path, "given", format!("is not read: {remedy}"))
                }
                None => InputError::new(format!("textures[{at}].source"), "missing", "must be given"),
            });
        };
        if source >= images {
            let path = format!("textures[{at}].extensions.EXT_texture_webp.source");
            return Err(InputError::new(
                path,
                source,
                format!("must be below {images}, the number of images"),
            ));
        }
        Ok(Texture { image: self.image(document, source, decode)?, sampling })
    }

    fn image(&mut self, document: &Document<'_>, at: usize, decode: Decode) -> Result<usize, InputError> {
        let path = format!("images[{at}]");
        if let Some(known) = self.of_images.get(&at) {
            decode.check(&path, &self.images[*known])?;
            return Ok(*known);
        }
        let image = &document.root.images[at];
        let file = match (image.buffer_view, &image.uri) {
            (Some(view), _) => Cow::Borrowed(document.view(view)?.0),
            (None, Some(uri)) => Cow::Owned(document.resource(&format!("{path}.uri"), uri)?.to_vec()),
            (None, None) => return Err(InputError::new(path, "empty", "must have a bufferView or a uri")),
        };
        let image = Image::of_file(file.to_vec(), size(&document.budget, &path, &file)?);
        decode.check(&path, &image)?;
        self.images.push(image);
        if let Some(files) = &mut self.files {
            files.push(file.into_owned());
        }
        self.of_images.insert(at, self.images.len() - 1);
        Ok(self.images.len() - 1)
    }
}

/// When an image is decoded.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Decode {
    /// At once: damage is an error of the import.
    Now,
    /// At the first use of its texels.
    Later,
}

impl Decode {
    /// Decodes an image that must be decoded now. `path` names the image in errors.
    fn check(self, path: &str, image: &Image) -> Result<(), InputError> {
        match self {
            Self::Now => {
                image.texels().map(|_| ()).map_err(|error| InputError { path: path.to_owned(), ..error })
            }
            Self::Later => Ok(()),
        }
    }
}

/// The specular-glossiness properties of a material that has them.
fn glossy(material: &GltfMaterial) -> Option<&PbrSpecularGlossiness> {
    material.extensions.as_ref().and_then(|all| all.pbr_specular_glossiness.as_ref())
}

/// A material's base colour.
struct Base<'a> {
    color: [f32; 4],
    texture: Option<&'a Info>,
    /// Name of the field with the colour, for paths in errors.
    name: &'static str,
}

impl<'a> Base<'a> {
    /// Returns the base colour: from `KHR_materials_pbrSpecularGlossiness` if the material has that extension, otherwise from
    /// metallic-roughness.
    fn of(material: &'a GltfMaterial) -> Self {
        match (glossy(material), &material.pbr_metallic_roughness) {
            (Some(glossy), _) => Self {
                color: glossy.diffuse_factor.0,
                texture: glossy.diffuse_texture.as_ref(),
                name: "extensions.KHR_materials_pbrSpecularGlossiness.diffuseFactor",
            },
            (None, rough) => Self {
                color: rough.base_color_factor.0,
                texture: rough.base_color_texture.as_ref(),
                name: "pbrMetallicRoughness.baseColorFactor",
            },
        }
    }
}

/// First bytes of a KTX2 image.
const KTX2: &[u8] = b"\xabKTX 20\xbb";

/// Decodes a PNG, JPEG or WebP image. The first bytes decide the format, whatever `mimeType` says. Texels are charged to the
/// budget. `path` names the image in errors.
pub fn decode(budget: &Budget, path: &str, bytes: &[u8]) -> Result<RgbaImage, InputError> {
    texels(path, bytes, size(budget, path, bytes)?)
}

/// Width and height of an image that [`decode`] reads. Texels are charged to the budget.
pub fn size(budget: &Budget, path: &str, bytes: &[u8]) -> Result<[u32; 2], InputError> {
    if bytes.starts_with(KTX2) {
        let bound = format!("is KTX2, which is not read: {DECOMPRESS}");
        return Err(InputError::new(path, format!("[{} bytes]", bytes.len()), bound));
    }
    let ([width, height], format) = stated_size(path, bytes)?;
    if width.max(height) > MAX_TEXELS {
        let bound = format!("must be at most {MAX_TEXELS} texels wide and high");
        return Err(InputError::new(path, format!("{width} × {height}"), bound));
    }
    // WebP has no limit of texels per byte: a few bytes can encode a large image of one colour.
    let packed = if format == ImageFormat::WebP { usize::MAX } else { bytes.len() };
    budget.spend_texels(path, [width, height], packed)?;
    Ok([width, height])
}

fn alpha(path: &str, material: &GltfMaterial) -> Result<Alpha, InputError> {
    let cutoff = material.alpha_cutoff.unwrap_or_default().0;
    match material.alpha_mode.unwrap() {
        AlphaMode::Opaque => Ok(Alpha::Opaque),
        AlphaMode::Blend => Ok(Alpha::Dithered),
        AlphaMode::Mask if cutoff >= 0.0 && cutoff.is_finite() => Ok(Alpha::Mask(cutoff)),
        AlphaMode::Mask => {
            let bound = "must be finite, and not negative";
            Err(InputError::new(format!("{path}.alphaCutoff"), cutoff, bound))
        }
    }
}

/// Converts a sampler. Filters that the sampler does not state become linear, with mip levels.
fn sampling(sampler: &Sampler) -> Sampling {
    let wrap = [sampler.wrap_s, sampler.wrap_t].map(|mode| match mode.unwrap() {
        WrappingMode::Repeat => Wrapping::Repeat,
        WrappingMode::MirroredRepeat => Wrapping::Mirror,
        WrappingMode::ClampToEdge => Wrapping::Clamp,
    });
    let (nearest, linear) = (Filter::Nearest, Filter::Linear);
    let magnified = match sampler.mag_filter.map(Checked::unwrap) {
        None | Some(MagFilter::Linear) => linear,
        Some(MagFilter::Nearest) => nearest,
    };
    let (minified, mips) = match sampler.min_filter.map(Checked::unwrap) {
        None | Some(MinFilter::LinearMipmapLinear) => (linear, Some(linear)),
        Some(MinFilter::Nearest) => (nearest, None),
        Some(MinFilter::Linear) => (linear, None),
        Some(MinFilter::NearestMipmapNearest) => (nearest, Some(nearest)),
        Some(MinFilter::LinearMipmapNearest) => (linear, Some(nearest)),
        Some(MinFilter::NearestMipmapLinear) => (nearest, Some(linear)),
    };
    Sampling { wrap, magnified, minified, mips }
}

/// The texture coordinates at which a material's texture is sampled: one of the mesh's sets of texture coordinates, and a
/// transform.
pub struct Coordinates<'a> {
    /// Index n of the attribute `TEXCOORD_n`.
    pub set: u32,
    /// The transform that `KHR_texture_transform` states, if any.
    transform: Option<&'a TextureTransform>,
}

impl<'a> Coordinates<'a> {
    /// Coordinates of the base colour's texture; `None` if the material has no such texture.
    pub fn of_color(material: &'a GltfMaterial) -> Option<Self> {
        let info = Base::of(material).texture?;
        let transform = info.extensions.as_ref().and_then(|all| all.texture_transform.as_ref());
        Some(Self::new(info.tex_coord, transform))
    }

    /// Coordinates of the normal map; `None` if the material has no normal map.
    pub fn of_normals(document: &'a Document<'_>, index: Index<GltfMaterial>) -> Option<Self> {
        let info = document.root.materials[index.value()].normal_texture.as_ref()?;
        let transform = document.extensions.normal_transforms.get(index.value()).and_then(Option::as_ref);
        Some(Self::new(info.tex_coord, transform))
    }

    /// Coordinates of the mesh: those of the base colour's texture, or else those of the normal map, or else the first set.
    pub fn of_mesh(document: &'a Document<'_>, index: Index<GltfMaterial>) -> Self {
        let of_color = Self::of_color(&document.root.materials[index.value()]);
        let drawn = of_color.or_else(|| Self::of_normals(document, index));
        drawn.unwrap_or(Self { set: 0, transform: None })
    }

    /// Coordinates of the first texture that is not drawn and has other coordinates than the mesh; `None` without such a texture.
    pub fn second(document: &'a Document<'_>, index: Index<GltfMaterial>) -> Option<Self> {
        let first = Self::of_mesh(document, index);
        let others = Self::undrawn(document, index).into_iter().flatten().map(|(_, coordinates)| coordinates);
        others.into_iter().find(|coordinates| !coordinates.are_same(&first))
    }

    /// The textures that scenes do not draw, with their coordinates: metallic-roughness, occlusion, emission.
    fn undrawn(
        document: &'a Document<'_>,
        index: Index<GltfMaterial>,
    ) -> [Option<(Index<GltfTexture>, Self)>; 3] {
        let material = &document.root.materials[index.value()];
        let info = |info: &'a Info| {
            let transform = info.extensions.as_ref().and_then(|all| all.texture_transform.as_ref());
            (info.index, Self::new(info.tex_coord, transform))
        };
        let rough = material.pbr_metallic_roughness.metallic_roughness_texture.as_ref();
        let transform = document.extensions.occlusion_transforms.get(index.value()).and_then(Option::as_ref);
        let occlusion = material.occlusion_texture.as_ref();
        [
            rough.filter(|_| glossy(material).is_none()).map(info),
            occlusion.map(|one| (one.index, Self::new(one.tex_coord, transform))),
            material.emissive_texture.as_ref().map(info),
        ]
    }

    /// Combines a set and a transform. The transform may override the set.
    fn new(set: u32, transform: Option<&'a TextureTransform>) -> Self {
        Self { set: transform.and_then(|transform| transform.tex_coord).unwrap_or(set), transform }
    }

    /// Whether the coordinates are transformed.
    pub fn is_moved(&self) -> bool {
        self.transform.is_some()
    }

    /// Whether two textures are sampled at the same coordinates.
    fn are_same(&self, other: &Self) -> bool {
        let key = |coordinates: &Self| {
            let TextureTransform { offset, rotation, scale, .. } =
                coordinates.transform.cloned().unwrap_or_default();
            (coordinates.set, offset.0, rotation.0, scale.0)
        };
        key(self) == key(other)
    }

    /// Applies the transform to texture coordinates: scale, rotation, translation, in this order.
    pub fn apply(&self, uv: &mut [[f32; 2]]) {
        let Some(transform) = self.transform else { return };
        let ([x, y], [dx, dy]) = (transform.scale.0, transform.offset.0);
        let (sine, cosine) = (libm::sinf(transform.rotation.0), libm::cosf(transform.rotation.0));
        for [u, v] in uv {
            let (along, down) = (*u * x, *v * y);
            [*u, *v] = [cosine * along + sine * down + dx, cosine * down - sine * along + dy];
        }
    }
}
