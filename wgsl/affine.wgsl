// Affine transforms, stored as three rows.

// One row of the product of two transforms. `row` is a row of the first transform; `x`, `y` and `z` are all rows of the second.
fn product_row(row: vec4<f32>, x: vec4<f32>, y: vec4<f32>, z: vec4<f32>) -> vec4<f32> {
    let linear = row.x * x + row.y * y + row.z * z;
    return vec4<f32>(linear.xyz, linear.w + row.w);
}
