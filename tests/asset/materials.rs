//! Material libraries of Wavefront OBJ.

use image::{Rgba, RgbaImage};
use relievo::asset::Model;
use relievo::asset::material::{Alpha, Wrapping};

use crate::{Folder, png};

const TRIANGLE: &str =
    "mtllib wood.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl wood\nf 1/1 2/2 3/3\n";

fn folder(library: &str) -> Folder {
    Folder::default().with("wood.mtl", library)
}

fn image(texels: [[u8; 4]; 2]) -> Vec<u8> {
    png(&RgbaImage::from_fn(2, 1, |x, _| Rgba(texels[x as usize])))
}

const COLORS: [[u8; 4]; 2] = [[200, 10, 0, 100], [0, 90, 255, 255]];

#[test]
fn colours_are_srgb_and_textures_are_opaque() {
    let library = "newmtl other\nKd 1 1 1\nnewmtl wood\nKd 0.5 0 1\nmap_Kd -clamp on bark image.png\n";
    let model = folder(library).with("bark image.png", image(COLORS)).read(TRIANGLE).expect("valid");
    let [material] = &model.materials[..] else { panic!("{} materials", model.materials.len()) };
    assert_eq!((&*material.name, material.alpha, model.meshes[0].material), ("wood", Alpha::Opaque, Some(0)));
    let [red, green, blue, alpha] = material.color;
    assert!(
        (red - 0.214_041_14).abs() < 1e-7 && [green, blue, alpha] == [0.0, 1.0, 1.0],
        "{:?}",
        material.color
    );
    let texture = material.texture.expect("a texture");
    assert_eq!((texture.image, texture.sampling.wrap), (0, [Wrapping::Clamp; 2]));
    let texels: Vec<_> = model.images[0].pixels().map(|texel| texel.0).collect();
    assert_eq!(texels, [[200, 10, 0, 255], [0, 90, 255, 255]]);
    assert_eq!((material.normal, material.normal_scale), (None, 1.0));
}

#[test]
fn opacity_is_a_pattern() {
    let of = |library: &str| {
        let folder = folder(library)
            .with("c.png", image(COLORS))
            .with("d.png", image([[7, 7, 7, 255], [80, 90, 100, 255]]));
        let model = folder.read(TRIANGLE).expect("valid");
        let alphas: Vec<u8> =
            model.images.iter().flat_map(|image| image.pixels().map(|texel| texel[3])).collect();
        (model.materials[0].color[3], model.materials[0].alpha, alphas)
    };
    assert_eq!(of("newmtl wood\nd 0.5\n"), (0.5, Alpha::Dithered, vec![]));
    assert_eq!(of("newmtl wood\nTr 0.25\n"), (0.75, Alpha::Dithered, vec![]));
    // The image's own alpha if it has some, and otherwise its brightness.
    assert_eq!(of("newmtl wood\nmap_Kd c.png\nmap_d c.png\n"), (1.0, Alpha::Dithered, vec![100, 255]));
    assert_eq!(of("newmtl wood\nmap_Kd c.png\nmap_d d.png\n"), (1.0, Alpha::Dithered, vec![7, 90]));
    assert_eq!(of("newmtl wood\nmap_d d.png\n"), (1.0, Alpha::Dithered, vec![7, 90]));
}

#[test]
fn bumps_are_normal_maps_if_they_have_colours() {
    let of = |library: &str| {
        let grey = image([[9, 9, 9, 255], [200, 200, 200, 255]]);
        let folder = folder(library).with("n.png", image([[128, 128, 255, 255]; 2])).with("h.png", grey);
        let material = folder.read(TRIANGLE).expect("valid").materials.remove(0);
        (material.normal.map(|texture| texture.image), material.normal_scale)
    };
    assert_eq!(of("newmtl wood\nmap_Bump -bm 0.5 n.png\n"), (Some(0), 0.5));
    assert_eq!(of("newmtl wood\nbump h.png\n"), (None, 1.0));
    assert_eq!(of("newmtl wood\nbump h.png\nnorm n.png\n"), (Some(0), 1.0));
    // The same image as colours: still heights.
    assert_eq!(of("newmtl wood\nmap_Kd h.png\nbump h.png\n"), (None, 1.0));
}

