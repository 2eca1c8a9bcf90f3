//! Compares poses, vertices and normals with those that three.js computes, for files in the manner of other exporters.
//! `README.md` in this folder says how the files and the numbers were made.

mod obj;

use std::path::{Path, PathBuf};

use glam::Vec3;
use relievo::asset::Light;
use relievo::asset::Mesh;
use relievo::asset::Model;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::transform::Affine;
use relievo::ops::animation::instance::Wrap;
use relievo::ops::animation::local_to_model::reference::local_to_model;
use relievo::ops::animation::sample::reference::sample;
use relievo::ops::skinning::morph::reference::morph;
use relievo::ops::skinning::palette::reference::palette_for;
use relievo::ops::skinning::skin::reference::skin;
use relievo::ops::skinning::{Blend, InstanceLod, Vertex, add_levels};
use relievo_lab::portrait::picture::texture::Surface;
use relievo_lab::portrait::picture::{Part, Scene, framing};

/// The largest distance between a vertex or joint and its position in three.js, relative to the size of its
/// mesh or skeleton: positions, keys and matrices are `f32` in files, and both programs multiply about ten of
/// them, here in `f32`.
const PLACES: f32 = 1e-5;

/// The largest difference of a joint's axis, relative to the longest axis, and of a unit normal.
const DIRECTIONS: f32 = 1e-4;

/// The nodes, meshes and poses that three.js computed.
struct Truth {
    folder: PathBuf,
    files: Vec<File>,
    numbers: Vec<f32>,
}

#[derive(serde::Deserialize)]
struct Index {
    files: Vec<File>,
}

#[derive(Clone, serde::Deserialize)]
struct File {
    file: String,
    nodes: Vec<String>,
    meshes: Vec<Described>,
    poses: Vec<Moment>,
}

#[derive(Clone, serde::Deserialize)]
struct Described {
    name: String,
    vertices: usize,
    normals: bool,
}

/// A moment of a clip, or the rest pose, and the index at which its numbers begin.
#[derive(Clone, serde::Deserialize)]
struct Moment {
    clip: Option<usize>,
    time: f32,
    first: usize,
}

/// The largest differences, each in the unit of its bound.
#[derive(Debug, Clone, Copy, Default)]
struct Worst {
    joints: f32,
    axes: f32,
    vertices: f32,
    normals: f32,
}

impl Truth {
    /// Reads the folder that `RELIEVO_TRUTH` names, or `files/` beside this file.
    fn read() -> Self {
        let own = || Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/truth/files");
        let folder = std::env::var_os("RELIEVO_TRUTH").map_or_else(own, PathBuf::from);
        let read = |name: &str| std::fs::read(folder.join(name)).expect("the numbers are there");
        let Index { files } = serde_json::from_slice(&read("truth.json")).expect("an index");
        let bytes = read("truth.f32");
        let float = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().expect("four bytes"));
        Self { folder, files, numbers: bytes.chunks_exact(4).map(float).collect() }
    }

    fn file(&self, name: &str) -> &File {
        self.files.iter().find(|file| file.file == name).expect("is listed")
    }

    fn model(&self, file: &File) -> Model {
        let model = Model::from_file_bare(&self.folder.join(&file.file));
        model.unwrap_or_else(|error| panic!("{}: {error}", file.file))
    }

    /// A model at a moment: 12 numbers a node, then 3 a vertex, and 3 a normal.
    fn numbers(&self, file: &File, moment: &Moment) -> &[f32] {
        let of_mesh = |mesh: &Described| 3 * mesh.vertices * (1 + usize::from(mesh.normals));
        let count = 12 * file.nodes.len() + file.meshes.iter().map(of_mesh).sum::<usize>();
        &self.numbers[moment.first..][..count]
    }

    /// The largest differences between a model and three.js over all poses.
    fn compare(&self, file: &File, model: &Model) -> Worst {
        let poses = file.poses.iter().map(|moment| {
            let (bones, meshes) = posed(model, moment);
            compared(file, model, self.numbers(file, moment), &bones, &meshes)
        });
        poses.fold(Worst::default(), Worst::max)
    }
}

impl Worst {
    fn max(self, other: Self) -> Self {
        Self {
            joints: self.joints.max(other.joints),
            axes: self.axes.max(other.axes),
            vertices: self.vertices.max(other.vertices),
            normals: self.normals.max(other.normals),
        }
    }

    fn holds(&self) -> bool {
        self.joints <= PLACES
            && self.vertices <= PLACES
            && self.axes <= DIRECTIONS
            && self.normals <= DIRECTIONS
    }
}

