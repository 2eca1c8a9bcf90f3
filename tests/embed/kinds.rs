//! The same tests for every kind of object: the library's own, and one of the caller's (`examples/kind/grass.rs`). What a kind
//! draws is compared with triangles on the host: places, numbers, motion, shadow, rays.

#[path = "../../examples/kind/grass.rs"]
mod grass;
mod mistakes;

use glam::{DVec3, Vec3};
use relievo::asset::Light;
use relievo::asset::material::Alpha;
use relievo::gpu::Gpu;
use relievo::ops::surface::map::HeightMap;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::render::{Layer, OutputProgram, Renderer, SunShadow, TargetFormat};
use relievo::scene::{
    Camera, InstanceId, ObjectId, Placement, Quality, Ray, Relief, Scene, TerrainSource, View,
};

use crate::frame::{Frame, device, devices};
use crate::harness::is_coarse;
use crate::host;
use crate::raw::Raw;
use crate::rays::{Triangle, cube, matrix, model, picture, plain, shown};
use crate::shadow::occluders::{Occluders, Verdict};
use grass::Grass;

const SIZE: [u32; 2] = [96, 64];

/// An object of a kind.
struct Sample {
    name: &'static str,
    add: fn(&Gpu, &mut Scene) -> ObjectId,
    /// The scale of its instances, and how high above the ground they stand; 0 for what is not spawned.
    scale: f32,
    /// The triangles of an instance in the world, as it stands now.
    triangles: fn(&Scene, InstanceId) -> Vec<[DVec3; 3]>,
    double_sided: bool,
}

const SAMPLES: [Sample; 5] = [
    Sample {
        name: "mesh",
        add: |_, scene| {
            scene.add_mesh(&model(&cube(), plain([1.0; 4], Alpha::Opaque), false), 4).expect("added")
        },
        scale: 0.8,
        triangles: |scene, instance| in_world(scene, instance, &cube()),
        double_sided: false,
    },
    Sample {
        name: "character",
        add: |_, scene| scene.add_character(&crate::world::model(), 4).expect("added"),
        scale: 1.0,
        triangles: |scene, instance| host::triangles(scene, &crate::world::model(), instance),
        double_sided: false,
    },
    Sample {
        name: "relief",
        add: |_, scene| scene.add_relief(&level(), 4).expect("added"),
        scale: 3.0,
        triangles: |scene, instance| in_world(scene, instance, &square()),
        double_sided: false,
    },
    Sample {
        name: "terrain",
        add: |_, scene| {
            let patches = [[0, 0], [-1, 0], [0, -1], [-1, -1]];
            scene.add_terrain(&TerrainSource::new(land()).with_patches(&patches)).expect("generated")
        },
        scale: 0.0,
        triangles: ground,
        double_sided: true,
    },
    Sample {
        name: "grass",
        add: |gpu, scene| scene.add_kind(Grass::new(gpu, BLADES).expect("valid"), 4).expect("added"),
        scale: 5.0,
        triangles: blades,
        double_sided: true,
    },
];

/// A square whose relief is nowhere deep.
fn level() -> Relief {
    let heights = HeightMap::new(8, 8, vec![1.0; 64]).expect("a map");
    Relief::wall(1.0, heights, image::RgbaImage::from_pixel(4, 4, image::Rgba([255; 4])))
}

fn square() -> Vec<[[f32; 3]; 3]> {
    let [a, b, c, d] = [[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]];
    vec![[a, b, c], [a, c, d]]
}

fn land() -> TerrainConfig {
    TerrainConfig::new(17, 2.0, "kinds").expect("valid")
}

fn in_world(scene: &Scene, instance: InstanceId, corners: &[[[f32; 3]; 3]]) -> Vec<[DVec3; 3]> {
    let into = matrix(&scene.placement(instance).expect("there"));
    let place = |corner: [f32; 3]| into.transform_point3(Vec3::from(corner).as_dvec3());
    corners.iter().map(|corners| corners.map(place)).collect()
}

/// The triangles of a patch, which lies around its placement.
fn ground(scene: &Scene, patch: InstanceId) -> Vec<[DVec3; 3]> {
    let (config, middle) = (land(), scene.placement(patch).expect("there").world());
    let (cells, step) = (16, config.terrain_scale);
    let corner = [middle.x, middle.z].map(|at| at - 8.0 * step);
    let place = |x: i32, z: i32| {
        let [x, z] = [corner[0] + f64::from(x) * step, corner[1] + f64::from(z) * step];
        let height = scene.ground(patch.object(), x, z).expect("terrain").map_or(0.0, |point| point.height);
        DVec3::new(x, height, z)
    };
    let cell = |(x, z)| {
        let [north, south, east, corner] =
            [place(x, z), place(x, z + 1), place(x + 1, z), place(x + 1, z + 1)];
        [[north, south, east], [east, south, corner]]
    };
    (0..cells).flat_map(|z| (0..cells).map(move |x| (x, z))).flat_map(cell).collect()
}

/// Blades of a tuft.
const BLADES: u32 = 9;

