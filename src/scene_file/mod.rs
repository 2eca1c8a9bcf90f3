//! Scenes as files: JSON that names terrain, models, reliefs, a light and a camera. `relievo scene`, the demo and the golden
//! tests draw such files, and a program may do the same.
//!
//! [`SceneFile::from_json`] checks a text. [`SceneFile::load`] reads what it names, through a function of the caller's, so
//! that it works without a file system. `LoadedScene::build` makes a [`Scene`](crate::scene::Scene) of it (and
//! [`LoadedScene::build_async`] without blocking), and `Player` draws its frames off screen.
//!
//! Every mistake is an [`InputError`](crate::InputError) with its path inside the file (`characters[1].scatter.count`), the
//! value and the bound.
//!
//! # The format
//!
//! An object with these fields, of which only `camera` must be there, and something to see. Positions are in world units: x
//! east, y up, z south. Angles are in radians, times in seconds, colours in linear light. Files are relative to the scene's.
//!
//! | field | value |
//! |---|---|
//! | `terrain` | `config`, which is a configuration of [`Config`](crate::terrain::config::Config), and `patches`: a list of columns and rows; by default `[[0, 0]]` |
//! | `meshes` | a list of models that do not move by themselves |
//! | `characters` | a list of animated models |
//! | `light` | `direction` towards the light, `color`, `ambient` 0 to 1, `shadow`: whether it casts one, or an object with the `size` of its map in texels (2048) and its `range` ahead of the camera in world units (100) |
//! | `camera` | `at` and `look`, or a `path`: a list of moments with `time`, `at`, `look` and optionally `fov`, between which the camera moves smoothly. `fov` is the vertical field of view (0.8), `near` the near plane (0.1), `far` the far plane (at infinity) |
//! | `quality` | `pixels`, by how many anything may be off (1) |
//! | `background` | red, green and blue |
//!
//! A mesh and a character have a `file` (`.glb`, `.gltf`, or `builtin:creature`; meshes also `builtin:rock` and
//! `builtin:wall`), and `instances` or `scatter` or both.
//!
//! - An instance has a place: `at` `[x, y, z]`, or `on` `[x, z]`, on the ground that is drawn, and then optionally `lift`,
//!   how many model units above it. `turn` is an angle about the vertical axis, counter-clockwise seen from above, or a
//!   quaternion x, y, z, w. `scale` is a factor or three, along the model's axes; negative ones mirror.
//! - `scatter` has a `count` and a `seed`, which is any text: the same text gives the same places, on every machine. They lie
//!   on the ground of the terrain's patches, or inside an `area`: two corners `[[x, z], [x, z]]`; without terrain at height
//!   0. `scale` is a factor, or the smallest and the largest; `lift` as above. Everything is turned at random.
//! - A mesh may have a `material` with a relief: `relief` is the image of its heights (or `builtin:bricks`, `cobbles`,
//!   `text`, `posts`), in its `channel` `brightness` or `alpha`; `albedo` its colours (by default those that belong to the
//!   heights, or the model's), `normal` a normal map whose green points up, `scale` the depth in tiles (0.1), `tiles` a
//!   factor of the texture coordinates, `method` one of [`Method`](crate::surface::relief::Method) (`quadtree`), `shadow`
//!   `none`, `hard` or `soft`. Such a mesh has one level of detail.
//! - A character plays a `clip`, by its name or number (the first), at a `rate` (1) from `start` on (0), and then repeats it
//!   (`wrap` `loop`) or holds its last pose (`clamp`); each instance may differ. Scattered ones begin at random times.
//!
//! # An example
//!
//! ```
//! # #[cfg(feature = "samples")] {
//! use relievo::scene::Depth;
//! use relievo::scene_file::SceneFile;
//!
//! let file = SceneFile::from_json(
//!     r#"{"terrain": {"config": {"patchSize": 33, "scaleFactor": 6, "seed": "meadow"}},
//!         "characters": [{"file": "builtin:creature", "clip": "walk", "scatter": {"count": 5, "seed": "herd"}}],
//!         "camera": {"at": [16, 12, 44], "look": [16, 0, 16]}}"#,
//! )?;
//! assert!(file.files().is_empty() && file.quality().pixels == 1.0);
//! let camera = file.camera().camera(0.0, [640, 400], Depth::Reversed);
//! assert_eq!(camera.viewport, [640, 400]);
//! // Then, with a device: `file.load(&|path| std::fs::read(folder.join(path)))?.build(&gpu)?`
//! let error = SceneFile::from_json(r#"{"camera": {"at": [0, 1, 0], "look": [0, 1, "far"]}}"#).unwrap_err();
//! assert_eq!(error.to_string(), "camera.look[2] = far: must be a number in -1000000000..=1000000000");
//! # }
//! # Ok::<(), relievo::InputError>(())
//! ```

mod builtin;
mod camera;
mod entries;
mod json;
mod limits;
mod load;
mod parse;
mod parse_object;
#[cfg(not(target_arch = "wasm32"))]
mod player;
mod scatter;
mod spec;
mod world;

pub use camera::CameraPath;
pub use load::LoadedScene;
#[cfg(not(target_arch = "wasm32"))]
pub use player::{FrameTimes, Player, Rendering, SurfacePixel};
pub use spec::{SceneFile, SunOptions};
pub use world::{World, WorldKind, WorldObject};
