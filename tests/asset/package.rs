//! Packages: written, and read back in part and as a whole.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use relievo::asset::material::{Pbr, PbrTexture, UvSet};
use relievo::asset::package::{Package, PackageHeader};
use relievo::asset::{Influences, Interpolation, Mesh, Model, MorphTarget, WeightKeys, morph::MorphDelta};
use relievo::ops::skinning::{add_levels, cook, join_levels, level_errors, own_levels};
use sha2::{Digest as _, Sha256};

fn cooked(model: &Model) -> Vec<u8> {
    cook(&model.clone().into(), &mut |_| ControlFlow::Continue(())).expect("cooked").expect("not broken off")
}

/// The triangles of a level with all attributes of their corners as bits, from the smallest corner on, each with its number.
fn triangles(mesh: &Mesh, level: u32) -> BTreeMap<Vec<u32>, usize> {
    let corner = |vertex: &u32| {
        let at = *vertex as usize;
        let mut words = Vec::new();
        let mut floats = |floats: &[f32]| words.extend(floats.iter().map(|value| value.to_bits()));
        floats(&mesh.positions[at]);
        floats(&mesh.normals[at]);
        floats(&mesh.tangents[at]);
        floats(&mesh.uv[at]);
        floats(mesh.second_uv.get(at).map_or(&[], |uv| &uv[..]));
        floats(mesh.colors.get(at).map_or(&[], |color| &color[..]));
        for target in &mesh.targets {
            let delta = target.vertices.binary_search(vertex).ok().map(|at| target.deltas[at]);
            let MorphDelta { position, normal, tangent } = delta.unwrap_or_default();
            floats([position, normal, tangent].as_flattened());
        }
        words.extend(mesh.influences.of(at).iter().flat_map(|one| [one.bone, one.weight.to_bits()]));
        words
    };
    let mut found = BTreeMap::new();
    for triangle in mesh.triangles(level).as_chunks::<3>().0 {
        let corners = [0, 1, 2].map(|at| corner(&triangle[at]));
        let first = (0..3).min_by_key(|at| &corners[*at]).expect("three");
        let all: Vec<u32> = (0..3).flat_map(|at| corners[(first + at) % 3].clone()).collect();
        *found.entry(all).or_default() += 1;
    }
    found
}

/// Checks that a mesh has the triangles of another at all levels from `level` on, with the same partners.
fn assert_same(found: &Mesh, wanted: &Mesh, level: u32) {
    assert_eq!(found.levels.len() as u32 + level, wanted.levels.len() as u32, "{}", wanted.name);
    for own in 0..=found.levels.len() as u32 {
        let same = triangles(found, own) == triangles(wanted, own + level);
        assert!(same, "{}: level {} of {}", wanted.name, own + level, wanted.levels.len());
    }
    for (found, wanted) in found.levels.iter().zip(&wanted.levels[level as usize..]) {
        assert_eq!(found.error.to_bits(), wanted.error.to_bits());
    }
    assert_eq!(found.partners.is_empty(), wanted.partners.is_empty());
    let moved = |mesh: &Mesh, at: u32| {
        let corner =
            |vertex: &u32| mesh.positions[mesh.partners[*vertex as usize] as usize].map(f32::to_bits);
        let mut all: Vec<_> = mesh.triangles(at).iter().map(corner).collect();
        all.sort_unstable();
        all
    };
    if !found.partners.is_empty() && !found.levels.is_empty() {
        assert!(moved(found, 0) == moved(wanted, level), "{}: partners", wanted.name);
    }
}