/// The triangles of a tuft of grass: the blades of `examples/kind`, written down once more.
fn blades(scene: &Scene, tuft: InstanceId) -> Vec<[DVec3; 3]> {
    let into = host::placed(&scene.placement(tuft).expect("there"));
    let mut all = Vec::new();
    for at in 0..BLADES {
        let at = at as f32;
        let (radius, angle, phase) = (0.45 * (at / BLADES as f32).sqrt(), 2.4 * at, f64::from(1.7 * at));
        let root = [radius * angle.cos(), radius * angle.sin()].map(f64::from);
        let height = f64::from(0.3 + 0.2 * (7.0 * at).sin());
        let lean = (2.0 * scene.time() + phase).sin() * 0.12;
        let place = |side: f64, up: f64| {
            let half = 0.02 * (1.0 - up) * side;
            let [x, z] = [half * phase.cos() + lean * up * up, half * phase.sin() + 0.4 * lean * up * up];
            into.transform_point3(DVec3::new(root[0] + x, height * up, root[1] + z))
        };
        let [a, b, c, d, tip] =
            [place(-1.0, 0.0), place(1.0, 0.0), place(-1.0, 0.5), place(1.0, 0.5), place(-1.0, 1.0)];
        all.extend([[a, b, c], [c, b, d], [c, d, tip]]);
    }
    all
}

/// A scene of one kind: three instances, of which one is mirrored, or the patches of terrain.
struct World {
    scene: Scene,
    view: View,
    object: ObjectId,
    instances: Vec<InstanceId>,
    sample: &'static Sample,
}

/// The triangles of a world, and whose they are.
struct Scenery {
    triangles: Vec<Triangle>,
    numbers: Vec<u32>,
}

impl World {
    fn new(gpu: &Gpu, sample: &'static Sample) -> Self {
        let mut scene = Scene::new(gpu).expect("compiled");
        scene.keep_motion_history(true).expect("kept");
        let object = (sample.add)(gpu, &mut scene);
        let places = [[-1.6, 0.3, 0.0], [1.5, 0.1, -0.6], [0.2, 0.5, -3.0]];
        for (at, place) in places.iter().enumerate().filter(|_| sample.scale > 0.0) {
            let side = if at == 1 { -1.0 } else { 1.0 };
            let scale = sample.scale * Vec3::new(side, 1.0, 1.1);
            let placement = Placement { scale, ..Placement::at(*place).turned(0.4 + 0.3 * at as f32) };
            scene.spawn(object, placement).expect("room");
        }
        let instances = scene.instances(object).expect("there");
        let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
        view.set(camera()).expect("a camera");
        scene.advance(1.3).expect("finite");
        Self { scene, view, object, instances, sample }
    }

    fn scenery(&self) -> Scenery {
        let (mut triangles, mut numbers) = (Vec::new(), Vec::new());
        for instance in &self.instances {
            let placement = self.scene.placement(*instance).expect("there");
            let is_mirrored = placement.scale.x < 0.0;
            for [a, b, c] in (self.sample.triangles)(&self.scene, *instance) {
                let corners = if is_mirrored { [a, c, b] } else { [a, b, c] };
                // The ground has no edges between its triangles.
                let tag = if self.sample.scale > 0.0 { triangles.len() } else { 0 };
                triangles.push(Triangle { corners, tag, double_sided: self.sample.double_sided });
                numbers.push(instance.number());
            }
        }
        Scenery { triangles, numbers }
    }

    /// Moves the first instance, and everything that moves by itself.
    fn step(&mut self) {
        self.scene.advance(0.15).expect("finite");
        if self.sample.scale > 0.0 {
            let placement = self.scene.placement(self.instances[0]).expect("there").turned(0.06);
            let placement = Placement { offset: placement.offset + Vec3::new(0.1, 0.05, 0.0), ..placement };
            self.scene.move_to(self.instances[0], placement).expect("there");
        }
    }
}

fn camera() -> Camera {
    Camera::looking_at(Vec3::new(1.0, 3.5, 8.0), Vec3::new(0.0, 0.6, 0.0), 0.6, [0.5, 60.0], SIZE)
}

fn moved() -> Camera {
    Camera::looking_at(Vec3::new(0.8, 3.7, 7.8), Vec3::new(0.1, 0.5, 0.0), 0.6, [0.5, 60.0], SIZE)
}

/// Pixels that show something, and of these the ones whose place, numbers or motion are wrong.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Tally {
    seen: usize,
    places: usize,
    numbers: usize,
    motions: usize,
}

/// What the layers of places and of velocities have.
struct Shots {
    places: Vec<[f32; 4]>,
    numbers: Vec<[u32; 2]>,
    motions: Vec<[f32; 4]>,
}

