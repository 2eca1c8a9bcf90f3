//! Bind groups for drawing a scene, and their layouts. Group 0 is the view, group 1 the object, group 2 the surface, and
//! group 3 belongs to the caller's shading.

use crate::asset::Affine;
use crate::gpu::bindings::render::{scene_mesh, scene_relief, scene_terrain};
use crate::gpu::{Buffer, Gpu, GpuError, Group, Layouts, Uniform};
use crate::scene::specialization::Program;
use crate::shared::lod::instance::SceneInstance;
use crate::shared::render::scene_instances::SceneObject;
use crate::shared::render::scene_terrain::{TerrainNode, TerrainView};
use crate::shared::render::scene_view::SceneView;

/// Bind group layouts of all scene shaders. All shaders share the layout of group 0 (view), and all mesh shaders share the
/// layout of group 1 (object). Pipelines can therefore change while these groups stay bound. Two values of this type on one
/// device are interchangeable.
#[derive(Debug, Clone)]
pub(crate) struct SceneLayouts {
    /// Layouts for meshes with materials.
    pub mesh: Layouts,
    /// Layouts for relief-mapped meshes.
    pub relief: Layouts,
    /// Layouts for terrain.
    pub terrain: Layouts,
    /// Layout of group 1 for caller-defined kinds.
    own_object: wgpu::BindGroupLayout,
    /// The shadow sampler, and the map that is bound for views without a shadow.
    shadow: ShadowBindings,
}

/// Buffers with one element per instance of a scene, for one view.
#[derive(Debug, Clone, Copy)]
pub(crate) struct InstancesInView<'a> {
    /// Transforms from model space to world axes, relative to the corner of the view's cell. With motion history, the last
    /// frame's transforms follow.
    pub placements: &'a Buffer<Affine>,
    /// All instances of the scene.
    pub instances: &'a Buffer<SceneInstance>,
    /// Instances in the last frame.
    pub last_instances: &'a Buffer<SceneInstance>,
    /// The view's level-of-detail decisions in the last frame.
    pub last_decisions: &'a Buffer<u32>,
}

/// The sampler of shadow maps, and a map of one texel for views without a shadow.
#[derive(Debug, Clone)]
struct ShadowBindings {
    sampler: wgpu::Sampler,
    nothing: wgpu::TextureView,
}

impl ShadowBindings {
    fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        gpu.scoped(|| Self {
            sampler: gpu.device().create_sampler(&wgpu::SamplerDescriptor {
                label: Some("sun shadow"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                compare: Some(wgpu::CompareFunction::LessEqual),
                ..Default::default()
            }),
            nothing: shadow_map(gpu, 1).create_view(&wgpu::TextureViewDescriptor::default()),
        })
    }
}

/// A sun's shadow map of `size` × `size` texels.
pub(crate) fn shadow_map(gpu: &Gpu, size: u32) -> wgpu::Texture {
    gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("sun shadow"),
        size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: SHADOW_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    })
}

/// Texture format of shadow maps.
pub(crate) const SHADOW_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

impl SceneLayouts {
    /// Creates the layouts on a device.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn new(gpu: &Gpu) -> Result<Self, GpuError> {
        Ok(Self {
            mesh: scene_mesh::layouts(gpu)?,
            relief: scene_relief::layouts(gpu)?,
            terrain: scene_terrain::layouts(gpu)?,
            own_object: gpu.scoped(|| gpu.device().create_bind_group_layout(&OWN_OBJECT))?,
            shadow: ShadowBindings::new(gpu)?,
        })
    }

    /// Creates bind group 0: a view, the scene's instances in this view, and the view's shadow map, if any.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn view(
        &self,
        gpu: &Gpu,
        view: &Uniform<SceneView>,
        instances: &InstancesInView<'_>,
        shadow_map: Option<&wgpu::TextureView>,
    ) -> Result<Group, GpuError> {
        let group = scene_mesh::Group {
            view,
            placements: instances.placements.slice(),
            instances: instances.instances.slice(),
            last_instances: instances.last_instances.slice(),
            last_decisions: instances.last_decisions.slice(),
            shadow_map: shadow_map.unwrap_or(&self.shadow.nothing),
            shadow_sampler: &self.shadow.sampler,
        };
        group.bind(gpu, &self.mesh)
    }

    /// Creates bind group 1 for a terrain in a view.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn ground(
        &self,
        gpu: &Gpu,
        ground: &Uniform<TerrainView>,
        nodes: &Buffer<TerrainNode>,
    ) -> Result<Group, GpuError> {
        scene_terrain::Group1 { ground, nodes: nodes.slice() }.bind(gpu, &self.terrain)
    }

    /// Creates bind group 1 for an object of a caller-defined kind.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn own_object(&self, gpu: &Gpu, object: &Uniform<SceneObject>) -> Result<Group, GpuError> {
        gpu.scoped(|| {
            gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
                label: OWN_OBJECT.label,
                layout: &self.own_object,
                entries: &[wgpu::BindGroupEntry { binding: 0, resource: object.raw().as_entire_binding() }],
            })
        })
    }

    /// The layouts of bind groups 0 to 2 of a shader program.
    ///
    /// # Errors
    /// [`GpuError`].
    pub fn of(&self, gpu: &Gpu, program: &Program) -> Result<[wgpu::BindGroupLayout; 3], GpuError> {
        let view = self.mesh.groups[0].clone();
        let [object, part] = match program {
            Program::Mesh => [self.mesh.groups[1].clone(), self.mesh.groups[2].clone()],
            Program::Relief => [self.mesh.groups[1].clone(), self.relief.groups[2].clone()],
            Program::Terrain => [self.terrain.groups[1].clone(), self.terrain.groups[2].clone()],
            Program::Own(program) => [self.own_object.clone(), program.layout(gpu)?],
        };
        Ok([view, object, part])
    }
}

/// Layout of group 1 in shaders of caller-defined kinds: the uniform `scene_object` of `wgsl/render/scene_instances.wgsl`.
const OWN_OBJECT: wgpu::BindGroupLayoutDescriptor<'static> = wgpu::BindGroupLayoutDescriptor {
    label: Some("object of a kind"),
    entries: &[wgpu::BindGroupLayoutEntry {
        binding: 0,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        },
        count: None,
    }],
};
