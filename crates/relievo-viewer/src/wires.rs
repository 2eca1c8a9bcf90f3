//! The edges of the triangles that are drawn, painted over the picture.
//!
//! The device chooses levels, and tells how many instances and triangles it drew at each. So the level of an object's instances is
//! known where all of them have the same one, and an object of which several levels are in view at once has no lines.

use std::collections::HashSet;

use egui::{Color32, Pos2, Stroke};
use glam::{DAffine3, DMat4, DQuat, DVec3};
use relievo::asset::{Mesh, Model};
use relievo::scene::{InstanceId, ObjectStatistics, ViewStatistics};
use relievo_scene_file::{World, WorldKind, WorldObject};

use crate::overlay::Projected;

/// Largest number of triangles whose edges are painted: each takes time of the host.
const TRIANGLES: usize = 30_000;

/// What was painted.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Wires {
    /// Number of triangles with painted edges, those that face away among them.
    pub triangles: usize,
    /// What has no lines, and why.
    pub left_out: Vec<String>,
}

/// Paints the edges of triangles that face the camera, as far as it is known which are drawn.
pub fn paint_wires(
    painter: &egui::Painter,
    on: Projected<'_>,
    world: &World,
    seen: Option<&ViewStatistics>,
) -> Wires {
    let mut wires = Wires::default();
    for object in &world.objects {
        let counts = seen.and_then(|seen| seen.objects.iter().find(|other| other.object == object.object));
        let level = match drawn_level(object, counts) {
            Ok(Some(level)) => level,
            Ok(None) => continue,
            Err(why) => {
                wires.left_out.push(format!("{}: {why}", object.name));
                continue;
            }
        };
        let Some(model) = &object.model else { continue };
        for instance in world.scene.instances(object.object).unwrap_or_default() {
            let Some(bones) = world_from_bones(world, object, model, instance) else { continue };
            for mesh in &model.meshes {
                let indices = indices(mesh, level);
                if wires.triangles + indices.len() / 3 > TRIANGLES {
                    wires.left_out.push(format!("{}: more than {TRIANGLES} triangles", object.name));
                    return wires;
                }
                wires.triangles += indices.len() / 3;
                paint_mesh(painter, on, &posed(mesh, model, &bones), indices, mesh.double_sided);
            }
        }
    }
    wires
}

/// The level of all instances of an object in view; `None` if none is in view.
fn drawn_level(
    object: &WorldObject,
    counts: Option<&ObjectStatistics>,
) -> Result<Option<usize>, &'static str> {
    if let WorldKind::Terrain | WorldKind::Relief = object.kind {
        return Err("its triangles are made on the device");
    }
    if object.model.iter().flat_map(|model| &model.meshes).any(|mesh| !mesh.targets.is_empty()) {
        return Err("its vertices morph");
    }
    let levels = counts.iter().flat_map(|counts| counts.levels.iter().enumerate());
    let drawn: Vec<usize> = levels.filter(|(_, level)| level.instances > 0).map(|(at, _)| at).collect();
    let level = match drawn[..] {
        [] => return Ok(None),
        [level] => level,
        _ => return Err("several levels at once; choose one level above"),
    };
    // The scene may have coarser levels than the model.
    let own: usize =
        object.model.iter().flat_map(|model| &model.meshes).map(|mesh| indices(mesh, level).len() / 3).sum();
    let is_own = counts.is_some_and(|counts| {
        let drawn = &counts.levels[level];
        drawn.triangles == u64::from(drawn.instances) * own as u64
    });
    if is_own { Ok(Some(level)) } else { Err("this level is not the model's own") }
}

/// The triangles of a level; a mesh with fewer levels has its coarsest one.
fn indices(mesh: &Mesh, level: usize) -> &[u32] {
    match level.min(mesh.levels.len()).checked_sub(1) {
        None => &mesh.indices,
        Some(coarser) => &mesh.levels[coarser].indices,
    }
}

/// The transforms of an instance's bones into the world: in the pose of its clip, or at rest for a mesh.
fn world_from_bones(
    world: &World,
    object: &WorldObject,
    model: &Model,
    instance: InstanceId,
) -> Option<Vec<DAffine3>> {
    let count = model.skeleton.len();
    if object.kind == WorldKind::Character {
        let pose = world.scene.pose(instance).ok()?;
        return (0..count).map(|bone| pose.world_from_bone(bone).ok()).collect();
    }
    let placed = world.scene.world_from_model(instance).ok()?;
    let mut bones: Vec<DAffine3> = Vec::with_capacity(count);
    for bone in model.skeleton.bones() {
        let [x, y, z, w] = bone.rest.rotation.map(f64::from);
        let local = DAffine3::from_scale_rotation_translation(
            DVec3::from(bone.rest.scale.map(f64::from)),
            DQuat::from_xyzw(x, y, z, w).normalize(),
            DVec3::from(bone.rest.translation.map(f64::from)),
        );
        bones.push(bone.parent.map_or(placed, |parent| bones[parent as usize]) * local);
    }
    Some(bones)
}

/// The vertices of a mesh in the world.
fn posed(mesh: &Mesh, model: &Model, bones: &[DAffine3]) -> Vec<DVec3> {
    let skin = &model.skins[mesh.skin];
    let binds = skin.inverse_binds.iter().zip(&skin.bones).map(|(bind, bone)| {
        bones[*bone as usize] * DAffine3::from_mat4(DMat4::from_cols_array(&bind.map(f64::from)))
    });
    let binds: Vec<DAffine3> = binds.collect();
    let place = |(vertex, position): (usize, &[f32; 3])| {
        let position = DVec3::from(position.map(f64::from));
        let parts = mesh.influences.of(vertex).iter().map(|influence| {
            f64::from(influence.weight) * binds[influence.bone as usize].transform_point3(position)
        });
        parts.sum()
    };
    mesh.positions.iter().enumerate().map(place).collect()
}

/// Paints each edge of a mesh once, if a triangle beside it is visible from the camera's side.
fn paint_mesh(
    painter: &egui::Painter,
    on: Projected<'_>,
    vertices: &[DVec3],
    indices: &[u32],
    is_double_sided: bool,
) {
    let places: Vec<Option<Pos2>> = vertices.iter().map(|vertex| on.at(*vertex)).collect();
    let eye = on.camera.world();
    let stroke = Stroke::new(0.8, Color32::from_rgba_unmultiplied(255, 255, 255, 150));
    let mut painted = HashSet::new();
    for triangle in indices.as_chunks::<3>().0 {
        let [a, b, c] = triangle.map(|corner| vertices[corner as usize]);
        let faces = (b - a).cross(c - a).dot(eye - a);
        if faces <= 0.0 && !is_double_sided {
            continue;
        }
        for (from, to) in [(0, 1), (1, 2), (2, 0)].map(|(from, to)| (triangle[from], triangle[to])) {
            if let (Some(at), Some(end)) = (places[from as usize], places[to as usize])
                && painted.insert((from.min(to), from.max(to)))
            {
                painter.line_segment([at, end], stroke);
            }
        }
    }
}
