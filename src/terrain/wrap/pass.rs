//! The GPU pass of `kernels/terrain/wrap.wgsl`: one dispatch per level, for a batch of patches. It generates diamond-square heights of single patches.

use crate::terrain::levels::level_pass;

level_pass!(wrap, "terrain/wrap");
