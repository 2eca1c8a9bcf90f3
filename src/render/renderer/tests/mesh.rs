//! Meshes look like the CPU reference's pictures: textured, cut out, mirrored, from both sides.

use glam::{Mat4, Vec3};
use image::{Rgba, RgbaImage};

use super::stage::{FORMAT, SIZE, Stage, differing, drawn, gpu, is_coarse, through, view};
use crate::asset::material::{Alpha, Material, Sampling, Texture};
use crate::asset::transform::{Affine, rows};
use crate::asset::{Light, Mesh, Model};
use crate::gpu::{Buffer, Gpu, Uniform};
use crate::picture::texture::Surface;
use crate::picture::{self, Part};
use crate::render::{Layer, TargetFormat};
use crate::samples::creature::creature;
use crate::scene::drawable::NO_OBJECT;
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::{Looks, PartMaterials};
use crate::scene::mesh::{Faces, MeshDrawable, MeshGeometry, MeshMaterials, MeshPart};
use crate::shared::render::scene_instances::SceneObject;
use crate::shared::render::scene_vertex::MeshParams;
use crate::skinning::buffers::MeshBuffers;
use crate::skinning::skin::reference::transformed;
use crate::skinning::vertex::{Vertex, vertices_of};

/// The creature with a texture of many colours and all alphas.
pub fn painted(alpha: Alpha, double_sided: bool) -> Model {
    let mut model = creature().expect("valid");
    let color = |x: u32, y: u32| {
        Rgba([(16 * x) as u8, (255 - 16 * y) as u8, ((x ^ y) << 4) as u8, (17 * (x + y) % 256) as u8])
    };
    model.images.push(RgbaImage::from_fn(16, 16, color).into());
    model.materials.push(Material {
        name: "paint".to_owned(),
        color: [0.9, 1.0, 0.8, 0.9],
        texture: Some(Texture { image: 0, sampling: Sampling::default() }),
        normal: None,
        normal_scale: 1.0,
        alpha,
        pbr: Default::default(),
    });
    model.meshes[0].material = Some(0);
    model.meshes[0].double_sided = double_sided;
    // A quarter of the triangles is removed, so that the inside is visible.
    let indices = &mut model.meshes[0].indices;
    let quarter = indices.len() / 12 * 3;
    indices.truncate(indices.len() - quarter);
    model.meshes[0].levels.clear();
    model
}

/// The object that a test stage draws.
pub const OBJECT: SceneObject = SceneObject { first_instance: 64, number: 1, ..NO_OBJECT };

/// The model's first mesh. Its instances have their own skinned vertices, in 64-vertex pages in reverse order.
pub fn mesh(gpu: &Gpu, layouts: &SceneLayouts, model: &Model, instances: usize) -> (MeshDrawable, u32) {
    let (buffers, clusters) = MeshBuffers::new(gpu, model, &model.meshes[0]).expect("uploaded");
    let material = &model.materials[0];
    let count = buffers.clusters();
    let params = MeshParams { clusters: count as u32, last: 0, partners: 0 };
    let mut pages = clusters.vertices.clone();
    pages.resize(64 * count, Vertex::default());
    let pages: Vec<Vertex> = pages.chunks(64).rev().flatten().copied().collect();
    let row: Vec<u32> = (0..count as u32).rev().collect();
    let table: Vec<u32> = (0..instances)
        .flat_map(|instance| row.iter().map(move |page| page + (instance * count) as u32))
        .collect();
    let geometry = MeshGeometry {
        object: Uniform::new(gpu, "object", &OBJECT).expect("uploaded"),
        params: Uniform::new(gpu, "mesh", &params).expect("uploaded"),
        vertices: Buffer::from_slice(gpu, "vertices", &pages.repeat(instances)).expect("uploaded"),
        last: 0,
        page_table: Buffer::from_slice(gpu, "page table", &table).expect("uploaded"),
        uv: buffers.uv.clone(),
        partners: 0,
        material_of: Buffer::from_slice(gpu, "material of", &vec![1; clusters.vertices.len()])
            .expect("uploaded"),
        indices: buffers.indices.clone(),
    };
    let table = PartMaterials::new(
        gpu,
        layouts,
        &Looks::taken(&mut model.clone()),
        &[None, Some(0)],
        Default::default(),
    )
    .expect("uploaded");
    assert_eq!(table.cut_out, material.alpha != Alpha::Opaque);
    let faces = Faces { blended: false, double_sided: model.meshes[0].double_sided };
    let part = MeshPart::new(faces, MeshMaterials::Plain(table));
    let drawable = MeshDrawable::new(gpu, layouts, geometry, params.clusters, vec![part]).expect("bound");
    (drawable, buffers.level(0).indices)
}

