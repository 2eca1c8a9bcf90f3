//! What level of detail and surface mapping cost and show, for the caller's own models and maps.

pub mod relief;
