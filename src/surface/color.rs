//! Colour textures with mip levels, on the device.

use crate::asset::material::{Filter, Sampling, Wrapping};
use crate::gpu::{Gpu, GpuError};
use crate::srgb::linear;
use crate::surface::map::Address;
use crate::surface::mips::Mips;

/// A colour texture on the device, with its sampler.
#[derive(Debug, Clone)]
pub struct ColorTexture {
    /// RGBA texture with all mip levels.
    pub texture: wgpu::Texture,
    /// Trilinear sampler, which wraps or clamps outside the image.
    pub sampler: wgpu::Sampler,
}

impl ColorTexture {
    /// Uploads mip levels as 8-bit texels. `mips` determines the format: sRGB for colours, linear for data. `address` determines
    /// whether the sampler wraps or clamps outside the image.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn new(gpu: &Gpu, mips: &Mips, address: Address) -> Result<Self, GpuError> {
        let format = match mips.is_srgb {
            true => wgpu::TextureFormat::Rgba8UnormSrgb,
            false => wgpu::TextureFormat::Rgba8Unorm,
        };
        upload(gpu, mips, address, format, |level| level.as_raw().clone())
    }

    /// Uploads mip levels as linear 16-bit floats, for pictures that are compared across drivers. This format takes twice the
    /// memory, but does not depend on the driver's sRGB decoding. `address` determines whether the sampler wraps or clamps
    /// outside the image.
    ///
    /// # Errors
    /// [`GpuError`] for errors of the device.
    pub fn linear(gpu: &Gpu, mips: &Mips, address: Address) -> Result<Self, GpuError> {
        let value = |channel: usize, byte: u8| match mips.is_srgb && channel < 3 {
            true => linear(byte),
            false => f32::from(byte) / 255.0,
        };
        let halves = |level: &image::RgbaImage| {
            let texels = level.pixels().flat_map(|texel| {
                let [r, g, b, a] = texel.0;
                [value(0, r), value(1, g), value(2, b), value(3, a)]
            });
            texels.flat_map(|light| half::f16::from_f32(light).to_le_bytes()).collect()
        };
        upload(gpu, mips, address, wgpu::TextureFormat::Rgba16Float, halves)
    }
}

/// Creates a wgpu sampler with the wrapping and filters of a material's texture.
///
/// # Errors
/// [`GpuError`] for errors of the device.
pub(crate) fn sampler_of(gpu: &Gpu, sampling: &Sampling) -> Result<wgpu::Sampler, GpuError> {
    let address = |wrapping: Wrapping| match wrapping {
        Wrapping::Repeat => wgpu::AddressMode::Repeat,
        Wrapping::Mirror => wgpu::AddressMode::MirrorRepeat,
        Wrapping::Clamp => wgpu::AddressMode::ClampToEdge,
    };
    let filter = |filter: Filter| match filter {
        Filter::Nearest => wgpu::FilterMode::Nearest,
        Filter::Linear => wgpu::FilterMode::Linear,
    };
    let [u, v] = sampling.wrap.map(address);
    gpu.scoped(|| {
        gpu.device().create_sampler(&wgpu::SamplerDescriptor {
            label: Some("texture"),
            address_mode_u: u,
            address_mode_v: v,
            mag_filter: filter(sampling.magnified),
            min_filter: filter(sampling.minified),
            mipmap_filter: match sampling.mips {
                Some(Filter::Linear) => wgpu::MipmapFilterMode::Linear,
                _ => wgpu::MipmapFilterMode::Nearest,
            },
            ..Default::default()
        })
    })
}

fn upload(
    gpu: &Gpu,
    mips: &Mips,
    address: Address,
    format: wgpu::TextureFormat,
    bytes: impl Fn(&image::RgbaImage) -> Vec<u8>,
) -> Result<ColorTexture, GpuError> {
    let [width, height] = [mips.levels[0].width(), mips.levels[0].height()];
    gpu.check_texture("colour", [width, height], "use a smaller image")?;
    gpu.scoped(|| {
        let texture = gpu.sampled_texture("colour", [width, height, 1], mips.levels.len() as u32, format);
        for (mip_level, level) in (0..).zip(&mips.levels) {
            gpu.fill_level(&texture, [mip_level, 0], &bytes(level));
        }
        ColorTexture { texture, sampler: gpu.trilinear_sampler("colour", address == Address::Wrap) }
    })
}
