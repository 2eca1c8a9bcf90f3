//! Levels of detail as they are drawn: no gap between meshes that share a border, and no change of the picture where a level
//! that has moved all the way becomes the next coarser one.

use glam::Vec3;
use image::RgbaImage;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::{Mesh, Model};
use relievo::gpu::Gpu;
use relievo::ops::animation::local_to_model::reference::local_to_model;
use relievo::ops::animation::sample::reference::sample;
use relievo::ops::mesh::ProgressiveMesh;
use relievo::ops::skinning::at_rest::still;
use relievo::ops::skinning::instance_lod::InstanceLod;
use relievo::ops::skinning::morph::reference::morph;
use relievo::ops::skinning::palette::reference::palette_for;
use relievo::ops::skinning::skin::reference::skin;
use relievo::ops::skinning::vertex::{Blend, Vertex};
use relievo::ops::skinning::{MeshLevels, add_levels};
use relievo::render::Renderer;
use relievo::scene::{Camera, Placement, Quality, Scene, View};
use relievo_samples::{creature, rock};

use crate::frame::{Frame, device};
use crate::hull::{Hull, halves};

const SIZE: [u32; 2] = [160, 160];

/// Draws models one after the other, alone, in the same scene.
struct Stage {
    scene: Scene,
    frame: Frame,
    renderer: Renderer,
    view: View,
    sky: RgbaImage,
}

impl Stage {
    fn new(gpu: &Gpu) -> Self {
        let mut scene = Scene::new(gpu).expect("compiled");
        let frame = Frame::plain(gpu, SIZE);
        let renderer = frame.renderer(gpu, &scene);
        let mut view = scene.view(Quality::default()).expect("a view");
        view.set(camera(0.0, 1.0)).expect("a camera");
        let sky = frame.shot(&mut scene, &mut view, &renderer);
        Self { scene, frame, renderer, view, sky }
    }

    /// The model at rest, in full.
    fn draw(&mut self, model: &Model, camera: Camera) -> RgbaImage {
        let object = self.scene.add_mesh(model, 1).expect("added");
        self.scene.spawn(object, Placement::at([0.0; 3])).expect("room");
        self.renderer.prepare(&self.scene).expect("compiled");
        self.view.set(camera).expect("a camera");
        let picture = self.frame.shot(&mut self.scene, &mut self.view, &self.renderer);
        self.scene.remove(object).expect("there");
        picture
    }

    /// How many pixels show the sky and are not joined to the picture's edge by such pixels.
    fn holes(&self, picture: &RgbaImage) -> usize {
        let [width, height] = SIZE.map(|size| size as usize);
        let sky = *self.sky.get_pixel(0, 0);
        let mut open: Vec<bool> = picture.pixels().map(|pixel| *pixel == sky).collect();
        let edge =
            |at: &usize| [0, width - 1].contains(&(at % width)) || [0, height - 1].contains(&(at / width));
        let mut reached: Vec<usize> = (0..width * height).filter(|at| edge(at) && open[*at]).collect();
        reached.iter().for_each(|at| open[*at] = false);
        while let Some(at) = reached.pop() {
            let (x, y) = (at % width, at / width);
            let beside = [(x > 0, 1), (y > 0, width)].map(|(is_there, step)| is_there.then(|| at - step));
            let beyond = [(x + 1 < width, 1), (y + 1 < height, width)];
            let beyond = beyond.map(|(is_there, step)| is_there.then(|| at + step));
            for next in
                beside.into_iter().chain(beyond).flatten().filter(|next| std::mem::take(&mut open[*next]))
            {
                reached.push(next);
            }
        }
        open.iter().filter(|is_open| **is_open).count()
    }
}

/// Around what is about `size` high.
fn camera(turn: f32, size: f32) -> Camera {
    let target = Vec3::new(0.0, 0.5 * size, 0.0);
    let eye = target + size * Vec3::new(2.0 * turn.cos(), 0.7, 2.0 * turn.sin());
    Camera::looking_at(eye, target, 0.75, [0.05, 100.0], SIZE)
}

/// The model with the triangles of one level.
fn at_level(model: &Model, levels: &[MeshLevels], level: usize) -> Model {
    let mut model = model.clone();
    for (mesh, own) in model.meshes.iter_mut().zip(levels) {
        let last = own.levels.len();
        if let Some(level) = level.min(last).checked_sub(1) {
            mesh.indices.clone_from(&own.levels[level].indices);
        }
        mesh.levels.clear();
    }
    model
}

#[test]
fn a_hull_of_two_parts_shows_no_background() {
    let mut stage = Stage::new(&device());
    let Hull { mut model, points } = halves();
    assert_eq!(points.len(), 2);
    let bare = model.clone();
    let together = add_levels(&mut model, &[0], 5).expect("valid");
    let alone: Vec<MeshLevels> =
        (0..2).map(|mesh| MeshLevels::new(&bare, mesh, &[0], 5).expect("valid")).collect();
    let count = together[0].levels.len();
    assert!(count >= 8, "{count}");
    let mut parted = 0;
    for level in 0..=count {
        for turn in [0.3, 2.2, 4.4] {
            let picture = stage.draw(&at_level(&bare, &together, level), camera(turn, 1.4));
            let inside = picture.pixels().filter(|pixel| **pixel != *stage.sky.get_pixel(0, 0)).count();
            assert!(inside > 2000, "level {level}: {inside} pixels of the hull");
            assert_eq!(stage.holes(&picture), 0, "level {level}, turned {turn}");
            let picture = stage.draw(&at_level(&bare, &alone, level), camera(turn, 1.4));
            parted += stage.holes(&picture);
        }
    }
    // The same parts, simplified each by itself.
    assert!(parted > 0, "a gap would be seen");
}

