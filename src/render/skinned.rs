//! Draws skinned instances of a mesh in the caller's render pass. The instances of each level of detail take
//! two indirect draws, the second for those that are mirrored. A mesh has one material: a model with several is
//! drawn mesh by mesh.

use glam::{Mat4, Vec4};

use crate::asset::Light;
use crate::asset::material::Alpha;
use crate::asset::mesh::MAX_LEVELS;
use crate::asset::transform::Affine;
use crate::gpu::{Buffer, Gpu, GpuError, Group, RenderPipeline, Uniform, shaders};
use crate::render::albedo::Albedo;
use crate::render::pipeline::{Draws, bind};
use crate::shared::render::skinned::SkinnedView;
use crate::skinning::buffers::MeshBuffers;
use crate::skinning::clusters::ClusterLevel;
use crate::skinning::lod::{draws_at, list_stride};
use crate::skinning::picture::is_mirrored;
use crate::skinning::vertex::Vertex;
use crate::{Error, InputError};

/// Draws meshes on targets of one format.
#[derive(Debug, Clone)]
pub struct SkinnedRenderer {
    color: wgpu::TextureFormat,
}

/// The instances to draw.
#[derive(Debug, Clone, Copy)]
pub struct SkinnedInstances<'a> {
    /// Triangles of all levels, and texture coordinates.
    pub mesh: &'a MeshBuffers,
    /// Skinned vertices, as [`crate::skinning::skin::SkinPass`] writes them.
    pub skinned: &'a Buffer<Vertex>,
    /// The transforms from the model's space into the world, one per instance. A mirrored instance still shows
    /// its outside.
    pub placements: &'a Buffer<Affine>,
    /// Indices of the instances to draw. Either one list for the mesh itself, with at most as many entries as
    /// there are placements; or one list per level of detail ([`MeshBuffers::levels`]), [`list_stride`] words
    /// each. Lists of levels that do not exist are drawn with the last level.
    pub drawn: &'a Buffer<u32>,
    /// The base colour.
    pub albedo: &'a Albedo,
    /// The light.
    pub light: Light,
}

impl SkinnedRenderer {
    /// Compiles the pipelines for opaque surfaces, unless they are cached for this device, for targets of
    /// `color` format with a [`DEPTH_FORMAT`](crate::render::target::DEPTH_FORMAT) depth buffer. The first mesh
    /// that is not opaque compiles pipelines of its own.
    ///
    /// # Errors
    /// What the driver's compiler reports.
    pub fn new(gpu: &Gpu, color: wgpu::TextureFormat) -> Result<Self, GpuError> {
        let renderer = Self { color };
        for sides in [Sides::Both, Sides::Outer, Sides::OuterMirrored] {
            renderer.pipeline(gpu, sides, Alpha::Opaque)?;
        }
        Ok(renderer)
    }

    fn pipeline(&self, gpu: &Gpu, sides: Sides, alpha: Alpha) -> Result<RenderPipeline, GpuError> {
        let is = |wanted: Sides| f64::from(sides == wanted);
        let draws = Draws {
            shader: &shaders::RENDER_SKINNED,
            fragment: match alpha {
                Alpha::Opaque => "opaque",
                Alpha::Mask(_) => "masked",
                Alpha::Dithered | Alpha::Blended => "screened",
            },
            constants: &[("DOUBLE_SIDED", is(Sides::Both)), ("MIRRORED", is(Sides::OuterMirrored))],
            topology: wgpu::PrimitiveTopology::TriangleList,
            cull: match sides {
                Sides::Both => None,
                Sides::Outer => Some(wgpu::Face::Back),
                Sides::OuterMirrored => Some(wgpu::Face::Front),
            },
            vertices: &[],
        };
        draws.pipeline(gpu, self.color)
    }

    /// Binds instances. Until [`SkinnedScene::arguments`] is written, the first list is drawn with as many
    /// entries as it has room for, at most one per placement, and the other lists are not drawn; any instance
    /// may be mirrored.
    ///
    /// # Errors
    /// [`InputError`] for too few vertices or placements, and for a buffer that does not consist of whole lists
    /// of at most [`MAX_LEVELS`] levels; [`GpuError`].
    pub fn scene(&self, gpu: &Gpu, instances: &SkinnedInstances<'_>) -> Result<SkinnedScene, Error> {
        let SkinnedInstances { mesh, skinned, placements, drawn, albedo, light } = *instances;
        light.validate()?;
        let vertices = mesh.vertices.len();
        skinned.check_holds("skinned", vertices * placements.len())?;
        let [levels, words] = lists(drawn.len(), placements.len())?;
        let view = SkinnedView {
            clip_from_world: Mat4::IDENTITY,
            light: light.direction.normalize().extend(light.ambient),
            color: Vec4::from(albedo.factor) * light.color.extend(1.0),
            vertices: vertices as u32,
            cutoff: if let Alpha::Mask(cutoff) = albedo.alpha { cutoff } else { 0.0 },
            side: 1.0,
        };
        let uniform = Uniform::new(gpu, "skinned view", &view)?;
        let texture = albedo.texture.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let (pipelines, layouts) = self.pipelines(gpu, mesh.double_sided, albedo.alpha)?;
        let group = |level: usize| {
            let resources = [
                uniform.raw().as_entire_binding(),
                skinned.raw().as_entire_binding(),
                mesh.uv.raw().as_entire_binding(),
                placements.raw().as_entire_binding(),
                list(drawn, level, words),
                wgpu::BindingResource::TextureView(&texture),
                wgpu::BindingResource::Sampler(&albedo.texture.sampler),
            ];
            bind(gpu, &shaders::RENDER_SKINNED, &layouts, 0, &resources)
        };
        let instances = drawn.len().min(placements.len()) as u32;
        let arguments = (0..levels).flat_map(|level| {
            let ClusterLevel { first_index, indices, .. } = mesh.level(level as u32);
            [indices, if level == 0 { instances } else { 0 }, first_index, 0, 0].repeat(2)
        });
        Ok(SkinnedScene {
            arguments: Buffer::from_slice(gpu, "draw", &arguments.collect::<Vec<_>>())?,
            groups: (0..levels).map(group).collect::<Result<_, _>>()?,
            indices: mesh.indices.clone(),
            pipelines,
            view,
            uniform,
        })
    }

