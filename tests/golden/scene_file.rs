//! Scenes of `examples/scenes/`, drawn through the library as the command line draws them.

use std::path::Path;

use image::RgbaImage;
use image::imageops::{FilterType, resize};
use relievo::scene_file::{LoadedScene, Player, Rendering};

use crate::harness::{Tolerance, check_golden, gpu};

/// The pictures: a scene file, and a time in it.
const PICTURES: &[(&str, &str, f32)] =
    &[("scene_ruins", "ruins.json", 0.0), ("scene_far", "far.json", 0.25), ("scene_herd", "herd.json", 2.5)];

/// The size of a golden. Frames have one sample a pixel at twice that size, and are averaged.
const SIZE: [u32; 2] = [208, 136];

fn picture(file: &str, seconds: f32) -> RgbaImage {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/scenes").join(file);
    let loaded = LoadedScene::from_path(&path).expect("valid");
    let rendering = Rendering {
        size: SIZE.map(|edge| 2 * edge),
        samples: 1,
        quality: loaded.file().quality(),
        ..Rendering::default()
    };
    let world = loaded.build(&gpu()).expect("built");
    let mut player = Player::new(world, rendering).expect("prepared");
    player.frame(seconds).expect("drawn");
    resize(&player.picture().expect("read"), SIZE[0], SIZE[1], FilterType::Triangle)
}

#[test]
fn scenes_of_files_equal_their_goldens() {
    let wrong: Vec<String> = (PICTURES.iter())
        .filter_map(|(name, file, seconds)| {
            let compared = check_golden(name, &picture(file, *seconds), Tolerance::IMAGE);
            compared.map(|difference| println!("{name}: {difference:?}")).err()
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
