//! What is painted over the picture: bounding boxes, and the bones of the chosen character.

use std::collections::VecDeque;

use egui::{Color32, Pos2, Rect, Stroke};
use glam::{DAffine3, DVec2, DVec3};
use relievo::asset::bone_radii;
use relievo::scene::{Camera, InstanceBone, InstanceId, Placement, WatchedBones};
use relievo::{Error, InputError};
use relievo_scene_file::{World, WorldKind};

/// Largest number of boxes that are painted: each takes time of the host.
const BOXES: usize = 400;

/// Number of frames whose poses wait for the device's.
const WAITING: usize = 24;

/// The pixel where a camera shows a point of the world, from the upper left corner; `None` behind the near plane.
pub fn pixel(camera: &Camera, point: DVec3) -> Option<DVec2> {
    let clip = camera.clip_from_cell().as_dmat4() * (point - Placement::corner(camera.cell)).extend(1.0);
    let [width, height] = camera.viewport.map(f64::from);
    let seen = clip.truncate() / clip.w;
    (clip.w > 1e-9).then(|| DVec2::new((0.5 + 0.5 * seen.x) * width, (0.5 - 0.5 * seen.y) * height))
}

/// Where a camera's picture lies on the screen.
#[derive(Debug, Clone, Copy)]
pub struct Projected<'a> {
    /// The camera.
    pub camera: &'a Camera,
    /// The picture on the screen, in points.
    pub rect: Rect,
}

impl Projected<'_> {
    /// Where a point of the world is on the screen.
    pub fn at(&self, point: DVec3) -> Option<Pos2> {
        let [width, height] = self.camera.viewport.map(|edge| edge as f32);
        let pixel = pixel(self.camera, point)?.as_vec2();
        Some(self.rect.lerp_inside(egui::vec2(pixel.x / width, pixel.y / height)))
    }

    /// Paints a line between two points of the world.
    fn line(&self, painter: &egui::Painter, [from, to]: [DVec3; 2], stroke: Stroke) {
        if let (Some(from), Some(to)) = (self.at(from), self.at(to)) {
            painter.line_segment([from, to], stroke);
        }
    }
}

/// Paints the bounding boxes of the instances of meshes, characters and patches. Returns their number.
pub fn paint_bounds(painter: &egui::Painter, on: Projected<'_>, world: &World) -> usize {
    let scene = &world.scene;
    let mut count = 0;
    for object in &world.objects {
        let color = match object.kind {
            WorldKind::Terrain => Color32::from_rgb(150, 190, 120),
            WorldKind::Character => Color32::from_rgb(240, 190, 70),
            WorldKind::Mesh | WorldKind::Relief => Color32::from_rgb(120, 190, 240),
        };
        for instance in scene.instances(object.object).unwrap_or_default() {
            let Ok(bounds) = scene.bounds(instance) else { continue };
            if count == BOXES {
                return count;
            }
            count += 1;
            let [low, high] = bounds.world();
            let corner = |at: usize| {
                let pick = |bit: usize, low: f64, high: f64| if at >> bit & 1 == 0 { low } else { high };
                DVec3::new(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z))
            };
            for (from, bit) in (0..8).flat_map(|from| (0..3).map(move |bit| (from, bit))) {
                if from >> bit & 1 == 0 {
                    on.line(painter, [corner(from), corner(from | 1 << bit)], Stroke::new(1.0, color));
                }
            }
        }
    }
    count
}

/// The bones of the chosen character: where the device has them, which of them were sampled, and how far they are off.
#[derive(Debug)]
pub struct Bones {
    pub instance: InstanceId,
    parents: Vec<Option<u32>>,
    /// For each bone, the distance in the model's units of the furthest vertex that follows it.
    radii: Vec<f32>,
    /// The exact poses of frames whose bones have not arrived, with the cameras.
    exact: VecDeque<(f64, Camera, Vec<DAffine3>)>,
    /// The bones of the last frame that arrived, and whether each was sampled in it.
    shown: Option<(WatchedBones, Vec<bool>)>,
    /// The largest displacement in the last frame that arrived, in pixels.
    displacement: Option<f64>,
}

impl Bones {
    /// Chooses a character's instance, and watches its bones.
    ///
    /// # Errors
    /// [`Error`] for an instance that is no character, and of the device.
    pub fn choose(world: &mut World, instance: InstanceId) -> Result<Self, Error> {
        let object = world.objects.iter().find(|object| object.object == instance.object());
        let Some(model) = object.and_then(|object| object.character()) else {
            return Err(
                InputError::new("instance", "no character", "must be an instance of a character").into()
            );
        };
        let parents: Vec<_> = model.skeleton.bones().iter().map(|bone| bone.parent).collect();
        let radii = bone_radii(parents.len(), &model.skins, &model.meshes);
        let names: Vec<String> = (0..parents.len()).map(|bone| bone.to_string()).collect();
        let watched: Vec<_> = names.iter().map(|bone| InstanceBone { instance, bone }).collect();
        world.scene.watch_bones(&watched)?;
        Ok(Self { instance, parents, radii, exact: VecDeque::new(), shown: None, displacement: None })
    }

