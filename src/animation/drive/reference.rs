//! Driven bones: the CPU reference of `kernels/animation/drive.wgsl`.

use super::DrivenWord;

/// Adds driven bones to a gate's bits. `bits` are the sampled bones and `ahead` those among them that are sampled ahead, in
/// `words` words per instance. Instances with `hidden` set are left alone.
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
