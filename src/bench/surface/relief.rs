//! The fragment pass, each method beside `plain` and beside as many bare texel loads.

use glam::{Mat4, Vec3, Vec4};

use crate::Error;
use crate::baseline::loads::LoadsPass;
use crate::bench::{Backend, Bench, Contender};
use crate::gpu::{Buffer, Gpu};
use crate::reference::surface::relief::Surface;
use crate::render::relief::{ReliefCamera, ReliefMaps, ReliefOptions, ReliefRenderer, ReliefScene};
use crate::render::{ColorTexture, Target, target::COLOR_FORMAT};
use crate::surface::builtin::BuiltInMap;
use crate::surface::map::{Address, HeightMap};
use crate::surface::material::{Material, Shadow};
use crate::surface::mesh::SurfaceMesh;
use crate::surface::mips::Mips;
use crate::surface::relief::{Hit, March, Method, Ray};
use crate::surface::texture::SurfaceTextures;

/// Pixels along an edge of the target.
const EDGE: u32 = 1024;

/// Degrees from the normal.
const ANGLE: f32 = 60.0;

/// 1024² pixels of cobbles at 60°, relief depth 0.1. `limit` is `plain` drawn the same; `copy` as many texel loads
/// a pixel as the method makes, and nothing else. The case names the loads.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let map = BuiltInMap::Cobbles.height_map(1024)?;
    let albedo = Mips::of_color(BuiltInMap::Cobbles.albedo(1024)?);
    let albedo = ColorTexture::new(gpu, &albedo, true)?;
    let target = Target::new(gpu, [EDGE, EDGE])?;
    let sums = Buffer::new(gpu, "sums", (EDGE * EDGE) as usize)?;
    let loads = LoadsPass::new(gpu)?;
    let plain = scene(gpu, &map, &albedo, Method::Plain)?;
    let rays = rays(64);
    for method in Method::ALL {
        let scene = scene(gpu, &map, &albedo, method)?;
        let surface = Surface::new(&map, method, Address::Wrap);
        let trace = |rays: &[Ray]| -> Vec<Hit> { surface.trace_all(method, rays, &March::default()) };
        let samples: u32 = trace(&rays).iter().map(|hit| hit.samples).sum();
        let mean = f64::from(samples) / rays.len() as f64;
        let bare = loads.prepare(
            gpu,
            &textures(gpu, &map, method)?.heights,
            [EDGE, EDGE],
            mean.round() as u32,
            &sums,
        )?;
        let draw = |scene: &ReliefScene, encoder: &mut wgpu::CommandEncoder| {
            target.record(encoder, [0.0; 3], |pass| scene.draw(pass));
        };
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| draw(&scene, encoder)),
            Contender::recorded(Backend::Limit, |encoder| draw(&plain, encoder)),
            Contender::job(Backend::Copy, &bare),
            Contender::host(Backend::TwinParallel, || {
                for _ in 0..EDGE * EDGE / rays.len() as u32 {
                    drop(std::hint::black_box(trace(&rays)));
                }
            }),
        ];
        let name = format!("{} {EDGE}², {mean:.1} loads", method.name());
        let pixels = u64::from(EDGE * EDGE);
        bench.case(name, (pixels as usize, "pixel"), (mean * 4.0 * pixels as f64) as u64, contenders)?;
    }
    Ok(())
}

fn textures(gpu: &Gpu, map: &HeightMap, method: Method) -> Result<SurfaceTextures, Error> {
    SurfaceTextures::new(gpu, map, method, Address::Wrap)
}

/// The square over the whole target.
fn scene(gpu: &Gpu, map: &HeightMap, albedo: &ColorTexture, method: Method) -> Result<ReliefScene, Error> {
    let options = ReliefOptions {
        method,
        shadow: Shadow::None,
        normal_map: false,
        silhouette: false,
        depth: false,
        mip: false,
    };
    let textures = textures(gpu, map, method)?;
    let maps = ReliefMaps { textures: &textures, albedo, normals: None };
    let renderer = ReliefRenderer::new(gpu, COLOR_FORMAT, options)?;
    let mesh = SurfaceMesh::square(1.0);
    let mut scene = renderer.scene(gpu, &mesh, maps, &Material::default(), &March::default(), 1.0)?;
    let clip_from_world = Mat4::from_translation(Vec3::Z * 0.5) * Mat4::from_scale(Vec3::new(2.0, 2.0, 1.0));
    let (sine, cosine) = ANGLE.to_radians().sin_cos();
    scene.set_camera(gpu, ReliefCamera { clip_from_world, eye: Vec4::new(0.0, -sine, cosine, 0.0) })?;
    Ok(scene)
}

/// The rays of the picture, `edge` of them along each edge.
fn rays(edge: u32) -> Vec<Ray> {
    let (sine, cosine) = ANGLE.to_radians().sin_cos();
    let at = |index: u32| (index as f32 + 0.5) / edge as f32;
    let places = (0..edge).flat_map(|y| (0..edge).map(move |x| [at(x), at(y)]));
    places.map(|uv| Ray::new(uv, [0.0, sine, cosine], Material::default().scale, 1.0)).collect()
}
