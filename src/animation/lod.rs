//! Animation level of detail of an instance in a view: the detail by distance (thesis A, section 12.10), and the motion that the
//! instance may miss before the error is visible. The host quantizes these values to integers, so that every device makes the
//! same decisions.

use crate::InputError;
use crate::shared::animation::gate_state;
/// Packed [`Lod`] that kernels read and write: the struct `Lod` of the WGSL module `animation`. The field `flags` has
/// `LOD_HIDDEN`, `LOD_FORCED` or 0, and the tier of the skeleton.
pub use crate::shared::animation::gate_state::Lod as PackedLod;
pub use crate::shared::animation::gate_state::{FULL_WEIGHT, OMEGA_ONE};

/// Animation level of detail of one instance.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Lod {
    /// Ω, the level of detail by distance, 0 to [`OMEGA_ONE`]. At [`OMEGA_ONE`] nothing is skipped. See [`Range::omega`].
    pub omega: u32,
    /// Motion that may be missed, in units of the gate's table ([`BoundTable::units`](super::BoundTable::units)). See
    /// [`Projection::allowed`].
    pub allowed: u32,
    /// Weight of this instance's motion relative to other instances, 0 to [`FULL_WEIGHT`]. It is proportional to the instance's
    /// size on screen.
    pub weight: u32,
    /// Selects the bones that a frame samples: the gate's choice, none or all.
    pub sampling: BoneSampling,
    /// Tier of the skeleton whose bones are sampled ([`Skeleton::with_tier`](crate::asset::Skeleton::with_tier)); 0 is the whole
    /// skeleton. After a change, all bones of the new tier are sampled.
    pub tier: u32,
}

/// Selects the bones of an instance that a frame samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum BoneSampling {
    /// Samples the bones that the gate chooses.
    #[default]
    Gated,
    /// Samples no bones, because the instance is not in view. The instance costs nothing, and is sampled in full when it is
    /// visible again.
    Hidden,
    /// Samples all bones, whatever the gate decides.
    Forced,
}

impl Lod {
    /// Full detail: no motion may be missed, and the gate skips nothing.
    pub const FULL: Self =
        Self { omega: OMEGA_ONE, allowed: 0, weight: FULL_WEIGHT, sampling: BoneSampling::Gated, tier: 0 };

    /// The level of detail in the packed form that kernels read.
    pub fn packed(&self) -> PackedLod {
        let flags = match self.sampling {
            BoneSampling::Gated => 0,
            BoneSampling::Hidden => gate_state::LOD_HIDDEN,
            BoneSampling::Forced => gate_state::LOD_FORCED,
        };
        let flags = gate_state::lod_flags_word(flags, self.tier);
        PackedLod { omega: self.omega, allowed: self.allowed, weight: self.weight, flags }
    }
}

impl Default for Lod {
    fn default() -> Self {
        Self::FULL
    }
}

/// Distance range, in metres, over which the level of detail Ω falls from 1 to 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Distance in metres up to which Ω is 1.
    pub min: f32,
    /// Distance in metres at and beyond which Ω is 0.
    pub max: f32,
}

impl Range {
    /// Checks that both distances are finite and that `0 ≤ min < max`.
    ///
    /// # Errors
    /// [`InputError`] for a minimum that is negative or not finite, and for a maximum that is not finite or not above the
    /// minimum.
    pub fn validate(&self) -> Result<(), InputError> {
        if !(self.min >= 0.0 && self.min.is_finite()) {
            return Err(InputError::new("range.min", self.min, "must be at least 0 and finite"));
        }
        let bound = || format!("must be above range.min, {}", self.min);
        InputError::check(self.max > self.min && self.max.is_finite(), "range.max", self.max, bound)?;
        Ok(())
    }

    /// Ω at a distance in metres, 0 to [`OMEGA_ONE`].
    ///
    /// **Decided**: Ω = `(max − d)/(max − min)`. Thesis A prints `(d − min)/(max − min)` (section 12.10), which contradicts the
    /// end points that it gives.
    pub fn omega(&self, distance: f32) -> u32 {
        let fraction =
            (f64::from(self.max) - f64::from(distance)) / (f64::from(self.max) - f64::from(self.min));
        (fraction.clamp(0.0, 1.0) * f64::from(OMEGA_ONE)).round() as u32
    }
}

/// Parameters of a camera that convert metres to pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projection {
    /// Focal length in pixels: the size of one metre at a distance of one metre on the optical axis. It is half the picture's
    /// height in pixels, divided by the tangent of half the vertical field of view. If the horizontal and the vertical value
    /// differ, use the larger one.
    pub focal_pixels: f32,
    /// Distance of the near plane in metres.
    pub near: f32,
}

impl Projection {
    /// Creates the projection of a picture that is `height` pixels high. `field_of_view` is vertical, in radians; `near` is the
    /// distance of the near plane in metres.
    pub fn new(height: u32, field_of_view: f32, near: f32) -> Self {
        Self { focal_pixels: height as f32 / 2.0 / libm::tanf(field_of_view / 2.0), near }
    }

    /// Largest displacement, in metres, that moves every point of a sphere by at most `pixels` on screen. `center` is in camera
    /// space: x and y across, z along the view direction. The result is 0 if displaced points might reach the near plane.
    /// `docs/pixel-bounds.md` has the derivation.
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

    /// Displaces points inside spheres by the allowed distance in every direction, projects them, and checks the error in pixels.
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
