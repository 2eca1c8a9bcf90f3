//! Bounding spheres of points, and of models in all of their clips.

use glam::Vec3;

use super::pose::poses_of;
use crate::animation::bounds::reference::bounds;
use crate::animation::local_to_model::reference::local_to_model;
use crate::animation::sample::reference::sample;
use crate::asset::keyframe::RotationPath;
use crate::asset::mesh::bone_radii;
use crate::asset::{Clip, Model, Transform};

/// The smallest and the largest number of samples per clip. The largest is one hour at 60 samples per second.
const MOMENTS: [usize; 2] = [32, 216_001];

/// Safety factor of a sphere's radius, for motion between samples.
pub(crate) const MARGIN: f32 = 1.05;

/// A sphere in the model's space and units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundingSphere {
    /// Center of the sphere.
    pub center: Vec3,
    /// Radius of the sphere.
    pub radius: f32,
}

impl BoundingSphere {
    /// A sphere around points, such as the vertices of a model at rest. Its radius is enlarged by a twentieth. Without
    /// points, the sphere has radius 0 and lies at the origin.
    pub fn around(points: impl Iterator<Item = Vec3> + Clone) -> Self {
        let (low, high) =
            points.clone().fold((Vec3::MAX, Vec3::MIN), |(low, high), p| (low.min(p), high.max(p)));
        let center = middle_of(low, high);
        Self { center, radius: MARGIN * points.map(|point| point.distance(center)).fold(0.0, f32::max) }
    }

    /// A sphere around this sphere and another.
    #[cfg(feature = "gpu")]
    pub(crate) fn with(&self, other: &Self) -> Self {
        let (apart, towards) = (self.center.distance(other.center), other.center - self.center);
        if apart + other.radius <= self.radius {
            return *self;
        }
        if apart + self.radius <= other.radius {
            return *other;
        }
        let radius = (apart + self.radius + other.radius) / 2.0;
        // The radius is enlarged slightly, to cover rounding.
        Self { center: self.center + towards * ((radius - self.radius) / apart), radius: 1.000_01 * radius }
    }

    /// A sphere around all meshes of a model, at rest and in every clip.
    ///
    /// Clips are sampled 60 times a second, and at least 32 times. A clip of more than an hour is sampled 216,001
    /// times, at larger intervals. The sphere is enlarged by a twentieth for motion between samples. Only the distances
    /// of vertices from their bones are used, so the sphere may be 1.5 times as large as necessary. Morph targets are
    /// included as [`bone_radii`] describes.
    ///
    /// # Panics
    /// In the cases of [`bone_radii`].
    pub fn in_clips(model: &Model) -> Self {
        let rest = std::iter::once(model.skeleton.rest());
        Self::in_poses(model, rest.chain(model.clips.iter().flat_map(poses)))
    }

    /// A sphere around all meshes in one clip, computed as in [`BoundingSphere::in_clips`]. The rest pose is not
    /// included. If the model has no clips at all, the sphere is around the rest pose, for any `clip`.
    ///
    /// # Panics
    /// If the model has clips but not this one, and in the cases of [`bone_radii`].
    pub fn in_clip(model: &Model, clip: usize) -> Self {
        if model.clips.is_empty() {
            return Self::in_clips(model);
        }
        Self::in_poses(model, poses(&model.clips[clip]))
    }

    /// A sphere around all meshes in the given poses, enlarged for motion between them.
    fn in_poses(model: &Model, poses: impl Iterator<Item = Vec<Transform>>) -> Self {
        let [low, high] = box_in_poses(model, poses);
        Self { center: middle_of(low, high), radius: MARGIN * low.distance(high) / 2.0 }
    }
}

/// The center of a box; the origin if the box is empty.
pub(crate) fn middle_of(low: Vec3, high: Vec3) -> Vec3 {
    if low.cmple(high).all() { low.midpoint(high) } else { Vec3::ZERO }
}

