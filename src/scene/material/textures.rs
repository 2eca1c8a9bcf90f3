//! A model's images as layers of one texture array.

use std::borrow::Cow;

use image::RgbaImage;
use image::imageops::{FilterType, resize};

use crate::asset::Image;
use crate::gpu::{Gpu, GpuError};
use crate::surface::mips::Mips;
use crate::{Error, InputError, srgb};

/// Largest number of texels in the finest mip level of a texture array, summed over all layers (256 MiB). If an array
/// is larger, the width and height of all its images are halved until it fits.
const MAX_TEXELS: u64 = 1 << 26;

/// The meaning of an image's channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Texels {
    /// sRGB colours and linear alpha.
    Color,
    /// Normals in tangent space.
    Normal,
}

/// Uploads a texture array. For each layer, `images` has the index of the layer's image in `all`. With `has_mips`, the
/// array has all mip levels. If `images` is empty, the array is one texel: white, or a flat normal.
///
/// # Errors
/// [`InputError`] for an image that cannot be decoded or that [`check_image`] refuses; [`GpuError`], also if there are more images than a texture
/// array may have layers.
pub(super) fn texture_array(
    gpu: &Gpu,
    all: &[Image],
    images: &[usize],
    texels: Texels,
    has_mips: bool,
) -> Result<wgpu::TextureView, Error> {
    let texels_of = |at: &usize| {
        let path = format!("model.images[{at}]");
        let image = all[*at].texels().map_err(|error| InputError { path: path.clone(), ..error })?;
        check_image(gpu, &path, image).map(|()| image)
    };
    let found = images.iter().map(texels_of).collect::<Result<Vec<_>, _>>()?;
    let flat = RgbaImage::from_pixel(1, 1, image::Rgba(texels.flat()));
    let images: Vec<&RgbaImage> = match images {
        [] => vec![&flat],
        _ => found,
    };
    let limits = gpu.device().limits();
    if images.len() > limits.max_texture_array_layers as usize {
        return Err(GpuError::Limit {
            pass: "scene textures",
            limit: "maxTextureArrayLayers",
            needed: images.len() as u64,
            available: limits.max_texture_array_layers.into(),
            remedy: "use fewer images, or join some of them to an atlas",
        }
        .into());
    }
    let size = common_size(&images);
    let layers: Vec<Mips> =
        images.iter().map(|image| texels.mips(resized(image, size, texels), has_mips)).collect();
    let texture = gpu.scoped(|| upload(gpu, &layers, texels))?;
    Ok(texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..Default::default()
    }))
}

impl Texels {
    /// The neutral texel: opaque white, or the normal of a flat surface.
    fn flat(self) -> [u8; 4] {
        match self {
            Self::Color => [255; 4],
            Self::Normal => [128, 128, 255, 255],
        }
    }

    fn mips(self, image: Cow<'_, RgbaImage>, has_mips: bool) -> Mips {
        let is_srgb = self == Self::Color;
        match (has_mips, is_srgb) {
            (false, _) => Mips { levels: vec![image.into_owned()], is_srgb },
            (true, true) => Mips::of_color(image.into_owned()),
            (true, false) => Mips::of_data(image.into_owned()),
        }
    }
}

/// Checks that an image has texels, and that it is not too wide or too high for a texture of the device. `path` names
/// the image in errors.
///
/// # Errors
/// [`InputError`] with the image's width and height.
pub(crate) fn check_image(gpu: &Gpu, path: &str, image: &RgbaImage) -> Result<(), InputError> {
    let most = gpu.device().limits().max_texture_dimension_2d;
    let (width, height) = image.dimensions();
    if [width, height].iter().all(|edge| (1..=most).contains(edge)) {
        return Ok(());
    }
    let bound = format!("must be 1 to {most} texels wide and high, the device's limit for textures");
    Err(InputError::new(path, format!("{width} × {height}"), bound))
}

