//! What stands where, computed by these tests themselves in f64: placements, poses, linear blending, rays.

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};
use relievo::asset::{Affine, Model};
use relievo::ops::animation::Pose;
use relievo::scene::{InstanceId, Placement, Scene};

/// The transform of a placement into the world.
pub fn placed(placement: &Placement) -> DAffine3 {
    let [x, y, z, w] = placement.turn.to_array().map(f64::from);
    let scale = placement.scale.as_dvec3();
    DAffine3::from_scale_rotation_translation(scale, DQuat::from_xyzw(x, y, z, w), placement.world())
}

/// The transform of three rows.
pub fn affine(rows: &Affine) -> DAffine3 {
    let column = |at: usize| DVec3::from(rows.map(|row| f64::from(row[at])));
    DAffine3 { matrix3: DMat3::from_cols(column(0), column(1), column(2)), translation: column(3) }
}

/// The bones of an instance in the world, as it stands now.
pub fn bones(scene: &Scene, model: &Model, instance: InstanceId) -> Vec<DAffine3> {
    let placement = placed(&scene.placement(instance).expect("there"));
    let time = scene.clip_time(instance).expect("there").expect("a character");
    let pose = Pose::on_host(&model.skeleton, &model.clips[time.clip], time.seconds);
    pose.model_matrices.iter().map(|matrix| placement * affine(matrix)).collect()
}

/// The triangles of an instance of a character in the world, as it stands now.
pub fn triangles(scene: &Scene, model: &Model, instance: InstanceId) -> Vec<[DVec3; 3]> {
    let bones = bones(scene, model, instance);
    let mut all = Vec::new();
    for mesh in &model.meshes {
        let skin = &model.skins[mesh.skin];
        let bind = |at: usize| {
            let matrix = DMat4::from_cols_array(&skin.inverse_binds[at].map(f64::from));
            bones[skin.bones[at] as usize] * DAffine3::from_mat4(matrix)
        };
        let palette: Vec<DAffine3> = (0..skin.bones.len()).map(bind).collect();
        let place = |vertex: usize| {
            let position = DVec3::from(mesh.positions[vertex].map(f64::from));
            let influences = mesh.influences.of(vertex).iter();
            let sum: f64 = influences.clone().map(|influence| f64::from(influence.weight)).sum();
            let moved = influences.map(|influence| {
                palette[influence.bone as usize].transform_point3(position) * f64::from(influence.weight)
            });
            moved.sum::<DVec3>() / sum
        };
        let places: Vec<DVec3> = (0..mesh.positions.len()).map(place).collect();
        let corners = mesh.indices.as_chunks::<3>().0.iter();
        all.extend(corners.map(|corners| corners.map(|corner| places[corner as usize])));
    }
    all
}

/// The distance along a unit direction to the nearest of these triangles, seen from outside, and its normal.
pub fn nearest(triangles: &[[DVec3; 3]], at: DVec3, direction: DVec3) -> Option<(f64, DVec3)> {
    let hits = triangles.iter().filter_map(|[a, b, c]| {
        // Möller and Trumbore.
        let (one, other) = (*b - *a, *c - *a);
        let across = direction.cross(other);
        let determinant = one.dot(across);
        if determinant <= 0.0 {
            return None;
        }
        let from = at - *a;
        let u = from.dot(across) / determinant;
        let around = from.cross(one);
        let v = direction.dot(around) / determinant;
        let distance = other.dot(around) / determinant;
        let is_hit = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance >= 0.0;
        is_hit.then(|| (distance, one.cross(other).normalize()))
    });
    hits.reduce(|one, other| if other.0 < one.0 { other } else { one })
}

/// Random numbers.
pub struct Draw(pub u32);

impl Draw {
    pub fn below(&mut self, range: usize) -> usize {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 16) as usize % range
    }

    /// A place in a cube around the origin with edges of two units.
    pub fn place(&mut self) -> DVec3 {
        DVec3::from([(); 3].map(|()| self.below(20_001) as f64 / 10_000.0 - 1.0))
    }
}
