//! Relief methods: algorithms that find where a ray meets a height map, with their rays, parameters and results (thesis B,
//! section 3.1).
//!
//! Material shaders import the methods from `wgsl/surface/`. The command `relievo shaders` writes the methods as flat WGSL. The
//! kernel `kernels/surface/relief.wgsl` runs the methods on lists of rays.

#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "gpu")]
pub mod textures;

#[cfg(feature = "gpu")]
pub use pass::ReliefPass;

use std::str::FromStr;

use crate::InputError;
pub use crate::shared::surface::ray::{SurfaceHit as ReliefHit, SurfaceRay as ReliefRay};
use crate::shared::surface::{linear, ray, trace};
use crate::surface::map::Address;

/// Smallest cosine of the angle between a traced ray and the normal: the cosine of 89.55°. Flatter rays are traced with this
/// cosine.
pub const LEAST_COSINE: f32 = ray::SURFACE_LEAST_COSINE;

/// Largest number of linear search steps per ray.
pub const MAX_STEPS: u32 = linear::SURFACE_MAX_STEPS;

/// Largest number of binary search steps per ray.
pub const MAX_BINARY: u32 = linear::SURFACE_MAX_BINARY;

/// Largest depth of a relief, in uv units (1 = one tile).
pub const MAX_SCALE: f32 = 1.0;

/// Method that finds the point where a ray meets the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
#[repr(u32)]
pub enum ReliefMethod {
    /// No relief: the polygon's own texture coordinates.
    Plain = trace::SURFACE_PLAIN,
    /// Parallax mapping: shifts the texture coordinates once, by one height sample (Kaneko 2001).
    ///
    /// **Decided**: the bias is −`plane` · `scale`. Thesis B takes +½ · `scale` (3.1.1), but wants heights remapped around 0,
    /// which needs the minus sign.
    Parallax = trace::SURFACE_PARALLAX,
    /// Parallax mapping with Welsh's offset limiting, which shifts less at flat angles.
    ParallaxLimited = trace::SURFACE_PARALLAX_LIMITED,
    /// Linear search, then binary search (Policarpo 2005; thesis B, table 4.4).
    Relief = trace::SURFACE_RELIEF,
    /// Linear search, then intersection with the segment between the last two samples (Tatarchuk 2006; thesis B, section 2.3.1).
    Occlusion = trace::SURFACE_OCCLUSION,
    /// Steps over relaxed cones that are safe under bilinear filtering, then binary search. Needs a cone map.
    Cone = trace::SURFACE_CONE,
    /// Traversal of a max-mip pyramid, with exact intersection of bilinear patches (Tevs 2008; thesis B, section 2.3.4). Needs a
    /// height pyramid.
    Quadtree = trace::SURFACE_QUADTREE,
}

impl ReliefMethod {
    /// All methods, in the order of their numbers in the shaders.
    pub const ALL: [Self; 7] = [
        Self::Plain,
        Self::Parallax,
        Self::ParallaxLimited,
        Self::Relief,
        Self::Occlusion,
        Self::Cone,
        Self::Quadtree,
    ];

    /// Name of the method in options and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Parallax => "parallax",
            Self::ParallaxLimited => "parallax-limited",
            Self::Relief => "relief",
            Self::Occlusion => "occlusion",
            Self::Cone => "cone",
            Self::Quadtree => "quadtree",
        }
    }

    /// Number of the method in the shaders.
    pub fn code(self) -> u32 {
        self as u32
    }

    /// Returns whether the method's cost and error depend on the numbers of search steps.
    pub fn is_stepped(self) -> bool {
        matches!(self, Self::Relief | Self::Occlusion)
    }
}

impl FromStr for ReliefMethod {
    type Err = InputError;

    fn from_str(name: &str) -> Result<Self, InputError> {
        Self::ALL.into_iter().find(|method| method.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            InputError::new("method", name, format!("must be one of {names}"))
        })
    }
}

impl ReliefRay {
    /// Creates the ray that meets a polygon at `uv`. `view` is the unit vector towards the eye in tangent space. `scale` is the
    /// depth of the relief in uv units. `plane` is the polygon's height in the relief, 0 (bottom) to 1 (top).
    pub fn new(uv: [f32; 2], view: [f32; 3], scale: f32, plane: f32) -> Self {
        let steepness = -scale / view[2].max(LEAST_COSINE);
        let slope = [view[0] * steepness, view[1] * steepness];
        let polygon = 1.0 - plane;
        let origin = [uv[0] - polygon * slope[0], uv[1] - polygon * slope[1]];
        Self { origin, slope, cosine: view[2], polygon }
    }

    /// Texture coordinates of the ray at a parameter, 0 (top of the relief) to 1 (bottom).
    pub fn at(&self, parameter: f32) -> [f32; 2] {
        [self.origin[0] + parameter * self.slope[0], self.origin[1] + parameter * self.slope[1]]
    }
}