impl Shots {
    /// Compares with rays that are traced on the host.
    fn compared(&self, now: &Scenery, last: &Scenery, cameras: [&Camera; 2], object: u32) -> Tally {
        let mut tally = Tally::default();
        for (at, pixel) in picture(&now.triangles, cameras[0]).into_iter().enumerate() {
            let Ok(hit) = pixel else { continue };
            let Some(hit) = hit else {
                tally.numbers += usize::from(self.numbers[at] != [0; 2]);
                continue;
            };
            tally.seen += 1;
            let [x, y, z, _] = self.places[at].map(f64::from);
            // Flat angles magnify rounding.
            let slack = hit.slack(|place| place.distance(hit.position));
            tally.places += usize::from(DVec3::new(x, y, z).distance(hit.position) > 1e-3 + slack);
            tally.numbers += usize::from(self.numbers[at] != [object, now.numbers[hit.triangle]]);
            let motion = |place: DVec3| {
                let before = carried(&now.triangles[hit.triangle], &last.triangles[hit.triangle], place);
                let [to, from] = [shown(cameras[0], place), shown(cameras[1], before)];
                [to[0] - from[0], to[1] - from[1]]
            };
            let expected = motion(hit.position);
            let off = [0, 1].map(|axis| {
                (f64::from(self.motions[at][axis]) - expected[axis]).abs()
                    - 0.002 * expected[axis].abs()
                    - hit.slack(|place| motion(place)[axis])
            });
            tally.motions += usize::from(off[0].max(off[1]) > 1e-4);
        }
        tally
    }
}

/// Where a point of a triangle lies in another one.
fn carried(now: &Triangle, last: &Triangle, point: DVec3) -> DVec3 {
    let [a, b, c] = now.corners;
    let (u, v) = (b - a, c - a);
    let normal = u.cross(v);
    let area = normal.length_squared();
    let weights = [(point - a).cross(v).dot(normal) / area, u.cross(point - a).dot(normal) / area];
    let [a, b, c] = last.corners;
    a + weights[0] * (b - a) + weights[1] * (c - a)
}

/// Places, numbers and motion, while instances, cameras and what moves by itself move.
#[test]
fn places_numbers_and_motion_are_those_of_rays() {
    let gpu = device();
    let (measure, velocity) = (TargetFormat::measure(), TargetFormat::velocity());
    let [measure, velocity] = [measure, velocity].map(|format| Raw::new(&gpu, format, SIZE));
    for sample in &SAMPLES {
        let mut world = World::new(&gpu, sample);
        let renderers = [&measure, &velocity].map(|raw| raw.renderer(&gpu, &world.scene));
        let mut encoder = gpu.encoder("before");
        world.scene.record(&mut encoder, &mut [&mut world.view]).expect("recorded");
        gpu.queue().submit([encoder.finish()]);
        let last = world.scenery();
        world.step();
        world.view.set(moved()).expect("a camera");
        let mut encoder = gpu.encoder("after");
        world.scene.record(&mut encoder, &mut [&mut world.view]).expect("recorded");
        for (raw, renderer, layer) in
            [(&measure, &renderers[0], Layer::Measure), (&velocity, &renderers[1], Layer::Velocity)]
        {
            raw.pass(&mut encoder, |pass| {
                for layer in [Layer::Depth, layer] {
                    renderer.draw(pass, &world.scene, &world.view, layer).expect("drawn");
                }
            });
        }
        gpu.queue().submit([encoder.finish()]);
        let shots = Shots {
            places: measure.floats(&gpu, 0),
            numbers: measure.words(&gpu, 1),
            motions: velocity.floats(&gpu, 0),
        };
        let (now, number) = (world.scenery(), world.object.number());
        let right = shots.compared(&now, &last, [&moved(), &camera()], number);
        println!("{}: {right:?}", sample.name);
        // Where vertices are rounded, the edges of small triangles decide more pixels, and fewer are compared.
        let fewest = if is_coarse() { 15 } else { 60 };
        assert!(right.seen > fewest, "{}: {right:?}", sample.name);
        // Pixels of which a triangle's edge is nearer than rounding are few.
        let most = right.seen / 100;
        assert!(right.places.max(right.numbers).max(right.motions) <= most, "{}: {right:?}", sample.name);
        // Each comparison sees what is wrong.
        let shift = if is_coarse() { 0.1 } else { 0.004 };
        let far = |triangle: &Triangle| Triangle {
            corners: triangle.corners.map(|corner| corner + DVec3::new(shift, 0.0, shift)),
            ..*triangle
        };
        let elsewhere =
            Scenery { triangles: now.triangles.iter().map(far).collect(), numbers: now.numbers.clone() };
        let wrong = shots.compared(&elsewhere, &last, [&moved(), &camera()], number);
        assert!(2 * wrong.places > wrong.seen, "{}: {wrong:?}", sample.name);
        let wrong = shots.compared(&now, &last, [&moved(), &camera()], number + 1);
        assert_eq!(wrong.numbers, wrong.seen, "{}", sample.name);
        for (last, cameras) in [(&now, [&moved(), &camera()]), (&last, [&moved(), &moved()])] {
            let moves = cameras[1] != &moved();
            let wrong = shots.compared(&now, last, cameras, number);
            // The ground stands still.
            let stands = moves && sample.scale == 0.0;
            assert!(stands || 20 * wrong.motions > wrong.seen, "{}: {wrong:?}", sample.name);
        }
    }
}