/// The local transforms of all bones at the sampled moments of a clip.
pub(crate) fn poses(clip: &Clip) -> impl Iterator<Item = Vec<Transform>> {
    let [least, most] = MOMENTS;
    let moments = poses_of(clip).unwrap_or(most).max(least);
    let time = move |moment| clip.duration() * (moment as f32 / (moments - 1) as f32);
    (0..moments).map(move |moment| sample(clip, time(moment), RotationPath::Slerp))
}

/// The lower and upper corner of a box around all meshes in the given poses.
fn box_in_poses(model: &Model, poses: impl Iterator<Item = Vec<Transform>>) -> [Vec3; 2] {
    let skeleton = &model.skeleton;
    let bone_radii = bone_radii(skeleton.len(), &model.skins, &model.meshes);
    let followed = followed(model);
    let weighted: Vec<usize> = (0..bone_radii.len()).filter(|bone| followed[*bone]).collect();
    let (mut low, mut high) = (Vec3::MAX, Vec3::MIN);
    let bone_radii: Vec<f32> = weighted.iter().map(|bone| bone_radii[*bone]).collect();
    for locals in poses {
        let models = local_to_model(skeleton, &locals);
        let models: Vec<_> = weighted.iter().map(|bone| models[*bone]).collect();
        if let Some(found) = (!bone_radii.is_empty()).then(|| bounds(&models, &bone_radii)[0]) {
            low = low.min(Vec3::from_slice(&found.low));
            high = high.max(Vec3::from_slice(&found.high));
        }
    }
    if low.cmple(high).all() { [low, high] } else { [Vec3::ZERO; 2] }
}

