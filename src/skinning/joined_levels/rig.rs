//! Matches the bones of one model to the bones of another by their names.

use crate::InputError;
use crate::asset::{Model, Skeleton};

/// For each skin of `model`, the bones of `near` that its bones become. `path` names the model in errors.
///
/// # Errors
/// [`InputError`] for a bone whose name is missing or not unique. Skins that no mesh follows are not checked.
pub(super) fn bones(near: &Model, model: &Model, path: &str) -> Result<Vec<Vec<u32>>, InputError> {
    if is_same(&near.skeleton, &model.skeleton) {
        return Ok(model.skins.iter().map(|skin| skin.bones.clone()).collect());
    }
    let is_used = |skin: usize| model.meshes.iter().any(|mesh| mesh.skin == skin && !mesh.indices.is_empty());
    let of_skin = |skin: usize| {
        let bones = model.skins[skin].bones.iter().enumerate();
        let matched = bones.map(|(at, bone)| {
            let name = &model.skeleton.bones()[*bone as usize].name;
            let refused = |bound| InputError::new(format!("{path}.skins[{skin}].bones[{at}]"), name, bound);
            matched(&near.skeleton, &model.skeleton, name).map_err(refused)
        });
        matched.collect::<Result<Vec<_>, _>>()
    };
    (0..model.skins.len()).map(|skin| if is_used(skin) { of_skin(skin) } else { Ok(Vec::new()) }).collect()
}

/// Whether two skeletons have the same names and parents in the same order.
fn is_same(one: &Skeleton, other: &Skeleton) -> bool {
    let bones = |skeleton: &Skeleton| -> Vec<(String, Option<u32>)> {
        skeleton.bones().iter().map(|bone| (bone.name.clone(), bone.parent)).collect()
    };
    one.len() == other.len() && bones(one) == bones(other)
}

/// The bone of `near` with this name, which a bone of `far` has. The error says which name the bone must have.
fn matched(near: &Skeleton, far: &Skeleton, name: &str) -> Result<u32, String> {
    let named = |skeleton: &Skeleton| -> Vec<u32> {
        (0..).zip(skeleton.bones()).filter(|(_, bone)| bone.name == name).map(|(at, _)| at).collect()
    };
    if named(far).len() > 1 {
        return Err(format!("must be the name of one bone of its model, which has {}", named(far).len()));
    }
    match named(near)[..] {
        [bone] => Ok(bone),
        [] => Err("must be the name of a bone of models[0]".to_owned()),
        ref several => Err(format!("must be the name of one bone of models[0], which has {}", several.len())),
    }
}