/// A mesh with its vertices in one pose.
struct Posed {
    model: Model,
    progressive: ProgressiveMesh,
    vertices: Vec<Vertex>,
}

impl Posed {
    /// The first mesh of a model, at a time of its first clip, if it has one.
    fn new(mut model: Model, time: f32) -> Self {
        let clips: &[usize] = if model.clips.is_empty() { &[] } else { &[0] };
        add_levels(&mut model, clips, 5).expect("valid");
        let progressive = ProgressiveMesh::of_levels(&model.meshes[0]).expect("valid");
        let mesh = progressive.mesh();
        let locals = match model.clips.first() {
            Some(clip) => sample(clip, time, RotationPath::Slerp),
            None => model.skeleton.rest(),
        };
        let models = local_to_model(&model.skeleton, &locals);
        let palette = palette_for(&model.skins[mesh.skin], &models, Blend::Linear);
        let vertices = skin(&morph(mesh, &mesh.weights), &mesh.influences, &palette, InstanceLod::FULL);
        let bare = Mesh { levels: Vec::new(), partners: Vec::new(), ..mesh.clone() };
        let model =
            still(&Model { meshes: vec![bare], ..model }, std::slice::from_ref(&vertices)).expect("in range");
        Self { model, progressive, vertices }
    }

    /// A level on its way to the next one.
    fn at(&self, level: usize, t: f32) -> Model {
        let mut model = self.model.clone();
        let mesh = &mut model.meshes[0];
        let positions: Vec<[f32; 3]> = self.vertices.iter().map(|vertex| vertex.position).collect();
        let normals: Vec<[f32; 3]> = self.vertices.iter().map(|vertex| vertex.normal).collect();
        let count = self.progressive.vertices(level);
        let moved = self.progressive.morphed(level, t, &positions).expect("valid");
        mesh.positions[..count].copy_from_slice(&moved);
        let moved = self.progressive.morphed(level, t, &normals).expect("valid");
        mesh.normals[..count].copy_from_slice(&moved);
        let moved = self.progressive.morphed(level, t, &mesh.uv).expect("valid");
        mesh.uv[..count].copy_from_slice(&moved);
        mesh.indices = self.progressive.indices(level).to_vec();
        model
    }

    /// The largest distance over which a vertex moves from a level to the next one.
    fn way(&self, level: usize) -> f32 {
        let partners = self.progressive.partners(level);
        let place = |at: usize| Vec3::from(self.vertices[at].position);
        let ways = partners.iter().enumerate().map(|(at, to)| place(at).distance(place(*to as usize)));
        ways.fold(0.0, f32::max)
    }
}

/// The largest distance between vertices of two steps inside a level.
fn moved(before: &Model, after: &Model) -> f32 {
    let [before, after] = [before, after].map(|model| &model.meshes[0].positions);
    let moves = before.iter().zip(after).map(|(a, b)| Vec3::from(*a).distance(Vec3::from(*b)));
    moves.fold(0.0, f32::max)
}

/// Sixty steps over all levels of a closed mesh and of a skinned one in a pose, whose vertices the host moves.
#[test]
fn pictures_do_not_change_where_levels_do() {
    let mut stage = Stage::new(&device());
    for (posed, size) in
        [(Posed::new(rock().expect("valid"), 0.0), 1.4), (Posed::new(creature().expect("valid"), 0.4), 2.0)]
    {
        let ways = posed.progressive.levels() - 1;
        let steps = 60 / ways;
        assert!(ways >= 8 && steps >= 4, "{ways} levels");
        let (mut changed, mut before): (usize, Option<RgbaImage>) = (0, None);
        for level in 0..ways {
            for step in 0..=steps {
                let t = step as f32 / steps as f32;
                let model = posed.at(level, t);
                let picture = stage.draw(&model, camera(0.8, size));
                match &before {
                    // The same picture from the coarser level's own vertices.
                    Some(before) if step == 0 => {
                        assert!(*before == picture, "level {level} begins with a jump")
                    }
                    Some(before) => changed += usize::from(*before != picture),
                    None => {}
                }
                if step > 0 {
                    let last = posed.at(level, (step - 1) as f32 / steps as f32);
                    let (most, found) = (posed.way(level) / steps as f32, moved(&last, &model));
                    assert!(found <= most * 1.0001 + 1e-6, "level {level}: {found} beyond {most}");
                }
                before = Some(picture);
            }
        }
        assert!(changed > ways * steps / 2, "it does move: {changed} of {} steps", ways * steps);
    }
}
