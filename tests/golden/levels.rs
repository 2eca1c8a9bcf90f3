//! Levels of detail of skinned meshes: a crowd near and far, on the device and in the reference.

use std::ops::Range;

use glam::{Mat4, Vec3, camera};
use image::RgbaImage;
use relievo::animation::order::Order;
use relievo::animation::{ModelMatrices, UpdatedBones};
use relievo::asset::Light;
use relievo::asset::transform::Affine;
use relievo::asset::{MeshLevel, Model};
use relievo::gpu::{Buffer, Gpu};
use relievo::render::target::LINEAR_FORMAT;
use relievo::render::{Albedo, Character, ColorTexture, CrowdScene, Target};
use relievo::skinning::bounding_sphere::BoundingSphere;
use relievo::skinning::instance_lod::{FadeRange, InstanceLod};
use relievo::skinning::level_errors;
use relievo::skinning::lod::reference::{lod, seen};
use relievo::skinning::lod::{LevelRanges, LodView, placed};
use relievo::skinning::morph::reference::morph;
use relievo::skinning::palette::reference::palette_for;
use relievo::skinning::picture::texture::Surface;
use relievo::skinning::picture::{Part, Scene};
use relievo::skinning::skin::reference::{skin, transformed};
use relievo::skinning::vertex::{Blend, Vertex};
use relievo::surface::linear_image::LinearImage;
use relievo::surface::mips::Mips;

use crate::harness::{Difference, Tolerance, gpu};
use crate::skinned::{RINGS, SIDES, SKY, limb, quad, rows};

const COUNT: usize = 15;
const CLAY: [u8; 3] = [200, 140, 90];

const SIZE: [u32; 2] = [2 * 176, 2 * 112];

/// The distances in world units at which the character's levels begin. There are as many as its meshes have
/// errors, one more than either mesh has levels.
const BEGINS: [f32; 4] = [5.0, 6.0, 9.0, 14.0];

/// A limb with three levels, of every second, fourth and eighth ring and side, and a shorter one around it with
/// one level, whose error is less than any of the limb's.
fn model() -> Model {
    let mut model = limb();
    let level = |step: usize, rings: Range<usize>| {
        let rings = rings.step_by(step);
        let indices =
            rings.flat_map(|ring| (0..SIDES).step_by(step).flat_map(move |side| quad(ring, side, step)));
        MeshLevel { indices: indices.collect(), error: step as f32 / 100.0 }
    };
    let mut sleeve = model.meshes[0].clone();
    let middle = 8..RINGS - 9;
    sleeve.indices = level(1, middle.clone()).indices;
    sleeve.levels = vec![MeshLevel { error: 0.01, ..level(4, middle) }];
    let wider = |[x, y, z]: [f32; 3]| [x, 1.25 * y, 1.25 * z];
    sleeve.positions.iter_mut().for_each(|position| *position = wider(*position));
    model.meshes[0].levels = [2, 4, 8].map(|step| level(step, 0..RINGS - 1)).to_vec();
    model.meshes.push(sleeve);
    assert_eq!(level_errors(&model.meshes), [0.01, 0.02, 0.04, 0.08]);
    model
}

/// For each mesh, its own level at each of the character's levels.
const OWN: [[u32; 5]; 2] = [[0, 0, 1, 2, 3], [0, 1, 1, 1, 1]];

struct Crowd {
    gpu: Gpu,
    model: Model,
    models: Vec<Affine>,
    places: Vec<Affine>,
}

impl Crowd {
    /// Limbs in rows away from the eye, each bent differently.
    fn new() -> Self {
        let bend = |index: usize| {
            [rows(Mat4::IDENTITY), rows(Mat4::from_axis_angle(Vec3::Z, 0.25 * index as f32 - 1.5))]
        };
        let place = |index: usize| {
            let (row, column) = (index / 3, index % 3);
            let at =
                Vec3::new(2.5 * column as f32 - 2.5 + 0.4 * row as f32, 0.4 * row as f32, -5.0 * row as f32);
            placed(at, 0.3 * index as f32, 1.0)
        };
        Self {
            gpu: gpu(),
            model: model(),
            models: (0..COUNT).flat_map(bend).collect(),
            places: (0..COUNT).map(place).collect(),
        }
    }

    fn view(&self, eye: Vec3) -> LodView {
        let look = camera::rh::view::look_at_mat4(eye, Vec3::new(0.5, 0.5, -6.0), Vec3::Y);
        let BoundingSphere { center, radius } = BoundingSphere::in_clips(&self.model);
        LodView {
            clip_from_world: camera::rh::proj::directx::perspective(0.6, 176.0 / 112.0, 0.2, 100.0) * look,
            eye,
            fade_range: FadeRange::NEVER,
            steps: 1,
            max_influences: 8,
            center,
            radius,
            levels: LevelRanges::new(&BEGINS).expect("ascending"),
        }
    }

    /// The vertices of all instances, instance by instance, mesh by mesh.
    fn skinned(&self) -> Vec<Vec<Vertex>> {
        let all = self.models.chunks(2).zip(&self.places);
        all.flat_map(|(models, place)| {
            self.model.meshes.iter().map(|mesh| {
                let palette = palette_for(&self.model.skins[0], models, Blend::Linear);
                let vertices = skin(&morph(mesh, &[]), &mesh.influences, &palette, InstanceLod::FULL);
                vertices.iter().map(|vertex| transformed(vertex, place)).collect()
            })
        })
        .collect()
    }

