//! A scene under a sun: ground, characters, boxes, and a wall with relief, and the same triangles on the host.

use glam::{DVec3, Vec3};
use image::RgbaImage;
use relievo::asset::Light;
use relievo::asset::material::Alpha;
use relievo::gpu::Gpu;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::render::{Layer, Renderer, SunShadow, TargetFormat};
use relievo::scene::{InstanceId, Placement, Relief, Scene, View};
use relievo::wgpu;
use relievo_samples::maps::BuiltInMap;

use super::occluders::Occluders;
use crate::frame::Frame;
use crate::host;
use crate::raw::Raw;
use crate::rays::{cube, matrix, model, plain};
use crate::solids::solid;
use crate::world::{self, SIZE, World};

pub const SUN: Vec3 = Vec3::new(-0.5, 0.7, 0.4);

/// Units ahead of the eye that lie in shadow.
pub const RANGE: f32 = 45.0;

pub struct Stage {
    pub world: World,
    pub view: View,
    pub shadow: SunShadow,
    /// Boxes and tetrahedra; the first is outside of the eye's view.
    pub solids: Vec<(InstanceId, Placement, bool)>,
    pub wall: (InstanceId, Placement),
}

impl Stage {
    pub fn new(gpu: &Gpu, size: u32) -> Self {
        let mut world = World::new(gpu, 6);
        let light = Light { direction: SUN, ..Light::default() };
        world.scene.set_light(light).expect("a light");
        let mirrored = world.placement(1);
        let mirrored = Placement { scale: Vec3::new(-3.0, 3.0, 3.0), ..mirrored };
        world.scene.move_to(world.crowd[1], mirrored).expect("there");
        let (boxes, others) = models();
        let boxes = world.scene.add_mesh(&boxes, 4).expect("added");
        let others = world.scene.add_mesh(&others, 2).expect("added");
        let towards = SUN.normalize();
        let at = |place: Vec3| Placement::at(place);
        let solids = [
            (at(Vec3::new(1.0, 0.0, -5.0) + 25.0 * towards).turned(0.4).scaled(3.0), false),
            (at(Vec3::new(4.0, 5.0, 0.0)).turned(0.7).scaled(1.2), false),
            // In the light of the wall, and of the second box.
            (at(Vec3::new(-6.0, 6.5, -4.0) + 5.0 * towards).scaled(0.9), true),
            (
                Placement {
                    scale: Vec3::new(-0.9, 0.8, 0.7),
                    ..at(Vec3::new(4.0, 5.6, 0.3) + 4.0 * towards)
                },
                true,
            ),
        ];
        let solids = solids.map(|(place, is_other)| {
            let object = if is_other { others } else { boxes };
            (world.scene.spawn(object, place).expect("room"), place, is_other)
        });
        let map = BuiltInMap::Cobbles;
        let heights = map.height_map(64).expect("a map");
        let relief = Relief::wall(3.0, heights, map.albedo(64).expect("colours"));
        let walls = world.scene.add_relief(&relief, 1).expect("added");
        let place = at(Vec3::new(-6.0, 6.0, -4.0)).turned(0.2).scaled(6.0);
        let wall = (world.scene.spawn(walls, place).expect("room"), place);
        // Full detail, so that what is drawn are the model's own triangles.
        let view = world.view(0.0);
        let shadow = SunShadow::new(&mut world.scene, size).expect("a shadow");
        Self { world, view, shadow, solids: solids.to_vec(), wall }
    }

    /// The triangles of what casts.
    pub fn occluders(&self, casts: impl Fn(InstanceId) -> bool) -> Occluders {
        let mut occluders = Occluders::new(SUN.as_dvec3());
        self.add_casters(&mut occluders, casts);
        occluders
    }

