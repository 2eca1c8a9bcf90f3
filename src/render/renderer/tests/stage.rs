//! Helpers of the renderer's tests: a scene of one object and one view, and a canvas to draw on.

use glam::{Mat4, Vec3, Vec4, camera};

use crate::asset::Light;
use crate::asset::transform::Affine;
use crate::gpu::{Buffer, Gpu, Group, Options, Uniform};
use crate::lod::is_mirrored;
use crate::lod::transition::Transition;
use crate::lod::{BLOCK, LodObject, OBJECT_LISTS, SceneDraw, SceneInstance};
use crate::render::{DepthFormat, TargetFormat};
use crate::render::{Layer, Renderer};
use crate::scene::drawable::{Drawable, DrawnObject, DrawnView};
use crate::scene::layouts::{InstancesInView, SceneLayouts};
use crate::shared::lod::object::object_flags_word;
use crate::shared::render::scene_view::SceneView;

/// Width and height of a canvas in pixels. The bytes of a row are a multiple of 256, as copies require.
pub const SIZE: [u32; 2] = [192, 128];

pub const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;

pub fn gpu() -> Gpu {
    Gpu::headless(&Options::default()).expect("the suite needs an adapter")
}

/// A perspective view of the origin.
pub fn view(eye: Vec3, reversed: bool) -> SceneView {
    let look = camera::rh::view::look_at_mat4(eye, Vec3::ZERO, Vec3::Y);
    let aspect = SIZE[0] as f32 / SIZE[1] as f32;
    let projection = match reversed {
        true => camera::rh::proj::directx::perspective_infinite_reverse(0.7, aspect, 0.5),
        false => camera::rh::proj::directx::perspective(0.7, aspect, 0.5, 50.0),
    };
    through(projection * look, eye.extend(1.0))
}

/// A view with this matrix and the default light.
pub fn through(clip_from_world: Mat4, eye: Vec4) -> SceneView {
    let light = Light::default();
    SceneView {
        clip_from_world,
        last_clip_from_world: clip_from_world,
        eye,
        light: light.direction.normalize().extend(light.ambient),
        light_color: light.color,
        side: if is_mirrored(&clip_from_world) { -1.0 } else { 1.0 },
        cell: glam::IVec3::ZERO,
        shadow_texel: 0.0,
        shadow_rows: [Vec4::ZERO; 3],
        dither_offset: glam::UVec2::ZERO,
    }
}

/// The data that kernels would have written for a view of one object. The object's instances are the scene's second block.
pub struct Stage {
    view: SceneView,
    group: Group,
    lists: Buffer<u32>,
    arguments: Buffer<SceneDraw>,
    lod: LodObject,
    reversed: bool,
}

impl Stage {
    /// Shows instances at `placements`, at most one block of them, at level 0. Each of `parts` is a range of indices:
    /// the first index and the count.
    pub fn new(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        view: SceneView,
        placements: &[Affine],
        parts: &[[u32; 2]],
    ) -> Self {
        let lod = LodObject {
            first: BLOCK,
            instances: BLOCK,
            first_list: 2 * BLOCK,
            first_draw: 3,
            parts: parts.len() as u32,
            flags: object_flags_word(1, 0, 0, 0, 0),
            ..LodObject::NONE
        };
        let (lists, draws) = listed(&lod, placements, parts);
        let nowhere = [[[f32::NAN; 4]; 3]; BLOCK as usize];
        let placements = [&nowhere[..], placements].concat();
        let instances = vec![SceneInstance::new([0.0; 4]); placements.len()];
        let up = "uploaded";
        let instances = Buffer::from_slice(gpu, "instances", &instances).expect(up);
        let group = layouts.view(
            gpu,
            &Uniform::new(gpu, "view", &view).expect(up),
            &InstancesInView {
                placements: &Buffer::from_slice(gpu, "placements", &placements).expect(up),
                instances: &instances,
                last_instances: &instances,
                last_decisions: &Buffer::new(gpu, "last decisions", placements.len()).expect(up),
            },
            None,
        );
        let z = view.clip_from_world.row(2);
        Self {
            view,
            group: group.expect("bound"),
            lists: Buffer::from_slice(gpu, "lists", &lists).expect(up),
            arguments: Buffer::from_slice(gpu, "draws", &draws).expect(up),
            lod,
            // With an infinite far plane at depth 0, the matrix's z row is constant.
            reversed: z.truncate() == Vec3::ZERO,
        }
    }

