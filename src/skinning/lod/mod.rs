//! Culling and level of detail of instances: which are seen, how far the influences of each fade with distance,
//! and which level of detail each uses.
//!
//! The fade has discrete steps, so that an instance that hardly moves keeps its vertices; a single step moves
//! no vertex noticeably. An instance that is not seen is not skinned ([`InstanceLod::UNSEEN`](crate::skinning::InstanceLod::UNSEEN)); when it is seen
//! again, all of it is skinned.

use glam::{Mat4, Vec3, Vec4};

use crate::InputError;
use crate::asset::influences::MAX_INFLUENCES;
use crate::asset::mesh::MAX_LEVELS;
use crate::asset::transform::Affine;
use crate::shared::skinning::lod::LEAST_NORMAL;
use crate::skinning::instance_lod::FadeRange;

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;

#[cfg(feature = "gpu")]
pub use pass::{LodBuffers, LodJob, LodPass};

/// The view of a crowd, and its fade and levels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LodView {
    /// The matrix from world space to clip space, depth 0 to 1.
    pub clip_from_world: Mat4,
    /// Position of the eye in world units.
    pub eye: Vec3,
    /// The distances between which influences fade.
    pub fade_range: FadeRange,
    /// Number of steps of the fade; 64 is a good number.
    pub steps: u32,
    /// The largest number of influences of instances that are seen, 1 to 8.
    pub max_influences: u32,
    /// The center of a sphere around the model in all of its clips.
    pub center: Vec3,
    /// The radius of the sphere.
    pub radius: f32,
    /// The distances at which instances change their level of detail.
    pub levels: LevelRanges,
}

/// The distances, in world units as [`LodView::projected_distance`] measures them, from which on levels 1, 2 …
/// of a character ([`level_errors`](super::level_errors)) replace finer ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LevelRanges {
    distances: [f32; MAX_LEVELS - 1],
    coarser: usize,
}

impl LevelRanges {
    /// Level 0, the mesh itself, at all distances.
    pub const NONE: Self = Self { distances: [f32::MAX; MAX_LEVELS - 1], coarser: 0 };

    /// The distances at which level 1, level 2 and so on begin. A level that begins where the next one does is
    /// not used.
    ///
    /// # Errors
    /// [`InputError`] for distances that are not finite or that descend, and for [`MAX_LEVELS`] or more of
    /// them.
    pub fn new(distances: &[f32]) -> Result<Self, InputError> {
        let mut ranges = Self { coarser: distances.len(), ..Self::NONE };
        let Some(to) = ranges.distances.get_mut(..distances.len()) else {
            let bound = format!("must be at most {}", MAX_LEVELS - 1);
            return Err(InputError::new("levels.len", distances.len(), bound));
        };
        to.copy_from_slice(distances);
        let mut least = f32::MIN;
        for (at, distance) in distances.iter().enumerate() {
            if !(least..=f32::MAX).contains(distance) {
                let bound = format!("must be finite, and at least {least}, where the level before begins");
                return Err(InputError::new(format!("levels[{at}]"), distance, bound));
            }
            least = *distance;
        }
        Ok(ranges)
    }

    /// The distances at which level 1, level 2 and so on begin.
    pub fn distances(&self) -> &[f32] {
        &self.distances[..self.coarser]
    }

    /// The level at a distance.
    pub fn at(&self, distance: f32) -> u32 {
        self.distances().iter().take_while(|begin| distance >= **begin).count() as u32
    }
}

/// Words from one level's list of drawn instances to the next: a multiple of 64, so that each list can be
/// bound.
pub fn list_stride(instances: usize) -> usize {
    instances.next_multiple_of(64)
}

/// Number of words of the lists of drawn instances of `levels` levels, 1 to [`MAX_LEVELS`]: [`list_stride`]
/// each. A single list needs only one word per instance.
pub fn list_words(instances: usize, levels: usize) -> usize {
    if levels == 1 { instances } else { levels * list_stride(instances) }
}

