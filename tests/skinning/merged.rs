//! Drawing a merged model is drawing its meshes, and a model at rest needs no skinning.

use std::path::Path;

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::material::{Alpha, Filter, Sampling, Texture};
use relievo::asset::morph::{MorphDelta, MorphTarget, WeightKeys};
use relievo::asset::{Interpolation, Material, Mesh, MeshLevel, Model};
use relievo::ops::animation::local_to_model::reference::local_to_model;
use relievo::ops::animation::sample::reference::sample;
use relievo::ops::skinning::clusters::Clusters;
use relievo::ops::skinning::merged::{MAX_DRAWS, MAX_PARTS, Merged, PartKey, merged};
use relievo::ops::skinning::morph::reference::morph;
use relievo::ops::skinning::palette::reference::palette_for;
use relievo::ops::skinning::skin::reference::skin;
use relievo::ops::skinning::{
    Blend, InstanceLod, Vertex, add_levels, at_rest, level_errors, level_errors_within, own_levels,
};

use crate::rigs::{self, Rig};

/// A corner as it is drawn, as bits: position, normal, tangent, texture coordinates.
type Corner = [u32; 12];

/// A triangle as it is drawn: its corners, its material, and whether it is double-sided and cut out.
type Triangle = ([Corner; 3], Option<usize>, bool, bool);

/// The skinned vertices of a mesh at a time of the first clip, or at rest.
fn skinned(model: &Model, mesh: &Mesh, time: Option<f32>, instance_lod: InstanceLod) -> Vec<Vertex> {
    let (locals, weights) = match time {
        None => (model.skeleton.rest(), mesh.weights.clone()),
        Some(time) => (sample(&model.clips[0], time, RotationPath::Slerp), mesh.weights_at(0, time)),
    };
    let models = local_to_model(&model.skeleton, &locals);
    let palette = palette_for(&model.skins[mesh.skin], &models, Blend::Linear);
    skin(&morph(mesh, &weights), &mesh.influences, &palette, instance_lod)
}

fn corner(mesh: &Mesh, vertices: &[Vertex], vertex: u32) -> Corner {
    let Vertex { position, normal, tangent } = vertices[vertex as usize];
    let uv = mesh.uv[vertex as usize];
    let all: Vec<f32> = [&position[..], &normal, &tangent, &uv].concat();
    std::array::from_fn(|at| all[at].to_bits())
}

/// All triangles of a model's meshes at a level of the character that has these errors.
fn drawn(
    model: &Model,
    errors: &[f32],
    level: usize,
    time: Option<f32>,
    instance_lod: InstanceLod,
) -> Vec<Triangle> {
    let mut all = Vec::new();
    for mesh in &model.meshes {
        let vertices = skinned(model, mesh, time, instance_lod);
        let key = PartKey::of(model, mesh).expect("has its material");
        for triangle in mesh.triangles(own_levels(mesh, errors)[level]).chunks_exact(3) {
            let corners = [0, 1, 2].map(|at| corner(mesh, &vertices, triangle[at]));
            all.push((corners, mesh.material, key.double_sided, key.cut_out));
        }
    }
    all.sort_unstable();
    all
}

/// The same of a merged model, part by part.
fn drawn_merged(
    merged: &Merged,
    level: usize,
    time: Option<f32>,
    instance_lod: InstanceLod,
) -> Vec<Triangle> {
    let mut all = Vec::new();
    let vertices: Vec<_> =
        merged.model.meshes.iter().map(|mesh| skinned(&merged.model, mesh, time, instance_lod)).collect();
    for part in &merged.parts {
        let mesh = &merged.model.meshes[part.mesh];
        let triangles = mesh.triangles(own_levels(mesh, &merged.errors)[level]);
        let range = &part.indices[level];
        for triangle in triangles[range.start as usize..range.end as usize].chunks_exact(3) {
            let corners = [0, 1, 2].map(|at| corner(mesh, &vertices[part.mesh], triangle[at]));
            let material = merged.materials[part.mesh][triangle[0] as usize];
            assert!(triangle.iter().all(|vertex| merged.materials[part.mesh][*vertex as usize] == material));
            all.push((corners, material, part.key.double_sided, part.key.cut_out));
        }
    }
    all.sort_unstable();
    all
}