/// What rays hit on the host is what is drawn.
#[test]
fn rays_hit_what_is_drawn() {
    let gpu = device();
    for sample in &SAMPLES {
        let mut world = World::new(&gpu, sample);
        // Kinds know the time of the last frame.
        let mut encoder = gpu.encoder("frame");
        world.scene.record(&mut encoder, &mut [&mut world.view]).expect("recorded");
        gpu.queue().submit([encoder.finish()]);
        let scenery = world.scenery();
        let (mut seen, mut wrong) = (0, 0);
        for (at, pixel) in (0..).zip(picture(&scenery.triangles, &camera())) {
            let Ok(hit) = pixel else { continue };
            let [x, y] = [at % SIZE[0], at / SIZE[0]].map(|place| place as f32 + 0.5);
            let ray = Ray::through(&camera(), [x, y]).expect("a pixel");
            let found = world.scene.pick(&ray).expect("a ray");
            seen += usize::from(hit.is_some());
            wrong += usize::from(match (hit, found) {
                (Some(hit), Some(found)) => {
                    found.world().distance(hit.position) > 1e-3
                        || found.instance.number() != scenery.numbers[hit.triangle]
                        || found.object != world.object
                }
                (None, None) => false,
                _ => true,
            });
        }
        println!("{}: {wrong} of {seen}", sample.name);
        assert!(seen > 60 && 100 * wrong <= seen, "{}: {wrong} of {seen}", sample.name);
    }
}

/// Each kind casts a shadow on a plate, and receives that of a cube above it.
#[test]
fn every_kind_casts_and_receives_shadow() {
    const SUN: Vec3 = Vec3::new(-0.3, 1.0, 0.4);
    let gpu = device();
    for sample in &SAMPLES {
        let mut world = World::new(&gpu, sample);
        let boxes = world.scene.add_mesh(&model(&cube(), plain([1.0; 4], Alpha::Opaque), false), 2);
        let boxes = boxes.expect("added");
        let plate = Placement { scale: Vec3::new(6.0, 0.1, 6.0), ..Placement::at([0.0, -1.5, 0.0]) };
        let lid = Placement::at([-0.6, 4.0, 0.9]).turned(0.2);
        let solids = [plate, lid].map(|place| (world.scene.spawn(boxes, place).expect("room"), place));
        world.scene.set_light(Light { direction: SUN, ..Light::default() }).expect("a light");
        let mut shadow = SunShadow::new(&mut world.scene, 4096).expect("a shadow");
        let raw = Raw::new(&gpu, TargetFormat::new(relievo::wgpu::TextureFormat::Rgba32Float), SIZE);
        let mut values = |expression: &str| {
            let source =
                format!("fn shade(surface: Surface, view: View) -> vec4<f32> {{ return {expression}; }}");
            let renderer = Renderer::new(&gpu, &raw.format).expect("a format");
            let mut renderer = renderer.with_shading(&source, None).expect("valid");
            renderer.prepare(&world.scene).expect("compiled");
            shadow.fit(&world.scene, &mut [&mut world.view], 20.0).expect("fitted");
            let mut encoder = gpu.encoder("frame");
            world.scene.record(&mut encoder, &mut [&mut world.view, shadow.view()]).expect("recorded");
            shadow.draw(&mut encoder, &world.scene).expect("drawn");
            raw.pass(&mut encoder, |pass| {
                renderer.draw(pass, &world.scene, &world.view, Layer::Color).expect("drawn");
            });
            gpu.queue().submit([encoder.finish()]);
            raw.floats(&gpu, 0)
        };
        let places = values("vec4<f32>(surface.position, surface.sunlit)");
        let normals = values("vec4<f32>(surface.geometric_normal, f32(surface.object))");
        let camera = shadow.camera().expect("fitted");
        let texel = 2.0 / f64::from(camera.clip_from_view.x_axis.x) / f64::from(camera.viewport[0]);
        let scenery = world.scenery();
        let occluders = |sun: Vec3| {
            let mut occluders = Occluders::new(sun.as_dvec3());
            for (triangle, number) in scenery.triangles.iter().zip(&scenery.numbers) {
                occluders.add(triangle.corners, [world.object.number(), *number]);
            }
            let cube = model(&cube(), plain([1.0; 4], Alpha::Opaque), false);
            for (instance, place) in &solids {
                occluders.add_model(&cube, matrix(place), [boxes.number(), instance.number()]);
            }
            occluders
        };
        // Lit, dark, and shown otherwise: of the kind, and of the plate.
        let tally = |occluders: &Occluders| {
            let mut tally = [[0; 3]; 2];
            for (place, normal) in places.iter().zip(&normals) {
                let number = normal[3] as u32;
                let of = usize::from(number != world.object.number());
                let [at, up] = [place, normal].map(|found| Vec3::from_slice(found).as_dvec3());
                let cosine = up.dot(occluders.light());
                if number == 0 || cosine < 0.1 {
                    continue;
                }
                let offset = 8.0_f64.sqrt() * texel * ((1.0 - cosine * cosine).sqrt() + 0.2).min(1.0);
                let [lit, dark, wrong] = &mut tally[of];
                match occluders.verdict((at, up), [offset, 8.0_f64.sqrt() * texel], None) {
                    Verdict::Edge => {}
                    Verdict::Lit => {
                        *lit += 1;
                        *wrong += usize::from(place[3] < 0.99);
                    }
                    Verdict::Dark => {
                        *dark += 1;
                        *wrong += usize::from(place[3] > 0.01);
                    }
                }
            }
            tally
        };
        let found = tally(&occluders(SUN));
        println!("{}: {found:?}", sample.name);
        for (of, [lit, dark, wrong]) in found.into_iter().enumerate() {
            // Terrain hides the plate.
            if of == 1 && sample.scale == 0.0 {
                continue;
            }
            assert!(lit + dark > 60 && dark > 20, "{}: {lit} lit, {dark} dark", sample.name);
            assert!(100 * wrong <= lit + dark, "{}: {wrong} of {lit} and {dark}", sample.name);
        }
        let wrong = tally(&occluders(SUN + Vec3::new(0.3, 0.0, 0.0)));
        assert!(wrong.iter().any(|[lit, dark, wrong]| 50 * wrong > lit + dark), "{wrong:?}");
    }
}

