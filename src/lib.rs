//! relievo lets a renderer show more detail than it could store or compute in full. Every hot path is a WGSL compute or
//! fragment pass, and every compute kernel is verified against a CPU reference on the current adapter.
//!
//! # Two interfaces
//!
//! **The scene** is the interface for engines: terrain, meshes, reliefs, characters, and kinds of objects that the caller
//! defines. Any number of views can show a scene. It is drawn in the caller's render pass. This interface is stable.
//!
//! - `scene` has objects, instances, views and queries. Its documentation begins with the order of calls and a complete program.
//! - `render` has the renderer, the shadow of the sun, and an off-screen target. The renderer draws in the caller's render pass.
//! - `gpu` opens a device or takes the caller's device. It has typed buffers, prepared jobs and errors.
//! - [`asset`] has plain data: models with skeletons, skins, clips, meshes and materials. It reads and writes glTF,
//!   Wavefront OBJ, and packages of models with their levels of detail ([`asset::package`]).
//! - [`error`] has the error types. An error for invalid input names the path, the value and the bound.
//!
//! **Operations** ([`ops`]) are for programs that bring their own buffers. Each operation is a GPU pass with a CPU reference.
//! Operations may change in a minor release.
//!
//! `scene`, `render` and `gpu` need the feature `gpu`, which is on by default.
//!
//! Further crates of the repository:
//!
//! - `relievo-asset` has [`asset`], [`error`], [`ops::mesh`] and [`ops::hash`](mod@ops::hash), which need no GPU. This crate
//!   re-exports them; depend on this crate.
//! - `relievo-scene-file` reads scenes from JSON, and builds them.
//! - `relievo-samples` has a creature with clips, and height maps with their colours.
//! - `relievo-lab` checks every kernel against its reference. It compares the kernel's time with the time of copying the same
//!   number of bytes. It also reports the cost and the visible error of levels of detail on the caller's own data.
//! - `relievo-cli` is the program `relievo`.
//!
//! The documentation cites two theses as **A** and **B**, by section, table or equation. `docs/sources.md` in the repository has
//! their titles.
//!
//! The crate re-exports `wgpu`, [`glam`] and [`image`], so that an embedding program can use the same versions.
//!
//! # Axes and units
//!
//! | what | convention |
//! |---|---|
//! | world | right-handed, +Y up, x east, z south; metres, seconds, radians |
//! | height | `i32`, 1/65536 of a unit ([`ops::terrain::config::HEIGHT_ONE`]); `f32` only for drawing |
//! | world coordinate of terrain | `i32`, 1/4096 of a patch's edge |
//! | fields | square, row by row: y (south) outer, x (east) inner |
//! | matrices | column-major; clip-space depth 0 (near) to 1 (far) |
//! | textures | origin top-left; sRGB in images, linear light in shaders |
//! | indices | `u32` |

// Lets docs.rs label the items that need a feature.
#![cfg_attr(docsrs, feature(doc_cfg))]

// Unit tests include sources of other crates (`samples`, `picture`) as modules. These sources import this crate as `relievo`.
#[cfg(test)]
extern crate self as relievo;

mod built_ins;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod ops;
#[doc(hidden)]
pub mod parallel;
#[cfg(test)]
#[allow(dead_code, reason = "the laboratory uses the rest")]
#[path = "../crates/relievo-lab/src/portrait/picture/mod.rs"]
mod picture;
#[cfg(feature = "gpu")]
pub mod render;
#[cfg(test)]
#[allow(dead_code, reason = "scene files use the rest")]
#[path = "../crates/relievo-samples/src/lib.rs"]
mod samples;
#[cfg(feature = "gpu")]
pub mod scene;
#[doc(hidden)]
pub mod shared;
pub mod srgb;

pub use built_ins::{BuiltIns, NoBuiltIns};
#[allow(unused_imports, reason = "not all of them are used without a GPU")]
pub(crate) use ops::{animation, hash, lod, mesh, skinning, surface, terrain};
#[doc(inline)]
pub use relievo_asset::{Error, InputError, asset, error};
#[cfg(feature = "gpu")]
pub use wgpu;
pub use {glam, image};
