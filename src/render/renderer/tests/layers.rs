//! Drawing after a depth prepass gives the same colours as drawing without one.

use glam::Vec3;

use super::mesh::{mesh, painted, placements};
use super::relief::{Maps, place, square};
use super::stage::{FORMAT, Stage, differing, drawn, gpu, view};
use super::terrain::Land;
use crate::asset::material::Alpha;
use crate::asset::transform::rows;
use crate::gpu::{Gpu, Group};
use crate::render::Layer;
use crate::render::TargetFormat;
use crate::scene::TerrainStyle;
use crate::scene::drawable::Drawable;
use crate::scene::layouts::SceneLayouts;
use crate::surface::{ReliefMethod, ReliefOptions};

/// The number of pixels that a depth prepass changes, at 1 and at 4 samples.
fn changed(gpu: &Gpu, drawable: &dyn Drawable, stage: &Stage, ground: Option<&Group>) -> [usize; 2] {
    [1, 4].map(|samples| {
        let format = TargetFormat::new(FORMAT).with_samples(samples);
        let format = if stage.seen().reversed { format.reversed() } else { format };
        let drawn = |layers: &[Layer]| drawn(gpu, &format, drawable, stage, ground, layers);
        let plain = drawn(&[Layer::Color]);
        let covered = plain.iter().filter(|pixel| **pixel != [0; 4]).count();
        assert!(covered > 500, "{covered} pixels");
        assert!(drawn(&[Layer::Depth]).iter().all(|pixel| *pixel == [0; 4]), "depth has no colour");
        differing(&plain, &drawn(&[Layer::Depth, Layer::Color]), 0)
    })
}

#[test]
fn meshes_pass_behind_their_prepass() {
    let gpu = gpu();
    let layouts = SceneLayouts::new(&gpu).expect("valid");
    for (alpha, double_sided) in [(Alpha::Opaque, false), (Alpha::Mask(0.5), true), (Alpha::Dithered, false)]
    {
        let (drawable, indices) = mesh(&gpu, &layouts, &painted(alpha, double_sided), 3);
        for reversed in [false, true] {
            let seen = view(Vec3::new(0.4, 0.8, 4.5), reversed);
            let stage = Stage::new(&gpu, &layouts, seen, &placements(), &[[0, indices]]);
            assert_eq!(changed(&gpu, &drawable, &stage, None), [0, 0], "{alpha:?} {reversed}");
        }
    }
}

#[test]
fn reliefs_pass_behind_their_prepass() {
    let gpu = gpu();
    let layouts = SceneLayouts::new(&gpu).expect("valid");
    let maps = Maps::new(&gpu, ReliefMethod::Quadtree);
    for (depth, plane) in [(true, 1.0), (true, 0.5), (false, 1.0), (false, 0.3)] {
        let options = ReliefOptions { depth, silhouette: true, ..ReliefOptions::default() };
        let square = square(&gpu, &layouts, &maps, options, plane);
        for reversed in [false, true] {
            let seen = view(Vec3::new(0.3, 0.9, 1.6), reversed);
            let placement = rows(&place(Vec3::splat(1.2)).to_cols_array());
            let stage = Stage::new(&gpu, &layouts, seen, &[placement], &[[0, 6]]);
            assert_eq!(changed(&gpu, &square, &stage, None), [0, 0], "{depth} {plane} {reversed}");
        }
    }
}

#[test]
fn terrain_passes_behind_its_prepass() {
    let gpu = gpu();
    let layouts = SceneLayouts::new(&gpu).expect("valid");
    let land = Land::new(&gpu);
    let (drawable, indices) = land.drawable(&gpu, &layouts, TerrainStyle::Textured);
    let ground = land.ground(&gpu, &layouts, [5, 9]);
    let stage = land.stage(&gpu, &layouts, indices);
    assert_eq!(changed(&gpu, &drawable, &stage, Some(&ground)), [0, 0]);
}

#[test]
fn a_prepass_that_is_nearer_is_noticed() {
    let gpu = gpu();
    let layouts = SceneLayouts::new(&gpu).expect("valid");
    let (drawable, indices) = mesh(&gpu, &layouts, &painted(Alpha::Opaque, false), 3);
    let seen = view(Vec3::new(0.4, 0.8, 4.5), false);
    let stage = Stage::new(&gpu, &layouts, seen, &placements(), &[[0, indices]]);
    // The smallest change of the matrix that f32 can represent at the depths of this picture.
    let mut nearer = seen;
    nearer.clip_from_world = glam::Mat4::from_translation(Vec3::new(0.0, 0.0, -1e-6)) * seen.clip_from_world;
    let other = Stage::new(&gpu, &layouts, nearer, &placements(), &[[0, indices]]);
    let format = TargetFormat::new(FORMAT);
    let renderer = super::stage::renderer(&gpu, &format, &drawable);
    let plain = drawn(&gpu, &format, &drawable, &stage, None, &[Layer::Color]);
    let found = super::stage::Canvas::new(&gpu, &format).draw(&gpu, |pass| {
        for (stage, layer) in [(&other, Layer::Depth), (&stage, Layer::Color)] {
            let objects = [stage.object(&drawable, None)].into_iter();
            renderer.draw_objects(pass, &stage.seen(), objects, layer).expect("prepared");
        }
    });
    assert!(differing(&plain, &found, 0) > 100, "{} pixels", differing(&plain, &found, 0));
}
