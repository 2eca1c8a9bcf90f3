//! Shadows of and on panes: of textures with holes, on blended surfaces, and of what is drawn in pieces and chunks.

use glam::Vec3;
use image::{Rgba, RgbaImage};
use relievo::asset::material::{Alpha, Sampling, Texture};
use relievo::asset::{Light, Material, Model};
use relievo::gpu::Gpu;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::render::{Layer, Renderer, SunShadow, TargetFormat};
use relievo::scene::{Camera, Placement, Quality, Scene, TerrainSource, View};
use relievo::wgpu;

use super::stage::{SUN, numbers, values};
use super::{NORMALS, PLACES, texel};
use crate::frame::{Frame, device};
use crate::harness::{Difference, gpu_of_bindings};
use crate::pieces::cloth;
use crate::raw::Raw;
use crate::rays::{model, plain};
use crate::world::SIZE;

/// A square of two units across z, seen from both sides, whose texture coordinates go from 0 to 1 and down.
fn pane(material: Material) -> Model {
    let [a, b, c, d] = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let mut pane = model(&[[a, b, c], [a, c, d]], material, true);
    for mesh in &mut pane.meshes {
        mesh.uv = mesh.positions.iter().map(|[x, y, _]| [0.5 + 0.5 * x, 0.5 - 0.5 * y]).collect();
    }
    pane
}

fn scene_of(gpu: &Gpu, light: Light) -> Scene {
    let mut scene = Scene::new(gpu).expect("compiled");
    scene.set_light(light).expect("a light");
    scene
}

fn view_of(scene: &Scene, eye: Vec3) -> View {
    let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
    view.set(Camera::looking_at(eye, Vec3::ZERO, 0.7, [0.5, 60.0], SIZE)).expect("a camera");
    view
}

/// The columns and rows of squares in the texture with holes.
const SQUARES: u32 = 4;

/// Whether a square of the texture is a hole: none of the patterns that turning or mirroring makes of it is the same.
fn is_hole(column: u32, row: u32) -> bool {
    [0b0110, 0b1000, 0b0010, 0b0101][row as usize] >> column & 1 == 1
}

/// A pane with holes in front of a wall.
fn pierced() -> Model {
    let image = RgbaImage::from_fn(16 * SQUARES, 16 * SQUARES, |x, y| {
        Rgba([200, 150, 90, if is_hole(x / 16, y / 16) { 0 } else { 255 }])
    });
    let texture = Some(Texture { image: 0, sampling: Sampling { mips: None, ..Sampling::default() } });
    let mut pierced = pane(Material { texture, ..plain([1.0; 4], Alpha::Mask(0.5)) });
    pierced.images = vec![image.into()];
    pierced
}

/// Light falls through the holes of a texture that is cut out, and nowhere else.
#[test]
fn light_falls_through_holes() {
    let gpu = device();
    let towards = Vec3::new(0.25, 0.35, 1.0);
    let mut scene = scene_of(&gpu, Light { direction: towards, ..Light::default() });
    let wall = scene.add_mesh(&pane(plain([1.0; 4], Alpha::Opaque)), 1).expect("added");
    let wall = scene.spawn(wall, Placement::at([0.0; 3]).scaled(5.0)).expect("room");
    let screen = scene.add_mesh(&pierced(), 1).expect("added");
    let (middle, scale) = (Vec3::new(0.2, 0.1, 1.0), Vec3::new(-2.4, 2.2, 1.0));
    let place = Placement { scale, ..Placement::at(middle) };
    scene.spawn(screen, place).expect("room");
    let mut view = view_of(&scene, Vec3::new(9.0, 3.0, 7.0));
    let mut shadow = SunShadow::new(&mut scene, 4096).expect("a shadow");
    let [places, normals] =
        [PLACES, NORMALS].map(|shown| values(&gpu, (&mut scene, &mut view, &mut shadow), shown));
    let reach = 2.0 * 8.0_f64.sqrt() * texel(&shadow);
    let check = |holes: fn(u32, u32) -> bool| {
        let (mut lit, mut dark, mut wrong) = (0, 0, 0);
        for (place, normal) in places.iter().zip(&normals) {
            let [object, instance] = numbers(wall);
            if normal[3] as u32 != 256 * object + instance {
                continue;
            }
            let at = Vec3::from_slice(place).as_dvec3();
            // Where the ray to the light meets the pane, and that in squares of its texture from its upper left corner.
            let met = at + towards.as_dvec3() * (1.0 - at.z) / f64::from(towards.z);
            let across = (met - middle.as_dvec3()) / scale.as_dvec3();
            let squares = [0.5 + 0.5 * across.x, 0.5 - 0.5 * across.y].map(|uv| uv * f64::from(SQUARES));
            // A texel of the image is 1/16 of a square, and filtered.
            let near = reach / f64::from(2.0 * scale.y) * f64::from(SQUARES) + 1.0 / 16.0;
            if squares.iter().any(|at| (at - at.round()).abs() < near) {
                continue;
            }
            let is_inside = squares.iter().all(|at| (0.0..f64::from(SQUARES)).contains(at));
            let is_dark = is_inside && !holes(squares[0] as u32, squares[1] as u32);
            *(if is_dark { &mut dark } else { &mut lit }) += 1;
            wrong += usize::from(if is_dark { place[3] > 0.01 } else { place[3] < 0.99 });
        }
        (lit, dark, wrong)
    };
    let (lit, dark, wrong) = check(is_hole);
    println!("{wrong} wrong of {lit} lit and {dark} dark");
    assert!(lit > 300 && dark > 200 && wrong == 0, "{wrong} wrong of {lit} lit and {dark} dark");
    for other in [|_, _| false, |column, row| is_hole(SQUARES - 1 - column, row)] {
        let (.., wrong) = check(other);
        assert!(wrong > 50, "{wrong}: another pattern is not told from it");
    }
}

