//! Model matrices from local transforms: the CPU reference of `kernels/animation/local_to_model.wgsl`.

use crate::animation::order::{Order, SlotParent};
use crate::asset::skeleton::Skeleton;
use crate::asset::transform::{AFFINE_IDENTITY, Affine, Transform};

/// Model matrix of each bone of one instance, from the bones' local transforms.
///
/// # Panics
/// If there are fewer local transforms than bones.
pub fn local_to_model(skeleton: &Skeleton, locals: &[Transform]) -> Vec<Affine> {
    let mut model_matrices = vec![AFFINE_IDENTITY; skeleton.len()];
    local_to_model_into(skeleton, locals, &mut model_matrices);
    model_matrices
}

/// Computes the same as [`local_to_model()`] for many instances, without allocation. The slices hold one instance after another,
/// with one local transform and one matrix per bone.
///
/// # Panics
/// If a local transform or matrix of the last instance is missing.
pub fn local_to_model_into(skeleton: &Skeleton, locals: &[Transform], model_matrices: &mut [Affine]) {
    let bones = skeleton.len();
    for (locals, model_matrices) in locals.chunks(bones).zip(model_matrices.chunks_mut(bones)) {
        for (bone, node) in skeleton.bones().iter().enumerate() {
            let local = affine(&locals[bone]);
            model_matrices[bone] =
                node.parent.map_or(local, |parent| product(&model_matrices[parent as usize], &local));
        }
    }
}

/// Matrix translation · rotation · scale of a transform.
pub fn affine(transform: &Transform) -> Affine {
    let [x, y, z, w] = transform.rotation;
    let [sx, sy, sz] = transform.scale;
    let [tx, ty, tz] = transform.translation;
    let (x2, y2, z2) = (x + x, y + y, z + z);
    [
        [(1.0 - (y * y2 + z * z2)) * sx, (x * y2 - w * z2) * sy, (x * z2 + w * y2) * sz, tx],
        [(x * y2 + w * z2) * sx, (1.0 - (x * x2 + z * z2)) * sy, (y * z2 - w * x2) * sz, ty],
        [(x * z2 - w * y2) * sx, (y * z2 + w * x2) * sy, (1.0 - (x * x2 + y * y2)) * sz, tz],
    ]
}

/// Product `a · b` of two affine matrices. The product transforms a point by `b` first, then by `a`.
pub fn product(a: &Affine, b: &Affine) -> Affine {
    // Loops over whole rows let compilers vectorize. Closures took twice as long.
    let mut product = [[0.0; 4]; 3];
    for (row, [x, y, z, moved]) in product.iter_mut().zip(a) {
        for (column, entry) in row.iter_mut().enumerate() {
            *entry = x * b[0][column] + y * b[1][column] + z * b[2][column];
        }
        row[3] += moved;
    }
    product
}

/// Computes the model matrices of the updated slots of one instance. `updated_bones` holds one bit per slot. If a slot's bit is
/// set, the bits of its descendants must also be set.
///
/// # Panics
/// If a slice has fewer bits, local transforms or matrices than there are bones.
pub fn local_to_model_updated(
    order: &Order,
    updated_bones: &[u32],
    locals: &[Transform],
    model_matrices: &mut [Affine],
) {
    for (at, slot) in order.slots.iter().enumerate() {
        if updated_bones[at / 32] >> (at % 32) & 1 == 0 {
            continue;
        }
        let local = affine(&locals[slot.bone as usize]);
        model_matrices[slot.bone as usize] = match slot.parent {
            SlotParent::Root => local,
            SlotParent::PreviousSlot => product(&model_matrices[order.slots[at - 1].bone as usize], &local),
            SlotParent::Bone(parent) => product(&model_matrices[parent as usize], &local),
        };
    }
}
