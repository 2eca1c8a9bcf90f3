//! Benchmark cases of `surface/relief`: each method, on lists of rays and in the fragment pass, against `plain`
//! and against the same number of bare texel loads.

use glam::{Mat4, Vec3, Vec4};

use crate::Error;
use crate::gpu::{Buffer, Gpu};
use crate::harness::{Backend, Bench, Contender};
use crate::render::relief::{ReliefCamera, ReliefMaps, ReliefOptions, ReliefRenderer, ReliefScene};
use crate::render::{ColorTexture, Target, target::COLOR_FORMAT};
use crate::samples::BuiltInMap;
use crate::surface::bench::{bare_loads, rays};
use crate::surface::map::{Address, HeightMap};
use crate::surface::material::Material;
use crate::surface::mesh::SurfaceMesh;
use crate::surface::mips::Mips;
use crate::surface::relief::reference::Surface;
use crate::surface::relief::textures::SurfaceTextures;
use crate::surface::relief::{Hit, March, Method, Ray, ReliefPass};

/// Texels along an edge of the map.
const TEXELS: u32 = 512;

/// Pixels along an edge of the target.
const EDGE: u32 = 1024;

/// Angle between eye and normal, in degrees.
const ANGLE: f32 = 60.0;

/// Measures cobbles at 60° with a relief depth of 0.1. The first cases trace lists of 1024² rays: `copy` makes
/// as many texel loads per ray as the method does (the case's name says how many), and nothing else. Further
/// cases draw 1024² pixels by the fragment pass: `limit` draws `plain` in the same way; the reference marches
/// but does not shade.
///
/// All kernels come before all pictures, because lavapipe's timestamps around compute work are too short once a
/// picture has been drawn.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let map = BuiltInMap::Cobbles.height_map(TEXELS)?;
    for method in Method::ALL {
        listed(bench, &map, method)?;
    }
    let gpu = bench.gpu;
    let albedo = Mips::of_color(BuiltInMap::Cobbles.albedo(TEXELS)?);
    let albedo = ColorTexture::new(gpu, &albedo, true)?;
    let target = Target::new(gpu, [EDGE, EDGE])?;
    let plain = scene(gpu, &map, &albedo, Method::Plain)?;
    let (rays, march) = (rays(EDGE, towards()), March::default());
    for method in Method::ALL {
        let scene = scene(gpu, &map, &albedo, method)?;
        let surface = Surface::new(&map, method, Address::Wrap);
        let draw = |scene: &ReliefScene, encoder: &mut wgpu::CommandEncoder| {
            target.record(encoder, [0.0; 3], |pass| scene.draw(pass));
        };
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| draw(&scene, encoder)),
            Contender::recorded(Backend::Limit, |encoder| draw(&plain, encoder)),
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

/// The square, which fills the target.
fn scene(gpu: &Gpu, map: &HeightMap, albedo: &ColorTexture, method: Method) -> Result<ReliefScene, Error> {
    let options = ReliefOptions { method, ..ReliefOptions::default() };
    let textures = textures(gpu, map, method)?;
    let maps = ReliefMaps { textures: &textures, albedo, normals: None };
    let renderer = ReliefRenderer::new(gpu, COLOR_FORMAT, options)?;
    let mesh = SurfaceMesh::square(1.0);
    let mut scene = renderer.scene(gpu, &mesh, maps, &Material::default(), &March::default(), 1.0)?;
    let clip_from_world = Mat4::from_translation(Vec3::Z * 0.5) * Mat4::from_scale(Vec3::new(2.0, 2.0, 1.0));
    let [x, y, z] = towards();
    scene.set_camera(gpu, ReliefCamera { clip_from_world, eye: Vec4::new(x, -y, z, 0.0) })?;
    Ok(scene)
}

/// The unit vector towards the eye, tangent space.
fn towards() -> [f32; 3] {
    let (sine, cosine) = ANGLE.to_radians().sin_cos();
    [0.0, sine, cosine]
}
