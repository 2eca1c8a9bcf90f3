//! Allocation budget of a document, in proportion to its size. Without a budget, small files could cause large allocations. An
//! accessor without a buffer view consists of zeros that take no bytes in the file. Nodes, animations and textures may refer to
//! the same bytes many times. Before an import allocates data that does not lie in the document, it charges this data to the
//! budget.

use std::cell::Cell;

use crate::InputError;

/// Number of elements that every document may have, however small. An element is a vector or a number that is read from an
/// accessor, or derived from such data. It counts each time it is read.
const ELEMENTS: u64 = 1 << 16;

/// Elements allowed per byte of a document that refers to the same bytes repeatedly, up to [`MAX_REPEATED`] in total.
const REPEATED: u64 = 128;

/// Largest number of elements of a document that refers to the same bytes repeatedly. They take about 300 MiB.
const MAX_REPEATED: u64 = 1 << 24;

/// Elements allowed per byte of any document. A document that refers to its bytes only once has fewer.
const ELEMENTS_A_BYTE: u64 = 4;

/// Elements allowed per byte of a document with compressed meshes: Draco can encode a triangle and half a vertex in one byte.
const ELEMENTS_A_PACKED_BYTE: u64 = 16;

/// Number of decompressed bytes that count as one element: four floats.
pub const BYTES_AN_ELEMENT: usize = 16;

/// Number of texels that the images of any document may have, however small: one image of 4096 × 4096, or 64 MiB.
const TEXELS: u64 = 1 << 24;

/// Texels allowed per byte of the document, for all its images together.
const TEXELS_A_BYTE: u64 = 256;

/// Largest number of texels that a byte of PNG or JPEG can encode. Deflate expands a byte to at most 1032 bytes, with 8 texels
/// each.
const TEXELS_A_PACKED_BYTE: u64 = 8 * 1032;

/// Number of bytes read so far, and the allocations charged against them.
pub struct Budget {
    elements_a_byte: u64,
    bytes: Cell<u64>,
    elements: Cell<u64>,
    texels: Cell<u64>,
}

impl Default for Budget {
    fn default() -> Self {
        let [bytes, elements, texels] = [(); 3].map(|()| Cell::new(0));
        Self { elements_a_byte: ELEMENTS_A_BYTE, bytes, elements, texels }
    }
}

impl Budget {
    /// Creates the budget of a document with compressed meshes.
    pub fn of_compressed() -> Self {
        Self { elements_a_byte: ELEMENTS_A_PACKED_BYTE, ..Self::default() }
    }

    /// Adds to the budget the bytes of a buffer that was read.
    pub fn add_bytes(&self, bytes: usize) {
        self.bytes.set(self.bytes.get().saturating_add(bytes as u64));
    }

    /// Charges `count` elements before they are allocated. `path` names the count in errors.
    ///
    /// # Errors
    /// [`InputError`] if the total exceeds the number of elements that the document may have.
    pub fn spend(&self, path: &str, count: usize) -> Result<(), InputError> {
        let most = self.most();
        let all = self.elements.get().saturating_add(count as u64);
        if all > most {
            let bytes = self.bytes.get();
            let bound = format!("with what came before must be at most {most} elements, for {bytes} bytes");
            return Err(InputError::new(path, count, bound));
        }
        self.elements.set(all);
        Ok(())
    }

    /// Number of elements that can still be charged.
    pub fn left(&self) -> u64 {
        self.most().saturating_sub(self.elements.get())
    }

    fn most(&self) -> u64 {
        let bytes = self.bytes.get();
        let repeated = bytes.saturating_mul(REPEATED).clamp(ELEMENTS, MAX_REPEATED);
        bytes.saturating_mul(self.elements_a_byte).max(repeated)
    }

    /// Refuses an accessor that consists of more zeros than the document has bytes. [`ELEMENTS`] zeros are always allowed.
    ///
    /// # Errors
    /// [`InputError`] with the largest count allowed.
    pub fn check_zeros(&self, path: &str, count: u64) -> Result<(), InputError> {
        let most = self.bytes.get().max(ELEMENTS);
        if count > most {
            let bound = format!("must be at most {most} without a bufferView");
            return Err(InputError::new(path, count, bound));
        }
        Ok(())
    }

    /// Charges the texels of an image before it is decoded. `packed` is the encoded size in bytes.
    ///
    /// # Errors
    /// [`InputError`] if the image has more texels than its bytes can hold, or if all images together have too many.
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
            assert_eq!((budget.left(), budget.spend("a", 1), budget.left()), (1, Ok(()), 0));
            assert_eq!(budget.spend("a.count", 1).expect_err("one too many").path, "a.count");
            most
        };
        assert_eq!(
            [0, 100, 3400, 1 << 20, 1 << 30].map(found),
            [1 << 16, 1 << 16, 128 * 3400, 1 << 24, 1 << 32]
        );
        let compressed = Budget::of_compressed();
        compressed.add_bytes(1 << 30);
        assert_eq!(compressed.left(), 1 << 34);
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
