//! The layer of transparent surfaces, against blends that are computed by hand.

use glam::Vec3;
use relievo::asset::material::Alpha;
use relievo::asset::{Light, Model};
use relievo::gpu::Gpu;
use relievo::render::{Layer, Renderer, TargetFormat};
use relievo::scene::{Camera, ObjectId, Placement, Quality, Scene, View};
use relievo::wgpu;

use crate::frame::device;
use crate::raw::Raw;
use crate::rays::{model, plain};

const SIZE: [u32; 2] = [64, 48];

/// What targets are cleared to.
const SKY: [f32; 3] = [0.25, 0.5, 0.75];

/// Two panes: their colours, and alpha.
const RED: [f32; 4] = [1.0, 0.0, 0.25, 0.5];
const BLUE: [f32; 4] = [0.0, 0.25, 1.0, 0.25];

/// A square of two units, seen from both sides.
fn pane(color: [f32; 4], alpha: Alpha) -> Model {
    let [a, b, c, d] = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    model(&[[a, b, c], [a, c, d]], plain(color, alpha), true)
}

/// A scene whose light shows every colour as it is.
fn scene(gpu: &Gpu) -> (Scene, View) {
    let mut scene = Scene::new(gpu).expect("compiled");
    scene.set_light(Light { ambient: 1.0, ..Light::default() }).expect("a light");
    let view = scene.view(Quality::default()).expect("a view");
    (scene, view)
}

fn camera(z: f32) -> Camera {
    Camera::looking_at(Vec3::new(0.0, 0.0, z), Vec3::new(0.0, 0.0, -0.5), 0.5, [0.5, 40.0], SIZE)
}

/// A target of linear colours.
fn target(gpu: &Gpu) -> Raw {
    let mut raw = Raw::new(gpu, TargetFormat::new(wgpu::TextureFormat::Rgba16Float), SIZE);
    let [r, g, b] = SKY.map(f64::from);
    raw.clear = wgpu::Color { r, g, b, a: 1.0 };
    raw
}

/// The colour in the middle of the picture of these layers.
fn middle(raw: &Raw, scene: &mut Scene, view: &mut View, renderer: &Renderer, layers: &[Layer]) -> [f32; 3] {
    raw.frame(scene, view, renderer, layers);
    let [r, g, b, _] = raw.floats(scene.gpu(), 0)[(SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2) as usize];
    [r, g, b]
}

/// `color` before `behind`.
fn over(color: [f32; 4], behind: [f32; 3]) -> [f32; 3] {
    let alpha = color[3];
    [0, 1, 2].map(|at| alpha * color[at] + (1.0 - alpha) * behind[at])
}

/// Half floats are rounded twice, and tints have 8 bits a channel.
fn near(a: [f32; 3], b: [f32; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.004)
}

/// Panes of two objects and of one, added and spawned in either order, seen from either side.
#[test]
fn panes_are_blended_from_back_to_front() {
    let gpu = device();
    let raw = target(&gpu);
    assert!(!near(over(RED, over(BLUE, SKY)), over(BLUE, over(RED, SKY))), "an order cannot be told");
    for is_swapped in [false, true] {
        for one_object in [false, true] {
            let (mut scene, mut view) = scene(&gpu);
            let [first, second] = if is_swapped { [BLUE, RED] } else { [RED, BLUE] };
            let objects: Vec<ObjectId> = if one_object {
                // The tint makes them differ.
                let white = pane([1.0; 4], Alpha::Blended);
                vec![scene.add_mesh(&white, 2).expect("added"); 2]
            } else {
                let add = |color| scene.add_mesh(&pane(color, Alpha::Blended), 1).expect("added");
                [first, second].map(add).to_vec()
            };
            for (object, color) in objects.into_iter().zip([first, second]) {
                let z = if color == RED { 0.0 } else { -1.0 };
                // The second is mirrored, which changes nothing.
                let scale = Vec3::new(if color == second { -1.0 } else { 1.0 }, 1.0, 1.0);
                let place = Placement { scale, ..Placement::at([0.0, 0.0, z]) };
                let instance = scene.spawn(object, place).expect("room");
                if one_object {
                    scene.set_tint(instance, color).expect("in range");
                }
            }
            let renderer = raw.renderer(&gpu, &scene);
            let layers = [Layer::Depth, Layer::Color, Layer::Transparent];
            view.set(camera(6.0)).expect("a camera");
            let found = middle(&raw, &mut scene, &mut view, &renderer, &layers);
            let expected = over(RED, over(BLUE, SKY));
            assert!(near(found, expected), "{found:?}, not {expected:?}");
            view.set(camera(-7.0)).expect("a camera");
            let found = middle(&raw, &mut scene, &mut view, &renderer, &layers);
            let expected = over(BLUE, over(RED, SKY));
            assert!(near(found, expected), "from behind {found:?}, not {expected:?}");
            // In no other layer there is anything.
            let found = middle(&raw, &mut scene, &mut view, &renderer, &layers[..2]);
            assert_eq!(found, SKY);
        }
    }
}

