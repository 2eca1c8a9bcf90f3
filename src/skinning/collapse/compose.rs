//! Composition of a chain of bones into one translation, rotation and scale.

use glam::{DQuat, DVec3};

use crate::asset::clip::{Clip, Interpolation, TransformPart};
use crate::asset::{Skeleton, Transform};

/// Tolerance for uniform scale: the largest difference between the scales along the axes, as a fraction of the largest
/// scale.
const UNEVEN: f32 = 1e-4;

/// The transform of a bone relative to a bone above it, composed along the chain of bones between them. All bones of
/// the chain except the last have uniform scale: equal along all axes, apart from the signs in `signs`.
#[derive(Clone, Copy)]
pub(super) struct Composed {
    pub translation: DVec3,
    pub rotation: DQuat,
    pub scale: DVec3,
    pub signs: DVec3,
}

impl Composed {
    pub(super) const IDENTITY: Self =
        Self { translation: DVec3::ZERO, rotation: DQuat::IDENTITY, scale: DVec3::ONE, signs: DVec3::ONE };

    pub(super) fn point(&self, point: DVec3) -> DVec3 {
        self.translation + self.vector(point)
    }

    pub(super) fn vector(&self, vector: DVec3) -> DVec3 {
        self.rotation * (self.scale * vector)
    }

    /// Appends the rotation of a bone below. Uniform scale leaves the rotation axis unchanged; the signs mirror it.
    pub(super) fn turned(&self, below: DQuat) -> DQuat {
        let axis = self.signs.element_product() * self.signs * DVec3::new(below.x, below.y, below.z);
        self.rotation * DQuat::from_xyzw(axis.x, axis.y, axis.z, below.w)
    }

    /// Appends a bone below, whose scale has the given signs.
    pub(super) fn with(&self, below: &Transform, signs: DVec3) -> Self {
        let [translation, scale] =
            [below.translation, below.scale].map(|vector| DVec3::from(vector.map(f64::from)));
        Self {
            translation: self.point(translation),
            rotation: self.turned(DQuat::from_array(below.rotation.map(f64::from))),
            scale: self.scale * scale,
            signs: self.signs * signs,
        }
    }

    pub(super) fn transform(&self) -> Transform {
        Transform {
            translation: self.translation.as_vec3().to_array(),
            rotation: self.rotation.normalize().as_quat().to_array(),
            scale: self.scale.as_vec3().to_array(),
        }
    }
}

/// The signs of the scales along each axis, if the scales are uniform except for signs; otherwise `None`.
pub(super) fn signs(scales: impl IntoIterator<Item = [f32; 3]>) -> Option<DVec3> {
    let scales: Vec<[f32; 3]> = scales.into_iter().collect();
    let largest = scales.iter().max_by(|a, b| a[0].abs().total_cmp(&b[0].abs()))?;
    let signs = largest.map(|scale| if scale < 0.0 { -1.0_f32 } else { 1.0 });
    let is_even = |scale: &[f32; 3]| {
        let [x, y, z] = [0, 1, 2].map(|axis| signs[axis] * scale[axis]);
        (x - y).abs().max((x - z).abs()) <= UNEVEN * largest[0].abs()
    };
    scales.iter().all(is_even).then(|| DVec3::from(signs.map(f64::from)))
}

/// The signs of a bone's scale in a clip, valid at keys and between them; `None` if the scale is not uniform.
pub(super) fn signs_in(clip: &Clip, bone: usize) -> Option<DVec3> {
    signs(
        clip.stored_keys(clip.track(bone, TransformPart::Scale))
            .values
            .into_iter()
            .map(|[x, y, z, _]| [x, y, z]),
    )
}

/// Whether one part of a bone's transform (translation, rotation or scale) is constant in a clip.
pub(super) fn is_constant(clip: &Clip, bone: usize, part: TransformPart) -> bool {
    let keys = clip.stored_keys(clip.track(bone, part));
    let is_spline = keys.interpolation == Interpolation::CubicSpline && !keys.times.is_empty();
    let first = keys.values[usize::from(is_spline)];
    keys.values.iter().enumerate().all(|(at, value)| {
        let is_tangent = is_spline && at % 3 != 1;
        *value == if is_tangent { [0.0; 4] } else { first }
    })
}

/// The rest transform of the last bone of a chain, relative to the bone above the chain.
pub(super) fn rest(skeleton: &Skeleton, chain: &[usize]) -> Transform {
    let rest = |bone: usize| skeleton.bones()[bone].rest;
    let [bone] = chain else {
        let add = |above: Composed, bone: &usize| {
            above.with(&rest(*bone), signs([rest(*bone).scale]).unwrap_or(DVec3::ONE))
        };
        return chain.iter().fold(Composed::IDENTITY, add).transform();
    };
    rest(*bone)
}