    /// The pipelines: one that draws all instances from both sides, or one for those that are not mirrored and
    /// one for those that are.
    fn pipelines(
        &self,
        gpu: &Gpu,
        double_sided: bool,
        alpha: Alpha,
    ) -> Result<(Vec<wgpu::RenderPipeline>, Vec<wgpu::BindGroupLayout>), GpuError> {
        let sides: &[Sides] =
            if double_sided { &[Sides::Both] } else { &[Sides::Outer, Sides::OuterMirrored] };
        let (pipelines, mut layouts): (Vec<_>, Vec<_>) =
            sides.iter().map(|sides| self.pipeline(gpu, *sides, alpha)).collect::<Result<_, _>>()?;
        // All are compiled from the same shader and have the same layouts.
        Ok((pipelines, layouts.swap_remove(0)))
    }
}

/// Which sides of triangles a draw shows, and of which instances. Seen from outside, triangles that the
/// placement or the view mirrors run clockwise on the screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sides {
    /// Both sides of all instances.
    Both,
    /// The outsides of instances that are not mirrored.
    Outer,
    /// The outsides of mirrored instances.
    OuterMirrored,
}

/// The number of lists of drawn instances, and the number of words of each.
fn lists(words: usize, places: usize) -> Result<[usize; 2], InputError> {
    if words <= places {
        return Ok([1, words]);
    }
    let stride = list_stride(places);
    let levels = words / stride;
    if !(2..=MAX_LEVELS).contains(&levels) || !words.is_multiple_of(stride) {
        let bound = format!(
            "must be at most {places}, one a place, or {stride} for each of 2 to {MAX_LEVELS} levels"
        );
        return Err(InputError::new("drawn.len", words, bound));
    }
    Ok([levels, stride])
}

/// One list, to be bound. An empty list has room for one word.
fn list(drawn: &Buffer<u32>, at: usize, words: usize) -> wgpu::BindingResource<'_> {
    let [offset, size] = [at * words, words.max(1)].map(|words| (size_of::<u32>() * words) as u64);
    let size = wgpu::BufferSize::new(size);
    wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer: drawn.raw(), offset, size })
}

/// Instances of a mesh: set the camera, then draw in any render pass.
#[derive(Debug, Clone)]
pub struct SkinnedScene {
    /// Two indirect draws, of five words each, for every level that has a list in `drawn`: number of indices, number
    /// of instances, first index, and two zeros. The first draw omits mirrored instances, and the second omits all
    /// others; each runs through as many entries of the list as its second word says. For double-sided meshes, the
    /// first draws all instances. The caller or a kernel may change the two numbers of instances; the second draw
    /// need not go beyond the last mirrored instance.
    pub arguments: Buffer<u32>,
    pipelines: Vec<wgpu::RenderPipeline>,
    view: SkinnedView,
    uniform: Uniform<SkinnedView>,
    groups: Vec<Group>,
    indices: Buffer<u32>,
}

impl SkinnedScene {
    /// Sets the camera of the next submission.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn set_camera(&mut self, gpu: &Gpu, clip_from_world: Mat4) -> Result<(), GpuError> {
        self.view.clip_from_world = clip_from_world;
        self.view.side = if is_mirrored(&clip_from_world) { -1.0 } else { 1.0 };
        self.uniform.write(gpu, &self.view)
    }

    /// Draws the instances.
    pub fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_index_buffer(self.indices.raw().slice(..), wgpu::IndexFormat::Uint32);
        for (draw, pipeline) in self.pipelines.iter().enumerate() {
            pass.set_pipeline(pipeline);
            for (level, group) in self.groups.iter().enumerate() {
                pass.set_bind_group(0, group, &[]);
                pass.draw_indexed_indirect(self.arguments.raw(), draws_at(level)[draw]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_whole() {
        assert_eq!((lists(0, 9), lists(9, 9), lists(64, 64)), (Ok([1, 0]), Ok([1, 9]), Ok([1, 64])));
        assert_eq!((lists(192, 64), lists(256, 65)), (Ok([3, 64]), Ok([2, 128])));
        for (words, places) in [(64, 63), (10, 9), (129, 64), (17 * 64, 64)] {
            assert_eq!(lists(words, places).expect_err("refused").path, "drawn.len");
        }
    }
}