/// Places and velocities in one pass, texture coordinates and alpha.
const PROBE: &str = "
    struct ProbeTargets {
        @location(0) place: vec4<f32>,
        @location(1) motion: vec4<f32>,
        @location(2) more: vec4<f32>,
    }
    fn probe_shown(clip: mat4x4<f32>, place: vec3<f32>) -> vec2<f32> {
        let at = clip * vec4<f32>(place, 1.0);
        return at.xy / at.w;
    }
    fn probe_write(surface: Surface) -> ProbeTargets {
        let now = probe_shown(relievo_view.clip_from_world, surface.position);
        let moved = now - probe_shown(relievo_view.last_clip_from_world, surface.last_position);
        return ProbeTargets(
            vec4<f32>(surface.position, 1.0), vec4<f32>(0.5 * moved.x, -0.5 * moved.y, 0.0, 1.0),
            vec4<f32>(fract(surface.uv), surface.alpha, 1.0));
    }";

/// An output of the caller's shows every kind, behind a prepass, as the library's own layers do.
#[test]
fn outputs_of_the_caller_show_every_kind() {
    use relievo::wgpu::TextureFormat::{Rg16Float, Rgba8Unorm, Rgba32Float};
    let gpu = device();
    let probe = OutputProgram::new("probe", PROBE).expect("valid");
    assert_eq!((probe.name(), probe.colors()), ("probe", 3));
    let format = TargetFormat::of_output(&probe, &[Rgba32Float, Rg16Float, Rgba8Unorm]);
    let [own, measure, velocity] = [format, TargetFormat::measure(), TargetFormat::velocity()]
        .map(|format| Raw::new(&gpu, format, SIZE));
    for sample in &SAMPLES {
        let mut world = World::new(&gpu, sample);
        let mut frame = |raws: &[(&Raw, Layer)]| {
            let mut encoder = gpu.encoder("frame");
            world.scene.record(&mut encoder, &mut [&mut world.view]).expect("recorded");
            for (raw, layer) in raws {
                let renderer = raw.renderer(&gpu, &world.scene);
                raw.pass(&mut encoder, |pass| {
                    for layer in [Layer::Depth, *layer] {
                        renderer.draw(pass, &world.scene, &world.view, layer).expect("drawn");
                    }
                });
            }
            gpu.queue().submit([encoder.finish()]);
            world.step();
            world.view.set(moved()).expect("a camera");
        };
        frame(&[]);
        frame(&[(&own, Layer::Own), (&measure, Layer::Measure), (&velocity, Layer::Velocity)]);
        let places = own.floats(&gpu, 0);
        assert!(places == measure.floats(&gpu, 0), "{}: other places", sample.name);
        assert!(own.floats(&gpu, 1) == velocity.floats(&gpu, 0), "{}: other velocities", sample.name);
        let more = own.floats(&gpu, 2);
        let drawn = |place: &[f32; 4]| place[3] == 1.0;
        let seen = places.iter().filter(|place| drawn(place)).count();
        let spread = more.iter().map(|more| more[1]).fold(0.0, f32::max);
        assert!(
            seen > 60 && (spread > 0.5 || sample.name == "mesh" || sample.name == "character"),
            "{spread}"
        );
        assert!(
            places.iter().zip(&more).all(|(place, more)| more[2] == f32::from(u8::from(drawn(place)))),
            "{}: alpha",
            sample.name
        );
    }
}

