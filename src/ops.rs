//! Operations: GPU passes over the caller's buffers, each with a CPU reference. The scene is built from operations.
//!
//! **This interface may change in a minor release.** The scene interface may not (see the [crate documentation](crate)).
//!
//! Some functions of the scene take or return types of operations. `scene` and `render` re-export these types: import them from
//! there. The parts of a terrain's configuration (`terrain::config`) are as stable as `scene::TerrainConfig`.
//!
//! | module | operations |
//! |---|---|
//! | [`mesh`] | simplification, and progressive meshes: stored levels, and the patches between them |
//! | [`terrain`] | heights from a seed, the same bits on every device; features, erosion, normals, colour maps |
//! | [`surface`] | height maps, ray-height methods and the maps that accelerate them, tangent frames |
//! | [`animation`] | bones of crowds (sampling and concatenation), layers, gates (level of detail), bounds, root motion |
//! | [`skinning`] | skinned and morphed meshes, their levels of detail, and the vertices that need work in a frame |
//! | [`lod`] | culling, choice of levels, lists of instances and draws |
//! | [`hash`](mod@hash) | counter-based random words |
//!
//! # The shape of an operation
//!
//! An operation is a folder with three files. `mod.rs` has the parameters. `reference.rs` has the CPU reference, which also
//! serves machines without a GPU. `pass.rs` has the GPU pass. A *pass* compiles its pipelines once. Its `prepare` binds buffers
//! and returns a *job*. The job's `record` writes into the caller's command encoder, without submission, wait or allocation.
//!
//! ```
//! # #[cfg(feature = "gpu")] {
//! use relievo::gpu::{Buffer, Gpu, Options};
//! use relievo::ops::terrain::morph::{Morph, MorphBuffers, HeightMorphPass};
//!
//! let gpu = Gpu::headless(&Options::default())?; // or Gpu::from_wgpu(device, queue)
//! let from = Buffer::from_slice(&gpu, "from", &[0, 65_536])?; // heights in 1/65536 units
//! let to = Buffer::from_slice(&gpu, "to", &[65_536, 0])?;
//! let heights = Buffer::new(&gpu, "heights", 2)?;
//!
//! let pass = HeightMorphPass::new(&gpu)?;
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
//! use relievo::ops::terrain::field::field;
//! use relievo::ops::terrain::{config::TerrainConfig, export::sha256, recipe::Recipe};
//!
//! // Thesis B's own JSON, on the CPU. `relievo::ops::terrain::generator::Generator` gives the same bits on a GPU.
//! let config = TerrainConfig::from_json(r#"{"patchSize": 257, "scaleFactor": 40.0, "seed": "any text"}"#)?;
//! let patch = field(&Recipe::new(config), &[[0, 0]], 0)?.remove(0);
//! assert!(sha256(&patch).starts_with("d50dfddcc5fb3237"));
//! # Ok::<(), relievo::InputError>(())
//! ```

#[path = "animation/mod.rs"]
pub mod animation;
#[path = "lod/mod.rs"]
pub mod lod;
#[path = "skinning/mod.rs"]
pub mod skinning;
#[path = "surface/mod.rs"]
pub mod surface;
#[path = "terrain/mod.rs"]
pub mod terrain;

#[doc(inline)]
pub use relievo_asset::{hash, mesh};