/// Random numbers from a seed.
struct Random(u64);

impl Random {
    /// A number below `end`.
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % end
    }
}

/// Another way to sample a texture for each number.
fn sampling(number: usize) -> Sampling {
    let filter = |bit: usize| if number >> bit & 1 == 0 { Filter::Linear } else { Filter::Nearest };
    Sampling { magnified: filter(0), minified: filter(1), mips: Some(filter(2)), ..Sampling::default() }
}

/// Opaque, masked and dithered materials: one without a texture, and one for each of these samplings.
fn materials(samplings: usize) -> Vec<Material> {
    let material = |number: usize| {
        let texture =
            (number / 3).checked_sub(1).map(|number| Texture { image: 0, sampling: sampling(number) });
        let alpha = [Alpha::Opaque, Alpha::Mask(0.5), Alpha::Dithered][number % 3];
        Material {
            name: format!("{number}"),
            color: [1.0; 4],
            texture,
            normal: None,
            normal_scale: 1.0,
            alpha,
            pbr: Default::default(),
        }
    };
    (0..3 * (samplings + 1)).map(material).collect()
}

/// Levels that leave out the last triangles of the level before.
fn levels(mesh: &Mesh, random: &mut Random) -> Vec<MeshLevel> {
    let (mut left, mut error) = (mesh.indices.len() / 3, 0.0);
    let mut levels = Vec::new();
    while random.below(5) > 0 && left > 1 && levels.len() < 15 {
        left -= random.below(left.min(3));
        error += random.below(5) as f32 / 16.0;
        levels.push(MeshLevel { indices: mesh.indices[..3 * left].to_vec(), error });
    }
    levels
}

/// Moves some vertices of a mesh by two targets, whose weights the first clip animates.
fn add_targets(mesh: &mut Mesh, random: &mut Random, speed: f32) {
    let target = |random: &mut Random| {
        let delta = |_| MorphDelta {
            position: [0.01 * random.below(9) as f32, 0.0, 0.02],
            normal: [0.1, 0.0, 0.2],
            tangent: [0.0, 0.1, 0.0],
        };
        let vertices: Vec<u32> = (0..mesh.vertices() as u32).step_by(2).collect();
        MorphTarget { deltas: vertices.iter().map(delta).collect(), vertices }
    };
    mesh.targets = vec![target(random), target(random)];
    mesh.weights = vec![0.25, 0.0];
    let values = vec![0.0, 1.0, 0.5 * speed, speed];
    let keys = WeightKeys::new(["", ""], vec![0.0, 1.0], values, Interpolation::Linear, 2).expect("valid");
    mesh.weight_keys = vec![(0, keys)];
}

/// A rig of three skins with random materials, levels, targets and sides; each mesh occurs several times.
fn model(seed: u64) -> Model {
    let mut random = Random(seed);
    let rig = Rig { is_mirrored: random.below(2) == 0, ..Rig::PLAIN };
    let mut model = rig.model();
    let samplings = random.below(4);
    model.materials = materials(samplings);
    model.images = vec![image::RgbaImage::new(1, 1).into()];
    let count = random.below(12);
    let more: Vec<Mesh> = (0..count).map(|_| model.meshes[random.below(4)].clone()).collect();
    model.meshes.extend(more);
    let morphs = random.below(3);
    for (at, mesh) in model.meshes.iter_mut().enumerate() {
        mesh.material = random.below(2 + model.materials.len()).checked_sub(2);
        mesh.double_sided = random.below(3) == 0;
        for (vertex, uv) in mesh.uv.iter_mut().enumerate() {
            *uv = [at as f32, vertex as f32];
        }
        if random.below(9) == 0 {
            mesh.indices.clear();
        }
        mesh.levels = levels(mesh, &mut random);
        if morphs > 0 && random.below(3) == 0 {
            let speed = 1.0 + random.below(morphs) as f32;
            add_targets(mesh, &mut random, speed);
        }
    }
    model
}

