//! The extent of a mesh in clips: a bounding sphere, and the largest displacement of a vertex by the fade of
//! influences. Both determine the distances at which the influences of a crowd may fade while the error stays within a
//! limit in pixels.

use glam::Vec3;

use super::bounding_sphere::{BoundingSphere, MARGIN, middle_of};
use super::instance_lod::FadeRange;
use super::pose::{Moment, Pose, bones_at, mean, moments, weights_at};
use crate::InputError;
use crate::animation::Projection;
use crate::asset::Mesh;
use crate::asset::Model;
use crate::asset::influences::Influence;
use crate::parallel;

/// Safety factor of [`Extent::stray`] over the sampled maximum. If a vertex's displacement changed linearly between two
/// poses, its maximum would be at one of the two. The factor covers curvature.
const STRAY_MARGIN: f32 = 1.01;

/// The extent of a mesh in its clips, in the model's units. It assumes linear blending, with the clips' weights of
/// morph targets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extent {
    /// Center of a sphere around all vertices in all poses.
    pub center: Vec3,
    /// Radius of the sphere.
    pub radius: f32,
    /// Largest displacement of a vertex per unit of influence fade
    /// ([`InstanceLod::fade`](crate::skinning::instance_lod::InstanceLod::fade)). At a fade of λ, no vertex is further
    /// than λ times this value from its position at full quality. Sampled as the maximum of displacement divided by λ.
    pub stray: f32,
}

impl Extent {
    /// Samples `poses` poses of each given clip, evenly spaced from start to end. Without clips, samples the rest pose.
    ///
    /// Between samples, the extent may be exceeded by 1 %. [`poses_of`](super::poses_of) gives a sufficient number of
    /// poses for a clip. Other clips, and layers on top of the given clips, are not covered.
    ///
    /// # Errors
    /// [`InputError`] if the model does not have the mesh or a clip, if `poses` is 0, or if the mesh does not match its
    /// skin.
    pub fn new(model: &Model, mesh: usize, clips: &[usize], poses: usize) -> Result<Self, InputError> {
        let moments = moments(model, mesh, clips, poses)?;
        let mesh = &model.meshes[mesh];
        let all = look_at(model, mesh, &moments);
        let center = middle_of(all.low, all.high);
        Ok(Self { center, radius: radius(model, mesh, &moments, center), stray: STRAY_MARGIN * all.stray })
    }

    /// The common extent of all meshes of a model, for objects whose meshes share levels of detail and fade.
    ///
    /// The sphere contains the vertices of all meshes. Its center is the center of [`BoundingSphere::in_clips`].
    /// [`Extent::stray`] is the largest value of any mesh. Everything else is as in [`Extent::new`].
    ///
    /// # Errors
    /// The same errors as [`Extent::new`]; also [`InputError`] for a model without meshes.
    pub fn of_model(model: &Model, clips: &[usize], poses: usize) -> Result<Self, InputError> {
        InputError::check(!model.meshes.is_empty(), "model.meshes.len", 0, || "must be at least 1")?;
        let mut all = Self { center: BoundingSphere::in_clips(model).center, radius: 0.0, stray: 0.0 };
        for index in 0..model.meshes.len() {
            let moments = moments(model, index, clips, poses)?;
            let mesh = &model.meshes[index];
            all.radius = all.radius.max(radius(model, mesh, &moments, all.center));
            all.stray = all.stray.max(STRAY_MARGIN * look_at(model, mesh, &moments).stray);
        }
        Ok(all)
    }

    /// The projected distances at which the influences of a crowd may begin to fade, and at which its vertices may be
    /// rigid.
    ///
    /// If influences fade over this range, no vertex is drawn more than `pixels` from its correct position, anywhere in
    /// the picture. Instances must not be scaled. With 0 pixels, nothing fades. Errors add up: a gate's error of ε′
    /// pixels and a fade of ε pixels together show at most ε + ε′. `docs/pixel-bounds.md` has the derivation.
    pub fn fade_range(&self, projection: &Projection, pixels: f32) -> FadeRange {
        let start = self.beyond(projection, pixels, 0.0);
        FadeRange { start, end: self.beyond(projection, pixels, self.stray).max(start.next_up()) }
    }

