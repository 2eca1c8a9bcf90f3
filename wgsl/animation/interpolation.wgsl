// Interpolation of values between keys, in tracks and in weights.

// Values stay constant until the next key.
const INTERPOLATION_STEP: u32 = 0u;
// A straight line; rotations take the shortest arc.
const INTERPOLATION_LINEAR: u32 = 1u;
// A cubic Hermite spline: a key has an in-tangent, a value and an out-tangent.
const INTERPOLATION_SPLINE: u32 = 2u;
