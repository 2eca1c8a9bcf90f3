//! Level of detail of an instance in its view: how far away it is (A section 12.10), and how much motion it may miss before
//! that is visible. The host quantizes these values, so that every device decides alike.

use crate::InputError;
use crate::shared::animation::gate_state;
/// Packed [`Lod`] that kernels read and write: the struct `Lod` of the WGSL module `animation`. Its `flags` are `LOD_HIDDEN`,
/// `LOD_FORCED` or 0.
pub use crate::shared::animation::gate_state::Lod as PackedLod;
pub use crate::shared::animation::gate_state::{FULL_WEIGHT, OMEGA_ONE};

/// An instance's level of detail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Lod {
    /// Ω, the level of detail by distance: 0 to [`OMEGA_ONE`], where nothing is skipped. See [`Range::omega`].
    pub omega: u32,
    /// Motion that may be missed, in units of the gate's table. See [`Projection::allowed`].
    pub allowed: u32,
    /// Weight of this instance's motion against that of other instances, 0 to [`FULL_WEIGHT`], proportional to its size on
    /// screen.
    pub weight: u32,
    /// Bones that a frame samples.
    pub sampling: BoneSampling,
}

/// Choice of the bones of an instance that a frame samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum BoneSampling {
    /// The bones that the gate chooses.
    #[default]
    Gated,
    /// No bones: the instance is not in view. It costs nothing, and is sampled in full when it comes back.
    Hidden,
    /// All bones, whatever the gate decides.
    Forced,
}

impl Lod {
    /// Full detail.
    pub const FULL: Self =
        Self { omega: OMEGA_ONE, allowed: 0, weight: FULL_WEIGHT, sampling: BoneSampling::Gated };

    /// The packed level of detail that kernels read.
    pub fn packed(&self) -> PackedLod {
        let flags = match self.sampling {
            BoneSampling::Gated => 0,
            BoneSampling::Hidden => gate_state::LOD_HIDDEN,
            BoneSampling::Forced => gate_state::LOD_FORCED,
        };
        PackedLod { omega: self.omega, allowed: self.allowed, weight: self.weight, flags }
    }
}

impl Default for Lod {
    fn default() -> Self {
        Self::FULL
    }
}

/// The distances, in metres, between which detail falls from full to none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Distance up to which Ω is 1.
    pub min: f32,
    /// Distance from which on Ω is 0.
    pub max: f32,
}

impl Range {
    /// Checks the distances.
    ///
    /// # Errors
    /// [`InputError`] for a minimum that is negative or not finite, and a maximum that is not above it.
    pub fn validate(&self) -> Result<(), InputError> {
        if !(self.min >= 0.0 && self.min.is_finite()) {
            return Err(InputError::new("range.min", self.min, "must be at least 0 and finite"));
        }
        if !(self.max > self.min && self.max.is_finite()) {
            return Err(InputError::new(
                "range.max",
                self.max,
                format!("must be above range.min, {}", self.min),
            ));
        }
        Ok(())
    }

    /// Ω at a distance, in 65536ths.
    ///
    /// **Decided**: `(max − d)/(max − min)`. A prints `(d − min)/(max − min)` (12.10), which contradicts its own end points.
    pub fn omega(&self, distance: f32) -> u32 {
        let fraction =
            (f64::from(self.max) - f64::from(distance)) / (f64::from(self.max) - f64::from(self.min));
        (fraction.clamp(0.0, 1.0) * f64::from(OMEGA_ONE)).round() as u32
    }
}

/// A camera's conversion from metres to pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// Focal length in pixels: the size of a metre at a distance of one metre on the axis. It is half the picture's height in
    /// pixels, divided by the tangent of half the field of view. Use the larger value of both directions.
    pub focal_pixels: f32,
    /// The distance of the near plane in metres.
    pub near: f32,
}

