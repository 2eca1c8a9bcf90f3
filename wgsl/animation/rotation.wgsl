// Interpolation of unit quaternions whose dot product is not negative.

// Factor of the last coefficient in `SLERP_U` and `SLERP_V`. It compensates for omitted terms of the polynomial. With this
// value, five terms have the smallest maximum error on halved arcs.
const SLERP_REST: f32 = 1.15;
// Coefficients 1/(i(2i + 1)), for i from 1 to 5, of Eberly's polynomial (Eberly 2011) for cosines from √½ to 1. The last one
// compensates for omitted terms.
const SLERP_U = array<f32, 5>(1.0 / 3.0, 1.0 / 10.0, 1.0 / 21.0, 1.0 / 36.0, SLERP_REST / 55.0);
// Coefficients i/(2i + 1), for i from 1 to 5, of Eberly's polynomial. The last one compensates for omitted terms.
const SLERP_V = array<f32, 5>(1.0 / 3.0, 2.0 / 5.0, 3.0 / 7.0, 4.0 / 9.0, SLERP_REST * 5.0 / 11.0);

// sin(t theta) / sin(theta), for two values of t at once. `less_one` is cos(theta) - 1.
fn slerp_weights(t: vec2<f32>, less_one: f32) -> vec2<f32> {
    let square = t * t;
    var sum = 1.0 + (SLERP_U[4] * square - SLERP_V[4]) * less_one;
    sum = 1.0 + (SLERP_U[3] * square - SLERP_V[3]) * less_one * sum;
    sum = 1.0 + (SLERP_U[2] * square - SLERP_V[2]) * less_one * sum;
    sum = 1.0 + (SLERP_U[1] * square - SLERP_V[1]) * less_one * sum;
    sum = 1.0 + (SLERP_U[0] * square - SLERP_V[0]) * less_one * sum;
    return t * sum;
}

// Spherical interpolation of unit quaternions (x, y, z, w) at constant speed on the shortest arc, for `t` from 0 to 1. The dot
// product of `a` and `b` must not be negative. The arc is halved: the polynomial runs from the nearer end to the unit
// quaternion in the middle. The error is within 1e-6.
fn slerp(a: vec4<f32>, b: vec4<f32>, t: f32) -> vec4<f32> {
    let cosine = dot(a, b);
    let inverse = inverseSqrt(2.0 + 2.0 * cosine);
    let less_one = (1.0 + cosine) * inverse - 1.0;
    let is_first = t < 0.5;
    let way = select(2.0 - 2.0 * t, 2.0 * t, is_first);
    let weights = slerp_weights(vec2<f32>(way, 1.0 - way), less_one);
    let of_middle = weights.x * inverse;
    let of_nearer = weights.y + of_middle;
    return select(b, a, is_first) * of_nearer + select(a, b, is_first) * of_middle;
}

// The quaternion scaled to length 1. Its length must not be 0.
fn unit_quaternion(q: vec4<f32>) -> vec4<f32> {
    return q * inverseSqrt(dot(q, q));
}
