//! How much a model may have for the bytes of its document: accessors without a buffer view are zeros that need none,
//! and nodes, animations and textures may name the same bytes again and again. Whatever an import allocates has been
//! counted here before, or lies in the document.

use std::cell::Cell;

use crate::InputError;

/// Elements that any document may have: vectors and numbers of accessors, each time they are read, and what is made of
/// them.
const ELEMENTS: u64 = 1 << 16;

/// Elements a byte, for documents that repeat what they have, up to [`MAX_REPEATED`].
const REPEATED: u64 = 128;

/// The most elements of a document that repeats what it has, about 300 MiB.
const MAX_REPEATED: u64 = 1 << 24;

/// Elements a byte, at least: more than any document has that repeats nothing.
const ELEMENTS_A_BYTE: u64 = 4;

/// Texels that all images of any document may have: 64 MiB of one of 4096².
const TEXELS: u64 = 1 << 24;

/// Texels a byte that all images together may have.
const TEXELS_A_BYTE: u64 = 256;

/// Texels that a byte of PNG or JPEG holds at most: deflate makes 1032 bytes of one, of 8 texels each.
const TEXELS_A_PACKED_BYTE: u64 = 8 * 1032;

/// What there is, and what has been made of it.
#[derive(Default)]
pub struct Budget {
    bytes: Cell<u64>,
    elements: Cell<u64>,
    texels: Cell<u64>,
}

impl Budget {
    /// More bytes have been found.
    pub fn add_bytes(&self, bytes: usize) {
        self.bytes.set(self.bytes.get().saturating_add(bytes as u64));
    }

    /// Counts elements before they are made. `path` has the count.
    ///
    /// # Errors
    /// [`InputError`] where they are too many.
    pub fn spend(&self, path: &str, count: usize) -> Result<(), InputError> {
        let bytes = self.bytes.get();
        let repeated = bytes.saturating_mul(REPEATED).clamp(ELEMENTS, MAX_REPEATED);
        let most = bytes.saturating_mul(ELEMENTS_A_BYTE).max(repeated);
        let all = self.elements.get().saturating_add(count as u64);
        if all > most {
            let bound = format!("with what came before must be at most {most} elements, for {bytes} bytes");
            return Err(InputError::new(path, count, bound));
        }
        self.elements.set(all);
        Ok(())
    }

    /// Refuses more zeros than there are bytes, but for a few.
    ///
    /// # Errors
    /// [`InputError`] with the largest count.
    pub fn check_zeros(&self, path: &str, count: u64) -> Result<(), InputError> {
        let most = self.bytes.get().max(ELEMENTS);
        if count > most {
            let bound = format!("must be at most {most} without a bufferView");
            return Err(InputError::new(path, count, bound));
        }
        Ok(())
    }

    /// Counts the texels of an image of so many bytes before it is decoded.
    ///
    /// # Errors
    /// [`InputError`] where the bytes cannot hold them, or all images have too many.
    pub fn spend_texels(&self, path: &str, size: [u32; 2], packed: usize) -> Result<(), InputError> {
        let texels = u64::from(size[0]) * u64::from(size[1]);
        let refused = |bound: String| {
            let [width, height] = size;
            Err(InputError::new(path, format!("{width} × {height}"), bound))
        };
        if texels > (packed as u64).saturating_mul(TEXELS_A_PACKED_BYTE) {
            return refused(format!("must fit {packed} bytes"));
        }
        let most = self.bytes.get().saturating_mul(TEXELS_A_BYTE).max(TEXELS);
        let all = self.texels.get().saturating_add(texels);
        if all > most {
            return refused(format!("with images before must be at most {most} texels"));
        }
        self.texels.set(all);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_bounded_by_bytes() {
        let found = |bytes: usize| {
            let budget = Budget::default();
            budget.add_bytes(bytes);
            let error = budget.spend("a.count", usize::MAX).expect_err("too many");
            let most: usize = error.bound.split(' ').find_map(|word| word.parse().ok()).expect("a number");
            assert_eq!(budget.spend("a", most - 1), Ok(()));
            assert_eq!(budget.spend("a", 1), Ok(()));
            assert_eq!(budget.spend("a.count", 1).expect_err("one too many").field, "a.count");
            most
        };
        assert_eq!(
            [0, 100, 3400, 1 << 20, 1 << 30].map(found),
            [1 << 16, 1 << 16, 128 * 3400, 1 << 24, 1 << 32]
        );
    }

    #[test]
    fn zeros_and_texels_too() {
        let budget = Budget::default();
        budget.add_bytes(100_000);
        assert_eq!(budget.check_zeros("a", 100_000), Ok(()));
        assert_eq!(budget.check_zeros("a", 100_001).expect_err("too many").value, "100001");
        assert_eq!(Budget::default().check_zeros("a", 1 << 16), Ok(()));
        let error = budget.spend_texels("i", [8192, 8192], 8000).expect_err("not in so few bytes");
        assert_eq!((&*error.value, &*error.bound), ("8192 × 8192", "must fit 8000 bytes"));
        assert_eq!(budget.spend_texels("i", [4096, 4096], 90_000), Ok(()));
        assert_eq!(budget.spend_texels("i", [4096, 2048], 90_000), Ok(()));
        assert!(budget.spend_texels("i", [1024, 512], 90_000).is_err());
        assert_eq!(budget.spend_texels("i", [640, 480], 90_000), Ok(()));
    }
}
