//! The GPU pass of `kernels/terrain/height.wgsl`: one dispatch per level, for a batch of windows. It generates diamond-square heights of `seamless` windows.

use crate::terrain::levels::level_pass;

level_pass!(height, "terrain/height");
