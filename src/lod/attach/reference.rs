//! Placements of attached meshes: the CPU reference of `kernels/lod/attach.wgsl`.

use glam::IVec3;

use super::{AttachParams, Attachment};
use crate::asset::Affine;
use crate::lod::SceneInstance;

/// The rows of an attached mesh: the transform from its space to the corner of a cell. `instances` are those of the scene,
/// `allowed` what the views of the frame allow each of them, and `model_matrices` those of the character's bones.
///
/// # Panics
/// For an attachment to an instance or a bone that is not there.
pub fn attached(
    params: &AttachParams,
    attachment: &Attachment,
    cell: IVec3,
    (instances, allowed): (&[SceneInstance], &[f32]),
    model_matrices: &[Affine],
) -> Affine {
    let character = (params.first + attachment.character) as usize;
    let instance = &instances[character];
    let ([x, y, z], at) = (instance.axes(), instance.position(cell));
    if allowed[character] < 0.0 {
        return std::array::from_fn(|row| [0.0, 0.0, 0.0, at[row]]);
    }
    let placement = std::array::from_fn(|row| [x[row], y[row], z[row], at[row]]);
    let bone = &model_matrices[(attachment.character * params.bones + attachment.bone) as usize];
    product(&placement, &product(bone, &attachment.offset))
}

/// The product `a · b`, which applies b first.
pub(super) fn product(a: &Affine, b: &Affine) -> Affine {
    a.map(|[x, y, z, moved]| {
        let entry = |at: usize| x * b[0][at] + y * b[1][at] + z * b[2][at];
        [entry(0), entry(1), entry(2), entry(3) + moved]
    })
}
