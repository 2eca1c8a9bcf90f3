//! relievo gives a renderer complexity that it cannot afford to store or compute in full. Every hot path is a
//! WGSL compute or fragment pass, proven against a CPU reference on the adapter at hand.
//!
//! # The map
//!
//! - [`asset`]: plain data: models with their skeletons, skins, clips, meshes and materials, and their import from glTF.
//! - [`terrain`]: seeded heights that are the same bits on every device, features, erosion, colours.
//! - [`surface`]: height maps, the ray-height methods with measured error and cost, acceleration maps, tangent
//!   frames.
//! - [`animation`]: sampling and concatenation, layers, gates, bounds, root motion, priorities of bones and keys.
//! - [`skinning`]: meshes that follow skeletons, and their levels of detail.
//! - [`mesh`]: meshes in fewer triangles.
//! - `gpu`: a device of its own or the caller's, typed buffers, prepared jobs, timing, errors. Feature `gpu`, as is
//!   `render`: a camera, an off-screen target, and passes that draw into the caller's render pass.
//! - `samples`: a creature with clips, and height maps with their colours. Feature `samples`.
//! - `verify` and `bench`: every kernel against its reference, and beside a copy of the same bytes. What `relievo verify` and
//!   `relievo bench` run. Feature `verify`, with `harness` (comparators, clocks) and `baseline` (kernels to measure
//!   against).
//! - `measure`: what level of detail costs and shows, for the caller's own models: errors, times, pareto curves. Feature
//!   `verify`.
//! - [`srgb`]: bytes and linear light. [`mod@hash`]: counter-based random words.
//! - [`error`]: bad input by field, value and bound.
//!
//! An operation is a folder: parameters in its `mod.rs`, the CPU reference in `reference.rs`, which is also the path of
//! machines without a GPU, the pass in `pass.rs`. `wgpu`, [`glam`] and [`image`] are exported, so that versions fit.
//!
//! # Axes and units
//!
//! | what | convention |
//! |---|---|
//! | world | right-handed, +Y up, x east, z south; metres, seconds, radians |
//! | height | `i32`, 1/65536 of a unit ([`terrain::config::HEIGHT_ONE`]); `f32` for drawing alone |
//! | world coordinate of terrain | `i32`, 1/4096 of a patch's edge |
//! | fields | square, row by row: y (south) outer, x (east) inner |
//! | matrices | column-major; clip-space depth 0 (near) to 1 (far) |
//! | textures | origin top-left; sRGB in images, linear light in shaders |
//! | indices | `u32` |
//!
//! # The shape of an operation
//!
//! A *pass* compiles its pipelines once. `prepare` binds buffers and gives a *job*. `record` writes a job into the
//! caller's command encoder: no hidden submission, no wait, no allocation.
//!
//! # An example
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

pub mod animation;
pub mod asset;
#[cfg(feature = "verify")]
pub mod baseline;
#[cfg(feature = "verify")]
pub mod bench;
pub mod error;
#[cfg(feature = "gpu")]
pub mod gpu;
#[cfg(feature = "verify")]
pub mod harness;
pub mod hash;
#[cfg(feature = "verify")]
pub mod measure;
pub mod mesh;
#[cfg(feature = "gpu")]
pub mod render;
#[cfg(feature = "samples")]
pub mod samples;
mod shared;
pub mod skinning;
pub mod srgb;
pub mod surface;
pub mod terrain;
#[cfg(feature = "verify")]
pub mod verify;

pub use error::{Error, InputError};
#[cfg(feature = "gpu")]
pub use wgpu;
pub use {glam, image};
