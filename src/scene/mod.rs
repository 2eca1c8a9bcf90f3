//! What there is, and views of it.

pub(crate) mod drawable;
pub(crate) mod layouts;
pub(crate) mod material;