/// Opaque surfaces hide what is behind them, and are seen through what is before them; dithered ones stay as they are.
#[test]
fn panes_are_tested_against_depth() {
    let gpu = device();
    let raw = target(&gpu);
    let (mut scene, mut view) = scene(&gpu);
    let wall = [0.5, 0.75, 0.25, 1.0];
    let panes = [(RED, Alpha::Blended, 0.0), (wall, Alpha::Opaque, -1.0), (BLUE, Alpha::Blended, -2.0)];
    for (color, alpha, z) in panes {
        let object = scene.add_mesh(&pane(color, alpha), 1).expect("added");
        scene.spawn(object, Placement::at([0.0, 0.0, z])).expect("room");
    }
    let renderer = raw.renderer(&gpu, &scene);
    view.set(camera(6.0)).expect("a camera");
    let layers = [Layer::Color, Layer::Transparent];
    let found = middle(&raw, &mut scene, &mut view, &renderer, &layers);
    let expected = over(RED, [0.5, 0.75, 0.25]);
    assert!(near(found, expected), "{found:?}, not {expected:?}");
    // Panes write no depth: what is drawn behind them afterwards is there.
    let found = middle(&raw, &mut scene, &mut view, &renderer, &[Layer::Transparent, Layer::Color]);
    assert!(near(found, [0.5, 0.75, 0.25]), "{found:?}");
    let mut dithered = pane(RED, Alpha::Dithered);
    let object = scene.add_mesh(&dithered, 1).expect("added");
    dithered.blend();
    assert_eq!(dithered.materials[0].alpha, Alpha::Blended);
    let instance = scene.spawn(object, Placement::at([0.0, 0.0, 1.0])).expect("room");
    let mut renderer = renderer;
    renderer.prepare(&scene).expect("compiled");
    raw.frame(&mut scene, &mut view, &renderer, &[Layer::Color]);
    let pixels = raw.floats(&gpu, 0);
    let red = pixels.iter().filter(|pixel| near([pixel[0], pixel[1], pixel[2]], [1.0, 0.0, 0.25])).count();
    assert!(red > 100, "{red} pixels of the pattern");
    scene.despawn(instance).expect("there");
}

/// Characters of which a view sees some are blended too, at their levels of detail, and hidden ones are not.
#[test]
fn transparent_characters_are_drawn_as_opaque_ones() {
    let gpu = device();
    let raw = target(&gpu);
    let count = |is_blended: bool, hidden: bool| {
        let (mut scene, mut view) = scene(&gpu);
        let mut creature = crate::world::model();
        creature.materials = vec![plain([0.5, 1.0, 0.0, 1.0], Alpha::Opaque)];
        if is_blended {
            creature.materials[0].alpha = Alpha::Blended;
        }
        creature.meshes.iter_mut().for_each(|mesh| mesh.material = Some(0));
        let object = scene.add_character(&creature, 70).expect("added");
        for at in 0..70 {
            let place = Placement::at([(at % 10) as f32 * 4.0 - 18.0, -2.0, -10.0 - 3.0 * (at / 10) as f32]);
            scene.spawn(object, place).expect("room");
        }
        scene.set_visible(object, !hidden).expect("there");
        scene.advance(0.5).expect("finite");
        view.set(camera(6.0)).expect("a camera");
        let renderer = raw.renderer(&gpu, &scene);
        raw.frame(&mut scene, &mut view, &renderer, &[Layer::Color, Layer::Transparent]);
        let pixels = raw.floats(&gpu, 0);
        pixels.iter().map(|pixel| near([pixel[0], pixel[1], pixel[2]], [0.5, 1.0, 0.0])).collect::<Vec<_>>()
    };
    let (opaque, blended) = (count(false, false), count(true, false));
    let covered = opaque.iter().filter(|is_covered| **is_covered).count();
    assert!(covered > 100, "{covered} pixels");
    // With an alpha of 1 the nearest hides the others, whatever the order.
    assert!(opaque == blended, "another silhouette");
    assert!(count(true, true).iter().all(|is_covered| !is_covered), "hidden ones are drawn");
}

/// A colour that cannot be blended, and depth alone, hold no such layer.
#[test]
fn only_colors_that_can_be_blended_hold_the_layer() {
    let gpu = device();
    let (mut scene, mut view) = scene(&gpu);
    scene.add_mesh(&pane(RED, Alpha::Blended), 1).expect("added");
    view.set(camera(6.0)).expect("a camera");
    for format in [
        TargetFormat::new(wgpu::TextureFormat::Rgba32Float),
        TargetFormat::depth_only(wgpu::TextureFormat::Depth32Float),
        TargetFormat::surface(),
    ] {
        let raw = Raw::new(&gpu, format, SIZE);
        let renderer = raw.renderer(&gpu, &scene);
        let mut encoder = gpu.encoder("refused");
        scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
        let mut refused = None;
        raw.pass(&mut encoder, |pass| {
            refused = renderer.draw(pass, &scene, &view, Layer::Transparent).err();
        });
        assert_eq!(refused.expect("refused").path, "layer");
        gpu.queue().submit([encoder.finish()]);
    }
}
