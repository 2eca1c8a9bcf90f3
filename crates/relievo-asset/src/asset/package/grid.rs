//! Whole numbers for the attributes of vertices. Each mapping gives back the same bits: a list of floats that lies on a grid
//! becomes multiples of the grid's step, and any other list becomes the bits of its floats, in the order of their values.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Largest number of bits of a multiple of a step. f32 has all of these multiples.
const MULTIPLE_BITS: u32 = 24;

/// Number of bits of a component of an octahedral normal.
pub(super) const NORMAL_BITS: u32 = 10;

/// Number of bits of the angle of a tangent.
pub(super) const TANGENT_BITS: u32 = 8;

/// Number of bits of a weight: weights are multiples of 2⁻¹⁴.
pub(super) const WEIGHT_BITS: u32 = 14;

/// How floats become whole numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Grid {
    /// Multiples of two to the power of this exponent.
    Step(i8),
    /// The bits of the floats.
    Bits,
}

impl Grid {
    /// The coarsest grid that has all of the values.
    pub fn of<'a>(values: impl Iterator<Item = &'a f32> + Clone) -> Self {
        let lowest = |value: &f32| {
            let bits = value.to_bits();
            let exponent = (bits >> 23 & 0xff) as i32;
            let mantissa = bits & 0x7f_ffff | u32::from(exponent > 0) << 23;
            exponent.max(1) - 150 + mantissa.trailing_zeros() as i32
        };
        let exponent = values.clone().filter(|value| **value != 0.0).map(lowest).min().unwrap_or(0);
        let grid = Self::Step(exponent.clamp(-120, 100) as i8);
        let has = |value: &f32| {
            let multiple = f64::from(*value) * grid.scale().recip();
            multiple.abs() < f64::from(1 << MULTIPLE_BITS)
                && grid.float(multiple as i32).to_bits() == value.to_bits()
        };
        if values.clone().all(has) { grid } else { Self::Bits }
    }

    /// The grid whose step is between 2⁻`bits` of `extent` and half of it, and at least 2⁻²³ of `largest`, the largest absolute
    /// value.
    pub fn fitting(extent: f32, largest: f32, bits: i32) -> Self {
        let exponent = |value: f32| (value.max(f32::MIN_POSITIVE).to_bits() >> 23) as i32 - 127;
        let exponent = (exponent(extent) - bits).max(exponent(largest) + 1 - (MULTIPLE_BITS as i32 - 1));
        Self::Step(exponent.clamp(-120, 100) as i8)
    }

    fn scale(self) -> f64 {
        match self {
            Self::Step(exponent) => f64::from_bits(((i64::from(exponent) + 1023) as u64) << 52),
            Self::Bits => 1.0,
        }
    }

    /// The whole number of a float that the grid has, or of the nearest float that the grid has.
    pub fn whole(self, value: f32) -> i32 {
        match self {
            Self::Step(_) => (f64::from(value) / self.scale()).round_ties_even() as i32,
            Self::Bits => ordered(value.to_bits() as i32),
        }
    }

    /// The float of a whole number.
    pub fn float(self, whole: i32) -> f32 {
        match self {
            Self::Step(_) => (f64::from(whole) * self.scale()) as f32,
            Self::Bits => f32::from_bits(ordered(whole) as u32),
        }
    }

    /// The nearest float that the grid has.
    pub fn snapped(self, value: f32) -> f32 {
        self.float(self.whole(value))
    }
}

/// Maps the bits of floats to numbers in the order of the floats. The mapping is its own inverse.
fn ordered(bits: i32) -> i32 {
    bits ^ ((bits >> 31) as u32 >> 1) as i32
}

/// How unit vectors become whole numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Directions {
    /// Normals by their place on an octahedron, tangents by their angle around the normal.
    Packed,
    /// The bits of the components.
    Bits,
}

/// Largest component of an octahedral normal.
pub(super) const OCTAHEDRON: i32 = (1 << (NORMAL_BITS - 1)) - 1;

/// The unit vector at a place on the octahedron (Cigolle et al., "A Survey of Efficient Representations for Independent Unit
/// Vectors", JCGT 2014).
pub(super) fn normal_of([u, v]: [i32; 2]) -> [f32; 3] {
    let [x, y] = [u, v].map(|part| f64::from(part) / f64::from(OCTAHEDRON));
    let z = 1.0 - x.abs() - y.abs();
    let [x, y] = if z < 0.0 { [(1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y)] } else { [x, y] };
    unit(DVec3::new(x, y, z))
}

fn unit(vector: DVec3) -> [f32; 3] {
    (vector / vector.dot(vector).sqrt()).to_array().map(|part| part as f32 + 0.0)
}

/// Where the line from the origin along a vector meets the octahedron, in units of places; the middle if the vector is 0.
fn on_octahedron(vector: DVec3) -> [f64; 2] {
    let sum = vector.x.abs() + vector.y.abs() + vector.z.abs();
    if sum.is_nan() || sum <= 0.0 {
        return [0.0; 2];
    }
    let flat = vector / sum;
    let place = match flat.z < 0.0 {
        true => [(1.0 - flat.y.abs()).copysign(flat.x), (1.0 - flat.x.abs()).copysign(flat.y)],
        false => [flat.x, flat.y],
    };
    place.map(|part| part * f64::from(OCTAHEDRON))
}

/// A place on the octahedron near a vector, which need not have length 1.
pub(super) fn near_octahedral(vector: DVec3) -> [i32; 2] {
    on_octahedron(vector).map(|part| part.round_ties_even() as i32)
}

