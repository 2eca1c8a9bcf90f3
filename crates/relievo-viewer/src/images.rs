//! Images whose decoder has to be waited for: in a page, those that the browser decodes.

#[cfg(target_arch = "wasm32")]
mod browser;

#[cfg(target_arch = "wasm32")]
use browser::forget;
#[cfg(target_arch = "wasm32")]
pub use browser::{decode, note, register};

#[cfg(not(target_arch = "wasm32"))]
use native::forget;
#[cfg(not(target_arch = "wasm32"))]
pub use native::{decode, note, register};

/// Files whose images were decoded beforehand. With the value, what was decoded is forgotten.
#[derive(Default)]
pub struct Decoded(pub Vec<Vec<u8>>);

impl Drop for Decoded {
    fn drop(&mut self) {
        forget(&self.0);
    }
}

/// Natively, the crate `image` decodes each image where it is read.
#[cfg(not(target_arch = "wasm32"))]
mod native {
    use relievo::gpu::Gpu;

    pub fn register() {}

    /// Nothing has to be decoded beforehand.
    pub fn note(_: &[u8]) {}

    /// Nothing was lacking.
    pub async fn decode(_: &Gpu) -> Vec<Vec<u8>> {
        Vec::new()
    }

    pub fn forget(_: &[Vec<u8>]) {}
}
