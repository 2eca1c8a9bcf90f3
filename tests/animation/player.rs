//! A player in double precision that shares nothing with the crate: slerp by `acos` and `sin`, 4×4 matrices.

pub type Matrix = [[f64; 4]; 4];

pub fn dot(a: [f64; 4], b: [f64; 4]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub fn unit(q: [f64; 4]) -> [f64; 4] {
    let length = dot(q, q).sqrt();
    q.map(|component| component / length)
}

/// glTF 2.0, appendix C.4, with the sign of `b` chosen for the shorter way.
pub fn slerp(a: [f64; 4], b: [f64; 4], t: f64) -> [f64; 4] {
    let (a, b) = (unit(a), unit(b));
    let cosine = dot(a, b);
    let angle = cosine.abs().min(1.0).acos();
    if angle < 1e-9 {
        return a;
    }
    let (of_a, of_b) = (((1.0 - t) * angle).sin() / angle.sin(), (t * angle).sin() / angle.sin());
    let sign = if cosine < 0.0 { -1.0 } else { 1.0 };
    unit(std::array::from_fn(|i| of_a * a[i] + of_b * sign * b[i]))
}

/// The angle of the rotation from `a` to `b`, exact for small ones too.
pub fn angle(a: [f64; 4], b: [f64; 4]) -> f64 {
    let (a, b) = (unit(a), unit(b));
    let sign = if dot(a, b) < 0.0 { -1.0 } else { 1.0 };
    let chord: f64 = (0..4).map(|i| (a[i] - sign * b[i]).powi(2)).sum::<f64>().sqrt();
    4.0 * (chord / 2.0).min(1.0).asin()
}

pub fn wide<const N: usize>(values: [f32; N]) -> [f64; N] {
    values.map(f64::from)
}

/// The matrix of a translation, rotation and scale, row by row.
pub fn matrix(t: [f64; 3], q: [f64; 4], s: [f64; 3]) -> Matrix {
    let [x, y, z, w] = q;
    let rows = [
        [w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z],
    ];
    let mut matrix = [[0.0; 4]; 4];
    for (row, values) in rows.iter().enumerate() {
        matrix[row] = [values[0] * s[0], values[1] * s[1], values[2] * s[2], t[row]];
    }
    matrix[3][3] = 1.0;
    matrix
}

pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| (0..4).map(|k| a[row][k] * b[k][column]).sum()))
}
