//! Rebinds skins and influences to the kept bones.

use glam::{DAffine3, DVec3};

use super::choice::Remap;
use super::rest::{Rest, bind};
use crate::InputError;
use crate::asset::skeleton::inverse_bind;
use crate::asset::{Influence, Influences, Mesh, Model, Skin};

/// Tolerance for merging two joints of one bone, as a fraction of the model's size at rest. For every vertex of the
/// skin, the positions to which the two joints take it must be closer together than this.
const SAME: f64 = 1e-4;

/// Rebinds the skins and meshes of a model to the kept bones.
pub(super) fn rebound(
    model: &Model,
    remap: &Remap,
    rest: &Rest,
) -> Result<(Vec<Skin>, Vec<Mesh>), InputError> {
    let (skins, joints): (Vec<Skin>, Vec<Vec<u32>>) =
        (0..model.skins.len()).map(|skin| rebound_skin(model, skin, remap, rest)).unzip();
    for (at, skin) in skins.iter().enumerate() {
        let path = format!("skins[{at}].inverse_binds");
        skin.inverse_binds.iter().try_for_each(|bind| inverse_bind(&path, bind))?;
    }
    let mesh = |(at, mesh): (usize, &Mesh)| {
        let joints = &joints[mesh.skin];
        if joints.iter().copied().eq(0..joints.len() as u32) {
            return Ok(mesh.clone());
        }
        let followed = (0..mesh.vertices()).map(|vertex| {
            let all = mesh.influences.of(vertex).iter();
            all.map(|one| Influence { bone: joints[one.bone as usize], ..*one }).collect()
        });
        let path = format!("meshes[{at}].influences");
        let influences = Influences::new(&path, skins[mesh.skin].bones.len(), followed)?;
        Ok(Mesh { influences, ..mesh.clone() })
    };
    let meshes = model.meshes.iter().enumerate().map(mesh).collect::<Result<_, InputError>>()?;
    Ok((skins, meshes))
}

/// A joint of a skin: its kept bone, and the transform of vertices from bind space into the bone's space.
struct Joint {
    bone: usize,
    bind: DAffine3,
    stored: [f32; 16],
}

/// Makes a skin from the kept bones. Bones that were joints of the old skin come first. Also returns the new index of
/// each joint of the old skin.
fn rebound_skin(model: &Model, index: usize, remap: &Remap, rest: &Rest) -> (Skin, Vec<u32>) {
    let skin = &model.skins[index];
    let corners = corners(model, index);
    let mut joints: Vec<Joint> = Vec::new();
    let mut became = vec![0; skin.bones.len()];
    for of_kept in [true, false] {
        for (at, (bone, stored)) in skin.bones.iter().zip(&skin.inverse_binds).enumerate() {
            let bone = *bone as usize;
            if remap.is_kept(bone) != of_kept {
                continue;
            }
            let mut joint = Joint { bone: remap.follows(bone), bind: bind(stored), stored: *stored };
            if !of_kept {
                joint.bind = rest.offset(&remap.chain(bone)) * joint.bind;
                let matrix = glam::DMat4::from(joint.bind).to_cols_array();
                joint.stored = matrix.map(|value| value as f32);
            }
            let is_same = |other: &Joint| {
                let apart = |corner: &DVec3| {
                    let [a, b] = [&joint, other].map(|joint| {
                        rest.models[joint.bone].transform_point3(joint.bind.transform_point3(*corner))
                    });
                    a.distance(b)
                };
                other.bone == joint.bone && corners.iter().all(|corner| apart(corner) <= SAME * rest.size)
            };
            let known = joints.iter().position(is_same).filter(|_| !of_kept);
            became[at] = known.unwrap_or(joints.len()) as u32;
            if known.is_none() {
                joints.push(joint);
            }
        }
    }
    let indices = remap.indices();
    let bones = joints.iter().map(|joint| indices[joint.bone]).collect();
    let inverse_binds = joints.iter().map(|joint| joint.stored).collect();
    (Skin { name: skin.name.clone(), bones, inverse_binds }, became)
}

/// The corners of a box around all vertices that use a skin.
fn corners(model: &Model, skin: usize) -> Vec<DVec3> {
    let meshes = model.meshes.iter().filter(|mesh| mesh.skin == skin);
    let positions =
        meshes.flat_map(|mesh| &mesh.positions).map(|position| DVec3::from(position.map(f64::from)));
    let (low, high) = positions
        .fold((DVec3::MAX, DVec3::MIN), |(low, high), position| (low.min(position), high.max(position)));
    if low.x > high.x {
        return Vec::new();
    }
    let corner = |at: u32| DVec3::select(glam::BVec3::new(at & 1 > 0, at & 2 > 0, at & 4 > 0), low, high);
    (0..8).map(corner).collect()
}
