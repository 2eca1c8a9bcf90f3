//! Images whose decoder has to be waited for: in a page, those that the browser decodes.

#[cfg(target_arch = "wasm32")]
mod browser;

#[cfg(target_arch = "wasm32")]
pub use browser::{decode, forget, note, register};

#[cfg(not(target_arch = "wasm32"))]
pub use native::{decode, forget, note};

/// Natively, the crate `image` decodes each image where it is read.
#[cfg(not(target_arch = "wasm32"))]
mod native {
    use relievo::gpu::Gpu;

    /// Nothing has to be decoded beforehand.
    pub fn note(_: &[u8]) {}

    /// Nothing was lacking.
    pub async fn decode(_: &Gpu) -> bool {
        false
    }

    pub fn forget() {}
}