/// Reads a package level by level. Each prefix must be the wanted model at that level, and have the hash of the header.
fn assert_read(bytes: &[u8], wanted: &Model) {
    let (header, first) = PackageHeader::read(bytes).expect("a header");
    assert_eq!((header.model.start, header.bytes()), (first, bytes.len()));
    let errors = level_errors(&wanted.meshes);
    assert_eq!(header.levels.len(), errors.len() + 1);
    // The bytes after the model's chunk are not there yet.
    let mut package = Package::new(&bytes[..header.model.end]).expect("read");
    for (at, level) in header.levels.iter().enumerate() {
        package.add_level(&bytes[level.chunk.range()]).expect("read");
        assert_eq!(package.hash().as_ref(), Ok(&level.hash));
        let model = package.model().expect("valid");
        assert_eq!(model.meshes.len(), wanted.meshes.len());
        let own = errors.len() - at;
        for (found, wanted) in model.meshes.iter().zip(&wanted.meshes) {
            assert_same(found, wanted, own_levels(wanted, &errors)[own]);
        }
        let triangles: usize = model.meshes.iter().map(|mesh| mesh.indices.len() / 3).sum();
        let vertices: usize = model.meshes.iter().map(Mesh::vertices).sum();
        assert_eq!((triangles, vertices), (level.triangles, level.vertices));
        assert_eq!(level.error, if own == 0 { header.quantization } else { errors[own - 1] });
    }
    assert!(package.add_level(&[]).is_err());
    let whole = Model::from_rlv(bytes).expect("read");
    assert_eq!(whole.meshes, package.model().expect("valid").meshes);
    let parts =
        |model: &Model| (model.skeleton.clone(), model.skins.clone(), model.clips.clone(), model.skinned);
    assert_eq!(parts(&whole), parts(wanted));
    assert_eq!((&whole.materials, &whole.images), (&wanted.materials, &wanted.images));
}

/// The creature with a material that shows an image, and with morph targets.
fn morphed() -> Model {
    let mut model = relievo_samples::creature().expect("valid");
    let painted = relievo_samples::rock().expect("valid");
    (model.materials, model.images) = (painted.materials, painted.images);
    let mesh = &mut model.meshes[0];
    mesh.material = (!model.materials.is_empty()).then_some(0);
    let delta = |at: u32| MorphDelta {
        position: [0.01 * (at % 7) as f32, 0.1, -0.0],
        normal: [0.0, 1e-3 * at as f32, 0.0],
        ..MorphDelta::default()
    };
    for (first, step) in [(3, 2), (100, 1)] {
        let vertices: Vec<u32> = (first..2000).step_by(step).collect();
        let deltas = vertices.iter().map(|at| delta(*at)).collect();
        mesh.targets.push(MorphTarget { vertices, deltas });
    }
    mesh.weights = vec![0.25, 0.0];
    mesh.second_uv = mesh.positions.iter().map(|[x, y, _]| [0.5 * x, y + 3.0]).collect();
    mesh.colors = mesh.positions.iter().map(|[x, y, z]| [x.abs().min(1.0), 0.1 * y, *z, 1.0]).collect();
    let occlusion = model.materials[0].texture.map(|texture| PbrTexture { texture, uv: UvSet::Second });
    model.materials[0].pbr = Pbr { metallic: 0.75, occlusion, emissive: [0.1, 0.2, 0.3], ..Pbr::default() };
    let values = vec![0.1, 0.0, 0.7, 1.0];
    let keys = WeightKeys::new(["t", "v"], vec![0.0, 0.5], values, Interpolation::Linear, 2);
    mesh.weight_keys = vec![(1, keys.expect("valid"))];
    model
}

/// A mesh whose triangles all have vertices of their own, beside triangles that share edges in threes and lie on each other.
fn rough() -> Model {
    let mut model = relievo_samples::rock().expect("valid");
    let mesh = &mut model.meshes[0];
    let corners: Vec<usize> = mesh.indices.iter().map(|vertex| *vertex as usize).collect();
    let mut positions: Vec<[f32; 3]> = corners.iter().map(|vertex| mesh.positions[*vertex]).collect();
    let mut uv: Vec<[f32; 2]> = corners.iter().map(|vertex| mesh.uv[*vertex]).collect();
    let far = |x: f32, y: f32, z: f32| [9.0 + x, y, z];
    let [a, b] = [far(0.0, 0.0, 0.0), far(0.0, 1.0, 0.0)];
    for third in [far(1.0, 0.0, 0.0), far(0.0, 0.0, 1.0), far(-1.0, 0.0, 0.0), far(1.0, 0.0, 0.0)] {
        positions.extend([a, b, third, b, a, third]);
        uv.extend([[0.5; 2]; 6]);
    }
    let indices: Vec<u32> = (0..positions.len() as u32).collect();
    *mesh = Mesh {
        name: "rough".to_owned(),
        material: mesh.material,
        normals: relievo::asset::mesh::smooth_normals(&positions, &indices),
        tangents: vec![[1.0, 0.0, 0.0, -1.0]; positions.len()],
        uv,
        influences: Influences::rigid(positions.len()),
        positions,
        indices,
        ..Mesh::default()
    };
    model
}