/// The texture's rows run down; offset and scale are those of coordinates that run up.
#[test]
fn offset_and_scale_move_texture_coordinates() {
    let library = "newmtl wood\nmap_Kd -o 0.5 0.25 -s 2 4 c.png\n";
    let model = folder(library).with("c.png", image(COLORS)).read(TRIANGLE).expect("valid");
    assert_eq!(model.meshes[0].uv, [[0.5, 0.75], [2.5, 0.75], [0.5, -3.25]]);
}

#[test]
fn libraries_may_be_several_or_missing() {
    let text = TRIANGLE.replace("mtllib wood.mtl", "mtllib gone.mtl a.mtl\nmtllib the wood.mtl");
    let read = |text: &str, folder: Folder| folder.read(text).expect("valid");
    assert_eq!(read(&text, Folder::default()).meshes[0].material, None);
    let first = Folder::default().with("a.mtl", "newmtl wood\nd 0.5\n");
    let both = first.with("the wood.mtl", "newmtl wood\nd 0.25\nnewmtl wood\nd 0\n");
    assert_eq!(read(&text, both).materials[0].color[3], 0.5);
    let named = Folder::default().with("the wood.mtl", "newmtl wood\nd 0.25\nnewmtl wood\nd 0\n");
    assert_eq!(read(&text, named).materials[0].color[3], 0.25);
    // Without a folder there are no materials.
    let bare = Model::from_obj(text.as_bytes(), None).expect("valid");
    assert_eq!((bare.meshes[0].material, bare.materials.len()), (None, 0));
}

/// Images of a library lie beside it.
#[test]
fn libraries_may_lie_in_folders() {
    let text = TRIANGLE.replace("mtllib wood.mtl", "mtllib .\\lib\\wood.mtl");
    let folder = Folder::default().with("lib/wood.mtl", "newmtl wood\nmap_Kd maps\\c.png\n");
    let model = folder.with("lib/maps/c.png", image(COLORS)).read(&text).expect("valid");
    assert_eq!(model.images.len(), 1);
}

#[test]
fn mistakes_are_refused_with_the_librarys_line() {
    for (library, path, words) in [
        ("newmtl wood\nKd 1 2 3\n", "wood.mtl line 2", "3 numbers from 0 to 1"),
        ("newmtl wood\nd\n", "wood.mtl line 2", "1 number from 0 to 1"),
        ("newmtl wood\nmap_Kd\n", "wood.mtl line 2", "must name an image"),
        ("newmtl wood\nmap_Kd gone.png\n", "wood.mtl line 2", "cannot be read"),
        ("newmtl wood\nmap_Kd ../c.png\n", "wood.mtl line 2", "in the folder"),
        ("newmtl wood\n\nmap_Kd broken.png\n", "wood.mtl line 3", "must be a whole"),
        ("newmtl wood\nmap_d text.png\n", "wood.mtl line 2", "PNG, JPEG or WebP"),
    ] {
        let folder = folder(library).with("broken.png", &image(COLORS)[..40]).with("text.png", "text");
        let error = folder.read(TRIANGLE).map(|_| ()).expect_err(library);
        assert!(error.path == path && error.bound.contains(words), "{library}: {error}");
    }
    let outside = TRIANGLE.replace("wood.mtl", "../wood.mtl");
    let error = Folder::default().read(&outside).map(|_| ()).expect_err("outside");
    assert_eq!((&*error.path, &*error.value), ("line 1", "mtllib ../wood.mtl"));
    // Images of materials that no mesh uses are not read.
    assert!(folder("newmtl other\nmap_Kd gone.png\nnewmtl wood\n").read(TRIANGLE).is_ok());
}