/// The model matrices of the bones, and the vertices of each mesh.
fn posed(model: &Model, moment: &Moment) -> (Vec<Affine>, Vec<Vec<Vertex>>) {
    let clip = moment.clip.map(|clip| (clip, &model.clips[clip]));
    let at = clip.map(|(index, clip)| {
        let time = Wrap::Clamp.inside(clip.duration(), f64::from(moment.time)).expect("finite");
        (index, clip, time)
    });
    let pose =
        at.map_or_else(|| model.skeleton.rest(), |(_, clip, time)| sample(clip, time, RotationPath::Slerp));
    let bones = local_to_model(&model.skeleton, &pose);
    let vertices = |mesh: &Mesh| {
        let weights = at.map_or_else(|| mesh.weights.clone(), |(clip, _, time)| mesh.weights_at(clip, time));
        let palette = palette_for(&model.skins[mesh.skin], &bones, Blend::Linear);
        skin(&morph(mesh, &weights), &mesh.influences, &palette, InstanceLod::FULL)
    };
    let meshes = model.meshes.iter().map(vertices).collect();
    (bones, meshes)
}

/// The diagonal of the box around the vertices.
fn size(places: &[Vec3]) -> f32 {
    let low = places.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let high = places.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    (high - low).length()
}

fn vectors(numbers: &[f32]) -> Vec<Vec3> {
    numbers.chunks_exact(3).map(Vec3::from_slice).collect()
}

fn farthest(found: impl Iterator<Item = Vec3>, wanted: &[Vec3]) -> f32 {
    let far = |(found, wanted): (Vec3, &Vec3)| match found.distance(*wanted) {
        far if far.is_finite() => far,
        _ => f32::INFINITY,
    };
    found.zip(wanted).map(far).fold(0.0, f32::max)
}

/// Compares meshes with those of the same names, and bones with the nodes of three.js that this crate needs.
fn compared(file: &File, model: &Model, truth: &[f32], bones: &[Affine], meshes: &[Vec<Vertex>]) -> Worst {
    let (nodes, mut rest) = truth.split_at(12 * file.nodes.len());
    let mut worst = Worst::default();
    let mut places = Vec::new();
    for described in &file.meshes {
        let at = model.meshes.iter().position(|mesh| mesh.name == described.name);
        let vertices = &meshes[at.unwrap_or_else(|| panic!("{}: no mesh {}", file.file, described.name))];
        assert_eq!(vertices.len(), described.vertices, "{}: {}", file.file, described.name);
        let wanted = vectors(rest.split_off(..3 * described.vertices).expect("as many"));
        let off = farthest(vertices.iter().map(|vertex| vertex.position.into()), &wanted);
        worst.vertices = worst.vertices.max(off / size(&wanted));
        if described.normals {
            let wanted = vectors(rest.split_off(..3 * described.vertices).expect("as many"));
            let off = farthest(vertices.iter().map(|vertex| vertex.normal.into()), &wanted);
            worst.normals = worst.normals.max(off);
        }
        places.extend(wanted);
    }
    assert_eq!(model.meshes.len(), file.meshes.len(), "{}", file.file);
    let size = size(&places);
    for (bone, rows) in model.skeleton.bones().iter().zip(bones) {
        let node = file.nodes.iter().position(|name| *name == bone.name);
        let node = node.unwrap_or_else(|| panic!("{}: {} is not in the scene", file.file, bone.name));
        let wanted = &nodes[12 * node..][..12];
        let column = |rows: &[f32], at: usize| Vec3::new(rows[at], rows[4 + at], rows[8 + at]);
        let columns = |rows: &[f32]| [0, 1, 2, 3].map(|at| column(rows, at));
        let (found, wanted) = (columns(rows.as_flattened()), columns(wanted));
        worst.joints = worst.joints.max(found[3].distance(wanted[3]) / size);
        let longest = wanted[..3].iter().map(|axis| axis.length()).fold(0.0, f32::max);
        worst.axes = worst.axes.max(farthest(found[..3].iter().copied(), &wanted[..3]) / longest);
    }
    worst
}

