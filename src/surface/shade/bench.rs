//! Benchmark cases of `surface/shade`: self-shadow and depth of lists of points, against the same number of
//! bare texel loads.

use crate::Error;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::samples::BuiltInMap;
use crate::surface::bench::{bare_loads, rays};
use crate::surface::map::Address;
use crate::surface::material::Material;
use crate::surface::relief::reference::Surface;
use crate::surface::relief::reference::height::BILINEAR;
use crate::surface::relief::reference::shadow::light_ray;
use crate::surface::relief::textures::SurfaceTextures;
use crate::surface::relief::{March, Method};
use crate::surface::shade::reference::shade_all;
use crate::surface::shade::{Shade, ShadePass, ShadePoint, ShadeView};

/// Points along each edge.
const EDGE: u32 = 512;

/// Measures 512² points on cobbles of 512² texels, seen straight from above under the default light, with hard
/// shadows by `quadtree` and by `relief`. `copy` makes as many texel loads per point as both shadows together,
/// and nothing else.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let map = BuiltInMap::Cobbles.height_map(512)?;
    let (march, view) = (March::default(), ShadeView::default());
    for method in [Method::Quadtree, Method::Relief] {
        let surface = Surface::new(&map, method, Address::Wrap);
        let points = points(&surface, method, &march);
        let hard: u64 = points
            .iter()
            .map(|point| light_ray(&point.hit, point.light, point.scale))
            .map(|ray| u64::from(surface.trace(method, &ray, &march).samples))
            .sum();
        let samples = hard + points.len() as u64 * u64::from(BILINEAR * (view.shadow_steps + 1));
        let mean = samples as f64 / points.len() as f64;
        let textures = SurfaceTextures::new(gpu, &map, method, Address::Wrap)?;
        let input = Buffer::from_slice(gpu, "points", &points)?;
        let shades = Buffer::new(gpu, "shades", points.len())?;
        let job = ShadePass::new(gpu, method)?.prepare(gpu, &textures, &march, &view, &input, &shades)?;
        let bare = bare_loads(gpu, &textures, EDGE, samples)?;
        let contenders = vec![
            Contender::job(Backend::Gpu, &job),
            Contender::job(Backend::Copy, &bare),
            Contender::host(Backend::ReferenceParallel, || {
                drop(std::hint::black_box(shade_all(&surface, method, &march, &view, &points)));
            }),
        ];
        let bytes = 4 * samples + (points.len() * (size_of::<ShadePoint>() + size_of::<Shade>())) as u64;
        let case = format!("{}, {mean:.1} loads a point", method.name());
        bench.case(case, (points.len(), "point"), bytes, contenders)?;
    }
    Ok(())
}

/// One point per texel.
fn points(surface: &Surface<'_>, method: Method, march: &March) -> Vec<ShadePoint> {
    let material = Material::default();
    let rays = rays(EDGE, [0.0, 0.0, 1.0]);
    let hits = surface.trace_all(method, &rays, march);
    let points = rays.into_iter().zip(hits).map(|(ray, hit)| ShadePoint {
        light: material.light,
        scale: material.scale,
        position: [ray.origin[0], ray.origin[1], 0.0],
        world: 1.0,
        ray,
        hit,
    });
    points.collect()
}
