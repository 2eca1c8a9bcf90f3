//! All relief methods: the CPU reference of `kernels/surface/relief.wgsl` and `wgsl/surface/trace.wgsl`.

pub mod cone;
pub mod flat;
pub mod grid;
pub mod height;
pub mod linear;
pub mod quadtree;

use crate::parallel;
use crate::surface::cone_map::reference::cone_map;
use crate::surface::height_pyramid::reference::height_pyramid;
use crate::surface::map::{Address, HeightMap};
use crate::surface::relief::reference::cone::cone;
use crate::surface::relief::reference::flat::{parallax, parallax_limited, plain};
use crate::surface::relief::reference::linear::{occlusion, relief};
use crate::surface::relief::reference::quadtree::quadtree;
use crate::surface::relief::{March, Outcome, ReliefHit, ReliefMethod, ReliefRay};

/// A height map together with the acceleration map of a method.
#[derive(Debug, Clone)]
pub struct ReliefSurface<'a> {
    /// The height map.
    pub map: &'a HeightMap,
    /// Address mode of the height map. The acceleration maps were computed for this mode.
    pub address: Address,
    /// Max-mip pyramid of the height map, for [`ReliefMethod::Quadtree`] and [`ReliefMethod::Cone`]; empty for other methods.
    pub pyramid: Vec<f32>,
    /// Cone map of the height map, for [`ReliefMethod::Cone`]; empty for other methods.
    pub cones: Vec<[f32; 2]>,
}

impl<'a> ReliefSurface<'a> {
    /// Computes the acceleration maps that `method` needs for a height map.
    pub fn new(map: &'a HeightMap, method: ReliefMethod, address: Address) -> Self {
        let pyramid = match method {
            ReliefMethod::Quadtree | ReliefMethod::Cone => height_pyramid(map, address),
            _ => Vec::new(),
        };
        let cones = if method == ReliefMethod::Cone { cone_map(map, &pyramid, address) } else { Vec::new() };
        Self { map, address, pyramid, cones }
    }

    /// Traces a ray with `method`. The surface's own address mode is used, not the mode in `march`.
    pub fn trace(&self, method: ReliefMethod, ray: &ReliefRay, march: &March) -> ReliefHit {
        if ray.cosine.is_nan() || ray.cosine <= 0.0 {
            return ReliefHit::of(ray, ray.polygon, 0, Outcome::Miss);
        }
        let march = &March { address: self.address, ..*march };
        match method {
            ReliefMethod::Plain => plain(ray),
            ReliefMethod::Parallax => parallax(self.map, ray, march),
            ReliefMethod::ParallaxLimited => parallax_limited(self.map, ray, march),
            ReliefMethod::Relief => relief(self.map, ray, march),
            ReliefMethod::Occlusion => occlusion(self.map, ray, march),
            ReliefMethod::Cone => cone(self.map, &self.cones, ray, march),
            ReliefMethod::Quadtree => quadtree(self.map, &self.pyramid, ray, march),
        }
    }

    /// Traces a list of rays like [`ReliefSurface::trace`], in parallel on all CPU threads.
    pub fn trace_all(&self, method: ReliefMethod, rays: &[ReliefRay], march: &March) -> Vec<ReliefHit> {
        parallel::map(rays, |ray| self.trace(method, ray, march))
    }
}
