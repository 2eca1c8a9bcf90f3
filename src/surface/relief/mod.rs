//! Ray-height methods: which there are, what a ray is, how it is marched, and what it hits (B section 3.1).
//!
//! Material shaders import the methods from `wgsl/surface/`; `relievo shaders` writes them flat. The kernel here
//! runs them on lists of rays.

#[cfg(feature = "verify")]
pub mod bench;
#[cfg(feature = "gpu")]
mod pass;
pub mod reference;
#[cfg(feature = "gpu")]
pub mod textures;
#[cfg(feature = "verify")]
pub mod verify;

#[cfg(feature = "gpu")]
pub use pass::ReliefPass;
#[cfg(feature = "gpu")]
pub(crate) use pass::SurfaceMarch;

use std::str::FromStr;

use crate::InputError;
use crate::surface::map::Address;

/// The flattest cosine that rays are marched at: 89.55° from the normal.
pub const LEAST_COSINE: f32 = 1.0 / 128.0;

/// The most linear steps of a march.
pub const MAX_STEPS: u32 = 1024;

/// The most binary steps of a march.
pub const MAX_BINARY: u32 = 24;

/// The deepest relief, in uv units.
pub const MAX_SCALE: f32 = 1.0;

/// How the surface is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Not at all: the polygon's own coordinates.
    Plain,
    /// One height, one shift (Kaneko 2001).
    Parallax,
    /// The same with Welsh's offset limiting.
    ParallaxLimited,
    /// Linear, then binary search (Policarpo 2005; B table 4.4).
    Relief,
    /// Linear search, then the segment between the last two samples (Tatarchuk 2006; B section 2.3.1).
    Occlusion,
    /// Relaxed cones, safe under bilinear filtering, then binary search. Needs a cone map.
    Cone,
    /// Max-mip traversal with exact patches (Tevs 2008; B section 2.3.4). Needs a height pyramid.
    Quadtree,
}

impl Method {
    /// Every method, in the order of their numbers in the shaders.
    pub const ALL: [Self; 7] = [
        Self::Plain,
        Self::Parallax,
        Self::ParallaxLimited,
        Self::Relief,
        Self::Occlusion,
        Self::Cone,
        Self::Quadtree,
    ];

    /// Its name in options and reports.
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

    /// Its number in the shaders: `SURFACE_PLAIN` and its kin of `wgsl/surface/trace.wgsl`.
    pub fn code(self) -> u32 {
        self as u32
    }

    /// Whether its cost and error depend on the numbers of steps.
    pub fn is_stepped(self) -> bool {
        matches!(self, Self::Relief | Self::Occlusion)
    }
}

impl FromStr for Method {
    type Err = InputError;

    fn from_str(name: &str) -> Result<Self, InputError> {
        Self::ALL.into_iter().find(|method| method.name() == name).ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            InputError::new("method", name, format!("must be one of {names}"))
        })
    }
}

/// A ray through the relief volume: at parameter t it is at uv `origin + t · slope` and height 1 − t.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Ray {
    /// uv where it enters the volume, at height 1.
    pub origin: [f32; 2],
    /// uv that it travels while it falls to height 0.
    pub slope: [f32; 2],
    /// Cosine of the angle between eye and normal; 0 or less is a miss.
    pub cosine: f32,
    /// The parameter at which it meets the polygon: 0 where the polygon is the top of the volume.
    pub polygon: f32,
}

impl Ray {
    /// The ray that meets a polygon at `uv`. `view` is the unit vector towards the eye in tangent space, `scale`
    /// the relief's depth in uv units, `plane` the polygon's height in the volume, 1 (top) to 0.
    pub fn new(uv: [f32; 2], view: [f32; 3], scale: f32, plane: f32) -> Self {
        let steepness = -scale / view[2].max(LEAST_COSINE);
        let slope = [view[0] * steepness, view[1] * steepness];
        let polygon = 1.0 - plane;
        let origin = [uv[0] - polygon * slope[0], uv[1] - polygon * slope[1]];
        Self { origin, slope, cosine: view[2], polygon }
    }