impl LodView {
    /// Checks the ranges.
    ///
    /// # Errors
    /// [`InputError`] that names the field.
    pub fn validate(&self) -> Result<(), InputError> {
        if !self.clip_from_world.is_finite() {
            return Err(InputError::new("view.clip_from_world", self.clip_from_world, "must be finite"));
        }
        for (field, position) in [("view.eye", self.eye), ("view.center", self.center)] {
            if !position.is_finite() {
                return Err(InputError::new(field, position, "must be finite"));
            }
        }
        if !(self.radius >= 0.0 && self.radius.is_finite()) {
            return Err(InputError::new("view.radius", self.radius, "must be finite, and not negative"));
        }
        if self.steps == 0 || self.steps > 1 << 16 {
            return Err(InputError::new("view.steps", self.steps, "must be in 1..=65536"));
        }
        if !(1..=MAX_INFLUENCES as u32).contains(&self.max_influences) {
            return Err(InputError::new(
                "view.max_influences",
                self.max_influences,
                format!("must be in 1..={MAX_INFLUENCES}"),
            ));
        }
        self.fade_range
            .validate()
            .map_err(|error| InputError::new(format!("view.{}", error.path), error.value, error.bound))
    }

    /// The distance at which a point counts. It equals the distance from the eye straight ahead, is less to the
    /// side, where perspective enlarges, and is 0 beside the eye and behind it. For a point at depth z and
    /// distance d it is z²/d, because a small displacement there moves the point on screen by at most
    /// focal·displacement·d/z² pixels. In a parallel view it is the distance.
    pub fn projected_distance(&self, position: Vec3) -> f32 {
        let towards = position - self.eye;
        let distance = towards.length();
        match self.ahead() {
            None => distance,
            Some(ahead) => {
                let depth = ahead.dot(towards).max(0.0);
                depth * (depth / distance.max(LEAST_NORMAL))
            }
        }
    }

    /// The unit vector ahead, if the view is a perspective.
    pub(crate) fn ahead(&self) -> Option<Vec3> {
        self.clip_from_world.row(3).truncate().try_normalize()
    }

    /// The planes of the view volume: unit normals that point inwards, and distances.
    pub fn planes(&self) -> [Vec4; 6] {
        let [x, y, z, w] = [0, 1, 2, 3].map(|row| self.clip_from_world.row(row));
        // A plane at infinity cuts nothing off.
        let unit = |plane: Vec4| match plane.truncate().length() {
            length if length > 0.0 => plane / length,
            _ => Vec4::W,
        };
        [w + x, w - x, w + y, w - y, z, w - z].map(unit)
    }
}