    /// Remembers the exact pose of the frame that is recorded now.
    pub fn record(&mut self, world: &World, camera: &Camera) {
        let Ok(pose) = world.scene.pose(self.instance) else { return };
        let exact = (0..self.parents.len()).filter_map(|bone| pose.world_from_bone(bone).ok()).collect();
        self.exact.push_back((world.scene.time(), *camera, exact));
        if self.exact.len() > WAITING {
            self.exact.pop_front();
        }
    }

    /// Takes the bones that have arrived.
    pub fn update(&mut self, world: &mut World) {
        let Some(watched) = world.scene.watched_bones() else { return };
        if self.shown.as_ref().is_some_and(|(shown, _)| shown.frame == watched.frame) {
            return;
        }
        let locals = |bones: &WatchedBones| -> Vec<DAffine3> {
            let of = |at: usize| bones.bones[at].world_from_bone();
            let local = |(at, parent): (usize, &Option<u32>)| {
                parent.map_or_else(|| of(at), |parent| of(parent as usize).inverse() * of(at))
            };
            self.parents.iter().enumerate().take(bones.bones.len()).map(local).collect()
        };
        let now = locals(watched);
        let moved = |(now, last): (&DAffine3, &DAffine3)| !now.abs_diff_eq(*last, 1e-5);
        let active = match &self.shown {
            Some((last, _)) => {
                let current = watched.bones.iter().map(|bone| bone.is_current);
                now.iter()
                    .zip(&locals(last))
                    .map(moved)
                    .zip(current)
                    .map(|(moved, current)| moved && current)
                    .collect()
            }
            None => vec![true; now.len()],
        };
        self.displacement =
            self.exact.iter().find(|(time, ..)| *time == watched.time).map(|(_, camera, exact)| {
                let off = watched.bones.iter().zip(exact).zip(&self.radii).map(|((bone, exact), radius)| {
                    largest_displacement(camera, [&bone.world_from_bone(), exact], f64::from(*radius))
                });
                off.fold(0.0, f64::max)
            });
        self.shown = Some((watched.clone(), active));
    }

    /// The largest displacement of points that follow the bones, in pixels.
    pub fn displacement(&self) -> Option<f64> {
        self.displacement
    }

    /// Number of bones, and number of those that were sampled in the last frame that arrived.
    pub fn counts(&self) -> [usize; 2] {
        let active = self.shown.iter().flat_map(|(_, active)| active).filter(|active| **active).count();
        [self.parents.len(), active]
    }

    /// Paints the bones: those that were sampled bright, the others dark.
    pub fn paint(&self, painter: &egui::Painter, on: Projected<'_>) {
        let Some((watched, active)) = &self.shown else { return };
        let (bright, dark) = (Color32::from_rgb(255, 210, 60), Color32::from_rgb(90, 110, 160));
        for (at, parent) in self.parents.iter().enumerate() {
            let (Some(bone), Some(active)) = (watched.bones.get(at), active.get(at)) else { continue };
            let color = if *active { bright } else { dark };
            if let Some(parent) = parent {
                let ends = [watched.bones[*parent as usize].world(), bone.world()];
                on.line(painter, ends, Stroke::new(if *active { 2.5 } else { 1.5 }, color));
            }
            if let Some(at) = on.at(bone.world()) {
                painter.circle_filled(at, 2.0, color);
            }
        }
    }
}

/// The largest distance in pixels between points on the axes of a bone, at a radius, under two transforms.
fn largest_displacement(camera: &Camera, [drawn, exact]: [&DAffine3; 2], radius: f64) -> f64 {
    let ends = DVec3::AXES.into_iter().flat_map(|axis| [axis * radius, -axis * radius]);
    let distances = ends.filter_map(|point| {
        let [drawn, exact] = [drawn, exact].map(|transform| pixel(camera, transform.transform_point3(point)));
        let (drawn, exact) = (drawn?, exact?);
        let size = DVec2::from(camera.viewport.map(f64::from));
        let is_inside = |pixel: DVec2| pixel.cmpge(DVec2::ZERO).all() && pixel.cmple(size).all();
        (is_inside(drawn) || is_inside(exact)).then(|| drawn.distance(exact))
    });
    distances.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_where_the_camera_shows_them() {
        let camera = Camera::looking_at_world(
            [0.0, 0.0, 10.0],
            [0.0; 3],
            2.0 * 1.0_f32.atan(),
            [0.1, 99.0],
            [300, 200],
        );
        let at = |x: f64, y: f64, z: f64| pixel(&camera, DVec3::new(x, y, z));
        // A picture's half height is as long as the distance.
        assert!(at(0.0, 0.0, 0.0).expect("seen").distance(DVec2::new(150.0, 100.0)) < 1e-3);
        assert!(at(10.0, 10.0, 0.0).expect("seen").distance(DVec2::new(250.0, 0.0)) < 1e-3);
        assert_eq!(at(0.0, 0.0, 11.0), None);
        let moved = |x: f64| DAffine3::from_translation(DVec3::new(x, 0.0, 0.0));
        let off = largest_displacement(&camera, [&moved(0.1), &moved(0.0)], 0.0);
        assert!((off - 1.0).abs() < 1e-6, "{off}");
        assert_eq!(largest_displacement(&camera, [&moved(99.0), &moved(98.0)], 0.0), 0.0);
    }
}