/// Models of several kinds, with levels, as packages give them back.
fn models() -> Vec<Model> {
    let samples = ["creature", "rock", "wall"].map(|name| relievo_samples::model(name).expect("valid"));
    let sources = samples.into_iter().chain([morphed(), rough()]);
    sources.map(|source| Model::from_rlv(&cooked(&source)).expect("read")).collect()
}

#[test]
fn every_prefix_is_the_model_at_its_level() {
    for model in models() {
        assert_read(&cooked(&model), &model);
    }
}

/// The comparison sees one vertex that is one step of texture coordinates away.
#[test]
#[should_panic(expected = "level 1 of 1")]
fn a_planted_difference_is_found() {
    let model = Model::from_rlv(&cooked(&relievo_samples::wall().expect("valid"))).expect("read");
    let bytes = cooked(&model);
    assert_read(&bytes, &model);
    let mut other = model;
    other.meshes[0].uv[0][0] += 1.0 / 16_384.0;
    assert_read(&bytes, &other);
}

/// Models that were not quantized, with levels that are no subsets of each other, and with influences that fit no grid.
#[test]
fn packages_lose_no_bits() {
    let mut exact = morphed();
    add_levels(&mut exact, &[0], 3).expect("valid");
    assert_read(&cooked(&exact), &exact);
    let [rock, coarse] =
        [relievo_samples::rock(), relievo_samples::wall()].map(|model| model.expect("valid"));
    let joined = join_levels(&[rock, coarse]).expect("joined");
    assert!(joined.meshes.iter().any(|mesh| mesh.indices.is_empty()));
    assert_read(&cooked(&joined), &joined);
    let mut strange = relievo_samples::wall().expect("valid");
    let mesh = &mut strange.meshes[0];
    mesh.positions[0] = [-0.0, f32::MIN_POSITIVE / 8.0, 1e9];
    mesh.normals[1] = [0.0; 3];
    mesh.uv[2] = [1e-20, -7.5];
    mesh.levels = vec![relievo::asset::MeshLevel { indices: mesh.indices[3..].to_vec(), error: 0.5 }];
    assert_read(&cooked(&strange), &strange);
    let mut empty = relievo_samples::wall().expect("valid");
    empty.meshes.clear();
    empty.skinned = 0;
    assert_read(&cooked(&empty), &empty);
}

/// The cooked model stays within the stated error of the source, and its levels know that.
#[test]
fn quantization_is_stated() {
    let source = relievo_samples::creature().expect("valid");
    let bytes = cooked(&source);
    let (header, _) = PackageHeader::read(&bytes).expect("a header");
    let cooked = Model::from_rlv(&bytes).expect("read");
    let extent =
        |model: &Model| model.meshes[0].positions.iter().flatten().fold(0.0_f32, |most, x| most.max(x.abs()));
    assert!(
        header.quantization > 0.0 && header.quantization < 1e-4 * extent(&source),
        "{}",
        header.quantization
    );
    let place = |at: &[f32; 3]| glam_of(*at);
    let points: Vec<_> = cooked.meshes[0].positions.iter().map(place).collect();
    for position in source.meshes[0].positions.iter().map(place) {
        let nearest = points.iter().map(|point| point.distance(position)).fold(f32::INFINITY, f32::min);
        assert!(nearest <= header.quantization, "{nearest}");
    }
    assert!(cooked.meshes[0].levels.iter().all(|level| level.error > header.quantization));
}

fn glam_of(position: [f32; 3]) -> relievo::glam::Vec3 {
    position.into()
}

/// Puts the right sums and lengths into a package whose header was replaced.
fn with_header(bytes: &[u8], change: &dyn Fn(&mut serde_json::Value)) -> Vec<u8> {
    let (_, first) = PackageHeader::read(bytes).expect("a header");
    let mut header: serde_json::Value = serde_json::from_slice(&bytes[40..first]).expect("JSON");
    change(&mut header);
    let json = serde_json::to_vec(&header).expect("JSON");
    sealed(&json, &bytes[first..])
}

fn sealed(json: &[u8], rest: &[u8]) -> Vec<u8> {
    let length = (json.len() as u32).to_le_bytes();
    [b"RLV\n", &length[..], Sha256::digest(json).as_slice(), json, rest].concat()
}