/// For each mesh of a merged model, the clusters of its vertices hold the same ranges.
fn check_clusters(merged: &Merged) {
    let Merged { model, parts, errors, .. } = merged;
    for (at, mesh) in model.meshes.iter().enumerate() {
        let own = own_levels(mesh, errors);
        let clusters = Clusters::new(mesh, &model.skins, &model.skeleton).expect("fits").with_levels(&own);
        for (level, own) in own.into_iter().enumerate() {
            let placed = clusters.level(level as u32);
            let ranges = parts.iter().filter(|part| part.mesh == at).map(|part| part.indices[level].clone());
            let mut end = 0;
            for range in ranges {
                assert_eq!((range.start, range.len() % 3), (end, 0));
                end = range.end;
            }
            assert_eq!(end, placed.indices);
            let first = placed.first_index as usize;
            let vertices = clusters.indices[first..].iter().map(|place| clusters.order[*place as usize]);
            assert!(vertices.take(end as usize).eq(mesh.triangles(own).iter().copied()));
        }
    }
}

/// Checks a merged model against its source, at every level, in several poses and with fewer influences.
fn check(model: &Model, merged: &Merged, most: usize) {
    assert!(merged.levels() <= most.max(1) && 2 * merged.levels() * merged.parts.len() <= MAX_DRAWS);
    assert_eq!(merged.errors, level_errors_within(&model.meshes, merged.levels()));
    assert_eq!(level_errors(&merged.model.meshes), merged.errors);
    let reduced = InstanceLod { influence_fade: 0.5, max_influences: 2, ..InstanceLod::FULL };
    for level in 0..merged.levels() {
        for (time, instance_lod) in
            [(None, InstanceLod::FULL), (Some(0.3), InstanceLod::FULL), (Some(0.9), reduced)]
        {
            let time = time.filter(|_| !model.clips.is_empty());
            let wanted = drawn(model, &merged.errors, level, time, instance_lod);
            let found = drawn_merged(merged, level, time, instance_lod);
            assert!(found == wanted, "level {level} at {time:?}");
        }
        let allowed = level.checked_sub(1).map_or(0.0, |at| merged.errors[at]);
        for mesh in &merged.model.meshes {
            let own = own_levels(mesh, &merged.errors)[level] as usize;
            assert!(own == 0 || mesh.levels[own - 1].error <= allowed);
        }
    }
    for part in &merged.parts {
        assert_eq!(part.indices.len(), merged.levels());
        assert!(!part.indices[0].is_empty());
    }
    check_clusters(merged);
}

fn settings() -> ProptestConfig {
    ProptestConfig {
        cases: 96,
        rng_seed: RngSeed::Fixed(2026),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(settings())]

    /// Whatever the meshes have in common: the same triangles, to the bit.
    #[test]
    fn a_merged_model_is_drawn_as_its_meshes_are(seed in any::<u64>(), most in 1_usize..9) {
        let model = model(seed);
        let merged = merged(&model, most).expect("valid");
        check(&model, &merged, most);
        let morphed = merged.model.meshes.iter().filter(|mesh| !mesh.targets.is_empty()).count();
        prop_assert!(morphed <= 2 && merged.model.meshes.len() <= 3);
        let sides = |part: &relievo::ops::skinning::merged::Part| (part.mesh, part.key.cut_out, part.key.double_sided);
        let needed: std::collections::BTreeSet<_> = merged.parts.iter().map(sides).collect();
        prop_assert!(merged.parts.len() <= MAX_PARTS.max(needed.len()));
        // Each pair of a bone and a bind is there once.
        let skin = &merged.model.skins[0];
        let mut pairs: Vec<_> =
            skin.bones.iter().zip(&skin.inverse_binds).map(|(bone, bind)| (*bone, bind.map(f32::to_bits))).collect();
        pairs.sort_unstable();
        pairs.dedup();
        prop_assert_eq!(pairs.len(), skin.bones.len());
    }
}

