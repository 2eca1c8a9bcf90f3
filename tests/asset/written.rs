//! Models as this crate writes them, read again.

use image::{Rgba, RgbaImage};
use relievo::asset::material::{Alpha, Filter, Sampling, Texture, Wrapping};
use relievo::asset::{Material, Mesh, Model};
use relievo::ops::skinning::at_rest;
use relievo_samples::creature;

use crate::{Folder, Words, check};

/// The models of the tests' files, and the built-in one.
fn models() -> Vec<(&'static str, Model)> {
    let file = |name: &str| Model::from_file(format!("tests/truth/files/{name}").as_ref()).expect(name);
    let files = [
        "rig.glb",
        "mirrored.glb",
        "keys.glb",
        "parts.glb",
        "still.glb",
        "bound.glb",
        "packed.gltf",
        "armature.glb",
    ];
    let mut models: Vec<_> = files.into_iter().map(|name| (name, file(name))).collect();
    models.push(("creature", creature().expect("valid")));
    models
}

fn from_obj(files: &[(String, Vec<u8>)]) -> Model {
    let folder =
        files[1..].iter().fold(Folder::default(), |folder, (name, bytes)| folder.with(name, &bytes[..]));
    folder.read_bytes(&files[0].1).expect("readable")
}

/// The first difference between two meshes in what OBJ holds, at every corner of every triangle.
fn difference(a: &Mesh, b: &Mesh) -> Option<String> {
    if a.indices.len() != b.indices.len() {
        return Some(format!("{} and {} indices", a.indices.len(), b.indices.len()));
    }
    let bits = |mesh: &Mesh, index: u32| {
        let at = index as usize;
        // OBJ has no −0 in texture coordinates: 1 − 1 is 0.
        let uv = mesh.uv[at].map(|x| x + 0.0);
        (mesh.positions[at].map(f32::to_bits), mesh.normals[at].map(f32::to_bits), uv.map(f32::to_bits))
    };
    let mut corners = a.indices.iter().zip(&b.indices).enumerate();
    corners.find(|(_, (x, y))| bits(a, **x) != bits(b, **y)).map(|(at, _)| format!("corner {at}"))
}

/// Models at rest, which have no skeleton.
#[test]
fn obj_comes_back_to_the_bit() {
    for (name, model) in models() {
        let rest = at_rest(&model).expect(name);
        let found = from_obj(&rest.to_obj("model").expect(name));
        assert_eq!(found.meshes.len(), rest.meshes.len(), "{name}");
        for (found, wanted) in found.meshes.iter().zip(&rest.meshes) {
            assert_eq!(difference(found, wanted), None, "{name} {}", wanted.name);
            // Vertices without triangles are left out.
            let used: std::collections::HashSet<u32> = wanted.indices.iter().copied().collect();
            assert_eq!(found.vertices(), used.len(), "{name} {}", wanted.name);
        }
        // A second time nothing changes any more but names.
        let mut again = from_obj(&found.to_obj("model").expect(name));
        for (again, found) in again.meshes.iter_mut().zip(&found.meshes) {
            again.name.clone_from(&found.name);
        }
        assert!(again.meshes == found.meshes, "{name}");
        assert!(again.materials == found.materials && again.images == found.images, "{name}");
    }
}

#[test]
fn planted_differences_are_found() {
    let mesh = &at_rest(&creature().expect("valid")).expect("valid").meshes[0];
    let mut other = mesh.clone();
    other.normals[mesh.indices[7] as usize][1] += 1e-7;
    assert!(difference(mesh, &other).is_some_and(|text| text.starts_with("corner")));
    other = mesh.clone();
    other.indices.truncate(3);
    assert!(difference(mesh, &other).is_some_and(|text| text.contains("and 3 indices")));
}

/// Numbers of all sizes, and texture coordinates beyond the image and close to its edges.
#[test]
fn obj_has_all_digits() {
    let mut words = Words(7);
    let mut number = |least: i32, most: i32| {
        let scale = libm::exp2f((least + words.below((most - least) as usize) as i32) as f32);
        let sign = if words.below(2) == 0 { -1.0 } else { 1.0 };
        sign * scale * (1.0 + words.below(1 << 23) as f32 / (1 << 23) as f32)
    };
    let mut model =
        Folder::default().read("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n").expect("valid");
    for _ in 0..3000 {
        let mesh = &mut model.meshes[0];
        for at in 0..3 {
            mesh.positions[at] = [(); 3].map(|()| number(-60, 29));
            mesh.uv[at] = [number(-60, 29), number(-28, 24)];
        }
        let found = from_obj(&model.to_obj("model").expect("valid"));
        assert_eq!(difference(&found.meshes[0], &model.meshes[0]), None);
    }
    // Smaller ones come back within 2⁻⁵³.
    model.meshes[0].uv = vec![[0.0, 1e-20], [0.0, -3e-15], [0.0, 1.0]];
    let found = &from_obj(&model.to_obj("model").expect("valid")).meshes[0];
    for (found, wanted) in found.uv.iter().zip(&model.meshes[0].uv) {
        assert!(
            (f64::from(found[1]) - f64::from(wanted[1])).abs() <= libm::exp2(-53.0),
            "{found:?} {wanted:?}"
        );
    }
}

