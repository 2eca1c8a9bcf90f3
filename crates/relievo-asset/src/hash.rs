//! Counter-based random words (the CPU reference of `wgsl/hash.wgsl`), and hashes of data.

use sha2::{Digest, Sha256};

/// Number of counters that are hashed together, so that the compiler can vectorize the loops.
pub const LANES: usize = 8;

/// Random words for [`LANES`] counters `(x, y)` at once: Threefry-2x32 with 20 rounds (Salmon et al. 2011, `docs/sources.md`).
///
/// The constants are not taken from the shader but written out here, so that published known answers check both implementations.
#[inline(always)]
pub fn threefry2x32(key: [u32; 2], x: [u32; LANES], y: [u32; LANES]) -> ([u32; LANES], [u32; LANES]) {
    const EVEN: [u32; 4] = [13, 15, 26, 6];
    const ODD: [u32; 4] = [17, 29, 16, 24];
    let schedule = [key[0], key[1], 0x1bd1_1bda ^ key[0] ^ key[1]];
    let mut first = x.map(|word| word.wrapping_add(key[0]));
    let mut second = y.map(|word| word.wrapping_add(key[1]));
    for group in 0..5 {
        for rotation in if group % 2 == 0 { EVEN } else { ODD } {
            for lane in 0..LANES {
                first[lane] = first[lane].wrapping_add(second[lane]);
                second[lane] = second[lane].rotate_left(rotation) ^ first[lane];
            }
        }
        let inject = [schedule[(group + 1) % 3], schedule[(group + 2) % 3].wrapping_add(group as u32 + 1)];
        for lane in 0..LANES {
            first[lane] = first[lane].wrapping_add(inject[0]);
            second[lane] = second[lane].wrapping_add(inject[1]);
        }
    }
    (first, second)
}

/// Hash key of a text, for [`threefry2x32`]: the first eight bytes of the text's SHA-256, as two little-endian words.
pub fn key_of(text: &str) -> [u32; 2] {
    let digest = Sha256::digest(text.as_bytes());
    let word = |at: usize| u32::from_le_bytes([digest[at], digest[at + 1], digest[at + 2], digest[at + 3]]);
    [word(0), word(4)]
}

/// SHA-256 of `words` in little-endian byte order, as 64 hexadecimal digits.
pub fn sha256(words: &[u32]) -> String {
    let mut hash = Sha256::new();
    words.iter().for_each(|word| hash.update(word.to_le_bytes()));
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compares with the known answers of the Random123 distribution.
    #[test]
    fn known_answers() {
        let cases = [
            ([0, 0], [0, 0], [0x6b20_0159, 0x99ba_4efe]),
            ([u32::MAX; 2], [u32::MAX; 2], [0x1cb9_96fc, 0xbb00_2be7]),
            ([0x1319_8a2e, 0x0370_7344], [0x243f_6a88, 0x85a3_08d3], [0xc492_3a9c, 0x483d_f7a0]),
        ];
        for (key, [x, y], expected) in cases {
            let (first, second) = threefry2x32(key, [x; LANES], [y; LANES]);
            assert_eq!((first, second), ([expected[0]; LANES], [expected[1]; LANES]), "key {key:x?}");
        }
    }

    /// Compares with the output of `printf abcd | sha256sum`, and with the SHA-256 of an empty input.
    #[test]
    fn words_are_hashed_as_bytes() {
        let known = "88d4266fd4e6338d13b845fcf289579d209c897823b9217da3e161936f031589";
        assert_eq!(sha256(&[u32::from_le_bytes(*b"abcd")]), known);
        assert!(sha256(&[]).starts_with("e3b0c44298fc1c149afbf4c8996fb924"));
    }
}
