//! Bounds of a model's motion: a sphere for each clip, and the largest displacement by the fade of influences.

#[cfg(feature = "gpu")]
use glam::Vec3;

use super::bounding_sphere::BoundingSphere;
use super::extent::stray_of;
use super::pose::poses_of;
use crate::InputError;
use crate::asset::{Model, MotionBounds};

/// The bounds of a model's motion. If the model's own bounds do not fit it, every clip is sampled 60 times a second.
///
/// # Errors
/// [`InputError`] for a clip of more than an hour, and for parts that do not match each other.
pub(crate) fn motion_bounds(model: &Model) -> Result<MotionBounds, InputError> {
    if let Some(known) = known(model) {
        return Ok(known.clone());
    }
    let stray = stray(model)?;
    let sphere = |clip| {
        let BoundingSphere { center, radius } = BoundingSphere::in_clip(model, clip);
        center.extend(radius).to_array()
    };
    Ok(MotionBounds::new(model, (0..model.clips.len()).map(sphere).collect(), stray))
}

/// The largest displacement of a vertex per unit of influence fade in any clip.
///
/// # Errors
/// As for [`motion_bounds`].
pub(super) fn stray(model: &Model) -> Result<f32, InputError> {
    if let Some(known) = known(model) {
        return Ok(known.stray);
    }
    let poses = model.clips.iter().map(poses_of).collect::<Result<Vec<_>, _>>()?;
    stray_of(model, poses.into_iter().max().unwrap_or(1))
}

fn known(model: &Model) -> Option<&MotionBounds> {
    model.motion.as_ref().filter(|motion| motion.fit(model))
}

/// The bounding sphere of each clip.
#[cfg(feature = "gpu")]
pub(crate) fn spheres(bounds: &MotionBounds) -> Vec<BoundingSphere> {
    let sphere =
        |[x, y, z, radius]: &[f32; 4]| BoundingSphere { center: Vec3::new(*x, *y, *z), radius: *radius };
    bounds.spheres.iter().map(sphere).collect()
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use super::*;

    fn cooked(model: &Model) -> Model {
        let bytes = crate::skinning::cook(&model.clone().into(), &mut |_| ControlFlow::Continue(()));
        Model::from_rlv(&bytes.expect("cooked").expect("not broken off")).expect("read")
    }

    /// A package has the bounds that sampling its model gives, to the bit. They belong to this model alone.
    #[test]
    fn packages_have_the_bounds_of_their_models() {
        let mut model = cooked(&crate::samples::creature().expect("valid"));
        let known = model.motion.take().expect("bounds");
        let sampled = motion_bounds(&model).expect("sampled");
        assert_eq!((known.spheres.len(), known.spheres == sampled.spheres), (3, true));
        assert!(known.stray > 0.0 && known.stray.to_bits() == sampled.stray.to_bits());
        let poses = model.clips.iter().map(|clip| poses_of(clip).expect("short")).max().expect("a clip");
        let extent = crate::skinning::Extent::of_model(&model, &[0, 1, 2], poses).expect("valid");
        assert_eq!(extent.stray.to_bits(), known.stray.to_bits());
        let changes: [fn(&mut Model); 5] = [
            |model| model.clips.swap(0, 1),
            |model| model.meshes[0].positions[7][1] += 1.0,
            |model| model.skins[0].inverse_binds[3][12] += 1.0,
            |model| model.clips.truncate(2),
            |model| model.motion.iter_mut().for_each(|motion| motion.spheres[0][3] = f32::NAN),
        ];
        for change in changes {
            let mut other = Model { motion: Some(known.clone()), ..model.clone() };
            assert!(other.motion.as_ref().is_some_and(|motion| motion.fit(&other)));
            change(&mut other);
            assert!(!other.motion.as_ref().is_some_and(|motion| motion.fit(&other)));
            assert!(motion_bounds(&other).is_ok_and(|found| found.fit(&other)));
        }
        // What does not move vertices may change.
        model.motion = Some(known.clone());
        model.meshes[0].uv[0] = [0.5; 2];
        assert_eq!(motion_bounds(&model), Ok(known));
    }

    #[test]
    fn models_without_clips_have_no_bounds() {
        assert_eq!(cooked(&crate::samples::rock().expect("valid")).motion, None);
    }
}