    /// Adds the triangles of the ground and of what casts.
    pub fn add_casters(&self, occluders: &mut Occluders, casts: impl Fn(InstanceId) -> bool) {
        self.add_ground(occluders);
        let model = world::model();
        for instance in self.world.crowd.iter().filter(|instance| casts(**instance)) {
            for corners in host::triangles(&self.world.scene, &model, *instance) {
                occluders.add(corners, numbers(*instance));
            }
        }
        let (boxes, others) = models();
        for (instance, place, is_other) in self.solids.iter().filter(|(instance, ..)| casts(*instance)) {
            let model = if *is_other { &others } else { &boxes };
            occluders.add_model(model, matrix(place), numbers(*instance));
        }
        let (instance, place) = &self.wall;
        if casts(*instance) {
            let corner = |x, y| matrix(place).transform_point3(DVec3::new(x, y, 0.0));
            let [a, b, c, d] = [corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)];
            occluders.add([a, b, c], numbers(*instance));
            occluders.add([a, c, d], numbers(*instance));
        }
    }

    /// The triangles of the nine patches.
    fn add_ground(&self, occluders: &mut Occluders) {
        let config = TerrainConfig::new(33, 6.0, "embed").expect("valid");
        let step = config.terrain_scale;
        let place = |x: i32, z: i32| {
            let [x, z] = [x, z].map(|at| f64::from(at) * step);
            let ground = self.world.scene.ground(self.world.land, x, z).expect("terrain").expect("inside");
            DVec3::new(x, ground.height, z)
        };
        for x in -32..63 {
            for z in -32..63 {
                let [north, south, north_east, south_east] =
                    [place(x, z), place(x, z + 1), place(x + 1, z), place(x + 1, z + 1)];
                occluders.add([north, south, north_east], [self.world.land.number(), 0]);
                occluders.add([north_east, south, south_east], [self.world.land.number(), 0]);
            }
        }
    }

    /// What a shading returns for every pixel, in f32.
    pub fn values(&mut self, gpu: &Gpu, expression: &str) -> Vec<[f32; 4]> {
        values(gpu, (&mut self.world.scene, &mut self.view, &mut self.shadow), expression)
    }

    /// The picture in the crate's own shading, or in one of the caller's.
    pub fn shot(&mut self, gpu: &Gpu, shading: Option<&str>) -> RgbaImage {
        let frame = Frame::plain(gpu, SIZE);
        let renderer = Renderer::new(gpu, &frame.format).expect("a format");
        let mut renderer = match shading {
            Some(source) => renderer.with_shading(source, None).expect("valid"),
            None => renderer,
        };
        renderer.prepare(&self.world.scene).expect("compiled");
        self.shadow.fit(&self.world.scene, &mut [&mut self.view], RANGE).expect("fitted");
        self.draw(gpu, &frame, &renderer);
        frame.read(gpu)
    }

    /// Draws a frame with the shadow as it was fitted.
    pub fn draw(&mut self, gpu: &Gpu, frame: &Frame, renderer: &Renderer) {
        let Self { world, view, shadow, .. } = self;
        let mut encoder = gpu.encoder("frame");
        world.scene.record(&mut encoder, &mut [view, shadow.view()]).expect("recorded");
        shadow.draw(&mut encoder, &world.scene).expect("drawn");
        frame.pass(&mut encoder, |pass| {
            renderer.draw(pass, &world.scene, view, Layer::Color).expect("drawn");
        });
        gpu.queue().submit([encoder.finish()]);
    }
}

/// What a shading returns for every pixel of a view in shadow, in f32.
pub fn values(
    gpu: &Gpu,
    (scene, view, shadow): (&mut Scene, &mut View, &mut SunShadow),
    expression: &str,
) -> Vec<[f32; 4]> {
    let raw = Raw::new(gpu, TargetFormat::new(wgpu::TextureFormat::Rgba32Float), SIZE);
    let source = format!("fn shade(surface: Surface, view: View) -> vec4<f32> {{ return {expression}; }}");
    let renderer = Renderer::new(gpu, &raw.format).expect("a format");
    let mut renderer = renderer.with_shading(&source, None).expect("valid");
    renderer.prepare(scene).expect("compiled");
    shadow.fit(scene, &mut [&mut *view], RANGE).expect("fitted");
    let mut encoder = gpu.encoder("frame");
    scene.record(&mut encoder, &mut [view, shadow.view()]).expect("recorded");
    shadow.draw(&mut encoder, scene).expect("drawn");
    raw.pass(&mut encoder, |pass| {
        renderer.draw(pass, scene, view, Layer::Color).expect("drawn");
    });
    gpu.queue().submit([encoder.finish()]);
    raw.floats(gpu, 0)
}

/// A box and a tetrahedron.
pub fn models() -> (relievo::asset::Model, relievo::asset::Model) {
    (model(&cube(), plain([0.5, 0.6, 0.9, 1.0], Alpha::Opaque), false), solid(false, false))
}

/// The numbers of object and instance, as shading has them.
pub fn numbers(instance: InstanceId) -> [u32; 2] {
    [instance.object().number(), instance.number()]
}
