//! A closed hull in parts that share borders, for tests of levels of detail.

use std::collections::{BTreeSet, HashMap};

use relievo::asset::Transform;
use relievo::asset::{
    Bone, BoneKeys, Clip, Influence, Influences, Interpolation, Keys, Mesh, Model, Skeleton, Skin,
};

/// A closed hull in parts, each a mesh that follows its own node, and for each vertex of each part its point of the hull.
pub struct Hull {
    pub model: Model,
    pub points: Vec<Vec<u32>>,
}

/// The parts' nodes: centimetres, mirrored metres, and something else.
const SCALES: [[f32; 3]; 3] = [[0.01; 3], [-1.0, 1.0, 1.0], [0.3048; 3]];

/// A rock, each of whose triangles belongs to the part that `part` gives for its middle.
pub fn hull(part: impl Fn(glam::Vec3) -> usize) -> Hull {
    let mut model = relievo_samples::rock().expect("valid");
    let rock = model.meshes.remove(0);
    let mut numbers = HashMap::new();
    let points: Vec<u32> = (rock.positions.iter().enumerate())
        .map(|(at, place)| *numbers.entry(place.map(|x| (x + 0.0).to_bits())).or_insert(at as u32))
        .collect();
    let rest = |scale: [f32; 3]| Transform { scale, ..Transform::IDENTITY };
    let mut bones = vec![Bone { name: "root".to_owned(), parent: None, rest: Transform::IDENTITY }];
    bones.extend(SCALES.map(|scale| Bone { name: "part".to_owned(), parent: Some(0), rest: rest(scale) }));
    model.skeleton = Skeleton::of_joints(bones).expect("valid");
    model.skins = (1..=3)
        .map(|bone| Skin {
            name: String::new(),
            bones: vec![bone],
            inverse_binds: vec![glam::Mat4::IDENTITY.to_cols_array()],
        })
        .collect();
    let turned = Keys {
        times: vec![0.0, 1.0],
        values: vec![[0.0, 0.0, 0.0, 1.0], [0.6, 0.0, 0.0, 0.8]],
        interpolation: Interpolation::Linear,
    };
    let still = || BoneKeys::default();
    let keys = [BoneKeys { rotation: Some(turned), ..still() }, still(), still(), still()];
    model.clips = vec![Clip::new("turn", &model.skeleton, &keys, 1.0).expect("valid")];
    let mut all = Vec::new();
    for (at, scale) in SCALES.iter().enumerate() {
        let scale = glam::Vec3::from(*scale);
        let middle = |corners: &&[u32]| {
            let sum: glam::Vec3 =
                corners.iter().map(|at| glam::Vec3::from(rock.positions[*at as usize])).sum();
            part(sum / 3.0) == at
        };
        let corners: Vec<u32> = rock.indices.chunks(3).filter(middle).flatten().copied().collect();
        let used: Vec<u32> = corners.iter().copied().collect::<BTreeSet<_>>().into_iter().collect();
        let own = |vertex: &u32| used.binary_search(vertex).expect("used") as u32;
        let taken = |vertex: &u32| *vertex as usize;
        let follows = used.iter().map(|_| vec![Influence { bone: 0, weight: 1.0 }]);
        let unscaled = |vector: [f32; 3]| (glam::Vec3::from(vector) / scale).to_array();
        let normal = |vector: [f32; 3]| (glam::Vec3::from(vector) * scale).normalize().to_array();
        if used.is_empty() {
            continue;
        }
        model.meshes.push(Mesh {
            name: format!("part {at}"),
            skin: at,
            positions: used.iter().map(|at| unscaled(rock.positions[taken(at)])).collect(),
            normals: used.iter().map(|at| normal(rock.normals[taken(at)])).collect(),
            tangents: used.iter().map(|at| rock.tangents[taken(at)]).collect(),
            uv: used.iter().map(|at| rock.uv[taken(at)]).collect(),
            indices: corners.iter().map(own).collect(),
            influences: Influences::new("w", 1, follows).expect("valid"),
            ..rock.clone()
        });
        all.push(used.iter().map(|at| points[taken(at)]).collect());
    }
    Hull { model, points: all }
}

/// Two parts, cut aslant.
pub fn halves() -> Hull {
    hull(|middle| usize::from(middle.y + 0.3 * middle.x < 0.3))
}
