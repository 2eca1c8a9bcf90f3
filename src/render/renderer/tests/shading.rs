//! Compares surface colours with a closed form: Lambert's law with normal maps, tints, coloured light, mirrored placements and
//! back faces.

use glam::{Mat4, Vec3, Vec4};
use image::{Rgba, RgbaImage};

use super::mesh::OBJECT;
use super::stage::{FORMAT, SIZE, Stage, drawn, gpu, through};
use crate::asset::Model;
use crate::asset::material::{Alpha, Material, Sampling, Texture};
use crate::asset::transform::rows;
use crate::gpu::{Buffer, Gpu, Uniform};
use crate::render::Layer;
use crate::render::TargetFormat;
use crate::samples::creature::creature;
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::{Looks, PartMaterials};
use crate::scene::mesh::{Faces, MeshDrawable, MeshGeometry, MeshMaterials, MeshPart};
use crate::shared::render::scene_vertex::MeshParams;
use crate::shared::render::scene_view::SceneView;
use crate::skinning::vertex::Vertex;
use crate::srgb;

/// A texel of the normal map that points to the right and down the image.
const BUMP: [u8; 4] = [200, 40, 230, 255];

/// A model without meshes and with two materials. The first is plain. The second has a scaled normal map, whose size differs from
/// the texture's.
fn model() -> Model {
    let mut model = creature().expect("valid");
    model.images = vec![
        RgbaImage::from_pixel(4, 2, Rgba([200, 100, 50, 255])).into(),
        RgbaImage::from_pixel(2, 2, Rgba([10, 20, 30, 255])).into(),
        RgbaImage::from_pixel(3, 3, Rgba(BUMP)).into(),
    ];
    let texture = |image| Some(Texture { image, sampling: Sampling::default() });
    let plain = Material {
        name: "plain".to_owned(),
        color: [0.5, 0.8, 1.0, 1.0],
        texture: texture(1),
        normal: None,
        normal_scale: 1.0,
        alpha: Alpha::Opaque,
        pbr: Default::default(),
    };
    let bumpy = Material { texture: texture(0), normal: texture(2), normal_scale: 0.5, ..plain.clone() };
    model.materials = vec![plain, bumpy];
    model
}

/// A square of 2 × 2 units that faces +Z, with u along +X, v along −Y, and the second material.
fn square(gpu: &Gpu, layouts: &SceneLayouts, double_sided: bool) -> MeshDrawable {
    square_of(gpu, layouts, &mut model(), double_sided)
}

/// A square as in [`square`], but of another model, with the second of the model's two materials.
fn square_of(gpu: &Gpu, layouts: &SceneLayouts, model: &mut Model, double_sided: bool) -> MeshDrawable {
    let corners = [[-1.0, 1.0], [1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
    let vertex = |[x, y]: [f32; 2]| Vertex {
        position: [x, y, 0.0],
        normal: [0.0, 0.0, 1.0],
        tangent: [1.0, 0.0, 0.0, -1.0],
    };
    let up = "uploaded";
    let geometry = MeshGeometry {
        object: Uniform::new(gpu, "object", &OBJECT).expect(up),
        params: Uniform::new(gpu, "mesh", &MeshParams { clusters: 0, last: 0, partners: 0 }).expect(up),
        last: 0,
        page_table: Buffer::from_slice(gpu, "no pages", &[0]).expect(up),
        vertices: Buffer::from_slice(gpu, "vertices", &corners.map(vertex)).expect(up),
        uv: Buffer::from_slice(gpu, "uv", &corners.map(|[x, y]| [0.5 * x + 0.5, 0.5 - 0.5 * y])).expect(up),
        partners: 0,
        material_of: Buffer::from_slice(gpu, "material of", &[1; 4]).expect(up),
        indices: Buffer::from_slice(gpu, "indices", &[0, 2, 1, 1, 2, 3]).expect(up),
    };
    let table = [Some(0), Some(1)];
    let materials =
        PartMaterials::new(gpu, layouts, &Looks::taken(model), &table, Default::default()).expect(up);
    let part = MeshPart::new(Faces { blended: false, double_sided }, MeshMaterials::Plain(materials));
    MeshDrawable::new(gpu, layouts, geometry, 0, vec![part]).expect("bound")
}

/// A parallel view along −Z (or +Z, from behind), lit in colour from a direction.
fn seen(from_behind: bool, light: Vec3) -> SceneView {
    let turn = if from_behind { Mat4::from_rotation_y(std::f32::consts::PI) } else { Mat4::IDENTITY };
    let clip = Mat4::from_cols(0.5 * Vec4::X, 0.5 * Vec4::Y, -0.1 * Vec4::Z, Vec4::new(0.0, 0.0, 0.5, 1.0));
    let mut view = through(clip * turn, Vec4::Z);
    view.light = light.normalize().extend(0.25);
    view.light_color = Vec3::new(1.0, 0.5, 0.75);
    view
}

/// The expected colour of the normal-mapped material. `frame` is the tangent space in world axes.
fn expected(frame: [Vec3; 3], light: Vec3, tint: [f32; 3]) -> [u8; 4] {
    let texel = [0, 1, 2].map(|axis| f32::from(BUMP[axis]) / 255.0 * 2.0 - 1.0);
    // Green points up the image; v points down.
    let [tangent, bitangent, normal] = frame;
    let bumpy = 0.5 * texel[0] * tangent - 0.5 * texel[1] * bitangent + texel[2] * normal;
    let direct = bumpy.normalize().dot(light.normalize()).max(0.0);
    let lit = 0.25 + 0.75 * direct;
    let color = Vec3::new(srgb::linear(200), srgb::linear(100), srgb::linear(50)) * Vec3::new(0.5, 0.8, 1.0);
    let color = color * Vec3::from(tint) * Vec3::new(1.0, 0.5, 0.75) * lit;
    [srgb::byte(color.x), srgb::byte(color.y), srgb::byte(color.z), 255]
}

#[test]
fn a_bumpy_square_has_the_colors_of_the_closed_form() {
    let gpu = gpu();
    let layouts = SceneLayouts::new(&gpu).expect("valid");
    let light = Vec3::new(0.3, 0.5, 0.9);
    let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z];
    let turned = Mat4::from_rotation_z(0.5);
    // Placement, whether it is seen from behind, and the expected tangent space on the visible side.
    let cases = [
        (Mat4::IDENTITY, false, [x, -y, z]),
        (turned, false, [turned.transform_vector3(x), turned.transform_vector3(-y), z]),
        (Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)), false, [-x, -y, z]),
        (Mat4::from_scale(Vec3::new(2.0, -1.5, 1.0)), false, [x, y, z]),
        (Mat4::IDENTITY, true, [-x, y, -z]),
        (Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)), true, [x, y, -z]),
        (Mat4::from_scale(Vec3::new(1.0, 1.0, -1.0)), false, [-x, y, z]),
    ];
    let format = TargetFormat::new(FORMAT);
    let square = square(&gpu, &layouts, true);
    for (placement, from_behind, frame) in cases {
        let light = if from_behind { light * Vec3::new(1.0, 1.0, -1.0) } else { light };
        let stage = Stage::new(
            &gpu,
            &layouts,
            seen(from_behind, light),
            &[rows(&placement.to_cols_array())],
            &[[0, 6]],
        );
        let pixels = drawn(&gpu, &format, &square, &stage, None, &[Layer::Color]);
        let middle = pixels[(SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2) as usize];
        let wanted = expected(frame, light, [1.0; 3]);
        let far = middle.iter().zip(wanted).any(|(found, wanted)| found.abs_diff(wanted) > 1);
        assert!(!far, "{placement} {from_behind}: {middle:?}, not {wanted:?}");
        // The test would fail if green pointed in the opposite direction.
        let other = expected([frame[0], -frame[1], frame[2]], light, [1.0; 3]);
        assert!(wanted.iter().zip(other).any(|(a, b)| a.abs_diff(b) > 4), "{wanted:?} {other:?}");
    }
}