/// For each bone, whether at least one vertex follows it.
pub(crate) fn followed(model: &Model) -> Vec<bool> {
    let mut followed = vec![false; model.skeleton.len()];
    for mesh in &model.meshes {
        let bones = &model.skins[mesh.skin].bones;
        for influence in mesh.influences.all() {
            followed[bones[influence.bone as usize] as usize] = true;
        }
    }
    followed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::asset::clip::{BoneKeys, Interpolation, Keys};
    use crate::skinning::instance_lod::InstanceLod;
    use crate::skinning::morph::reference::morph;
    use crate::skinning::palette::reference::palette_for;
    use crate::skinning::skin::reference::skin;
    use crate::skinning::vertex::Blend;

    /// The largest distance of any vertex from `center`, in 45 poses of a clip.
    fn farthest(model: &Model, clip: &Clip, center: Vec3) -> f32 {
        let mesh = &model.meshes[0];
        let in_pose = |moment: u16| {
            let locals = sample(clip, clip.duration() * f32::from(moment) / 44.0, RotationPath::Slerp);
            let models = local_to_model(&model.skeleton, &locals);
            let palette = palette_for(&model.skins[mesh.skin], &models, Blend::Linear);
            let vertices = skin(&morph(mesh, &[]), &mesh.influences, &palette, InstanceLod::FULL);
            vertices.iter().map(|vertex| Vec3::from(vertex.position).distance(center)).fold(0.0, f32::max)
        };
        (0..45).map(in_pose).fold(0.0, f32::max)
    }

    #[test]
    fn the_sphere_holds_every_vertex_and_not_much_more() {
        let model = crate::samples::creature().expect("valid");
        let all = BoundingSphere::in_clips(&model);
        let largest = model.clips.iter().map(|clip| farthest(&model, clip, all.center)).fold(0.0, f32::max);
        assert!((largest..1.6 * largest).contains(&all.radius), "{} for {largest}", all.radius);
        for (at, clip) in model.clips.iter().enumerate() {
            let BoundingSphere { center, radius } = BoundingSphere::in_clip(&model, at);
            let largest = farthest(&model, clip, center);
            assert!((largest..1.6 * largest).contains(&radius), "{radius} for {largest} in {}", clip.name());
            assert!(radius <= all.radius && center.distance(all.center) + radius < 1.5 * all.radius);
        }
        let bare = Model { meshes: vec![], ..model };
        let none = BoundingSphere { center: Vec3::ZERO, radius: 0.0 };
        assert_eq!(BoundingSphere::in_clips(&bare), none);
        assert_eq!(BoundingSphere::in_clip(&bare, 0), none);
        assert_eq!(BoundingSphere::around(std::iter::empty()), none);
    }

    #[cfg(feature = "gpu")]
    #[test]
    fn a_sphere_holds_two() {
        let sphere = |x: f32, radius: f32| BoundingSphere { center: Vec3::X * x, radius };
        for (a, b) in [
            (sphere(0.0, 1.0), sphere(5.0, 2.0)),
            (sphere(0.0, 9.0), sphere(1.0, 2.0)),
            (sphere(1.0, 1.0), sphere(1.0, 1.0)),
        ] {
            for (one, other) in [(a, b), (b, a)] {
                let both = one.with(&other);
                let holds = |of: &BoundingSphere| {
                    both.center.distance(of.center) + of.radius <= 1.000_1 * both.radius
                };
                assert!(holds(&a) && holds(&b), "{both:?}");
                let least = (a.center.distance(b.center) + a.radius + b.radius) / 2.0;
                assert!(both.radius <= 1.000_1 * least.max(a.radius).max(b.radius), "{both:?}");
            }
        }
    }

    #[test]
    fn spheres_hold_their_points() {
        let points = [Vec3::ZERO, Vec3::X, Vec3::new(0.5, 2.0, -1.0)];
        let BoundingSphere { center, radius } = BoundingSphere::around(points.into_iter());
        assert!(points.iter().all(|point| point.distance(center) <= radius) && radius < 1.5);
    }

    /// The clip lasts 90 seconds and contains a jump that takes a tenth of a second.
    #[test]
    fn the_sphere_holds_what_long_clips_do() {
        let mut model = crate::samples::creature().expect("valid");
        let still = BoundingSphere::in_clips(&Model { clips: vec![], ..model.clone() }).radius;
        let mut keys = vec![BoneKeys::default(); model.skeleton.len()];
        let at = |y: f32| [0.0, y, 0.0, 0.0];
        keys[0].translation = Some(Keys {
            times: vec![0.0, 50.0, 50.05, 50.1, 90.0],
            values: [0.0, 0.0, 8.0, 0.0, 0.0].map(at).to_vec(),
            interpolation: Interpolation::Linear,
        });
        model.clips = vec![Clip::new("jump", &model.skeleton, &keys, 90.0).expect("valid")];
        let radius = BoundingSphere::in_clips(&model).radius;
        assert!(radius > still + 3.5, "{radius}, {still} without a clip");
        assert_eq!(BoundingSphere::in_clip(&model, 0).radius, radius);
    }

    /// The rest pose is used only if there is no clip.
    #[test]
    fn clips_have_spheres_of_their_own() {
        let mut model = crate::samples::creature().expect("valid");
        model.clips.clear();
        let rest = BoundingSphere::in_clip(&model, 7);
        assert_eq!(rest, BoundingSphere::in_clips(&model));
        let clip = |y: f32| {
            let mut keys = vec![BoneKeys::default(); model.skeleton.len()];
            let values = vec![[0.0, y, 0.0, 0.0]];
            keys[0].translation = Some(Keys { times: vec![0.0], values, interpolation: Interpolation::Step });
            Clip::new("far", &model.skeleton, &keys, 1.0).expect("valid")
        };
        model.clips = vec![clip(-50.0), clip(90.0)];
        let height = model.skeleton.bones()[0].rest.translation[1];
        for (at, y) in [-50.0, 90.0].into_iter().enumerate() {
            let found = BoundingSphere::in_clip(&model, at);
            let moved = rest.center + Vec3::new(0.0, y - height, 0.0);
            assert!(
                found.center.distance(moved) < 0.1 && (found.radius - rest.radius).abs() < 0.01,
                "{found:?}"
            );
        }
        assert!(BoundingSphere::in_clips(&model).radius > 70.0);
    }
}
