//! Random words, drawn and stored (`kernels/baseline/words.wgsl`).

pub use pass::WordsPass;

mod pass;
pub mod reference;