/// The common size of all layers: the largest width and the largest height, halved until all layers fit [`MAX_TEXELS`].
fn common_size(images: &[&RgbaImage]) -> [u32; 2] {
    let largest = |edge: fn(&RgbaImage) -> u32| images.iter().map(|image| edge(image)).max().unwrap_or(1);
    let mut size = [largest(RgbaImage::width), largest(RgbaImage::height)];
    let texels = |[width, height]: [u32; 2]| images.len() as u64 * u64::from(width) * u64::from(height);
    while texels(size) > MAX_TEXELS {
        size = size.map(|edge| (edge / 2).max(1));
    }
    size
}

/// The image resized to a width and height. Colours are filtered in linear light. An image that already has this size
/// is returned without a copy.
fn resized(image: &RgbaImage, [width, height]: [u32; 2], texels: Texels) -> Cow<'_, RgbaImage> {
    if image.dimensions() == (width, height) {
        return Cow::Borrowed(image);
    }
    let is_light = |channel: usize| texels == Texels::Color && channel < 3;
    let light = image::Rgba32FImage::from_fn(image.width(), image.height(), |x, y| {
        let texel = image.get_pixel(x, y).0;
        image::Rgba(std::array::from_fn(|channel| match is_light(channel) {
            true => srgb::linear(texel[channel]),
            false => f32::from(texel[channel]) / 255.0,
        }))
    });
    let light = resize(&light, width, height, FilterType::Triangle);
    Cow::Owned(RgbaImage::from_fn(width, height, |x, y| {
        let texel = light.get_pixel(x, y).0;
        image::Rgba(std::array::from_fn(|channel| match is_light(channel) {
            true => srgb::byte(texel[channel]),
            false => (texel[channel] * 255.0 + 0.5) as u8,
        }))
    }))
}

fn upload(gpu: &Gpu, layers: &[Mips], texels: Texels) -> wgpu::Texture {
    let size = |level: &RgbaImage| wgpu::Extent3d {
        width: level.width(),
        height: level.height(),
        depth_or_array_layers: 1,
    };
    let texture = gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("scene textures"),
        size: wgpu::Extent3d { depth_or_array_layers: layers.len() as u32, ..size(&layers[0].levels[0]) },
        mip_level_count: layers[0].levels.len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: match texels {
            Texels::Color => wgpu::TextureFormat::Rgba8UnormSrgb,
            Texels::Normal => wgpu::TextureFormat::Rgba8Unorm,
        },
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (z, layer) in (0..).zip(layers) {
        for (mip_level, level) in (0..).zip(&layer.levels) {
            gpu.fill_level(&texture, [mip_level, z], level.as_raw());
        }
    }
    texture
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_get_the_largest_edges_that_fit() {
        let image = |width, height| RgbaImage::new(width, height);
        let (wide, high, tiny) = (image(64, 2), image(4, 32), image(1, 1));
        assert_eq!(common_size(&[&wide, &high, &tiny]), [64, 32]);
        assert_eq!(common_size(&[&tiny]), [1, 1]);
        // Nine layers of 4096 × 4096 texels exceed the limit of 64 Mi texels; nine of 2048 × 2048 do not.
        let large = image(4096, 4096);
        assert_eq!(common_size(&[&large; 9]), [2048, 2048]);
    }

    #[test]
    fn images_are_enlarged_in_linear_light() {
        let mut image = RgbaImage::from_pixel(2, 1, image::Rgba([0, 0, 0, 255]));
        image.put_pixel(1, 0, image::Rgba([255, 255, 255, 255]));
        assert!(matches!(resized(&image, [2, 1], Texels::Color), Cow::Borrowed(_)));
        let color = resized(&image, [4, 1], Texels::Color).into_owned();
        let data = resized(&image, [4, 1], Texels::Normal).into_owned();
        // The second pixel is a quarter white. For colours, a quarter of the light is 137 in sRGB; for data, it is 64.
        assert_eq!((color.get_pixel(1, 0).0[0], data.get_pixel(1, 0).0[0]), (137, 64));
        assert_eq!((color.get_pixel(0, 0).0[0], color.get_pixel(3, 0).0[0]), (0, 255));
    }
}
