//! Driven bones: the CPU reference of `kernels/animation/drive.wgsl`.

use super::DrivenWord;

/// Adds driven bones to a gate's bits. `bits` marks the sampled bones and `ahead` the bones that are sampled ahead; both have
/// `words` words per instance. Driven bones are never sampled ahead. `hidden` has one entry per instance; the bits
/// of hidden instances do not change.
///
/// # Panics
/// If the index of a driven word is beyond `bits`, `ahead` or the instances of `hidden`.
pub fn drive(driven: &[DrivenWord], words: usize, hidden: &[bool], [bits, ahead]: [&mut [u32]; 2]) {
    for word in driven {
        let at = word.at as usize;
        if !hidden[at / words] {
            bits[at] |= word.bones;
            ahead[at] &= !word.bones;
        }
    }
}
