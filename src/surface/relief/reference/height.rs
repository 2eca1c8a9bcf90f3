//! Bilinear heights: the CPU reference of `wgsl/surface/height.wgsl`.

pub use crate::shared::surface::height::SURFACE_BILINEAR as BILINEAR;
use crate::surface::map::{Address, HeightMap};

/// Bilinearly interpolated height at `uv`, 0 to 1.
pub fn height(map: &HeightMap, uv: [f32; 2], address: Address) -> f32 {
    let edges = [map.width(), map.height()];
    let axis = |axis: usize| {
        let size = edges[axis] as f32;
        let at = match address {
            Address::Wrap => (uv[axis] - uv[axis].floor()) * size - 0.5,
            Address::Clamp => (uv[axis] * size - 0.5).clamp(0.0, size - 1.0),
        };
        (at.floor() as i32, at - at.floor())
    };
    let ((x, right), (y, below)) = (axis(0), axis(1));
    let texel = |dx: i32, dy: i32| map.texel(x + dx, y + dy, address);
    let near = [texel(0, 0), texel(1, 0)];
    let far = [texel(0, 1), texel(1, 1)];
    let rows = [0, 1].map(|i| near[i] + below * (far[i] - near[i]));
    rows[0] + right * (rows[1] - rows[0])
}