    /// uv at a parameter.
    pub fn at(&self, parameter: f32) -> [f32; 2] {
        [self.origin[0] + parameter * self.slope[0], self.origin[1] + parameter * self.slope[1]]
    }
}

/// How rays are marched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct March {
    /// What lies beyond the map's edge. Acceleration maps are made for one address mode.
    pub address: Address,
    /// Linear steps straight down and at the horizon, 1 to [`MAX_STEPS`]; between, ⌈mix(min, max, 1 − V.z)⌉.
    pub steps: [u32; 2],
    /// Binary steps behind them, and behind cones, up to [`MAX_BINARY`].
    pub binary_steps: u32,
}

impl Default for March {
    fn default() -> Self {
        Self { address: Address::Wrap, steps: [16, 64], binary_steps: 8 }
    }
}

impl March {
    /// Refuses steps out of bounds.
    ///
    /// # Errors
    /// [`InputError`].
    pub fn validate(&self) -> Result<(), InputError> {
        let [low, high] = self.steps;
        if low < 1 || high < low || high > MAX_STEPS {
            let bound = format!("must satisfy 1 <= MIN <= MAX <= {MAX_STEPS}");
            return Err(InputError::new("steps", format!("{low},{high}"), bound));
        }
        if self.binary_steps > MAX_BINARY {
            let bound = format!("must be at most {MAX_BINARY}");
            return Err(InputError::new("binary_steps", self.binary_steps, bound));
        }
        Ok(())
    }
}

/// Whether a ray met the surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It came from behind.
    Miss,
    /// It did.
    Hit,
    /// The method ran out of steps; the result is where it stood. `cone` and `quadtree` look at 32,774 nodes at the
    /// most: enough for rays that cross 16,384 cells.
    Exhausted,
}

/// What a ray hit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "gpu", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(C)]
pub struct Hit {
    /// Displaced texture coordinates; beyond the tile where the ray left it.
    pub uv: [f32; 2],
    /// Height of the surface there.
    pub height: f32,
    /// The ray's parameter there.
    pub parameter: f32,
    /// Texels loaded, those of acceleration maps included.
    pub samples: u32,
    /// 0 miss, 1 hit, 2 exhausted: see [`Hit::outcome`].
    pub code: u32,
}

impl Hit {
    /// A point of the ray as the result.
    pub fn of(ray: &Ray, parameter: f32, samples: u32, outcome: Outcome) -> Self {
        Self { uv: ray.at(parameter), height: 1.0 - parameter, parameter, samples, code: outcome as u32 }
    }

    /// Whether the ray met the surface.
    pub fn outcome(&self) -> Outcome {
        match self.code {
            0 => Outcome::Miss,
            1 => Outcome::Hit,
            _ => Outcome::Exhausted,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_numbers_agree() {
        for (number, method) in Method::ALL.into_iter().enumerate() {
            assert_eq!(method.code() as usize, number);
            assert_eq!(method.name().parse(), Ok(method));
        }
        assert_eq!("bump".parse::<Method>().expect_err("no such method").field, "method");
    }

    #[test]
    fn steps_out_of_bounds_are_refused() {
        for steps in [[0, 4], [8, 4], [1, MAX_STEPS + 1]] {
            assert_eq!(March { steps, ..March::default() }.validate().expect_err("refused").field, "steps");
        }
        let march = March { binary_steps: MAX_BINARY + 1, ..March::default() };
        assert_eq!(march.validate().expect_err("refused").field, "binary_steps");
        assert!(March { steps: [1, MAX_STEPS], binary_steps: 0, ..March::default() }.validate().is_ok());
    }

    #[test]
    fn a_ray_meets_the_polygon_where_it_was_sent() {
        let ray = Ray::new([0.25, 0.5], [0.6, 0.0, 0.8], 0.1, 0.5);
        let at = ray.at(ray.polygon);
        assert!((at[0] - 0.25).abs() < 1e-7 && at[1] == 0.5, "{at:?}");
        assert!(ray.slope[0] < 0.0, "rays go away from the eye");
        // At the horizon the slope is bounded.
        assert!(Ray::new([0.0; 2], [1.0, 0.0, 1e-9], 0.1, 1.0).slope[0] >= -12.8);
    }
}