    pub fn seen(&self) -> DrawnView<'_> {
        DrawnView {
            group: &self.group,
            lists: &self.lists,
            arguments: &self.arguments,
            mirrors: self.view.side < 0.0,
            reversed: self.reversed,
            keeps_last: true,
            is_shadowed: false,
        }
    }

    pub fn object<'a>(&'a self, drawable: &'a dyn Drawable, ground: Option<&'a Group>) -> DrawnObject<'a> {
        let transition = Transition::Hard;
        DrawnObject { number: 1, drawable, lod: &self.lod, sides: [true; 2], transition, view_group: ground }
    }
}

/// The lists of level 0 and the draws of all parts.
fn listed(lod: &LodObject, placements: &[Affine], parts: &[[u32; 2]]) -> (Vec<u32>, Vec<SceneDraw>) {
    let mirrored = |placement: &Affine| {
        let [x, y, z] = placement.map(|row| Vec3::from_slice(&row));
        x.dot(y.cross(z)) < 0.0
    };
    let list = |wanted: bool| -> Vec<u32> {
        let all = (0..).zip(placements).filter(|(_, placement)| mirrored(placement) == wanted);
        all.map(|(index, _)| index).collect()
    };
    let all = [list(false), list(true)];
    // A draw that reads words of other lists fails the test.
    let mut lists = vec![u32::MAX; (4 * BLOCK) as usize];
    let mut draws = vec![[0; 5]; lod.first_draw as usize];
    for (at, list) in all.iter().enumerate() {
        let first = lod.first_list as usize + at * BLOCK as usize;
        lists[first..first + list.len()].copy_from_slice(list);
    }
    for [first, indices] in parts {
        let count = |list: usize| all.get(list).map_or(0, |list| list.len() as u32);
        draws.extend((0..OBJECT_LISTS as usize).map(|list| [*indices, count(list), *first, 0, 0]));
    }
    (lists, draws.into_iter().map(bytemuck::cast).collect())
}

/// A renderer with the pipelines of one object.
pub fn renderer(gpu: &Gpu, format: &TargetFormat, drawable: &dyn Drawable) -> Renderer {
    let mut renderer = Renderer::new(gpu, format).expect("a format");
    renderer.prepare_objects([(drawable, Transition::Hard)].into_iter(), false).expect("compiled");
    renderer
}

/// Draws layers of an object in one pass, in this order, and reads the colours.
pub fn drawn(
    gpu: &Gpu,
    format: &TargetFormat,
    drawable: &dyn Drawable,
    stage: &Stage,
    ground: Option<&Group>,
    layers: &[Layer],
) -> Vec<[u8; 4]> {
    let renderer = renderer(gpu, format, drawable);
    let object = stage.object(drawable, ground);
    Canvas::new(gpu, format).draw(gpu, |pass| {
        for layer in layers {
            renderer.draw_objects(pass, &stage.seen(), [object].into_iter(), *layer).expect("prepared");
        }
    })
}

/// Whether the adapter rounds vertices to a sixteenth of a pixel, the coarsest step that Vulkan allows. Others round to a 256th.
pub fn is_coarse(gpu: &Gpu) -> bool {
    gpu.adapter().name.contains("SwiftShader")
}

/// The number of pixels that differ by more than `levels` in a channel.
pub fn differing(a: &[[u8; 4]], b: &[[u8; 4]], levels: u8) -> usize {
    assert_eq!(a.len(), b.len());
    let far = |(a, b): (&[u8; 4], &[u8; 4])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > levels);
    a.iter().zip(b).filter(|pair| far(*pair)).count()
}

/// Clear value of all [`FORMAT`] colours except the first, as a colour and as a texel.
const OTHER: (wgpu::Color, [u8; 4]) = (wgpu::Color { r: 1.0, g: 0.0, b: 1.0, a: 0.0 }, [255, 0, 255, 0]);

