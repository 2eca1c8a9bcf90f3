// Bilinear heights, computed from texel loads. The functions use neither derivatives nor filtering that depends on the driver,
// so a march may call them in any control flow. The red channel is the height.
import package::wgsl::surface::ray::SURFACE_WRAP;

// Number of texel loads for one bilinear height.
const SURFACE_BILINEAR: u32 = 4u;

// Height, 0 to 1, at the coordinates `uv` in a mip level. `address` is SURFACE_WRAP or SURFACE_CLAMP.
fn surface_height(heights: texture_2d<f32>, uv: vec2<f32>, mip: u32, address: u32) -> f32 {
    let size = vec2<f32>(textureDimensions(heights, mip));
    let last = vec2<i32>(size) - 1;
    var low: vec2<i32>;
    var high: vec2<i32>;
    var weight: vec2<f32>;
    if address == SURFACE_WRAP {
        let at = (uv - floor(uv)) * size - 0.5;
        let corner = floor(at);
        weight = at - corner;
        low = vec2<i32>(corner);
        high = select(low + 1, vec2<i32>(0), low >= last);
        low = select(low, last, low < vec2<i32>(0));
    } else {
        let at = clamp(uv * size - 0.5, vec2<f32>(0.0), size - 1.0);
        let corner = floor(at);
        weight = at - corner;
        low = vec2<i32>(corner);
        high = min(low + 1, last);
    }
    let near = vec2<f32>(
        textureLoad(heights, low, mip).r,
        textureLoad(heights, vec2<i32>(high.x, low.y), mip).r);
    let far = vec2<f32>(
        textureLoad(heights, vec2<i32>(low.x, high.y), mip).r,
        textureLoad(heights, high, mip).r);
    let rows = near + weight.y * (far - near);
    return rows.x + weight.x * (rows.y - rows.x);
}

// Mip level at which a texel is about as large as a pixel. `uv_dx` and `uv_dy` are the screen derivatives of uv.
fn surface_mip(heights: texture_2d<f32>, uv_dx: vec2<f32>, uv_dy: vec2<f32>) -> u32 {
    let size = vec2<f32>(textureDimensions(heights));
    let texels = max(dot(uv_dx * size, uv_dx * size), dot(uv_dy * size, uv_dy * size));
    let level = 0.5 * log2(max(texels, 1.0));
    return min(u32(level + 0.5), textureNumLevels(heights) - 1u);
}