#[test]
fn a_square_with_one_side_is_seen_from_that_side_only() {
    let gpu = gpu();
    let layouts = SceneLayouts::new(&gpu).expect("valid");
    let (format, square) = (TargetFormat::new(FORMAT), square(&gpu, &layouts, false));
    let mirror = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    // A placement mirrored in the square's own plane turns the square's front to the other side.
    let flipped = Mat4::from_scale(Vec3::new(1.0, 1.0, -1.0));
    for (placement, is_seen_from_behind) in [(Mat4::IDENTITY, false), (mirror, false), (flipped, true)] {
        for from_behind in [false, true] {
            let view = seen(from_behind, Vec3::Z);
            let stage = Stage::new(&gpu, &layouts, view, &[rows(&placement.to_cols_array())], &[[0, 6]]);
            let pixels = drawn(&gpu, &format, &square, &stage, None, &[Layer::Color]);
            let is_seen = pixels.iter().any(|pixel| *pixel != [0; 4]);
            assert_eq!(is_seen, from_behind == is_seen_from_behind, "{placement} {from_behind}");
        }
    }
}

#[test]
fn materials_that_share_a_texture_or_have_none_keep_their_colors() {
    let gpu = gpu();
    let layouts = SceneLayouts::new(&gpu).expect("valid");
    let (light, format) = (Vec3::Z, TargetFormat::new(FORMAT));
    let colors = [[1.0, 0.25, 0.5, 1.0], [0.5, 0.8, 1.0, 1.0]];
    // Textures of the two materials: no textures; one shared texture; a texture for the second only; two different textures.
    for images in [[None, None], [Some(0), Some(0)], [None, Some(0)], [Some(1), Some(0)]] {
        let mut model = model();
        let texture = |image| Texture { image, sampling: Sampling::default() };
        let material = |at: usize| Material {
            color: colors[at],
            texture: images[at].map(texture),
            normal: None,
            ..model.materials[0].clone()
        };
        model.materials = [0, 1].map(material).to_vec();
        let square = square_of(&gpu, &layouts, &mut model, true);
        let stage = Stage::new(
            &gpu,
            &layouts,
            seen(false, light),
            &[rows(&Mat4::IDENTITY.to_cols_array())],
            &[[0, 6]],
        );
        let pixels = drawn(&gpu, &format, &square, &stage, None, &[Layer::Color]);
        let middle = pixels[(SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2) as usize];
        let texel = images[1]
            .map_or(Vec3::ONE, |_| Vec3::new(srgb::linear(200), srgb::linear(100), srgb::linear(50)));
        let color = texel * Vec3::new(0.5, 0.8, 1.0) * Vec3::new(1.0, 0.5, 0.75);
        let wanted = [srgb::byte(color.x), srgb::byte(color.y), srgb::byte(color.z), 255];
        let far = middle.iter().zip(wanted).any(|(found, wanted)| found.abs_diff(wanted) > 1);
        assert!(!far, "{images:?}: {middle:?}, not {wanted:?}");
    }
}
