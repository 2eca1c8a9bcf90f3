//! Driven bones: the CPU reference of `kernels/animation/drive.wgsl`.

use super::DrivenWord;

/// Adds driven bones to the bits of a gate: `bits` are the bones that are sampled, `ahead` those of them that are sampled ahead,
/// in `words` words per instance. Instances for which `hidden` is set are left alone.
///
/// # Panics
/// For words beyond the bits.
pub fn drive(driven: &[DrivenWord], words: usize, hidden: &[bool], [bits, ahead]: [&mut [u32]; 2]) {
    for word in driven {
        let at = word.at as usize;
        if !hidden[at / words] {
            bits[at] |= word.bones;
            ahead[at] &= !word.bones;
        }
    }
}