/// A model with a textured, a cut out and a plain mesh, and one without material.
fn painted() -> Model {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\no a\nf 1/1 2/2 3/3\no b\nf 2/1 1/2 3/3\no c\n\
                f 3/1 2/2 1/3\no d\nf 3/1 1/2 2/3\n";
    let mut model = Folder::default().read(text).expect("valid");
    let image =
        |seed: u8| RgbaImage::from_fn(3, 2, |x, y| Rgba([seed, x as u8, 9 * y as u8, 255 - 10 * seed]));
    model.images = vec![image(1).into(), image(2).into()];
    let repeat = Texture { image: 1, sampling: Sampling::default() };
    let wrap = [Wrapping::Clamp; 2];
    let clamped = Texture { image: 0, sampling: Sampling { wrap, ..Sampling::default() } };
    let nearest = Sampling {
        wrap: [Wrapping::Mirror, Wrapping::Repeat],
        magnified: Filter::Nearest,
        minified: Filter::Linear,
        mips: Some(Filter::Nearest),
    };
    let material = |name: &str, texture: Option<Texture>, alpha: Alpha| Material {
        name: name.to_owned(),
        color: [0.2, 0.4, 0.9, 0.75],
        texture,
        normal: None,
        normal_scale: 1.0,
        alpha,
        pbr: Default::default(),
    };
    let normal = Some(Texture { image: 1, sampling: nearest });
    model.materials = vec![
        Material { normal, normal_scale: 0.5, ..material("old wood", Some(clamped), Alpha::Dithered) },
        material("old_wood", Some(repeat), Alpha::Mask(0.25)),
        material("plain", None, Alpha::Opaque),
    ];
    for (mesh, material) in model.meshes.iter_mut().zip([Some(0), Some(1), Some(2), None]) {
        mesh.material = material;
    }
    check(&model);
    model
}

#[test]
fn obj_has_materials() {
    let model = painted();
    let files = model.to_obj("barn").expect("valid");
    let names: Vec<_> = files.iter().map(|(name, _)| &**name).collect();
    assert_eq!(names, ["barn.obj", "barn.mtl", "barn_0.png", "barn_1.png"]);
    let found = from_obj(&files);
    let of = |mesh: usize| found.material(&found.meshes[mesh]).expect("valid");
    let names: Vec<_> = (0..4).map(|mesh| of(mesh).map(|material| &*material.name)).collect();
    assert_eq!(names, [Some("old_wood"), Some("old_wood_1"), Some("plain"), None]);
    for (mesh, material) in [(0, 0), (1, 1)] {
        let (found_material, wanted) = (of(mesh).expect("a material"), &model.materials[material]);
        assert_eq!((found_material.color, found_material.alpha), (wanted.color, Alpha::Dithered));
        let images =
            [found_material.texture, wanted.texture].map(|texture| texture.expect("a texture").image);
        assert!(found.images[images[0]] == model.images[images[1]], "{mesh}");
    }
    let (first, wanted) = (of(0).expect("a material"), &model.materials[0]);
    assert_eq!(first.texture.map(|texture| texture.sampling), wanted.texture.map(|texture| texture.sampling));
    assert_eq!((first.normal.is_some(), first.normal_scale), (true, 0.5));
    // Opaque: alpha does not matter.
    assert_eq!(
        of(2).map(|material| (material.color, material.alpha)),
        Some(([0.2, 0.4, 0.9, 1.0], Alpha::Opaque))
    );
}

#[test]
fn names_of_files_are_plain() {
    for name in ["", "a b", "../a", "a/b", "a\nb", "#a"] {
        assert_eq!(painted().to_obj(name).expect_err(name).path, "name");
    }
}