/// An image is decoded at its first use. One that cannot be decoded has no texels, and its error names it.
#[test]
fn images_are_decoded_when_they_are_asked_for() {
    let mut file: relievo::asset::ModelFile = relievo_samples::rock().expect("valid").into();
    file.model.images = vec![image::RgbaImage::from_pixel(64, 16, image::Rgba([9, 8, 7, 255])).into()];
    let source = relievo_samples::rock().expect("valid");
    file.model.materials[0].texture = source.materials[0].texture.or(file.model.materials[0].texture);
    let bytes = cook(&file, &mut |_| ControlFlow::Continue(())).expect("cooked").expect("not broken off");
    let (header, first) = PackageHeader::read(&bytes).expect("a header");
    let model = Model::from_rlv(&bytes).expect("read");
    assert_eq!((model.images[0].size(), model.images[0].dimensions()), ([64, 16], (64, 16)));
    assert!(model.images == file.model.images && model.images[0] == *file.model.images[0]);
    // Zeros behind the first bytes of the PNG, which state its size.
    let mut damaged = bytes.clone();
    damaged[header.images[0].start + 50..header.images[0].end].fill(0);
    let image = &damaged[header.images[0].range()];
    let sum: String = Sha256::digest(image).iter().map(|byte| format!("{byte:02x}")).collect();
    let mut sealed_header: serde_json::Value = serde_json::from_slice(&damaged[40..first]).expect("JSON");
    sealed_header["images"][0]["sha256"] = sum.into();
    let damaged = sealed(&serde_json::to_vec(&sealed_header).expect("JSON"), &damaged[first..]);
    let model = Model::from_rlv(&damaged).expect("read");
    assert_eq!(model.images[0].size(), [64, 16]);
    let error = model.images[0].texels().expect_err("refused");
    assert!(error.path == "image" && error.bound.contains("must be a whole Png"), "{error}");
    assert!(model.images[0].is_empty() && model.to_glb().is_err());
}

#[test]
fn a_later_version_is_named() {
    let bytes = cooked(&relievo_samples::wall().expect("valid"));
    let later = with_header(&bytes, &|header| *header = serde_json::json!({"version": 2, "new": []}));
    let error = Model::from_rlv(&later).expect_err("refused");
    assert_eq!((error.path.as_str(), error.value.as_str()), ("package.version", "2"));
    assert!(error.bound.contains("must be at most 1"), "{error}");
}

#[test]
fn headers_are_checked_field_by_field() {
    let bytes = cooked(&relievo_samples::rock().expect("valid"));
    let refused = |path: &str, change: &dyn Fn(&mut serde_json::Value)| {
        let error = Model::from_rlv(&with_header(&bytes, change)).expect_err("refused");
        assert_eq!(error.path, path, "{error}");
    };
    refused("package.version", &|header| header["version"] = 0.into());
    refused("package.header", &|header| header["more"] = 0.into());
    refused("package.header", &|header| header["levels"][0]["vertices"] = (-1).into());
    refused("package.quantization", &|header| header["quantization"] = (-1).into());
    refused("package.levels.len", &|header| header["levels"] = serde_json::json!([]));
    refused("package.levels[1].vertices", &|header| header["levels"][1]["vertices"] = 1.into());
    refused("package.levels[1].error", &|header| header["levels"][1]["error"] = 1e9.into());
    refused("package.levels", &|header| {
        for level in header["levels"].as_array_mut().expect("a list") {
            level["vertices"] = 1_000_000_000_u64.into();
        }
    });
    // Numbers of as many digits, so that the chunks stay where they are.
    refused("package.levels[0].chunk.start", &|header| header["levels"][0]["chunk"]["start"] = 9999.into());
    refused("package.model.end", &|header| header["model"]["end"] = 1000.into());
    // The header has become longer, so that chunks no longer begin behind it.
    refused("package.model.start", &|header| header["generator"] = "somebody else, with a long name".into());
    let error = |bytes: &[u8]| Model::from_rlv(bytes).expect_err("refused").path;
    assert_eq!(error(&[&bytes[..], &[0]].concat()), "package.len");
    assert_eq!(error(&bytes[..bytes.len() - 1]), "package.len");
    assert_eq!(error(&bytes[..100]), "package.header.len");
    assert_eq!(error(&bytes[..20]), "package.len");
    assert_eq!(error(b"RLV"), "package.magic");
}
