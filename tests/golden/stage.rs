//! Pictures of scenes in linear light, drawn at twice the size and averaged, as the host's pictures are.

use glam::Mat4;
use image::{Rgba, RgbaImage};
use relievo::asset::material::{Alpha, Material, Sampling, Texture};
use relievo::asset::{Mesh, Model};
use relievo::gpu::Gpu;
use relievo::render::{Layer, Offscreen, Renderer};
use relievo::scene::{Camera, Depth, Scene, View};

/// The colour behind everything, in linear light.
pub const SKY: [f32; 3] = [0.02, 0.025, 0.03];

/// A camera that draws at twice the size.
pub fn camera(view_from_world: Mat4, clip_from_view: Mat4, size: [u32; 2]) -> Camera {
    let viewport = size.map(|edge| 2 * edge);
    Camera { cell: [0; 3], view_from_cell: view_from_world, clip_from_view, viewport, depth: Depth::Forward }
}

/// Records a frame of a scene and draws it.
pub fn picture(gpu: &Gpu, scene: &mut Scene, view: &mut View) -> RgbaImage {
    let size = view.camera().expect("set").viewport;
    let target = Offscreen::linear(gpu, size).expect("allocated");
    let mut renderer = Renderer::new(gpu, target.format()).expect("a format");
    renderer.prepare(scene).expect("compiled");
    let mut encoder = gpu.encoder("frame");
    scene.record(&mut encoder, &mut [view]).expect("recorded");
    let draw = |pass: &mut wgpu::RenderPass<'_>| renderer.draw(pass, scene, view, Layer::Color);
    target.record(&mut encoder, SKY, draw).expect("drawn");
    gpu.queue().submit([encoder.finish()]);
    target.read_linear(gpu).expect("read").reduced(2).encoded()
}

/// Gives meshes without a material a checkerboard of two colours.
pub fn checkered(mut model: Model) -> Model {
    let square = |x: u32, y: u32| {
        if (x / 16 + y / 16).is_multiple_of(2) { [214, 150, 104, 255] } else { [150, 82, 52, 255] }
    };
    let (index, image) = (model.materials.len(), model.images.len());
    model.images.push(RgbaImage::from_fn(64, 64, |x, y| Rgba(square(x, y))).into());
    model.materials.push(Material {
        name: "checks".to_owned(),
        color: [1.0; 4],
        texture: Some(Texture { image, sampling: Sampling::default() }),
        normal: None,
        normal_scale: 1.0,
        alpha: Alpha::Opaque,
        pbr: Default::default(),
    });
    let bare = |mesh: &&mut Mesh| mesh.material.is_none();
    model.meshes.iter_mut().filter(bare).for_each(|mesh| mesh.material = Some(index));
    model
}