/// What an output writes is blended as its format says: here it counts what is drawn from far to near.
#[test]
fn outputs_of_the_caller_are_blended_as_their_formats_say() {
    use relievo::wgpu::{BlendComponent, BlendFactor, BlendOperation, BlendState, TextureFormat};
    let gpu = device();
    let text = "struct CountTargets { @location(0) drawn: vec4<f32> }
        fn count_write(surface: Surface) -> CountTargets { return CountTargets(vec4<f32>(1.0)); }";
    let count = OutputProgram::new("count", text).expect("valid");
    let mut scene = Scene::new(&gpu).expect("compiled");
    let meadow = scene.add_kind(Grass::new(&gpu, 10).expect("valid"), 8).expect("added");
    for at in 0..8 {
        scene.spawn(meadow, Placement::at([0.0, 0.0, -3.0 + 0.3 * at as f32])).expect("room");
    }
    let mut view = scene.view(Quality::pixels(0.0)).expect("a view");
    let camera = Camera::looking_at(Vec3::new(0.0, 0.2, 0.5), Vec3::NEG_Z, 0.6, [0.1, 200.0], SIZE);
    view.set(camera).expect("a camera");
    let add = BlendComponent {
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::One,
        operation: BlendOperation::Add,
    };
    let mut most = |blend| {
        let mut format = TargetFormat::of_output(&count, &[TextureFormat::Rgba16Float]);
        format.color[0].as_mut().expect("one").blend = blend;
        let raw = Raw::new(&gpu, format, SIZE);
        let renderer = raw.renderer(&gpu, &scene);
        raw.frame(&mut scene, &mut view, &renderer, &[Layer::Own]);
        raw.floats(&gpu, 0).iter().map(|drawn| drawn[0]).fold(0.0, f32::max)
    };
    assert_eq!(most(None), 1.0);
    let counted = most(Some(BlendState { color: add, alpha: add }));
    assert!(counted > 2.0 && counted.fract() == 0.0, "{counted}");
}

/// Instances out of view are not drawn, and far ones by coarser levels.
#[test]
fn grass_is_culled_and_has_levels() {
    let gpu = device();
    let mut scene = Scene::new(&gpu).expect("compiled");
    let meadow = scene.add_kind(Grass::new(&gpu, 10).expect("valid"), 2).expect("added");
    // More than there was room for: 1 to 3 units ahead of the eye, far ahead, and behind it.
    for at in 0..4 {
        scene.spawn(meadow, Placement::at([0.0, 0.0, -1.0 - 0.5 * at as f32])).expect("room");
        scene.spawn(meadow, Placement::at([0.0, 0.0, -90.0 - at as f32])).expect("room");
        scene.spawn(meadow, Placement::at([0.0, 0.0, 5.0 + at as f32])).expect("room");
    }
    scene.set_statistics(true).expect("room");
    let mut view = scene.view(Quality::pixels(1.0)).expect("a view");
    let camera = Camera::looking_at(Vec3::new(0.0, 0.3, 0.5), Vec3::NEG_Z, 0.6, [0.1, 200.0], SIZE);
    view.set(camera).expect("a camera");
    let mut encoder = gpu.encoder("frame");
    scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
    gpu.queue().submit([encoder.finish()]);
    gpu.wait().expect("done");
    let counts = view.statistics().expect("arrived").clone();
    let levels: Vec<_> =
        counts.objects[0].levels.iter().map(|level| (level.instances, level.triangles)).collect();
    // Ten blades of three triangles, of one, and half as many blades.
    assert_eq!(levels, [(4, 120), (0, 0), (4, 20)]);
}

