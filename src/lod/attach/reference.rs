//! Placements of attached meshes: the CPU reference of `kernels/lod/attach.wgsl`.

use glam::IVec3;

use super::{AttachParams, Attachment, KeptBone};
use crate::asset::Affine;
use crate::lod::SceneInstance;
use crate::shared::lod::allowed::Allowed;

/// Transform from an attached mesh to its character's model space: the bone's model matrix times the mesh's offset.
///
/// # Panics
/// If the attachment names a bone that does not exist.
pub fn local(params: &AttachParams, attachment: &Attachment, model_matrices: &[Affine]) -> Affine {
    let bone = &model_matrices[(attachment.character * params.bones + attachment.bone) as usize];
    product(bone, &attachment.offset)
}

/// The instances of a scene, and the displacement that the frame's views allow each instance.
#[derive(Debug, Clone, Copy)]
pub struct AttachScene<'a> {
    /// All instances of the scene.
    pub instances: &'a [SceneInstance],
    /// Allowed displacement of each instance, in model units; negative if no view sees the instance.
    pub allowed: &'a [Allowed],
}

/// Placement of an attached mesh: transform from mesh space to the world, relative to the corner of `cell`. `local` is the
/// product of bone and offset.
///
/// # Panics
/// If the attachment names an instance that does not exist.
pub fn attached(
    params: &AttachParams,
    attachment: &Attachment,
    cell: IVec3,
    scene: AttachScene<'_>,
    local: &Affine,
) -> Affine {
    let AttachScene { instances, allowed } = scene;
    let character = (params.first + attachment.character) as usize;
    let instance = &instances[character];
    let ([x, y, z], at) = (instance.axes(), instance.position(cell));
    if allowed[character].displacement < 0.0 {
        return std::array::from_fn(|row| [0.0, 0.0, 0.0, at[row]]);
    }
    let placement = std::array::from_fn(|row| [x[row], y[row], z[row], at[row]]);
    product(&placement, local)
}

/// Product of bone and offset in the last frame, if it was kept; otherwise `local`, the product of this frame. `kept` holds the
/// attachment's products of the last two frames.
pub fn last_local(
    params: &AttachParams,
    attachment: &Attachment,
    kept: &[KeptBone; 2],
    local: &Affine,
) -> Affine {
    let last = &kept[(params.frame as usize + 1) % 2];
    match params.last_frame != 0 && last.frame == params.last_frame && last.key == attachment.key {
        true => last.rows,
        false => *local,
    }
}

/// The product `a · b`, which applies `b` first.
pub fn product(a: &Affine, b: &Affine) -> Affine {
    a.map(|[x, y, z, moved]| {
        let entry = |at: usize| x * b[0][at] + y * b[1][at] + z * b[2][at];
        [entry(0), entry(1), entry(2), entry(3) + moved]
    })
}
