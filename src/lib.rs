//! relievo gives a renderer complexity that it cannot afford to store or compute in full. Every hot path is a WGSL
//! compute or fragment pass, and every compute kernel is verified against a CPU reference on the current adapter.
//!
//! # Two storeys
//!
//! **The scene** is what an engine embeds: terrain, meshes, reliefs, characters and kinds of the caller's, seen through any number
//! of views, drawn into the caller's render pass. Its interface is stable.
//!
//! - `scene` has objects, instances, views and queries. Its documentation begins with the order of calls, and has a whole program.
//! - `render` has the renderer, which draws in the caller's render pass, shadows of the sun, and an off-screen target.
//! - `scene_file` reads scenes from JSON, builds them and draws their frames.
//! - `gpu` opens a device or takes the caller's. It has typed buffers, prepared jobs and errors.
//! - [`asset`] is plain data: models with their skeletons, skins, clips, meshes and materials, glTF and Wavefront OBJ in and out.
//! - [`error`] names invalid input by path, value and bound.
//!
//! **Operations** ([`ops`]) are for programs that bring their own buffers. Each is a GPU pass beside a CPU reference. They may
//! change in a minor release.
//!
//! `scene`, `render`, `scene_file` and `gpu` need the feature `gpu`, which is on unless it is turned off.
//!
//! Beside the library there are `relievo-samples` (a creature with clips, and height maps with their colours), `relievo-lab`
//! (it compares every kernel with its reference, measures it against a copy of the same bytes, and says what level of detail
//! costs and shows on the caller's own data), and the program `relievo-cli`.
//!
//! The documentation cites two theses as **A** and **B**, by section, table or equation; `docs/sources.md` in the repository names
//! them.
//!
//! `wgpu`, [`glam`] and [`image`] are exported, so that the versions of an embedding program match.
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

// Labels of features, which docs.rs shows.
#![cfg_attr(docsrs, feature(doc_cfg))]

// The samples and the laboratory's pictures, which unit tests have as modules, name this crate as their dependency.
#[cfg(test)]
extern crate self as relievo;

pub mod asset;
pub mod error;
#[cfg(feature = "gpu")]
pub mod gpu;
pub mod ops;
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
pub mod srgb;

pub use error::{Error, InputError};
#[allow(unused_imports, reason = "not all of them are used without a GPU")]
pub(crate) use ops::{animation, hash, lod, mesh, skinning, surface, terrain};
#[cfg(feature = "gpu")]
pub use wgpu;
pub use {glam, image};
