//! relievo gives a renderer complexity that it cannot afford to store or compute in full. Every hot path is a WGSL
//! compute or fragment pass, and every compute kernel is verified against a CPU reference on the current adapter.
//!
//! # The map
//!
//! [`asset`] is plain data, independent of any device: models with their skeletons, skins, clips, meshes and
//! materials, their import from glTF and Wavefront OBJ, and their export. [`mesh`] simplifies meshes and measures how far they
//! are apart.
//!
//! [`terrain`] generates heights from a seed, the same bits on every device, and has injected features, erosion,
//! normals and colour maps.
//!
//! [`surface`] has height maps, the ray-height methods with their measured error and cost, the maps that accelerate
//! them, and tangent frames.
//!
//! [`animation`] samples and concatenates the bones of crowds, with layers, gates (animation level of detail),
//! bounds, root motion, and priorities of bones and keys.
//!
//! [`skinning`] computes meshes that follow skeletons, their levels of detail, and which of their vertices need
//! work in a frame.
//!
//! [`lod`] decides which instances of a scene each view sees and with which level of detail, and lists them.
//!
//! `scene` is everything there is in a world (terrain, meshes, reliefs, characters), and views of it: what an engine
//! embeds. Its documentation begins with the order of calls, and has a whole program. It needs the feature `gpu`.
//!
//! `gpu` opens a device or takes the caller's. It has typed buffers, prepared jobs, timing and errors. `render`
//! has the renderer of scenes, which draws in the caller's render pass, shadows of the light, and an off-screen target. Both
//! need the feature `gpu`.
//!
//! `scene_file` reads scenes from JSON, builds them and draws their frames; it needs the feature `gpu`.
//!
//! Beside the library there are `relievo-samples` (a creature with clips, and height maps with their colours), `relievo-lab`
//! (it compares every kernel with its reference, measures it against a copy of the same bytes, and says what level of detail
//! costs and shows on the caller's own data), and the program `relievo-cli`.
//!
//! [`srgb`] converts between bytes and linear light. [`mod@hash`] draws counter-based random words. [`error`] names
//! invalid input by path, value and bound.
//!
//! `wgpu`, [`glam`] and [`image`] are exported, so that the versions of an embedding program match.
//!
//! # Axes and units
//!
//! | what | convention |
//! |---|---|
//! | world | right-handed, +Y up, x east, z south; metres, seconds, radians |
//! | height | `i32`, 1/65536 of a unit ([`terrain::config::HEIGHT_ONE`]); `f32` only for drawing |
//! | world coordinate of terrain | `i32`, 1/4096 of a patch's edge |
//! | fields | square, row by row: y (south) outer, x (east) inner |
//! | matrices | column-major; clip-space depth 0 (near) to 1 (far) |
//! | textures | origin top-left; sRGB in images, linear light in shaders |
//! | indices | `u32` |
//!
//! # The shape of an operation
//!
//! An operation is a folder: `mod.rs` has its parameters, `reference.rs` the CPU reference, which also serves machines
//! without a GPU, and `pass.rs` the GPU pass. A *pass* compiles its pipelines once. Its `prepare` binds buffers and
//! gives a *job*. `record` writes the job into the caller's command encoder, without submission, wait or allocation.
//!
//! ```
//! # #[cfg(feature = "gpu")] {
//! use relievo::gpu::{Buffer, Gpu, Options};
//! use relievo::terrain::morph::{Morph, MorphBuffers, MorphPass};
//!
//! let gpu = Gpu::headless(&Options::default())?; // or Gpu::from_wgpu(device, queue)
//! let from = Buffer::from_slice(&gpu, "from", &[0, 65_536])?; // heights in 1/65536 units
//! let to = Buffer::from_slice(&gpu, "to", &[65_536, 0])?;
//! let heights = Buffer::new(&gpu, "heights", 2)?;
//!
//! let pass = MorphPass::new(&gpu)?;
//! let job = pass.prepare(&gpu, MorphBuffers { from: &from, to: &to, heights: &heights })?;
//! job.set(&gpu, Morph { time: 0.25 })?;
//! gpu.run("morph", |encoder| job.record(encoder))?; // or record it into your own encoder
//! assert_eq!(heights.read_blocking(&gpu)?, [16_384, 49_152]);
//! # }
//! # Ok::<(), relievo::Error>(())
//! ```
//!
//! # Without a GPU
//!
//! ```
//! use relievo::terrain::field::field;
//! use relievo::terrain::{config::Config, export::sha256, recipe::Recipe};
//!
//! // B's own JSON, on the CPU. `relievo::terrain::generator::Generator` gives the same bits on a GPU.
//! let config = Config::from_json(r#"{"patchSize": 257, "scaleFactor": 40.0, "seed": "any text"}"#)?;
//! let patch = field(&Recipe::new(config), &[[0, 0]], 0)?.remove(0);
//! assert!(sha256(&patch).starts_with("d50dfddcc5fb3237"));
//! # Ok::<(), relievo::InputError>(())
//! ```

// Labels of features, which docs.rs shows.
#![cfg_attr(docsrs, feature(doc_cfg))]

// The samples and the laboratory's pictures, which unit tests have as modules, name this crate as their dependency.
#[cfg(test)]
extern crate self as relievo;

pub mod animation;
pub mod asset;
pub mod error;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod hash;
pub mod lod;
pub mod mesh;
#[cfg(test)]
#[allow(dead_code, reason = "the laboratory uses the rest")]
#[path = "../crates/relievo-lab/src/portrait/picture/mod.rs"]
mod picture;
#[cfg(feature = "gpu")]
pub mod render;
#[cfg(test)]
#[path = "../crates/relievo-samples/src/lib.rs"]
mod samples;
#[cfg(feature = "gpu")]
pub mod scene;
#[cfg(feature = "gpu")]
pub mod scene_file;
#[doc(hidden)]
pub mod shared;
pub mod skinning;
pub mod srgb;
pub mod surface;
pub mod terrain;

pub use error::{Error, InputError};
#[cfg(feature = "gpu")]
pub use wgpu;
pub use {glam, image};