/// Textures for the attachments of a target format.
pub struct Canvas {
    colors: Vec<Option<wgpu::Texture>>,
    resolved: wgpu::Texture,
    depth: Option<(wgpu::Texture, DepthFormat)>,
}

impl Canvas {
    pub fn new(gpu: &Gpu, format: &TargetFormat) -> Self {
        let texture = |format, sample_count, usage| {
            gpu.device().create_texture(&wgpu::TextureDescriptor {
                label: Some("canvas"),
                size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
                view_formats: &[],
            })
        };
        let [none, read] = [wgpu::TextureUsages::empty(), wgpu::TextureUsages::COPY_SRC];
        let color = |target: &Option<wgpu::ColorTargetState>| {
            target.as_ref().map(|target| texture(target.format, format.samples, read))
        };
        Self {
            colors: format.color.iter().map(color).collect(),
            resolved: texture(FORMAT, 1, read),
            depth: format.depth.map(|depth| (texture(depth.format, format.samples, none), depth)),
        }
    }

    /// Clears, draws, and reads the first colour, which has [`FORMAT`]. A depth-only canvas returns black.
    pub fn draw(&self, gpu: &Gpu, draw: impl FnOnce(&mut wgpu::RenderPass<'_>)) -> Vec<[u8; 4]> {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let resolved = view(&self.resolved);
        let colors: Vec<_> = self.colors.iter().map(|color| color.as_ref().map(view)).collect();
        let first = self.colors.first().cloned().flatten();
        let samples = first.as_ref().map_or(1, wgpu::Texture::sample_count);
        let attachments: Vec<_> = (colors.iter().enumerate())
            .map(|(at, color)| {
                color.as_ref().map(|view| wgpu::RenderPassColorAttachment {
                    view,
                    depth_slice: None,
                    resolve_target: (samples > 1 && at == 0).then_some(&resolved),
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(if at == 0 { wgpu::Color::default() } else { OTHER.0 }),
                        store: wgpu::StoreOp::Store,
                    },
                })
            })
            .collect();
        let depth = self.depth.as_ref().map(|(texture, depth)| (view(texture), depth));
        gpu.run("draw", |encoder| {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                color_attachments: &attachments,
                depth_stencil_attachment: depth.as_ref().map(|(view, depth)| cleared(view, depth)),
                ..Default::default()
            });
            draw(&mut pass);
        })
        .expect("drawn");
        let from = if samples > 1 { Some(&self.resolved) } else { first.as_ref() };
        from.map_or_else(|| vec![[0; 4]; (SIZE[0] * SIZE[1]) as usize], |from| texels(gpu, from))
    }

    /// The number of texels in the colour attachment with index `at` that differ from the clear value [`OTHER`]. `at` is at least
    /// 1, and a texel has four bytes.
    pub fn changed(&self, gpu: &Gpu, at: usize) -> usize {
        let color = self.colors[at].as_ref().expect("a colour");
        texels(gpu, color).iter().filter(|texel| **texel != OTHER.1).count()
    }
}

/// The texels of a four-byte colour.
fn texels(gpu: &Gpu, from: &wgpu::Texture) -> Vec<[u8; 4]> {
    let buffer = Buffer::<[u8; 4]>::new(gpu, "pixels", (SIZE[0] * SIZE[1]) as usize).expect("allocated");
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * SIZE[0]), rows_per_image: None };
    let run = gpu.run("read", |encoder| {
        let to = wgpu::TexelCopyBufferInfo { buffer: buffer.raw(), layout };
        encoder.copy_texture_to_buffer(from.as_image_copy(), to, from.size());
    });
    run.expect("read");
    buffer.read_blocking(gpu).expect("read")
}

/// A depth attachment, cleared to the far value.
fn cleared<'a>(
    view: &'a wgpu::TextureView,
    depth: &DepthFormat,
) -> wgpu::RenderPassDepthStencilAttachment<'a> {
    let far = if depth.reversed { 0.0 } else { 1.0 };
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(far), store: wgpu::StoreOp::Store }),
        stencil_ops: depth.format.has_stencil_aspect().then(wgpu::Operations::default),
    }
}
