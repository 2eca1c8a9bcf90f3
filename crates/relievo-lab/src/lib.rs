//! The laboratory of relievo: it proves and measures what the library does, on the adapter at hand.
//!
//! [`verify`] compares every kernel with its CPU reference (`relievo verify`), and [`mod@bench`] measures it against a copy of
//! the same bytes (`relievo bench`). [`OPERATIONS`] lists the cases of both; [`harness`] has comparators and clocks.
//!
//! [`measure`] says what methods cost and which errors they show on the caller's own data: level of detail in crowds of
//! models, and surface mapping on height maps. [`files`] writes reports and pictures whole or not at all. [`plot`] draws
//! charts.

pub mod bench;
pub mod cases;
pub mod files;
pub mod harness;
pub mod measure;
pub mod plot;
pub mod verify;

pub use cases::{OPERATIONS, Operation};
