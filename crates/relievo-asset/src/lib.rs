//! The parts of relievo that need no GPU: models with their files, meshes with their levels of detail, and errors.
//!
//! **Depend on the crate `relievo`**, which re-exports all of this: [`asset`] and [`error`] under the same names, [`hash`](mod@hash)
//! and [`mesh`] in `relievo::ops`.

// Lets docs.rs label the items that need a feature.
#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod asset;
pub mod error;
pub mod hash;
pub mod mesh;

pub use error::{Error, InputError};
