// The texels at the corners of a map's bilinear cells.
import package::wgsl::surface::ray::SURFACE_WRAP;

// The index, among the texels of all maps of a batch, of the texel at the first corner of a cell, up to one cell beyond the last.
fn corner_index(size: vec2<u32>, address: u32, map: u32, cell: vec2<i32>) -> u32 {
    let texels = vec2<i32>(size);
    let wrapped = select(cell, vec2<i32>(0), cell >= texels);
    let clamped = clamp(cell - 1, vec2<i32>(0), texels - 1);
    let at = vec2<u32>(select(clamped, wrapped, address == SURFACE_WRAP));
    return (map * size.y + at.y) * size.x + at.x;
}
