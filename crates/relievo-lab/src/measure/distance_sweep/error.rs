//! Measures how far points that follow bones are drawn from where full evaluation puts them.

use glam::{DAffine3, DMat3, DVec2, DVec3};
use relievo::InputError;
use relievo::asset::{Affine, Model, bone_radii};
use relievo::ops::animation::Pose;
use relievo::scene::{InstanceId, Scene, WatchedBone};

use crate::measure::distance_sweep::report::SweepError;
use crate::measure::options::{FIELD_OF_VIEW, NEAR, PICTURE};
use crate::measure::tally::Tally;

/// Collects the errors of watched bones, frame by frame.
pub(super) struct Errors<'a> {
    model: &'a Model,
    /// For each bone, the distance in the model's units of the furthest vertex that follows it.
    radii: Vec<f32>,
    /// The distance of the camera from the origin, on +Z.
    distance: f64,
    pixels: Tally,
    max_units: f64,
}

impl<'a> Errors<'a> {
    pub fn new(model: &'a Model, distance: f32) -> Self {
        let radii = bone_radii(model.skeleton.len(), &model.skins, &model.meshes);
        Self { model, radii, distance: distance.into(), pixels: Tally::new(), max_units: 0.0 }
    }

    /// Indices of the bones whose errors are measured: those that vertices follow.
    pub fn bones(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.radii.len()).filter(|bone| self.radii[*bone] > 0.0)
    }

    /// Adds a frame: the bones of visible instances as the scene skinned them, at the scene's present time.
    pub fn add(&mut self, scene: &Scene, bones: &[WatchedBone]) -> Result<(), InputError> {
        for own in bones.chunk_by(|a, b| a.instance == b.instance) {
            let Some(fresh) = self.evaluated(scene, own[0].instance)? else { continue };
            for bone in own.iter().filter(|bone| bone.is_current) {
                self.add_bone(&bone.world_from_bone(), &fresh[bone.bone], self.radii[bone.bone].into());
            }
        }
        Ok(())
    }

    /// The transform of each bone of an instance from bone space to world coordinates, by full evaluation on the host.
    fn evaluated(&self, scene: &Scene, instance: InstanceId) -> Result<Option<Vec<DAffine3>>, InputError> {
        let Some(time) = scene.clip_time(instance)? else { return Ok(None) };
        let pose = Pose::on_host(&self.model.skeleton, &self.model.clips[time.clip], time.seconds);
        let world = scene.world_from_model(instance)?;
        Ok(Some(pose.model_matrices.iter().map(|matrix| world * affine(matrix)).collect()))
    }

    fn add_bone(&mut self, stale: &DAffine3, fresh: &DAffine3, radius: f64) {
        for axis in DVec3::AXES {
            for point in [axis * radius, -axis * radius] {
                let [stale, fresh] = [stale, fresh].map(|matrix| matrix.transform_point3(point));
                let (Some(drawn), Some(right)) = (self.pixel(stale), self.pixel(fresh)) else { continue };
                if is_inside(right) || is_inside(drawn) {
                    self.pixels.add(drawn.distance(right));
                    self.max_units = self.max_units.max(stale.distance(fresh));
                }
            }
        }
    }

    /// The position of a point in the picture, in pixels from its middle; `None` for a point before the near plane.
    fn pixel(&self, point: DVec3) -> Option<DVec2> {
        let depth = self.distance - point.z;
        let focal = 0.5 * f64::from(PICTURE[1]) / (0.5 * f64::from(FIELD_OF_VIEW)).tan();
        (depth > f64::from(NEAR)).then(|| focal / depth * DVec2::new(point.x, point.y))
    }

    pub fn finish(self) -> SweepError {
        SweepError {
            max_pixels: self.pixels.max,
            rms_pixels: self.pixels.rms(),
            max_units: self.max_units,
            points: self.pixels.count,
        }
    }
}

fn is_inside(pixel: DVec2) -> bool {
    let half = 0.5 * DVec2::from(PICTURE.map(f64::from));
    pixel.abs().cmple(half).all()
}

/// A matrix of three rows.
fn affine([x, y, z]: &Affine) -> DAffine3 {
    let column = |at: usize| DVec3::new(x[at].into(), y[at].into(), z[at].into());
    DAffine3::from_mat3_translation(DMat3::from_cols(column(0), column(1), column(2)), column(3))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A point 10 units before a camera that is 30 units from the origin moves to the right, and ahead.
    #[test]
    fn errors_are_projected_from_where_the_camera_stands() {
        let model = relievo_samples::creature().expect("built in");
        let focal = 540.0 * 3.0_f64.sqrt();
        let at = |x: f64, z: f64| DAffine3::from_translation(DVec3::new(x, 0.0, z));
        let found = |stale: DAffine3, fresh: DAffine3| {
            let mut errors = Errors::new(&model, 30.0);
            errors.add_bone(&stale, &fresh, 0.0);
            errors.finish()
        };
        let error = found(at(0.1, 20.0), at(0.0, 20.0));
        assert!((error.max_pixels - focal * 0.01).abs() < 1e-4 && (error.max_units - 0.1).abs() < 1e-12);
        assert_eq!((error.points, error.max_pixels == error.rms_pixels), (6, true));
        assert_eq!(found(at(0.0, 10.0), at(0.0, 20.0)).max_pixels, 0.0);
        // Behind the camera, and beside the picture.
        assert_eq!(found(at(0.1, 31.0), at(0.0, 31.0)).points, 0);
        assert_eq!(found(at(11.0, 20.0), at(11.0, 20.0)).points, 0);
    }
}
