//! Objects on the ground touch it: the depth of every pixel is that of the triangle which the CPU finds.

use glam::{DMat4, DVec3, Vec3};
use relievo::gpu::{Buffer, Gpu};
use relievo::render::target::{COLOR_FORMAT, DEPTH_FORMAT};
use relievo::render::{Camera, Materials, Style, TerrainRenderer, TerrainScene};
use relievo::terrain::blend::Shading;
use relievo::terrain::config::Config;
use relievo::terrain::generator::Generator;
use relievo::terrain::ground::Ground;
use relievo::terrain::mesh::HeightField;
use relievo::terrain::recipe::Recipe;
use relievo::terrain::texture::Texture;

use crate::harness::gpu;

const EDGE: u32 = 256;
const ORIGIN: [i32; 2] = [-3, 70_000];

/// The depths of a picture of `EDGE`² pixels, row by row.
fn depths(gpu: &Gpu, scene: &TerrainScene) -> Vec<f32> {
    let texture = |format, usage| {
        gpu.device().create_texture(&wgpu::TextureDescriptor {
            label: Some("ground"),
            size: wgpu::Extent3d { width: EDGE, height: EDGE, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | usage,
            view_formats: &[],
        })
    };
    let color = texture(COLOR_FORMAT, wgpu::TextureUsages::empty());
    let depth = texture(DEPTH_FORMAT, wgpu::TextureUsages::COPY_SRC);
    let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
    let buffer = Buffer::<f32>::new(gpu, "depths", (EDGE * EDGE) as usize).expect("allocated");
    gpu.run("draw", |encoder| {
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view(&color),
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations::default(),
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &view(&depth),
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(1.0),
                    store: wgpu::StoreOp::Store,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        scene.draw(&mut pass);
        drop(pass);
        let to =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * EDGE), rows_per_image: None };
        encoder.copy_texture_to_buffer(
            depth.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: buffer.raw(), layout: to },
            wgpu::Extent3d { width: EDGE, height: EDGE, depth_or_array_layers: 1 },
        );
    })
    .expect("drawn");
    buffer.read_blocking(gpu).expect("read")
}

/// The points that a picture of 2×2 patches shows, from each pixel's depth, relative to the first patch; with the
/// ground on the CPU and, for comparison, the whole as one field.
fn seen() -> (Vec<DVec3>, Ground, HeightField) {
    let gpu = gpu();
    let config = Config { terrain_scale: 0.25, ..Config::new(17, 12.0, "ground").expect("valid") };
    let patches = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[x, y]| [ORIGIN[0] + x, ORIGIN[1] + y]);
    let generator = Generator::new(&gpu, Recipe::new(config.clone())).expect("valid");
    let fields = generator.generate(&gpu, &patches, 1, &mut |_| ()).expect("generated").remove(0);
    let textures = Texture::of_zones(&config.zones).expect("built in");
    let materials = Materials::new(&gpu, &config.zones, &textures).expect("uploaded");
    let renderer = TerrainRenderer::new(&gpu, COLOR_FORMAT, Style::Textured).expect("compiled");
    let mut scene = renderer.scene(&gpu, &materials, &Shading::default()).expect("bound");
    scene.add(&gpu, &config, &fields, &patches, ORIGIN).expect("added");
    // From above, and a little aside, so that no ray is straight.
    let camera = Camera {
        eye: Vec3::new(3.0, 60.0, 5.0),
        target: Vec3::new(4.0, 0.0, 4.0),
        field_of_view: 0.12,
        near: 20.0,
        far: 100.0,
    };
    scene.set_camera(&gpu, &camera, 1.0).expect("a camera");
    let clip_from_world = camera.clip_from_world(1.0).expect("a camera").to_cols_array().map(f64::from);
    let world_from_clip = DMat4::from_cols_array(&clip_from_world).inverse();
    let middle = |pixel: usize| (2 * pixel + 1) as f64 / f64::from(EDGE) - 1.0;
    let points = (depths(&gpu, &scene).into_iter().enumerate())
        .filter(|(_, depth)| *depth < 1.0)
        .map(|(pixel, depth)| {
            let (x, y) = (pixel % EDGE as usize, pixel / EDGE as usize);
            world_from_clip.project_point3(DVec3::new(middle(x), -middle(y), depth.into()))
        })
        .collect();
    let mut ground = Ground::new(&config).expect("valid");
    let heights = fields.heights.read_blocking(&gpu).expect("read");
    let mut whole = vec![0; 33 * 33];
    for ((index, patch), window) in patches.iter().enumerate().zip(heights.chunks_exact(19 * 19)) {
        ground.insert(*patch, window, 1).expect("19² heights");
        let first = (index % 2 * 16, index / 2 * 16);
        for (y, x) in (0..17).flat_map(|y| (0..17).map(move |x| (y, x))) {
            whole[(first.1 + y) * 33 + first.0 + x] = window[(y + 1) * 19 + x + 1];
        }
    }
    (points, ground, HeightField::new(whole, 33, 0.25).expect("square"))
}

#[test]
fn the_picture_shows_the_triangles_that_the_cpu_answers() {
    let (points, ground, bilinear) = seen();
    let (mut inside, mut worst, mut worst_bilinear) = (0, 0.0_f64, 0.0_f64);
    for point in &points {
        // Rounding may move points on the outer edge of the patches out of them.
        let Some(answer) = ground.point_from(ORIGIN, point.x, point.z) else { continue };
        inside += 1;
        worst = worst.max((answer.height - point.y).abs());
        let other = bilinear.height_at(point.x, point.z).unwrap_or(answer.height);
        worst_bilinear = worst_bilinear.max((other - point.y).abs());
    }
    println!(
        "{inside} pixels: triangles within {worst:.5} of the picture, bilinear within {worst_bilinear:.4}"
    );
    assert!(inside > 45_000 && inside + 500 > points.len(), "{inside} of {}", points.len());
    // Slopes here are below 60 (12 units of height on a quarter), and rasterizers move vertices by up to 2⁻⁹
    // pixels of 0.03 units each way; depth in f32 adds z² / near · 2⁻²⁴ for every rounding.
    assert!(worst < 5e-3, "{worst}");
    assert!(worst_bilinear > 0.1, "a bilinear surface would pass: {worst_bilinear}");
}
