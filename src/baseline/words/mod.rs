//! Random words, drawn and stored (`kernels/baseline/words.wgsl`).

mod pass;
pub mod reference;

pub use pass::WordsPass;