/// The comparison finds a corner that changed, a bone, a material, and a level that draws too little.
#[test]
fn planted_faults_are_found() {
    let model = model(5);
    let good = merged(&model, 8).expect("valid");
    assert!(good.levels() > 3 && good.parts.len() > 1 && good.model.skins[0].bones.len() > 20);
    let differs = |level: usize, plant: &dyn Fn(&mut Merged)| {
        let mut bad = good.clone();
        plant(&mut bad);
        let full = InstanceLod::FULL;
        drawn_merged(&bad, level, Some(0.3), full) != drawn(&model, &good.errors, level, Some(0.3), full)
    };
    assert!(!differs(0, &|_| ()) && !differs(2, &|_| ()));
    assert!(differs(0, &|bad| bad.model.meshes[0].indices.swap(0, 1)));
    assert!(differs(0, &|bad| bad.model.meshes[0].positions[4][1] += 1e-3));
    assert!(differs(0, &|bad| bad.model.skins[0].bones.swap(0, 3)));
    assert!(differs(0, &|bad| bad.parts[0].key.double_sided ^= true));
    assert!(differs(0, &|bad| bad.materials[0].rotate_left(9)));
    assert!(differs(2, &|bad| bad.parts[0].indices[2].end -= 3));
    assert!(differs(2, &|bad| bad.model.meshes[0].levels[1].indices.swap(3, 4)));
}

/// Meshes with the same weights are merged, and so are those without targets.
#[test]
fn meshes_that_morph_alike_are_merged() {
    let mut model = Rig::PLAIN.model();
    let mut random = Random(1);
    model.meshes.extend(model.meshes.clone());
    for (mesh, speed) in [(1, 1.0), (4, 1.0), (5, 2.0)] {
        add_targets(&mut model.meshes[mesh], &mut random, speed);
    }
    let merged = merged(&model, 8).expect("valid");
    check(&model, &merged, 8);
    let targets: Vec<_> = merged.model.meshes.iter().map(|mesh| mesh.targets.len()).collect();
    let vertices = |meshes: &[usize]| meshes.iter().map(|at| model.meshes[*at].vertices()).sum::<usize>();
    let found: Vec<_> = merged.model.meshes.iter().map(Mesh::vertices).collect();
    assert_eq!(targets, [0, 2, 2]);
    assert_eq!(found, [vertices(&[0, 2, 3, 6, 7]), vertices(&[1, 4]), vertices(&[5])]);
    assert_eq!((merged.model.skinned, merged.parts.len()), (2, 3));
}

/// The first mesh of a rig, as often as there are keys.
fn with_keys(keys: &[(usize, bool)], triangles: impl Fn(usize) -> usize) -> Merged {
    let mut model = Rig::PLAIN.model();
    model.materials = materials(6);
    model.images = vec![image::RgbaImage::new(1, 1).into()];
    let mesh = model.meshes[0].clone();
    let copy = |(at, (material, double_sided)): (usize, &(usize, bool))| Mesh {
        indices: mesh.indices[..3 * triangles(at)].to_vec(),
        material: Some(*material),
        double_sided: *double_sided,
        ..mesh.clone()
    };
    model.meshes = keys.iter().enumerate().map(copy).collect();
    merged(&model, 8).expect("valid")
}

fn keys(merged: &Merged) -> Vec<(bool, bool, Option<Sampling>, usize)> {
    let key = |part: &relievo::ops::skinning::merged::Part| {
        let PartKey { cut_out, double_sided, sampling, .. } = part.key;
        (cut_out, double_sided, sampling, part.indices[0].len() / 3)
    };
    merged.parts.iter().map(key).collect()
}

#[test]
fn samplings_are_given_up_before_anything_else() {
    // Materials 3n, 3n + 1 and 3n + 2 are opaque, masked and dithered, without a texture or with sampling n − 1.
    let some = |number| Some(sampling(number));
    let four = with_keys(&[(3, false), (6, false), (9, false), (12, false)], |at| at + 1);
    let kept = |number: usize| (false, false, some(number), number + 1);
    assert_eq!(keys(&four), [kept(0), kept(1), kept(2), kept(3)]);
    // With a fifth, the least goes to the most.
    let five = with_keys(&[(3, false), (6, false), (9, false), (12, false), (15, false)], |at| at + 1);
    assert_eq!(keys(&five), [kept(1), kept(2), kept(3), (false, false, some(4), 6)]);
    // Both uses of alpha belong together; what has no texture joins the others, and needs none by itself.
    let alpha = with_keys(&[(1, false), (4, false), (8, false), (0, true)], |_| 2);
    assert_eq!(keys(&alpha), [(true, false, some(0), 4), (true, false, some(1), 2), (false, true, None, 2)]);
    // All that differs in sides and alpha stays apart, whatever it is sampled with.
    let every: Vec<_> = (3..21).flat_map(|material| [(material, false), (material, true)]).collect();
    let every = with_keys(&every, |at| 1 + at % 7);
    let mut sides: Vec<_> = keys(&every).iter().map(|(cut_out, double, ..)| (*cut_out, *double)).collect();
    sides.sort_unstable();
    assert_eq!(sides, [(false, false), (false, true), (true, false), (true, true)]);
}