/// Parameters of the search along a ray (ray march).
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct March {
    /// Address mode of the height map. An acceleration map can be used only with the address mode it was computed for.
    pub address: Address,
    /// Numbers of linear steps for rays straight down (min) and for rays at the horizon (max), each 1 to [`MAX_STEPS`]. The
    /// second number must not be smaller than the first. For other rays, the number is ⌈mix(min, max, 1 − V.z)⌉, where V.z is the
    /// ray's cosine.
    ///
    /// **Decided**: the number of steps grows with the angle from the normal, as in the text of thesis B (3.1.2). Its table 4.4
    /// takes 10 steps at every angle.
    pub steps: [u32; 2],
    /// Number of binary search steps after the linear steps or the cone steps, 0 to [`MAX_BINARY`].
    pub binary_steps: u32,
}

impl Default for March {
    fn default() -> Self {
        Self { address: Address::Wrap, steps: [16, 64], binary_steps: 8 }
    }
}

impl March {
    /// Checks that all numbers of steps are within their bounds.
    ///
    /// # Errors
    /// [`InputError`] that names the first invalid field.
    pub fn validate(&self) -> Result<(), InputError> {
        let [low, high] = self.steps;
        InputError::check_within("steps[0]", low, 1..=MAX_STEPS)?;
        let bound = || format!("must be in {low}..={MAX_STEPS}: at least steps[0]");
        InputError::check((low..=MAX_STEPS).contains(&high), "steps[1]", high, bound)?;
        InputError::check_most("binary_steps", self.binary_steps, MAX_BINARY)
    }
}

/// Outcome of tracing a ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum Outcome {
    /// The ray comes from behind the polygon.
    Miss = ray::SURFACE_MISS,
    /// The ray met the surface.
    Hit = ray::SURFACE_HIT,
    /// The method ran out of steps. The result is the last point that it reached. `cone` and `quadtree` visit at most 32,774
    /// nodes, which is enough for rays that cross 16,384 cells.
    Exhausted = ray::SURFACE_EXHAUSTED,
}

impl Default for ReliefHit {
    /// A miss, with uv at the corner of the tile.
    fn default() -> Self {
        let outcome_code = Outcome::Miss as u32;
        Self { uv: [0.0; 2], height: 0.0, parameter: 0.0, samples: 0, outcome_code }
    }
}

impl ReliefHit {
    /// Creates the result at a parameter of the ray. `samples` is the number of texels loaded.
    pub fn of(ray: &ReliefRay, parameter: f32, samples: u32, outcome: Outcome) -> Self {
        Self {
            uv: ray.at(parameter),
            height: 1.0 - parameter,
            parameter,
            samples,
            outcome_code: outcome as u32,
        }
    }

    /// Outcome of the ray, decoded from `outcome_code`.
    pub fn outcome(&self) -> Outcome {
        match self.outcome_code {
            ray::SURFACE_MISS => Outcome::Miss,
            ray::SURFACE_HIT => Outcome::Hit,
            _ => Outcome::Exhausted,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_numbers_agree() {
        for (number, method) in ReliefMethod::ALL.into_iter().enumerate() {
            assert_eq!(method.code() as usize, number);
            assert_eq!(method.name().parse(), Ok(method));
        }
        assert_eq!("bump".parse::<ReliefMethod>().expect_err("no such method").path, "method");
    }

    #[test]
    fn steps_out_of_bounds_are_refused() {
        for (steps, path, value, bound) in [
            ([0, 4], "steps[0]", 0, "must be in 1..=1024"),
            ([MAX_STEPS + 1, 4], "steps[0]", MAX_STEPS + 1, "must be in 1..=1024"),
            ([8, 4], "steps[1]", 4, "must be in 8..=1024: at least steps[0]"),
            ([1, MAX_STEPS + 1], "steps[1]", MAX_STEPS + 1, "must be in 1..=1024: at least steps[0]"),
        ] {
            let found = March { steps, ..March::default() }.validate();
            assert_eq!(found, Err(InputError::new(path, value, bound)));
        }
        let march = March { binary_steps: MAX_BINARY + 1, ..March::default() };
        assert_eq!(march.validate().expect_err("refused").path, "binary_steps");
        assert!(March { steps: [1, MAX_STEPS], binary_steps: 0, ..March::default() }.validate().is_ok());
    }

    #[test]
    fn a_ray_meets_the_polygon_where_it_was_sent() {
        let ray = ReliefRay::new([0.25, 0.5], [0.6, 0.0, 0.8], 0.1, 0.5);
        let at = ray.at(ray.polygon);
        assert!((at[0] - 0.25).abs() < 1e-7 && at[1] == 0.5, "{at:?}");
        assert!(ray.slope[0] < 0.0, "rays go away from the eye");
        // Rays at the horizon have a bounded slope.
        assert!(ReliefRay::new([0.0; 2], [1.0, 0.0, 1e-9], 0.1, 1.0).slope[0] >= -12.8);
    }
}