    /// For each error in `errors` ([`MeshLevel::error`](crate::asset::mesh::MeshLevel::error)), the smallest projected
    /// distance at which a level with this error may be drawn.
    ///
    /// From that distance on, the level and the mesh's surface are at most `pixels` apart on the screen. Every point of
    /// either surface has a point of the other surface within `pixels`. This holds wherever the level keeps its error.
    /// Instances must not be scaled. With 0 pixels, a level with an error gets the largest finite distance. Errors add
    /// up, so split the allowed pixels between fade and levels. `docs/pixel-bounds.md` has the derivation.
    pub fn level_ranges(
        &self,
        projection: &Projection,
        pixels: f32,
        errors: impl IntoIterator<Item = f32>,
    ) -> Vec<f32> {
        errors.into_iter().map(|error| self.beyond(projection, pixels, error)).collect()
    }

    /// The projected distance beyond which a displacement of `off` covers at most `pixels` on the screen; finite.
    fn beyond(&self, projection: &Projection, pixels: f32, off: f32) -> f32 {
        let [focal, pixels, radius, off] =
            [projection.focal_pixels, pixels.max(0.0), self.radius, off].map(f64::from);
        let projected_distance = 3.0 * radius + off * (focal + pixels) / pixels;
        // An error of 0 is allowed at any distance. With 0 pixels, any other error needs an infinite distance.
        projected_distance.max(3.0 * radius).min(f64::from(f32::MAX)) as f32
    }
}

/// The largest [`Extent::stray`] of a model's meshes in `poses` poses of every clip.
///
/// # Errors
/// As for [`Extent::new`].
pub(super) fn stray_of(model: &Model, poses: usize) -> Result<f32, InputError> {
    let clips: Vec<usize> = (0..model.clips.len()).collect();
    let mut all = Vec::new();
    for mesh in 0..model.meshes.len() {
        all = moments(model, mesh, &clips, poses)?;
    }
    // A vertex that follows one bone stays where it is.
    let fading = |mesh: &Mesh| {
        let vertices = (0..mesh.vertices()).filter(|vertex| mesh.influences.of(*vertex).len() > 1);
        vertices.collect::<Vec<_>>()
    };
    let fading: Vec<_> = model.meshes.iter().map(|mesh| (mesh, fading(mesh))).collect();
    let fading: Vec<_> = fading.iter().filter(|(_, vertices)| !vertices.is_empty()).collect();
    if fading.is_empty() {
        return Ok(0.0);
    }
    let at = |moment: &Moment| {
        let bones = bones_at(model, *moment);
        let of_mesh = |(mesh, vertices): &&(&Mesh, Vec<usize>)| {
            let pose = Pose::at(model, mesh, &bones, &weights_at(model, mesh, *moment));
            let of_vertex = |vertex: &usize| {
                let influences = mesh.influences.of(*vertex);
                stray(influences, &pose.points(*vertex, influences))
            };
            vertices.iter().map(of_vertex).fold(0.0, f32::max)
        };
        fading.iter().map(of_mesh).fold(0.0, f32::max)
    };
    Ok(STRAY_MARGIN * parallel::map(&all, at).into_iter().fold(0.0, f32::max))
}

/// Bounds of a mesh at the sampled moments: the corners of its box, and the largest displacement of a vertex per unit
/// of fade.
#[derive(Clone, Copy)]
struct Look {
    low: Vec3,
    high: Vec3,
    stray: f32,
}

impl Look {
    const NONE: Self = Self { low: Vec3::MAX, high: Vec3::MIN, stray: 0.0 };

    fn with(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            stray: self.stray.max(other.stray),
        }
    }
}