/// What has a normal map of another sampling is drawn apart; what has none, or only a normal map, joins.
#[test]
fn normal_maps_have_samplings_of_their_own() {
    let mut model = Rig::PLAIN.model();
    model.images = vec![image::RgbaImage::new(1, 1).into()];
    let texture = |number| Some(Texture { image: 0, sampling: sampling(number) });
    let looks = [(texture(0), texture(1)), (texture(0), texture(2)), (texture(0), None), (None, texture(2))];
    let plain = materials(0).remove(0);
    let material = |(texture, normal)| Material { texture, normal, ..plain.clone() };
    model.materials = looks.map(material).to_vec();
    let mesh = Mesh { levels: Vec::new(), ..model.meshes[0].clone() };
    let triangles = |at: usize| 1 + usize::from(at == 1);
    let copy = |at: usize| Mesh {
        indices: mesh.indices[..3 * triangles(at)].to_vec(),
        material: Some(at),
        ..mesh.clone()
    };
    model.meshes = (0..4).map(copy).collect();
    let found = merged(&model, 8).expect("valid");
    let key = |part: &relievo::ops::skinning::merged::Part| {
        (part.key.sampling, part.key.normal_sampling, part.indices[0].len() / 3)
    };
    let [zero, one, two] = [0, 1, 2].map(|number| Some(sampling(number)));
    assert_eq!(found.parts.iter().map(key).collect::<Vec<_>>(), [(zero, one, 1), (zero, two, 4)]);
}

/// Draws stay within their limit however many meshes morph by themselves, at the expense of levels.
#[test]
fn many_morphs_cost_levels() {
    let mut model = Rig::PLAIN.model();
    let mesh = model.meshes[0].clone();
    let mut random = Random(3);
    model.meshes = (0..10)
        .map(|at| {
            let mut copy = mesh.clone();
            add_targets(&mut copy, &mut random, at as f32);
            let level =
                |left: usize| MeshLevel { indices: mesh.indices[..3 * left].to_vec(), error: -(left as f32) };
            copy.levels = (1..10)
                .rev()
                .map(level)
                .map(|level| MeshLevel { error: level.error + 9.5, ..level })
                .collect();
            copy
        })
        .collect();
    let found = merged(&model, 8).expect("valid");
    assert_eq!((found.parts.len(), found.levels()), (10, 3));
    check(&model, &found, 8);
    // The coarsest is kept.
    assert_eq!(found.errors[1], 8.5);
}

#[test]
fn what_does_not_match_is_refused() {
    let refused = |plant: &dyn Fn(&mut Model)| {
        let mut model = Rig::PLAIN.model();
        plant(&mut model);
        [merged(&model, 8).map(|_| ()), at_rest(&model).map(|_| ())]
            .map(|found| found.map_err(|error| error.path))
    };
    let both = |path: &str| [Err(path.to_owned()), Err(path.to_owned())];
    assert_eq!(refused(&|model| model.meshes[2].indices[1] = 999), both("meshes[2].indices[1]"));
    assert_eq!(refused(&|model| model.skins[0].bones[3] = 999), both("skins[0].bones[3]"));
    let path = "meshes[1].material".to_owned();
    assert_eq!(refused(&|model| model.meshes[1].material = Some(3)), [Err(path), Ok(())]);
    let path = "meshes[0].positions[0]".to_owned();
    assert_eq!(
        refused(&|model| {
            model.meshes[0].positions[0] = [1e17; 3];
            model.skins[0].inverse_binds[0][0] = 1e9;
        }),
        [Ok(()), Err(path)]
    );
    assert_eq!(refused(&|model| model.meshes.clear()), [Ok(()), Ok(())]);
    let empty = merged(&Model { meshes: vec![], ..Rig::PLAIN.model() }, 8).expect("nothing to merge");
    assert!(empty.parts.is_empty() && empty.model.meshes.is_empty() && empty.model.skins.is_empty());
}