/// The placement of an instance of uniform scale: rotated about +Y by `turn` radians, then translated.
pub fn placed(at: Vec3, turn: f32, scale: f32) -> Affine {
    let (sine, cosine) = (scale * libm::sinf(turn), scale * libm::cosf(turn));
    [[cosine, 0.0, sine, at.x], [0.0, scale, 0.0, at.y], [-sine, 0.0, cosine, at.z]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::camera;

    fn view() -> LodView {
        LodView {
            clip_from_world: Mat4::IDENTITY,
            eye: Vec3::ZERO,
            fade_range: FadeRange { start: 10.0, end: 30.0 },
            steps: 64,
            max_influences: 8,
            center: Vec3::ZERO,
            radius: 1.0,
            levels: LevelRanges::NONE,
        }
    }

    #[test]
    fn views_are_checked_field_by_field() {
        assert_eq!(view().validate(), Ok(()));
        let refused = |view: LodView| view.validate().expect_err("refused").path;
        assert_eq!(refused(LodView { clip_from_world: Mat4::NAN, ..view() }), "view.clip_from_world");
        assert_eq!(refused(LodView { eye: Vec3::NAN, ..view() }), "view.eye");
        assert_eq!(refused(LodView { center: Vec3::INFINITY, ..view() }), "view.center");
        let error = LodView { center: Vec3::INFINITY, ..view() }.validate().expect_err("refused");
        assert_eq!((error.value.as_str(), error.bound.as_str()), ("[inf, inf, inf]", "must be finite"));
        assert_eq!(refused(LodView { radius: -1.0, ..view() }), "view.radius");
        assert_eq!(refused(LodView { steps: 0, ..view() }), "view.steps");
        assert_eq!(refused(LodView { max_influences: 0, ..view() }), "view.max_influences");
        assert_eq!(refused(LodView { max_influences: 9, ..view() }), "view.max_influences");
        let fade = |start, end| LodView { fade_range: FadeRange { start, end }, ..view() };
        assert_eq!(refused(fade(30.0, 30.0)), "view.fade_range.start");
        assert_eq!(refused(fade(10.0, f32::INFINITY)), "view.fade_range.end");
    }

    #[test]
    fn levels_follow_distances() {
        let ranges = LevelRanges::new(&[-1.0, 5.0, 5.0, 9.0]).expect("ascending");
        assert_eq!(
            [-2.0, -1.0, 4.9, 5.0, 9.0, f32::MAX].map(|distance| ranges.at(distance)),
            [0, 1, 1, 3, 4, 4]
        );
        assert_eq!(ranges.distances(), [-1.0, 5.0, 5.0, 9.0]);
        assert_eq!(LevelRanges::new(&[]), Ok(LevelRanges::NONE));
        assert_eq!(LevelRanges::NONE.at(f32::MAX), 0);
        let refused = |distances: &[f32]| LevelRanges::new(distances).expect_err("refused").path;
        assert_eq!(refused(&[2.0, 1.0]), "levels[1]");
        assert_eq!(refused(&[1.0, f32::NAN]), "levels[1]");
        assert_eq!(refused(&[f32::INFINITY]), "levels[0]");
        assert_eq!(refused(&[0.0; 16]), "levels.len");
        assert_eq!(LevelRanges::new(&[f32::MAX; 15]).map(|ranges| ranges.distances().len()), Ok(15));
    }

    #[test]
    fn lists_can_be_bound() {
        assert_eq!([1, 63, 64, 65].map(list_stride), [64, 64, 64, 128]);
        assert_eq!(
            [(63, 1), (63, 2), (64, 3), (65, 16)].map(|(count, levels)| list_words(count, levels)),
            [63, 128, 192, 2048]
        );
    }

    #[test]
    fn what_lies_aside_counts_as_nearer() {
        let eye = Vec3::new(1.0, 2.0, 3.0);
        let look = camera::rh::view::look_at_mat4(eye, eye + Vec3::X, Vec3::Y);
        let projection = camera::rh::proj::directx::perspective(1.0, 1.5, 0.1, 90.0);
        let projected_distance = |x, y, z| {
            LodView { clip_from_world: projection * look, eye, ..view() }
                .projected_distance(eye + Vec3::new(x, y, z))
        };
        assert!((projected_distance(7.0, 0.0, 0.0) - 7.0).abs() < 1e-5);
        assert!((projected_distance(4.0, 0.0, -3.0) - 16.0 / 5.0).abs() < 1e-5);
        assert_eq!(
            [
                projected_distance(0.0, 0.0, 0.0),
                projected_distance(0.0, 5.0, 0.0),
                projected_distance(-5.0, 1.0, 0.0)
            ],
            [0.0; 3]
        );
        // The identity is a parallel view.
        assert_eq!(view().projected_distance(Vec3::new(0.0, 3.0, -4.0)), 5.0);
    }

    #[test]
    fn planes_hold_the_cube_of_clip_space() {
        let planes = view().planes();
        let inside = |p: Vec3| planes.iter().all(|plane| plane.dot(p.extend(1.0)) >= 0.0);
        assert!(inside(Vec3::new(0.9, -0.9, 0.1)) && inside(Vec3::new(0.0, 0.0, 0.9)));
        for outside in [
            Vec3::new(1.1, 0.0, 0.5),
            Vec3::new(0.0, -1.1, 0.5),
            Vec3::new(0.0, 0.0, -0.1),
            Vec3::new(0.0, 0.0, 1.1),
        ] {
            assert!(!inside(outside), "{outside}");
        }
    }
}