fn look_at(model: &Model, mesh: &Mesh, moments: &[Moment]) -> Look {
    let looks = parallel::map(moments, |moment| look(&Pose::new(model, mesh, *moment), mesh));
    looks.into_iter().fold(Look::NONE, Look::with)
}

fn look(pose: &Pose, mesh: &Mesh) -> Look {
    let mut all = Look::NONE;
    for vertex in 0..mesh.vertices() {
        let influences = mesh.influences.of(vertex);
        let points = pose.points(vertex, influences);
        let point = mean(influences, &points);
        all = all.with(Look { low: point, high: point, stray: stray(influences, &points) });
    }
    all
}

/// The radius of a sphere around `center` that contains all vertices at all moments, with a margin.
fn radius(model: &Model, mesh: &Mesh, moments: &[Moment], center: Vec3) -> f32 {
    let farthest = |moment: &Moment| {
        let points = Pose::new(model, mesh, *moment).positions(mesh);
        points.into_iter().map(|point| point.distance(center)).fold(0.0, f32::max)
    };
    MARGIN * parallel::map(moments, farthest).into_iter().fold(0.0, f32::max)
}

/// The largest displacement of a vertex per unit of fade λ: the maximum over λ of |Σ min(wᵢ, λ·w₂)·(pᵢ − p₁)|/λ, with
/// the sum over i > 1.
///
/// As a function of 1/λ, the sum divided by λ is piecewise linear, with kinks at λ = wᵢ/w₂, where one of the minima
/// switches. The length of this vector is convex between kinks, so it is largest at a kink.
fn stray(influences: &[Influence], points: &[Vec3]) -> f32 {
    let Some(second) = influences.get(1) else { return 0.0 };
    let off = |fade: f32| {
        let others = influences.iter().zip(points).skip(1);
        let sum: Vec3 = others
            .map(|(other, point)| (other.weight / fade).min(second.weight) * (*point - points[0]))
            .sum();
        sum.length()
    };
    influences[1..].iter().map(|other| off(other.weight / second.weight)).fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strays_are_the_largest_of_all_fades() {
        let points = [Vec3::ZERO, Vec3::X, Vec3::Y, -2.0 * Vec3::X];
        let weights = [0.4_f32, 0.3, 0.2, 0.1];
        let influences: Vec<_> =
            (0..).zip(weights).map(|(bone, weight)| Influence { bone, weight }).collect();
        // At small λ, every minimum is 0.3 λ, and the sum divided by λ is (0.3 − 0.6, 0.3). At λ = 1, the sum is
        // (0.3 − 0.2, 0.2).
        assert!((stray(&influences, &points) - 0.3 * 2.0_f32.sqrt()).abs() < 1e-6);
        assert!((stray(&influences[..2], &points[..2]) - 0.3).abs() < 1e-6);
        assert_eq!(stray(&influences[..1], &points[..1]), 0.0);
    }

    #[test]
    fn requests_are_checked() {
        let model = crate::samples::creature().expect("valid");
        let field =
            |mesh, clips: &[usize], poses| Extent::new(&model, mesh, clips, poses).expect_err("refused").path;
        assert_eq!(field(1, &[0], 1), "mesh");
        assert_eq!(field(0, &[0, 3], 1), "clips[1]");
        assert_eq!(field(0, &[0], 0), "poses");
    }

    /// The sphere contains every mesh. Its center is the center of the sphere that scenes use.
    #[test]
    fn models_have_one_extent() {
        let mut model = crate::samples::creature().expect("valid");
        let one = Extent::new(&model, 0, &[0], 9).expect("valid");
        let mut hat = model.meshes[0].clone();
        hat.positions.iter_mut().for_each(|position| position[1] += 3.0);
        model.meshes.push(hat);
        let all = Extent::of_model(&model, &[0], 9).expect("valid");
        let each = [0, 1].map(|mesh| Extent::new(&model, mesh, &[0], 9).expect("valid"));
        assert_eq!(each[0], one);
        assert_eq!(
            (all.center, all.stray),
            (BoundingSphere::in_clips(&model).center, each[0].stray.max(each[1].stray))
        );
        let points = |mesh: &Mesh| Pose::new(&model, mesh, Moment::In(0, 0.3)).positions(mesh);
        let farthest = model.meshes.iter().flat_map(points).map(|point| point.distance(all.center));
        let farthest = farthest.fold(0.0, f32::max);
        assert!((0.9 * all.radius..=all.radius).contains(&farthest), "{farthest} of {}", all.radius);
        assert!(all.radius > one.radius + 1.0);
        model.meshes.clear();
        assert_eq!(Extent::of_model(&model, &[0], 9).expect_err("refused").path, "model.meshes.len");
    }

    #[test]
    fn ranges_begin_where_the_model_does() {
        let projection = Projection::new(1080, 1.0, 0.1);
        let extent = Extent { center: Vec3::ZERO, radius: 1.5, stray: 0.02 };
        let range = |extent: &Extent, pixels| extent.fade_range(&projection, pixels);
        let FadeRange { start, end } = range(&extent, 0.5);
        assert_eq!(start, 4.5);
        // With twice the allowed pixels, the fade ends at half the distance from its start.
        let nearer = range(&extent, 1.0).end;
        assert!(((nearer - start) / (end - start) - 0.5).abs() < 1e-3, "{nearer} {end}");
        let endless = FadeRange { start: 4.5, end: f32::MAX };
        assert_eq!([0.0, -1.0].map(|pixels| range(&extent, pixels)), [endless; 2]);
        let rigid = Extent { stray: 0.0, ..extent };
        for pixels in [0.0, 1.0] {
            assert_eq!(range(&rigid, pixels).validate(), Ok(()));
        }
    }

    #[test]
    fn levels_begin_where_their_errors_are_so_many_pixels() {
        let projection = Projection::new(1080, 1.0, 0.1);
        let extent = Extent { center: Vec3::ZERO, radius: 0.5, stray: 0.02 };
        let ranges =
            |pixels, errors: &[f32]| extent.level_ranges(&projection, pixels, errors.iter().copied());
        let errors = [0.0, 0.02, 0.02, 0.5];
        let begins = ranges(1.0, &errors);
        assert_eq!((begins[0], begins[1]), (1.5, extent.fade_range(&projection, 1.0).end));
        assert!(begins.is_sorted() && begins.iter().all(|begin| begin.is_finite()));
        assert_eq!(ranges(0.0, &errors), [1.5, f32::MAX, f32::MAX, f32::MAX]);
        assert!(ranges(1.0, &[]).is_empty());

        // Tests errors in every direction, at the nearest points of the sphere, straight ahead and far to the side.
        let focal = projection.focal_pixels;
        let screen = |point: Vec3| point.truncate() * (focal / point.z);
        let unit = |at: i32| {
            let [a, b] = [0.1 * at as f32, 0.37 * at as f32];
            Vec3::new(libm::cosf(a) * libm::cosf(b), libm::sinf(a) * libm::cosf(b), libm::sinf(b))
        };
        for towards in [Vec3::Z, Vec3::new(1.0, 0.6, 1.0).normalize(), Vec3::new(0.0, -3.0, 1.0).normalize()]
        {
            for pixels in [0.25, 1.0, 8.0] {
                let mut largest = 0.0_f32;
                for (begin, error) in ranges(pixels, &errors).into_iter().zip(errors) {
                    // The sphere's center, placed at the projected distance `begin` in this direction.
                    let middle = towards * (begin / (towards.z * towards.z));
                    let bounding_sphere = [-Vec3::Z, -towards, Vec3::X].map(|to| middle + extent.radius * to);
                    for (point, off) in bounding_sphere
                        .into_iter()
                        .flat_map(|p| (0..500).map(move |at| (p, error * unit(at))))
                    {
                        largest = largest.max(screen(point).distance(screen(point + off)));
                    }
                }
                assert!(
                    (0.8 * pixels..=1.001 * pixels).contains(&largest),
                    "{largest} of {pixels}, {towards}"
                );
            }
        }
    }
}