/// The vertices of a model at rest are where independent code puts them, and skinning leaves them there.
#[test]
fn models_at_rest_need_no_skinning() {
    for is_mirrored in [false, true] {
        let model = Rig { is_mirrored, ..Rig::PLAIN }.model();
        let baked = at_rest(&model).expect("valid");
        let wanted = rigs::skinned(&model, &rigs::at_rest(&model.skeleton));
        let found = baked.meshes.iter().flat_map(|mesh| &mesh.positions);
        let off =
            found.zip(&wanted).map(|(found, wanted)| DVec3::from(found.map(f64::from)).distance(*wanted));
        assert!(off.fold(0.0, f64::max) < 1e-5);
        assert_eq!(wanted.len(), baked.meshes.iter().map(Mesh::vertices).sum::<usize>());
        for mesh in &baked.meshes {
            let vertices = skinned(&baked, mesh, None, InstanceLod::FULL);
            assert!(vertices.iter().map(|vertex| vertex.position).eq(mesh.positions.iter().copied()));
        }
    }
    // Targets move vertices at rest too.
    let mut model = model(8);
    model.meshes.iter_mut().for_each(|mesh| mesh.levels.clear());
    let moved = model.meshes.iter().filter(|mesh| !mesh.targets.is_empty()).count();
    let baked = at_rest(&model).expect("valid");
    assert!(moved > 0 && baked.meshes.iter().all(|mesh| mesh.targets.is_empty()));
    let positions = |triangles: Vec<Triangle>| {
        let corners = triangles
            .into_iter()
            .map(|(corners, ..)| corners.map(|corner| [corner[0], corner[1], corner[2]]));
        let mut all: Vec<_> = corners.collect();
        all.sort_unstable();
        all
    };
    let [found, wanted] =
        [&baked, &model].map(|model| positions(drawn(model, &[], 0, None, InstanceLod::FULL)));
    assert_eq!(found, wanted);
    let merged = merged(&baked, 8).expect("valid");
    check(&baked, &merged, 8);
    assert_eq!((merged.model.meshes.len(), &merged.model.skins[0].bones[..]), (1, &[0][..]));
}

/// Closed meshes in files, mirrored and not, show their outside at rest, before and after merging, and so do their
/// levels.
#[test]
fn baked_triangles_face_outward() {
    let files = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/truth/files");
    for (file, mirrored_meshes) in [("mirrored.glb", 3), ("parts.glb", 0), ("still.glb", 0)] {
        let model = Model::from_file(&files.join(file)).expect("valid");
        let mut baked = at_rest(&model).expect("valid");
        let mut turned = 0;
        for (mesh, source) in baked.meshes.iter().zip(&model.meshes) {
            assert_eq!(against_normals(mesh, &mesh.indices), 0, "{file}: {}", mesh.name);
            turned += usize::from(against_normals(source, &source.indices) > 0);
            for ([x, y, z], [a, b, c, _]) in mesh.normals.iter().zip(&mesh.tangents) {
                let (normal, tangent) = (Vec3::new(*x, *y, *z), Vec3::new(*a, *b, *c));
                assert!((normal.length() - 1.0).abs() < 1e-5 && (tangent.length() - 1.0).abs() < 1e-5);
            }
        }
        assert!(turned >= mirrored_meshes, "{file}: {turned} meshes were mirrored");
        add_levels(&mut baked, &[], 1).expect("simplified");
        let merged = merged(&baked, 8).expect("valid");
        check(&baked, &merged, 8);
        assert_eq!(against_normals(&merged.model.meshes[0], &merged.model.meshes[0].indices), 0);
    }
}

/// How many triangles face away from the normals of their corners.
fn against_normals(mesh: &Mesh, indices: &[u32]) -> usize {
    let is_against = |triangle: &&[u32]| {
        let corners = [0, 1, 2].map(|corner| triangle[corner] as usize);
        let [a, b, c] = corners.map(|vertex| Vec3::from(mesh.positions[vertex]));
        let normal: Vec3 = corners.iter().map(|vertex| Vec3::from(mesh.normals[*vertex])).sum();
        (b - a).cross(c - a).dot(normal) <= 0.0
    };
    indices.chunks_exact(3).filter(is_against).count()
}