#[test]
fn vertices_are_where_three_js_has_them() {
    let truth = Truth::read();
    let mut wrong = Vec::new();
    for file in &truth.files {
        let found = truth.compare(file, &truth.model(file));
        println!("{}, {} poses: {found:?}", file.file, file.poses.len());
        if !found.holds() {
            wrong.push((&file.file, found));
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// Each of these planted faults exceeds the bounds of the comparison.
#[test]
fn a_planted_fault_is_found() {
    let truth = Truth::read();
    let found = |name: &str, plant: &dyn Fn(&mut Model)| {
        let file = truth.file(name);
        let mut model = truth.model(file);
        assert!(truth.compare(file, &model).holds());
        plant(&mut model);
        let worst = truth.compare(file, &model);
        assert!(!worst.holds(), "{name}: {worst:?}");
        worst
    };
    // Moves one vertex of a limb one metre long by 30 micrometres.
    let worst = found("bound.glb", &|model| model.meshes[0].positions[4][1] += 3e-5);
    assert!(worst.vertices > PLACES && worst.joints < PLACES, "{worst:?}");
    found("bound.glb", &|model| model.skins[1].inverse_binds[1][12] += 1e-3);
    found("rig.glb", &|model| model.skins[0].bones.swap(0, 8));
    found("armature.glb", &|model| model.meshes[0].normals[3] = [0.0, 1.0, 0.0]);
    found("keys.glb", &|model| model.meshes[1].weight_keys.clear());
    // Only the rest pose shows this fault, because clips move everything else.
    found("rig.glb", &|model| {
        let mut bones = model.skeleton.bones().to_vec();
        let neck = bones.iter_mut().find(|bone| bone.name == "neck").expect("there");
        neck.rest.translation[1] += 1e-3;
        let joints = model.skeleton.joints().to_vec();
        model.skeleton = relievo::asset::Skeleton::new(bones, joints).expect("valid");
    });
}

/// Six times the volume that triangles enclose; positive if they are counter-clockwise seen from outside.
fn volume(vertices: &[Vertex], indices: &[u32]) -> f32 {
    let place = |index: u32| Vec3::from(vertices[index as usize].position);
    // Volumes are taken about the middle of the vertices, which keeps rounding small.
    let middle =
        vertices.iter().map(|vertex| Vec3::from(vertex.position)).sum::<Vec3>() / vertices.len() as f32;
    let signed = |triangle: &[u32]| {
        let [a, b, c] = [0, 1, 2].map(|corner| place(triangle[corner]) - middle);
        a.dot(b.cross(c))
    };
    indices.chunks_exact(3).map(signed).sum()
}

/// How many triangles face away from the normals of their corners.
fn against_normals(vertices: &[Vertex], indices: &[u32]) -> usize {
    let is_along = |triangle: &&[u32]| {
        let corners = [0, 1, 2].map(|corner| &vertices[triangle[corner] as usize]);
        let [a, b, c] = corners.map(|vertex| Vec3::from(vertex.position));
        let normal: Vec3 = corners.iter().map(|vertex| Vec3::from(vertex.normal)).sum();
        (b - a).cross(c - a).dot(normal) > 0.0
    };
    indices.len() / 3 - indices.chunks_exact(3).filter(is_along).count()
}

/// Every mesh of these files is closed and counter-clockwise seen from outside, so that glTF shows its outside, whether
/// the node mirrors it or not. The levels of detail also show their outside.
#[test]
fn closed_meshes_are_seen_from_outside() {
    let truth = Truth::read();
    let (mut levels, mut triangles) = (0, 0);
    for file in &truth.files {
        let mut model = truth.model(file);
        let clips: Vec<usize> = (0..model.clips.len()).collect();
        if !clips.is_empty() {
            add_levels(&mut model, &clips, 8).expect("simplified");
        }
        for moment in &file.poses {
            let (_, meshes) = posed(&model, moment);
            for (mesh, vertices) in model.meshes.iter().zip(&meshes) {
                let name = (&file.file, &mesh.name, moment.clip, moment.time);
                let whole = volume(vertices, &mesh.indices);
                assert!(whole > 0.0, "{name:?}: a volume of {whole}");
                // Where limbs bend or morph, coarse levels fold, and the normals differ from those of the triangles.
                if moment.clip.is_none() && mesh.targets.is_empty() {
                    for level in &mesh.levels {
                        // Some meshes are flat.
                        let volume = volume(vertices, &level.indices);
                        assert!(volume > -1e-3 * whole, "{name:?}: a level has {volume} of {whole}");
                        levels += usize::from(volume > 0.5 * whole);
                    }
                    assert_eq!(against_normals(vertices, &mesh.indices), 0, "{name:?}");
                    triangles += mesh.indices.len() / 3;
                }
            }
        }
    }
    assert!(triangles > 500 && levels > 20, "{triangles} triangles, {levels} levels");
}

/// Seen from outside, a closed mesh looks the same with and without its back faces.
#[test]
fn pictures_of_closed_meshes_show_their_outside() {
    let truth = Truth::read();
    // In the other files limbs bend so much that some back faces are visible.
    for name in ["mirrored.glb", "bound.glb", "parts.glb", "still.glb", "scenes.glb"] {
        let file = truth.file(name);
        let mut model = truth.model(file);
        for moment in &file.poses {
            let (_, meshes) = posed(&model, moment);
            let mut picture = |double_sided: bool| {
                model.meshes.iter_mut().for_each(|mesh| mesh.double_sided = double_sided);
                let surface = Surface::plain([0.6, 0.3, 0.16]);
                let parts: Vec<_> = (model.meshes.iter().zip(&meshes))
                    .map(|(mesh, vertices)| Part { mesh, level: 0, vertices, surface: &surface })
                    .collect();
                let clip_from_model = framing(meshes.iter().flatten());
                Scene { clip_from_model, light: Light::default(), size: [64; 2] }
                    .draw(&parts, [0.0; 3])
                    .pixels
            };
            let (one, both) = (picture(false), picture(true));
            assert!(one.iter().any(|pixel| *pixel != [0.0; 3]));
            let differ = one.iter().zip(&both).filter(|(one, both)| one != both).count();
            // At edges one pixel wide, the surface behind may be visible.
            assert!(differ <= 2, "{}, {:?} at {}: {differ} pixels", file.file, moment.clip, moment.time);
        }
    }
}