/// Placements that are plain, mirrored, and mirrored with an uneven scale.
pub fn placements() -> [Affine; 3] {
    let at = |x: f32, scale: Vec3| {
        let place = Mat4::from_translation(Vec3::new(x, -1.0, 0.0)) * Mat4::from_rotation_y(0.6);
        rows(&(place * Mat4::from_scale(scale)).to_cols_array())
    };
    [at(-1.2, Vec3::ONE), at(0.0, Vec3::new(1.0, 1.0, -1.0)), at(1.2, Vec3::new(-0.8, 1.1, 1.0))]
}

/// The CPU reference's picture of the same instances. A mirrored placement flips the winding, so corners are swapped.
fn expected(model: &Model, clip_from_world: Mat4) -> Vec<[u8; 4]> {
    let mesh = &model.meshes[0];
    let vertices = vertices_of(mesh);
    let placed = placements().map(|place| {
        let [x, y, z] = place.map(|row| Vec3::from_slice(&row));
        let mut mesh = Mesh::clone(mesh);
        if x.dot(y.cross(z)) < 0.0 {
            mesh.indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(0, 2));
        }
        (mesh, vertices.iter().map(|vertex| transformed(vertex, &place)).collect::<Vec<_>>())
    });
    let surface = Surface::of(model, &model.materials[0]);
    let parts: Vec<_> =
        placed.iter().map(|(mesh, vertices)| Part { mesh, level: 0, vertices, surface: &surface }).collect();
    let scene = picture::Scene { clip_from_model: clip_from_world, light: Light::default(), size: SIZE };
    let found = scene.draw(&parts, [-1.0; 3]);
    let pixels = found.pixels.iter().zip(found.encoded().pixels().copied().collect::<Vec<_>>());
    pixels.map(|(light, pixel)| if *light == [-1.0; 3] { [0; 4] } else { pixel.0 }).collect()
}

#[test]
fn meshes_look_as_the_reference_draws_them() {
    let gpu = gpu();
    let layouts = SceneLayouts::new(&gpu).expect("valid");
    // Allowed difference in 8-bit levels: filters and lighting may round differently. Between two texels, a sixteenth of a pixel
    // is up to 16 levels.
    let levels = if is_coarse(&gpu) { 16 } else { 3 };
    let seen = view(Vec3::new(0.4, 0.8, 4.5), false);
    let mirror = through(Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)) * seen.clip_from_world, seen.eye);
    let cases =
        [(Alpha::Opaque, false), (Alpha::Opaque, true), (Alpha::Mask(0.5), false), (Alpha::Dithered, true)];
    for (alpha, double_sided) in cases {
        let model = painted(alpha, double_sided);
        let (drawable, indices) = mesh(&gpu, &layouts, &model, 3);
        for view in [seen, mirror] {
            let expected = expected(&model, view.clip_from_world);
            let stage = Stage::new(&gpu, &layouts, view, &placements(), &[[0, indices]]);
            let found = drawn(&gpu, &TargetFormat::new(FORMAT), &drawable, &stage, None, &[Layer::Color]);
            let covered = found.iter().filter(|pixel| **pixel != [0; 4]).count();
            assert!(covered > 500, "{covered} pixels");
            // Rasterizers disagree about pixels on the edges of triangles and holes, and this picture has many of them.
            let others = differing(&found, &expected, levels);
            println!("{alpha:?} {double_sided} {}: {others} of {covered} pixels", view.side);
            assert!(25 * others <= covered, "{alpha:?} {double_sided} {}: {others} of {covered}", view.side);
            // A view with the wrong handedness mirrors the wrong instances.
            let wrong = Stage::new(
                &gpu,
                &layouts,
                crate::shared::render::scene_view::SceneView { side: -view.side, ..view },
                &placements(),
                &[[0, indices]],
            );
            let wrong = drawn(&gpu, &TargetFormat::new(FORMAT), &drawable, &wrong, None, &[Layer::Color]);
            let wrong = differing(&wrong, &expected, levels);
            assert!(10 * wrong > covered, "{alpha:?} {double_sided} {}: {wrong} of {covered}", view.side);
        }
    }
}