/// Every layer shows a kind of the caller's, in the shadow or not, in bundles, blended, cut out, with its own depth.
#[test]
fn parts_are_blended_cut_out_and_have_their_own_depth() {
    let gpu = device();
    let text = "
        fn card_place(entry: u32, vertex: u32) -> relievo_SceneVertex {
            let at = vec2<f32>(f32(vertex & 1u), f32(vertex >> 1u)) * 2.0 - 1.0;
            return relievo_scene_placed(
                entry, vec3<f32>(at, 0.0), vec3<f32>(0.0, 0.0, 1.0), vec4<f32>(1.0, 0.0, 0.0, 1.0), vec4<f32>(at, 0.0, 0.0));
        }
        fn card_surface(in: relievo_SceneFragment) -> Surface {
            var surface = relievo_scene_surface(in);
            surface.color = vec3<f32>(0.0, 1.0, 0.0);
            surface.alpha = 0.5;
            surface.cutoff = select(0.25, 0.75, in.uv.x < 0.0);
            surface.depth = select(in.clip.z, 0.999, in.uv.y < 0.0);
            return surface;
        }";
    let program = relievo::scene::kind::KindProgram::new("card", text).expect("valid");
    for own_depth in [false, true] {
        for (cut_out, blended) in [(false, false), (true, false), (false, true)] {
            let mut scene = Scene::new(&gpu).expect("compiled");
            // A wall behind the card, nearer than depth 0.999.
            let wall = scene.add_mesh(&model(&cube(), plain([1.0, 0.0, 0.0, 1.0], Alpha::Opaque), false), 1);
            let wall = wall.expect("added");
            let place = Placement { scale: Vec3::new(9.0, 9.0, 0.1), ..Placement::at([0.0, 0.0, -2.0]) };
            scene.spawn(wall, place).expect("room");
            scene.set_light(Light { direction: Vec3::Z, ..Light::default() }).expect("a light");
            let part = |part| relievo::scene::kind::KindPart { cut_out, blended, own_depth, ..part };
            let card = scene.add_kind(mistakes::Card::new(&gpu, &program, part), 1).expect("added");
            scene.spawn(card, Placement::at([0.0, 0.0, 0.0])).expect("room");
            let mut view = scene.view(Quality::default()).expect("a view");
            let eye = Camera::looking_at(Vec3::new(0.0, 0.0, 6.0), Vec3::ZERO, 0.7, [0.5, 60.0], SIZE);
            view.set(eye).expect("a camera");
            let frame = Frame::plain(&gpu, SIZE);
            let renderer = frame.renderer(&gpu, &scene);
            let mut encoder = gpu.encoder("frame");
            scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
            frame.pass(&mut encoder, |pass| {
                for layer in [Layer::Color, Layer::Transparent] {
                    renderer.draw(pass, &scene, &view, layer).expect("drawn");
                }
            });
            gpu.queue().submit([encoder.finish()]);
            let picture = frame.read(&gpu);
            let [red, green, both] = [[true, false], [false, true], [true, true]];
            let shows = |x: i32, y: i32| {
                let [x, y] = [x + SIZE[0] as i32 / 2, SIZE[1] as i32 / 2 - y];
                let pixel = picture.get_pixel(x as u32, y as u32).0;
                [pixel[0] > 90, pixel[1] > 90]
            };
            let quadrants = [shows(-6, 6), shows(6, 6), shows(-6, -6), shows(6, -6)];
            let above = match (cut_out, blended) {
                (true, _) => [red, green],
                (_, true) => [both, both],
                _ => [green, green],
            };
            // Its own depth puts the lower half behind the wall.
            let below = if own_depth { [red, red] } else { above };
            assert_eq!(
                quadrants,
                [above[0], above[1], below[0], below[1]],
                "cut out {cut_out}, blended {blended}, own depth {own_depth}"
            );
        }
    }
}

/// Names that the crate has too are the caller's own in a kind and in an output.
#[test]
fn names_of_the_crate_are_free() {
    let gpu = device();
    let text = "
        fn scene_place(entry: u32, vertex: u32) -> relievo_SceneVertex {
            let at = vec2<f32>(f32(vertex & 1u), f32(vertex >> 1u)) * 2.0 - 1.0;
            return relievo_scene_placed(
                entry, vec3<f32>(at, 0.0), vec3<f32>(0.0, 0.0, 1.0), vec4<f32>(1.0, 0.0, 0.0, 1.0), vec4<f32>());
        }
        fn scene_surface(in: relievo_SceneFragment) -> Surface {
            var surface = relievo_scene_surface(in);
            surface.alpha = 0.5;
            return surface;
        }";
    let format = relievo::wgpu::TextureFormat::Rgba32Float;
    for (kind, output) in [("scene", "color"), ("triangle", "mesh"), ("mesh", "depth"), ("grass", "vertex")] {
        let mut scene = Scene::new(&gpu).expect("compiled");
        for sample in &SAMPLES {
            let object = (sample.add)(&gpu, &mut scene);
            scene.set_visible(object, false).expect("there");
        }
        let program =
            relievo::scene::kind::KindProgram::new(kind, &text.replace(" scene_", &format!(" {kind}_")));
        let card = mistakes::Card::new(&gpu, &program.expect("valid"), |part| part);
        let card = scene.add_kind(card, 1).expect("added");
        scene.spawn(card, Placement::default()).expect("room");
        let mut view = scene.view(Quality::default()).expect("a view");
        let eye = Camera::looking_at(Vec3::new(0.0, 0.0, 6.0), Vec3::ZERO, 0.7, [0.5, 60.0], SIZE);
        view.set(eye).expect("a camera");
        let upper = format!("{}{}", output[..1].to_uppercase(), &output[1..]);
        let text = format!(
            "struct {upper}Targets {{ @location(0) it: vec4<f32>, }}
            fn {output}_write(surface: Surface) -> {upper}Targets {{
                return {upper}Targets(vec4<f32>(surface.alpha, f32(surface.object), 0.0, 1.0));
            }}"
        );
        let program = OutputProgram::new(output, &text).expect("valid");
        let raw = Raw::new(&gpu, TargetFormat::of_output(&program, &[format]), SIZE);
        let renderer = raw.renderer(&gpu, &scene);
        raw.frame(&mut scene, &mut view, &renderer, &[Layer::Own]);
        let middle = raw.floats(&gpu, 0)[(SIZE[0] * SIZE[1] / 2 + SIZE[0] / 2) as usize];
        assert_eq!(middle, [0.5, card.number() as f32, 0.0, 1.0], "{kind} {output}");
    }
}