/// Half of a blended pane lies in shadow: what it adds of its own light is missing there, and what is behind it is not.
#[test]
fn blended_surfaces_lie_in_shadow() {
    let gpu = device();
    let light = Light { direction: Vec3::Z, ambient: 0.0, ..Light::default() };
    let mut scene = scene_of(&gpu, light);
    let color = [0.5, 0.25, 1.0, 0.75];
    let glass = scene.add_mesh(&pane(plain(color, Alpha::Blended)), 1).expect("added");
    scene.spawn(glass, Placement::at([0.0; 3]).scaled(2.0)).expect("room");
    let screen = scene.add_mesh(&pane(plain([1.0; 4], Alpha::Opaque)), 1).expect("added");
    // It shades what is east of the middle, and is behind the eye.
    scene.spawn(screen, Placement::at([3.0, 0.0, 12.0]).scaled(3.0)).expect("room");
    let mut view = view_of(&scene, Vec3::new(0.0, 0.0, 7.0));
    let mut shadow = SunShadow::new(&mut scene, 512).expect("a shadow");
    let mut raw = Raw::new(&gpu, TargetFormat::new(wgpu::TextureFormat::Rgba16Float), SIZE);
    let sky = [0.125, 0.5, 0.25];
    raw.clear = wgpu::Color { r: sky[0], g: sky[1], b: sky[2], a: 1.0 };
    let renderer = raw.renderer(&gpu, &scene);
    shadow.fit(&scene, &mut [&mut view], 30.0).expect("fitted");
    let mut encoder = gpu.encoder("frame");
    scene.record(&mut encoder, &mut [&mut view, shadow.view()]).expect("recorded");
    shadow.draw(&mut encoder, &scene).expect("drawn");
    raw.pass(&mut encoder, |pass| {
        renderer.draw(pass, &scene, &view, Layer::Transparent).expect("drawn");
    });
    gpu.queue().submit([encoder.finish()]);
    let found = raw.floats(&gpu, 0);
    let alpha = f64::from(color[3]);
    let [width, height] = SIZE.map(|edge| edge as usize);
    for (x, own) in [(width / 2 - 20, alpha), (width / 2 + 20, 0.0)] {
        let pixel = found[height / 2 * width + x];
        let expected = [0, 1, 2].map(|at| own * f64::from(color[at]) + (1.0 - alpha) * sky[at]);
        let off = (0..3).map(|at| (f64::from(pixel[at]) - expected[at]).abs()).fold(0.0, f64::max);
        assert!(off < 0.004, "at {x}: {pixel:?}, not {expected:?}");
    }
}

/// Meshes in pieces and terrain in chunks cast and receive the shadows that they do whole.
#[test]
fn pieces_and_chunks_cast_what_the_whole_does() {
    let cloth = cloth();
    let patches: Vec<[i32; 2]> = (0..196).map(|at| [at % 14 - 7, at / 14 - 7]).collect();
    let draw = |gpu: &Gpu, is_shadowed: bool| {
        let mut scene = scene_of(gpu, Light { direction: SUN, ..Light::default() });
        let object = scene.add_mesh(&cloth, 2).expect("added");
        for (at, turn) in [([0.0, 9.0, 0.0], 0.4), ([2.0, 12.0, -3.0], 1.4)] {
            scene.spawn(object, Placement::at(at).turned(turn)).expect("room");
        }
        let config = TerrainConfig::new(65, 12.0, "chunks").expect("valid");
        let land = scene.add_terrain(&TerrainSource::new(config).with_patches(&patches)).expect("generated");
        let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
        let camera =
            Camera::looking_at(Vec3::new(6.0, 22.0, 24.0), Vec3::new(0.0, 5.0, 0.0), 0.8, [0.3, 400.0], SIZE);
        view.set(camera).expect("a camera");
        let mut shadow = is_shadowed.then(|| SunShadow::new(&mut scene, 1024).expect("a shadow"));
        let frame = Frame::plain(gpu, SIZE);
        let renderer: Renderer = frame.renderer(gpu, &scene);
        if let Some(shadow) = &mut shadow {
            shadow.fit(&scene, &mut [&mut view], 60.0).expect("fitted");
        }
        let mut encoder = gpu.encoder("frame");
        match &mut shadow {
            Some(shadow) => {
                scene.record(&mut encoder, &mut [&mut view, shadow.view()]).expect("recorded");
                shadow.draw(&mut encoder, &scene).expect("drawn");
            }
            None => scene.record(&mut encoder, &mut [&mut view]).expect("recorded"),
        }
        frame.pass(&mut encoder, |pass| {
            renderer.draw(pass, &scene, &view, Layer::Color).expect("drawn");
        });
        gpu.queue().submit([encoder.finish()]);
        let draws = [object, land].map(|object| scene.draws(object).expect("there"));
        (frame.read(gpu), draws)
    };
    let large = device();
    let (divided, pieces) = draw(&gpu_of_bindings(3 << 20), true);
    let (whole, draws) = draw(&large, true);
    assert!(pieces[0] > draws[0] && pieces[1] > draws[1], "{pieces:?} draws, {draws:?}");
    let difference = Difference::of(&divided, &whole, 0);
    assert!(difference.outliers < 0.001, "{difference:?}");
    let difference = Difference::of(&draw(&large, false).0, &whole, 0);
    assert!(difference.outliers > 0.02, "a shadow makes no difference: {difference:?}");
}
