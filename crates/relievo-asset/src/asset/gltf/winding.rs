//! Winding: reverses triangles that are mirrored at rest, so that they are counter-clockwise seen from outside when the mesh is
//! drawn. The sign of the determinant decides (glTF 2.0, section 3.7.4). For a skinned mesh, the matrix is each joint's global
//! transform times its inverse bind matrix, because the transform of the mesh's own node has no effect.

use glam::DMat4;

use crate::asset::Mesh;
use crate::asset::skeleton::{Skeleton, Skin};

/// For each bone, whether its global transform mirrors in the rest pose. A scale of 0 counts as positive.
pub fn mirrored(skeleton: &Skeleton) -> Vec<bool> {
    let mut mirrored: Vec<bool> = Vec::with_capacity(skeleton.len());
    for bone in skeleton.bones() {
        // Only signs are multiplied: the product of many scales could overflow or underflow.
        let is_turned = bone.rest.scale.iter().filter(|scale| **scale < 0.0).count() % 2 == 1;
        mirrored.push(is_turned != bone.parent.is_some_and(|parent| mirrored[parent as usize]));
    }
    mirrored
}

/// For each bone of a skin, whether it mirrors the vertices that follow it; empty if no bone mirrors. `mirrored` has one entry
/// per bone of the skeleton.
pub fn mirrors(mirrored: &[bool], skin: &Skin) -> Vec<bool> {
    let is_inverted = |bind: &[f32; 16]| DMat4::from_cols_array(&bind.map(f64::from)).determinant() < 0.0;
    let binds = skin.bones.iter().zip(&skin.inverse_binds);
    let all: Vec<_> = binds.map(|(bone, bind)| mirrored[*bone as usize] != is_inverted(bind)).collect();
    if all.contains(&true) { all } else { Vec::new() }
}

/// Reverses each triangle for which the weights of mirroring bones, added over the three corners, exceed 1.5.
pub fn turn_mirrored(mesh: &mut Mesh, mirrors: &[bool]) {
    // Early exit for skins without mirroring bones, because files may have many meshes with large skins.
    if mirrors.is_empty() {
        return;
    }
    let is_mirrored = |bone: u32| mirrors[bone as usize];
    let weight = |vertex: u32| -> f32 {
        let mirrored =
            mesh.influences.of(vertex as usize).iter().filter(|influence| is_mirrored(influence.bone));
        mirrored.map(|influence| influence.weight).sum()
    };
    for triangle in mesh.indices.chunks_exact_mut(3) {
        if triangle.iter().map(|vertex| weight(*vertex)).sum::<f32>() > 1.5 {
            triangle.swap(1, 2);
        }
    }
}