/// The box of an instance holds what it draws, and is not far larger.
#[test]
fn bounds_hold_what_is_drawn() {
    let gpu = device();
    for sample in &SAMPLES {
        let world = World::new(&gpu, sample);
        for instance in &world.instances {
            let corners = (sample.triangles)(&world.scene, *instance).into_iter().flatten();
            let [low, high] = corners
                .fold([DVec3::MAX, DVec3::MIN], |[low, high], corner| [low.min(corner), high.max(corner)]);
            for bounds in [world.scene.bounds(*instance), world.scene.tight_bounds(*instance)] {
                let [least, most] = bounds.expect("there").world();
                let is_inside = least.cmple(low).all() && most.cmpge(high).all();
                assert!(is_inside, "{}: {low} to {high} in {least} to {most}", sample.name);
                let larger = (most - least).length() / (high - low).length();
                assert!(larger < 4.0, "{}: {larger} times as large", sample.name);
            }
        }
    }
}

/// On another device everything is as it was.
#[test]
fn kinds_outlive_a_device() {
    let [gpu, other] = devices();
    for sample in &SAMPLES {
        let mut world = World::new(&gpu, sample);
        let frame = Frame::plain(&gpu, SIZE);
        let mut renderer = frame.renderer(&gpu, &world.scene);
        let before = frame.shot(&mut world.scene, &mut world.view, &renderer);
        world.scene.rebuild_all(&other, &mut [&mut world.view, &mut renderer]).expect("rebuilt");
        let frame = Frame::plain(&other, SIZE);
        let after = frame.shot(&mut world.scene, &mut world.view, &renderer);
        assert!(after == before, "{}: another picture", sample.name);
        world.step();
        assert!(
            frame.shot(&mut world.scene, &mut world.view, &renderer) != before || sample.scale == 0.0,
            "{}: nothing moves",
            sample.name
        );
    }
}

/// What the documentation of [`Renderer::with_shading`] leaves a caller's shading of the default limits, it has in every kind;
/// and not more.
#[test]
fn shading_has_what_the_kinds_leave_of_the_limits() {
    let gpu = device();
    // Storage buffers, uniform buffers, textures and samplers.
    let left = [3, 8, 11, 13];
    let refused = [[4, 8, 11, 13], [3, 9, 11, 13], [3, 8, 12, 13], [3, 8, 11, 14]];
    let mut scene = Scene::new(&gpu).expect("compiled");
    for sample in &SAMPLES {
        (sample.add)(&gpu, &mut scene);
    }
    let renderer = |counts: [u32; 4]| {
        let (source, layout) = shading(&gpu, counts);
        let renderer = Renderer::new(&gpu, &TargetFormat::new(relievo::wgpu::TextureFormat::Rgba8Unorm));
        renderer.expect("a format").with_shading(&source, Some(&layout))
    };
    renderer(left).expect("within the limits").prepare(&scene).expect("compiled");
    for counts in refused {
        let error = renderer(counts).expect_err("beyond the limits").to_string();
        assert!(error.starts_with("shading.layout"), "{counts:?}: {error}");
    }
}

/// A shading that uses so many storage buffers, uniform buffers, textures and samplers, and its layout.
fn shading(gpu: &Gpu, counts: [u32; 4]) -> (String, relievo::wgpu::BindGroupLayout) {
    use relievo::wgpu;
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let classes = [
        ("var<storage, read> s", "array<f32>", buffer(wgpu::BufferBindingType::Storage { read_only: true })),
        ("var<uniform> u", "vec4<f32>", buffer(wgpu::BufferBindingType::Uniform)),
        ("var t", "texture_2d<f32>", texture),
        ("var f", "sampler", wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering)),
    ];
    let (mut text, mut entries) = (String::new(), Vec::new());
    for ((declared, ty, layout), count) in classes.into_iter().zip(counts) {
        for at in 0..count {
            let binding = entries.len() as u32;
            text += &format!("@group(3) @binding({binding}) {declared}{at}: {ty};\n");
            let visibility = wgpu::ShaderStages::FRAGMENT;
            entries.push(wgpu::BindGroupLayoutEntry { binding, visibility, ty: layout, count: None });
        }
    }
    let [storage, uniforms, textures, samplers] = counts;
    let used = (0..storage).map(|at| format!("s{at}[0]"));
    let used = used.chain((0..uniforms).map(|at| format!("u{at}.x")));
    let most = textures.max(samplers);
    let used = used.chain((0..most).map(|at| {
        let (texture, sampler) = (at.min(textures - 1), at.min(samplers - 1));
        format!("textureSampleLevel(t{texture}, f{sampler}, surface.uv, 0.0).x")
    }));
    let sum = used.collect::<Vec<_>>().join(" + ");
    text += &format!("fn shade(surface: Surface, view: View) -> vec4<f32> {{ return vec4<f32>({sum}); }}");
    let layout = gpu
        .device()
        .create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries });
    (text, layout)
}