/// What reading a GLB again must not change. Rotations and tangents of splines may differ in the last bit.
fn assert_alike(name: &str, found: &Model, wanted: &Model) {
    assert_eq!(found.meshes.len(), wanted.meshes.len(), "{name}");
    for (found, wanted) in found.meshes.iter().zip(&wanted.meshes) {
        let weights = |mesh: &Mesh| mesh.influences.all().iter().map(|one| one.weight).collect::<Vec<_>>();
        let close = weights(found).iter().zip(weights(wanted)).all(|(a, b)| (a - b).abs() <= f32::EPSILON);
        assert!(close && weights(found).len() == weights(wanted).len(), "{name} {}", wanted.name);
        let influences = wanted.influences.clone();
        let same = Mesh {
            influences,
            material: wanted.material,
            skin: wanted.skin,
            levels: vec![],
            partners: vec![],
            ..found.clone()
        };
        assert!(
            same == Mesh { levels: vec![], partners: vec![], ..wanted.clone() },
            "{name} {}",
            wanted.name
        );
    }
    assert_eq!(found.clips.len(), wanted.clips.len(), "{name}");
    for (found, wanted) in found.clips.iter().zip(&wanted.clips) {
        assert_eq!((found.name(), found.times()), (wanted.name(), wanted.times()), "{name}");
        let values = [found.values(), wanted.values()].map(|values| values.as_flattened());
        let most = values[1].iter().fold(1.0_f32, |most, value| most.max(value.abs()));
        let off = values[0].iter().zip(values[1]).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off <= 2.0 * f32::EPSILON * most, "{name} {}: {off}", wanted.name());
        assert_eq!(found.tracks(), wanted.tracks(), "{name} {}", wanted.name());
    }
}

#[test]
fn glb_comes_back_whole() {
    for (name, model) in models() {
        let bytes = model.to_glb().expect(name);
        let found = Model::from_gltf(&bytes, None).expect(name);
        check(&found);
        // The creature's skeleton has another order than the import gives bones, which the tests of poses compare.
        if name != "creature" {
            assert_alike(name, &found, &model);
            assert_eq!(found.skins, model.skins, "{name}");
            assert_eq!(
                (found.skeleton.joints(), found.skinned),
                (model.skeleton.joints(), model.skinned),
                "{name}"
            );
        }
        let again = Model::from_gltf(&found.to_glb().expect(name), None).expect(name);
        assert!(again.meshes == found.meshes && again.skins == found.skins, "{name}");
    }
}

/// Where every vertex is at rest, however bones are ordered.
#[test]
fn glb_stands_as_the_model_does() {
    for (name, model) in models() {
        let found = Model::from_gltf(&model.to_glb().expect(name), None).expect(name);
        let (found, wanted) = (at_rest(&found).expect(name), at_rest(&model).expect(name));
        for (found, wanted) in found.meshes.iter().zip(&wanted.meshes) {
            assert_eq!(found.indices, wanted.indices, "{name} {}", wanted.name);
            let size = wanted.positions.as_flattened().iter().fold(0.0_f32, |most, x| most.max(x.abs()));
            let numbers = found.positions.as_flattened().iter().zip(wanted.positions.as_flattened());
            let off = numbers.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(off <= 4.0 * f32::EPSILON * size, "{name} {}: {off} of {size}", wanted.name);
        }
    }
}

#[test]
fn glb_has_materials() {
    let mut model = painted();
    model.meshes[2].double_sided = true;
    model.meshes[3].double_sided = true;
    let found = Model::from_gltf(&model.to_glb().expect("valid"), None).expect("valid");
    let sides: Vec<bool> = found.meshes.iter().map(|mesh| mesh.double_sided).collect();
    assert_eq!(sides, [false, false, true, true]);
    for (found_mesh, mesh) in found.meshes[..3].iter().zip(&model.meshes) {
        let [a, b] = [(&found, found_mesh), (&model, mesh)]
            .map(|(model, mesh)| model.material(mesh).expect("valid").expect("one"));
        let without = |material: &Material| Material { texture: None, normal: None, ..material.clone() };
        assert_eq!(without(a), without(b));
        for (a, b) in [(a.texture, b.texture), (a.normal, b.normal)] {
            let of = |model: &Model, texture: Option<Texture>| {
                texture.map(|texture| (model.images[texture.image].clone(), texture.sampling))
            };
            assert!(of(&found, a) == of(&model, b), "a texture of {}", mesh.name);
        }
    }
}

/// Blending is glTF's BLEND, which the import makes a pattern.
#[test]
fn what_glb_cannot_say_is_said() {
    let mut model = painted();
    model.materials[2].alpha = Alpha::Blended;
    let found = Model::from_gltf(&model.to_glb().expect("valid"), None).expect("valid");
    assert_eq!(found.materials[2].alpha, Alpha::Dithered);
    model.materials[1].texture = Some(Texture { image: 9, sampling: Sampling::default() });
    assert_eq!(model.to_glb().expect_err("no such image").path, "materials[1].texture.image");
    assert_eq!(model.to_obj("a").expect_err("no such image").path, "materials[1].texture.image");
    let mut model = painted();
    model.meshes[0].positions[1][0] = f32::NAN;
    assert_eq!(model.to_glb().expect_err("NaN").path, "meshes[0].positions[1][0]");
    assert_eq!(model.to_obj("a").expect_err("NaN").path, "meshes[0].positions[1][0]");
}