impl Projection {
    /// Projection of a picture of `height` pixels with a vertical field of view in radians.
    pub fn new(height: u32, field_of_view: f32, near: f32) -> Self {
        Self { focal_pixels: height as f32 / 2.0 / libm::tanf(field_of_view / 2.0), near }
    }

    /// Largest distance, in metres, by which every point inside a sphere may be off while no point is drawn more than `pixels`
    /// from its place. `center` is in camera space: x and y across, z along the view. The result is 0 if a part of the sphere
    /// may reach the near plane. `docs/pixel-bounds.md` has the derivation.
    pub fn allowed(&self, center: [f32; 3], radius: f32, pixels: f32) -> f32 {
        let [x, y, z] = center.map(f64::from);
        let (radius, pixels, focal) = (f64::from(radius), f64::from(pixels), f64::from(self.focal_pixels));
        let depth = z - radius;
        if depth <= f64::from(self.near) {
            return 0.0;
        }
        let across = x.hypot(y) + radius;
        let cosine = depth / depth.hypot(across);
        let way = pixels * cosine * depth / (focal + pixels * cosine);
        if depth - way <= f64::from(self.near) { 0.0 } else { way as f32 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn omega_falls_from_one_to_none() {
        let range = Range { min: 200.0, max: 1700.0 };
        assert_eq!([0.0, 200.0, 950.0, 1700.0, 5000.0].map(|d| range.omega(d)), [65536, 65536, 32768, 0, 0]);
        assert!(range.validate().is_ok());
        let refused = |min, max| Range { min, max }.validate().expect_err("refused").path;
        assert_eq!([refused(-1.0, 2.0), refused(f32::NAN, 2.0)], ["range.min", "range.min"]);
        assert_eq!([refused(2.0, 2.0), refused(2.0, f32::INFINITY)], ["range.max", "range.max"]);
    }

    /// Moves points inside spheres by the allowed distance in every direction, and projects them.
    #[test]
    fn what_is_allowed_stays_within_the_pixels() {
        let projection = Projection::new(1080, 1.0, 0.1);
        let mut worst = 0.0_f64;
        for (x, z, radius, pixels) in
            [(0.0, 10.0, 1.0, 1.0), (6.0, 8.0, 2.0, 0.25), (-3.0, 3.0, 0.5, 8.0), (40.0, 30.0, 1.0, 2.0)]
        {
            let allowed = f64::from(projection.allowed([x, 0.5, z], radius, pixels));
            assert!(allowed > 0.0);
            let around = |steps: u32, of: u32| {
                let (azimuth, height) = (f64::from(of % steps), f64::from(of / steps));
                let polar = height / f64::from(steps) * std::f64::consts::PI;
                let turn = azimuth / f64::from(steps) * std::f64::consts::TAU;
                [polar.sin() * turn.cos(), polar.sin() * turn.sin(), polar.cos()]
            };
            let screen = |[x, y, z]: [f64; 3]| [x / z, y / z].map(|s| s * f64::from(projection.focal_pixels));
            for (at, to) in (0..144).flat_map(|at| (0..144).map(move |to| (at, to))) {
                let (out, way) = (around(12, at), around(12, to));
                let center = [f64::from(x), 0.5, f64::from(z)];
                let fresh: [f64; 3] = std::array::from_fn(|i| center[i] + f64::from(radius) * out[i]);
                let stale: [f64; 3] = std::array::from_fn(|i| fresh[i] + allowed * way[i]);
                let ([ax, ay], [bx, by]) = (screen(fresh), screen(stale));
                let off = (ax - bx).hypot(ay - by) / f64::from(pixels);
                worst = worst.max(off);
                assert!(off <= 1.0 + 1e-6, "{off} of the pixels");
            }
        }
        assert!(worst > 0.5, "far too careful: {worst}");
        assert_eq!(projection.allowed([0.0, 0.0, 1.0], 0.95, 1.0), 0.0, "reaches the near plane");
        assert_eq!(projection.allowed([0.0, 0.0, -5.0], 1.0, 1.0), 0.0, "behind");
    }
}
