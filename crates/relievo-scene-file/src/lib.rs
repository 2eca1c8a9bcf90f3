//! Scene files: JSON that describes terrain, models, reliefs, a light and a camera. `relievo scene`, the demo and the golden
//! tests draw such files. Any program can do so with this crate.
//!
//! [`SceneFile::from_json`] checks the JSON text. [`SceneFile::load`] reads the files that the text names. It reads them through
//! a function of the caller, so it works without a file system. Names with the prefix `builtin:` come from the caller's
//! [`BuiltIns`]. `LoadedScene::build` creates a [`Scene`](relievo::scene::Scene); [`LoadedScene::build_async`] does so without
//! blocking.
//!
//! Every mistake is an [`InputError`](relievo::InputError) with its path inside the file (`characters[1].scatter.count`),
//! the value and the bound.
//!
#![doc = include_str!("../scene-files.md")]
//!
//! # An example
//!
//! ```
//! use relievo::scene::Depth;
//! use relievo_scene_file::SceneFile;
//!
//! let file = SceneFile::from_json(
//!     r#"{"terrain": {"config": {"patchSize": 33, "scaleFactor": 6, "seed": "meadow"}},
//!         "characters": [{"file": "builtin:creature", "clip": "walk", "scatter": {"count": 5, "seed": "herd"}}],
//!         "camera": {"at": [16, 12, 44], "look": [16, 0, 16]}}"#,
//! )?;
//! assert!(file.files().is_empty() && file.quality().pixels == 1.0);
//! let camera = file.camera().camera(0.0, [640, 400], Depth::Reversed);
//! assert_eq!(camera.viewport, [640, 400]);
//! // Then, with a device: `file.load(&|path| std::fs::read(folder.join(path)), &relievo_samples::Samples)?.build(&gpu)?`
//! let error = SceneFile::from_json(r#"{"camera": {"at": [0, 1, 0], "look": [0, 1, "far"]}}"#).unwrap_err();
//! assert_eq!(error.to_string(), "camera.look[2] = far: must be a number in -1000000000..=1000000000");
//! # Ok::<(), relievo::InputError>(())
//! ```

mod camera;
mod entries;
mod json;
mod load;
mod parse;
mod parse_character;
mod parse_lod;
mod parse_object;
mod scatter;
mod spec;
mod world;

pub use camera::CameraPath;
pub use load::LoadedScene;
pub use relievo::{BuiltIns, NoBuiltIns};
pub use spec::{SceneFile, SunOptions};
pub use world::{World, WorldKind, WorldObject};
