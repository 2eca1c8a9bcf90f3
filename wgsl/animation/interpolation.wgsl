// Interpolation of values between keys, in tracks and in morph weights.

// Interpolation: a value stays constant until the next key.
const INTERPOLATION_STEP: u32 = 0u;
// Interpolation along a straight line; rotations take the shortest arc.
const INTERPOLATION_LINEAR: u32 = 1u;
// Interpolation by a cubic Hermite spline: a key has an in-tangent, a value and an out-tangent.
const INTERPOLATION_SPLINE: u32 = 2u;
