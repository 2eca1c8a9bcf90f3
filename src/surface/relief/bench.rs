//! Benchmark cases of `surface/relief`: each method, on lists of rays and in the fragment pass, against `plain`
//! and against the same number of bare texel loads.

use glam::{Mat4, Vec3, Vec4};

use crate::asset::Light;
use crate::gpu::{Buffer, Gpu};
use crate::harness::{Backend, Bench, Contender};
use crate::render::{Layer, Offscreen, Renderer};
use crate::samples::BuiltInMap;
use crate::scene::{Camera, Depth, Placement, Quality, Relief, Scene, View};
use crate::surface::bench::{bare_loads, rays};
use crate::surface::color::ColorTexture;
use crate::surface::map::{Address, HeightMap};
use crate::surface::mesh::SurfaceMesh;
use crate::surface::mips::Mips;
use crate::surface::relief::reference::Surface;
use crate::surface::relief::textures::SurfaceTextures;
use crate::surface::relief::{Hit, March, Method, Ray, ReliefPass};
use crate::surface::{Material, ReliefMaps, ReliefOptions};
use crate::{Error, InputError};

/// Texels along an edge of the map.
const TEXELS: u32 = 512;

/// Pixels along an edge of the target.
const EDGE: u32 = 1024;

/// Angle between eye and normal, in degrees.
const ANGLE: f32 = 60.0;

/// Measures cobbles at 60° with a relief depth of 0.1. The first cases trace lists of 1024² rays: `copy` makes
/// as many texel loads per ray as the method does (the case's name says how many), and nothing else. Further
/// cases draw 1024² pixels of a scene, which was recorded before: `limit` draws `plain` in the same way; the
/// reference marches but does not shade.
///
/// All kernels come before all pictures, because lavapipe's timestamps around compute work are too short once a
/// picture has been drawn.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let map = BuiltInMap::Cobbles.height_map(TEXELS)?;
    for method in Method::ALL {
        listed(bench, &map, method)?;
    }
    let gpu = bench.gpu;
    let albedo = Mips::of_color(BuiltInMap::Cobbles.albedo(TEXELS)?);
    let albedo = ColorTexture::new(gpu, &albedo, true)?;
    let target = Offscreen::new(gpu, [EDGE, EDGE], true, 1, false)?;
    let plain = Drawing::new(gpu, &target, (&map, &albedo), Method::Plain)?;
    let (rays, march) = (rays(EDGE, towards()), March::default());
    for method in Method::ALL {
        let drawing = Drawing::new(gpu, &target, (&map, &albedo), method)?;
        let surface = Surface::new(&map, method, Address::Wrap);
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| drawing.record(encoder, &target)),
            Contender::recorded(Backend::Limit, |encoder| plain.record(encoder, &target)),
            Contender::host(Backend::ReferenceParallel, || {
                drop(std::hint::black_box(surface.trace_all(method, &rays, &march)));
            }),
        ];
        let pixels = (EDGE * EDGE) as usize;
        bench.case(
            format!("{EDGE}² pixels, {}", method.name()),
            (pixels, "pixel"),
            4 * pixels as u64,
            contenders,
        )?;
    }
    Ok(())
}

/// Measures one method with the compute kernel.
fn listed(bench: &mut Bench<'_>, map: &HeightMap, method: Method) -> Result<(), Error> {
    let gpu = bench.gpu;
    let rays = rays(EDGE, towards());
    let march = March::default();
    let surface = Surface::new(map, method, Address::Wrap);
    let samples: u64 =
        (surface.trace_all(method, &rays, &march).iter()).map(|hit| u64::from(hit.samples)).sum();
    let mean = samples as f64 / rays.len() as f64;
    let textures = textures(gpu, map, method)?;
    let input = Buffer::from_slice(gpu, "rays", &rays)?;
    let hits = Buffer::new(gpu, "hits", rays.len())?;
    let job = ReliefPass::new(gpu, method)?.prepare(gpu, &textures, &march, &input, &hits)?;
    let bare = bare_loads(gpu, &textures, EDGE, samples)?;
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &bare),
        Contender::host(Backend::ReferenceParallel, || {
            drop(std::hint::black_box(surface.trace_all(method, &rays, &march)));
        }),
    ];
    let bytes = 4 * samples + (rays.len() * (size_of::<Ray>() + size_of::<Hit>())) as u64;
    bench.case(format!("{}, {mean:.1} loads a ray", method.name()), (rays.len(), "ray"), bytes, contenders)
}

fn textures(gpu: &Gpu, map: &HeightMap, method: Method) -> Result<SurfaceTextures, Error> {
    SurfaceTextures::new(gpu, map, method, Address::Wrap)
}

/// A scene of the square, which fills the target, recorded through a view.
struct Drawing {
    scene: Scene,
    view: View,
    renderer: Renderer,
}

impl Drawing {
    fn new(
        gpu: &Gpu,
        target: &Offscreen,
        (map, albedo): (&HeightMap, &ColorTexture),
        method: Method,
    ) -> Result<Self, Error> {
        let textures = textures(gpu, map, method)?;
        let maps = ReliefMaps { textures: &textures, albedo, normals: None };
        let options = ReliefOptions { method, ..ReliefOptions::default() };
        let relief = Relief { options, ..Relief::of_maps(SurfaceMesh::square(1.0), maps) };
        let Material { light, ambient, .. } = relief.material;
        let mut scene = Scene::new(gpu)?;
        scene.set_light(Light { direction: light.into(), color: Vec3::ONE, ambient })?;
        let square = scene.add_relief(&relief, 1)?;
        scene.spawn(square, Placement::default())?;
        let mut renderer = Renderer::new(gpu, target.format())?;
        renderer.prepare(&scene)?;
        let mut view = scene.view(Quality { pixels: 0.0 })?;
        view.set(camera())?;
        gpu.try_run("record", |encoder| scene.record(encoder, &mut [&mut view]))?;
        let drawing = Self { scene, view, renderer };
        gpu.try_run("draw", |encoder| Ok(drawing.draw(encoder, target)?))?;
        Ok(drawing)
    }

    fn draw(&self, encoder: &mut wgpu::CommandEncoder, target: &Offscreen) -> Result<(), InputError> {
        target
            .record(encoder, [0.0; 3], |pass| self.renderer.draw(pass, &self.scene, &self.view, Layer::Color))
    }

    /// Draws again what has been drawn without an error.
    fn record(&self, encoder: &mut wgpu::CommandEncoder, target: &Offscreen) {
        drop(self.draw(encoder, target));
    }
}

/// A parallel camera, aslant: the square fills the picture, and rays come from [`towards`].
fn camera() -> Camera {
    let [x, y, z] = towards();
    // Across the picture nothing changes along the rays.
    let slant = Mat4 { z_axis: Vec4::new(-x / z, y / z, 1.0, 0.0), ..Mat4::IDENTITY };
    let clip_from_view =
        Mat4::from_translation(Vec3::Z * 0.5) * Mat4::from_scale(Vec3::new(2.0, 2.0, -0.25)) * slant;
    let view_from_cell = Mat4::IDENTITY;
    Camera { cell: [0; 3], view_from_cell, clip_from_view, viewport: [EDGE; 2], depth: Depth::Forward }
}

/// The unit vector towards the eye, tangent space.
fn towards() -> [f32; 3] {
    let (sine, cosine) = ANGLE.to_radians().sin_cos();
    [0.0, sine, cosine]
}