/// The place on the octahedron whose unit vector is nearest to a normal.
pub(super) fn octahedral(normal: [f32; 3]) -> [i32; 2] {
    let wanted = DVec3::from(normal.map(f64::from));
    let [u, v] = on_octahedron(wanted).map(|part| part.floor() as i32);
    let near = [[u, v], [u + 1, v], [u, v + 1], [u + 1, v + 1]];
    let near = near.map(|place| place.map(|part| part.clamp(-OCTAHEDRON, OCTAHEDRON)));
    let facing = |place: &[i32; 2]| wanted.dot(DVec3::from(normal_of(*place).map(f64::from)));
    let best = near.into_iter().rev().max_by(|a, b| facing(a).total_cmp(&facing(b)));
    best.unwrap_or_default()
}

/// Two directions across a normal, perpendicular to each other. Tangents are angles between them.
#[derive(Clone, Copy)]
pub(super) struct Across([DVec3; 2]);

fn across(normal: [f32; 3]) -> [DVec3; 2] {
    let normal = DVec3::from(normal.map(f64::from));
    let least = normal.abs();
    let axis = if least.x <= least.y && least.x <= least.z {
        DVec3::X
    } else if least.y <= least.z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    let first = axis - normal * normal.dot(axis);
    let first = first / first.dot(first).sqrt();
    [first, normal.cross(first)]
}

/// Number of angles of tangents in a quarter turn.
const QUARTER: i32 = 1 << (TANGENT_BITS - 2);

/// The tangent at an angle around its normal. Angles are places on a square, 2^[`TANGENT_BITS`] in a turn. The sign is that of
/// the bitangent.
pub(super) fn tangent_of(normal: [f32; 3], angle: i32, sign: f32) -> [f32; 4] {
    Across::new(normal).tangent(angle, sign)
}

/// The angle of a tangent around its normal.
pub(super) fn angle_of(normal: [f32; 3], tangent: [f32; 4]) -> i32 {
    Across::new(normal).angle(tangent)
}

impl Across {
    pub fn new(normal: [f32; 3]) -> Self {
        Self(across(normal))
    }

    /// As [`tangent_of`].
    pub fn tangent(self, angle: i32, sign: f32) -> [f32; 4] {
        let part = f64::from(angle.rem_euclid(QUARTER)) / f64::from(QUARTER);
        let (x, y) = match angle.div_euclid(QUARTER).rem_euclid(4) {
            0 => (1.0 - part, part),
            1 => (-part, 1.0 - part),
            2 => (part - 1.0, -part),
            _ => (part, part - 1.0),
        };
        let Self([first, second]) = self;
        let [x, y, z] = unit(first * x + second * y);
        [x, y, z, sign]
    }

    /// As [`angle_of`].
    pub fn angle(self, tangent: [f32; 4]) -> i32 {
        let [x, y, z, _] = tangent.map(f64::from);
        let Self([first, second]) = self;
        let tangent = DVec3::new(x, y, z);
        let (x, y) = (tangent.dot(first), tangent.dot(second));
        let sum = x.abs() + y.abs();
        if sum.is_nan() || sum <= 0.0 {
            return 0;
        }
        let turns = match (x >= 0.0, y >= 0.0) {
            (true, true) => y / sum,
            (false, true) => 1.0 - x / sum,
            (false, false) => 2.0 - y / sum,
            (true, false) => 3.0 + x / sum,
        };
        (turns * f64::from(QUARTER)).round_ties_even() as i32 & (4 * QUARTER - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grids_give_back_the_same_bits() {
        let on_grid = [0.0, 0.25, -3.5, 1024.0];
        assert_eq!(Grid::of(on_grid.iter()), Grid::Step(-2));
        for values in [&on_grid[..], &[0.1, -0.0, 1e-30, 5e9], &[f32::MIN_POSITIVE / 4.0], &[]] {
            let grid = Grid::of(values.iter());
            assert!(values.iter().all(|value| grid.snapped(*value).to_bits() == value.to_bits()), "{grid:?}");
        }
        assert!(
            Grid::Bits.whole(-2.0) < Grid::Bits.whole(-1.0) && Grid::Bits.whole(-1.0) < Grid::Bits.whole(0.5)
        );
        assert_eq!(Grid::fitting(1.5, 1.0, 15), Grid::Step(-15));
        assert_eq!(Grid::fitting(1.5, 1e6, 15), Grid::Step(-3));
    }

    #[test]
    fn directions_stay_near_and_are_fixed_points() {
        let mut worst = [0.0_f64; 2];
        for at in 0..5000 {
            let [x, y, z] = [0.37, 0.73, 0.11].map(|step: f64| (step * f64::from(at)).fract() - 0.5);
            let normal = unit(DVec3::new(x, y, z));
            let packed = normal_of(octahedral(normal));
            assert_eq!(octahedral(packed), octahedral(normal));
            assert_eq!(normal_of(octahedral(packed)), packed);
            let [first, second] = across(packed);
            let [a, b, c] = unit(first * y + second * z);
            let tangent = tangent_of(packed, angle_of(packed, [a, b, c, 1.0]), 1.0);
            assert_eq!(tangent_of(packed, angle_of(packed, tangent), 1.0), tangent);
            let angle = |a: [f32; 3], b: [f32; 3]| {
                glam::Vec3::from(a).as_dvec3().angle_between(glam::Vec3::from(b).as_dvec3())
            };
            worst[0] = worst[0].max(angle(normal, packed));
            worst[1] = worst[1].max(angle([a, b, c], [tangent[0], tangent[1], tangent[2]]));
        }
        assert!(worst[0] < 0.003 && worst[1] < 0.02, "{worst:?}");
    }
}