    /// The reference's picture, with these levels.
    fn drawn(&self, view: &LodView, levels: &[u32]) -> RgbaImage {
        let skinned = self.skinned();
        let surface = Surface::plain(CLAY.map(relievo::srgb::linear));
        let meshes = self.model.meshes.len();
        let scene = Scene { clip_from_model: view.clip_from_world, light: Light::default(), size: SIZE };
        let parts: Vec<_> = (skinned.iter().enumerate())
            .map(|(at, vertices)| {
                let mesh = &self.model.meshes[at % meshes];
                let level = OWN[at % meshes][levels[at / meshes] as usize];
                Part { mesh, level, vertices, surface: &surface }
            })
            .collect();
        scene.draw(&parts, SKY.map(|light| light as f32)).reduced(2).encoded()
    }
}

/// The crowd is seen from afar, from near, from the side and from afar again. Vertices that a level lacks are
/// skinned when a finer level is used, vertices that it has are not skinned again, and the picture is the
/// reference's.
#[test]
fn a_crowd_with_levels() {
    let crowd = Crowd::new();
    let Crowd { gpu, model, models, places } = &crowd;
    let mut scene = CrowdScene::new(gpu, LINEAR_FORMAT, Light::default()).expect("compiled");
    let [r, g, b] = CLAY;
    let clay = Mips::of_color(RgbaImage::from_pixel(1, 1, image::Rgba([r, g, b, 255])));
    let clay: Albedo = ColorTexture::linear(gpu, &clay, true).expect("uploaded").into();
    let words = COUNT * Order::new(&model.skeleton).words();
    let models = Buffer::from_slice(gpu, "model matrices", models).expect("uploaded");
    let updated = UpdatedBones::new(gpu, words).expect("allocated");
    let character = Character {
        model,
        matrices: &ModelMatrices::new(&models).with_updated_bones(&updated),
        placements: &Buffer::from_slice(gpu, "placements", places).expect("uploaded"),
        fade_range: FadeRange::NEVER,
        levels: &BEGINS,
        blend: Blend::Linear,
        albedos: &[clay.clone(), clay],
    };
    scene.add(gpu, &character).expect("prepared");
    let mut last = [InstanceLod::UNSEEN; COUNT];
    let mut used = [0; 5];
    for eye in [[1.0, 5.0, 22.0], [-0.5, 2.0, 5.0], [9.0, 3.0, -3.0], [1.0, 5.0, 22.0]].map(Vec3::from) {
        let view = crowd.view(eye);
        let near = |place: &Affine| {
            BEGINS.iter().any(|begin| (seen(&view, place).projected_distance - begin).abs() < 1e-3)
        };
        assert!(!places.iter().any(near), "too near to tell");
        let now: Vec<InstanceLod> = places.iter().map(|place| lod(&view, place)).collect();
        scene.set_camera(gpu, view.clip_from_world, eye).expect("set");
        let target = Target::linear(gpu, SIZE).expect("allocated");
        gpu.run("skin", |encoder| scene.record(encoder)).expect("run");
        target.draw(gpu, SKY, |pass| scene.draw(pass)).expect("drawn");
        let picture = LinearImage { size: SIZE, pixels: target.read_linear(gpu).expect("read") };
        let picture = picture.reduced(2).encoded();

        let levels: Vec<u32> = now.iter().map(|instance_lod| instance_lod.mesh_lod).collect();
        let difference =
            |levels: &[u32]| Difference::of(&picture, &crowd.drawn(&view, levels), Tolerance::IMAGE.levels);
        assert!(difference(&levels).within(Tolerance::IMAGE), "{eye}: {:?}", difference(&levels));
        let whole = difference(&[0; COUNT]);
        assert!(!whole.within(Tolerance::IMAGE), "{eye}: levels do not show: {whole:?}");

        let drawn = &scene.characters()[0];
        let scenes = drawn.frames.iter().zip(&drawn.scenes);
        for ((mesh, own), (frame, scene)) in model.meshes.iter().zip(OWN).zip(scenes) {
            let counts = (0..5).map(|level| {
                now.iter().filter(|now| now.max_influences > 0 && now.mesh_lod == level).count() as u32
            });
            let arguments = scene.arguments.read_blocking(gpu).expect("read");
            for ((level, count), words) in (0..).zip(counts).zip(arguments.chunks(10)) {
                let held = frame.clusters.level(level);
                let triangles = mesh.triangles(own[level as usize]).len() as u32;
                let draw = |count| [triangles, count, held.first_index, 0, 0];
                // No instance is mirrored.
                assert_eq!(words, [draw(count), draw(0)].as_flattened());
                used[level as usize] += count;
            }
            // Nobody moves: only what comes into view, or gets finer.
            let clusters = |of: &InstanceLod| {
                if of.max_influences == 0 { 0 } else { frame.clusters.level(of.mesh_lod).clusters }
            };
            let anew: u32 =
                now.iter().zip(&last).map(|(now, last)| clusters(now).saturating_sub(clusters(last))).sum();
            assert_eq!(frame.active.dispatched.read_blocking(gpu).expect("read")[3], anew, "{eye}");
        }
        last.copy_from_slice(&now);
    }
    assert!(used.iter().all(|count| *count > 0), "{used:?}");
}
