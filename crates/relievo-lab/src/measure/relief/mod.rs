//! Surface mapping of the caller's own maps: draws a picture by any ray-height method, and measures error and
//! cost of every method against the exact intersection.

pub use compare::{Comparison, Entry};
pub use measured::Measured;
use std::time::Instant;

use image::RgbaImage;
use relievo::gpu::Gpu;
use relievo::ops::surface::{
    Green, HeightMap, March, Mips, ReliefHit, ReliefMaterial, ReliefMethod, ReliefRay, ReliefShadow,
};
use relievo::{Error, InputError};
use serde::Serialize;
use tracer::Tracer;
pub use view::{SquareView, towards_light};

mod compare;
pub mod exact;
mod measured;
mod picture;
pub(crate) mod square;
mod tracer;
mod view;

/// A square of relief under a parallel projection, so that every pixel sees the square at the same angle.
#[derive(Debug, Clone)]
pub struct ReliefSquare {
    /// The height map.
    pub map: HeightMap,
    /// The colour map.
    pub albedo: Mips,
    /// The normal map, in tangent space; if it is `None`, normals are computed from the heights.
    pub normals: Option<Mips>,
    /// The direction of green in the normal map.
    pub green: Green,
    /// The self-shadow of the relief.
    pub shadow: ReliefShadow,
    /// Whether what leaves the square is cut away.
    pub silhouette: bool,
    /// How rays are marched through the relief.
    pub march: March,
    /// Depth and light; the light's direction is in the square's tangent space.
    pub material: ReliefMaterial,
    /// The direction from which the square is seen.
    pub view: SquareView,
}

/// A picture, and the measurements made with it.
#[derive(Debug, Clone)]
pub struct Drawn {
    /// The picture.
    pub picture: RgbaImage,
    /// For each pixel, row by row, the ray through its center; `None` where the pixel does not see the
    /// square.
    pub rays: Vec<Option<ReliefRay>>,
    /// For each pixel, the hit of its ray; the default where there is no ray.
    pub hits: Vec<ReliefHit>,
    /// Error and cost of these rays.
    pub measured: Measured,
    /// The time that each step took.
    pub seconds: Seconds,
}

/// Wall-clock times, in seconds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Seconds {
    /// Making acceleration maps, and compiling pipelines.
    pub maps: f64,
    /// Tracing the rays through all pixels' centers.
    pub rays: f64,
    /// Drawing the picture.
    pub picture: f64,
    /// Computing the exact intersections.
    pub exact: f64,
}

impl ReliefSquare {
    /// Draws the square over a linear `background` with `finer` × `finer` samples per pixel (one if the
    /// device has no room for more), and measures the method. Without a device, the CPU computes. `progress`
    /// is called after each of four steps, with the step that comes next.
    ///
    /// # Errors
    /// [`InputError`] for a view in which no pixel sees the square, and for maps that cannot be drawn;
    /// [`relievo::gpu::GpuError`] for errors of the device.
    pub fn draw(
        &self,
        method: ReliefMethod,
        gpu: Option<&Gpu>,
        background: [f32; 3],
        finer: u32,
        progress: &dyn Fn(&'static str),
    ) -> Result<Drawn, Error> {
        let rays = self.view.rays(self.material.scale, self.material.plane);
        let seen: Vec<ReliefRay> = rays.iter().flatten().copied().collect();
        if seen.is_empty() {
            let bound = "must be smaller, or size larger: no pixel sees the square";
            return Err(InputError::new("angle", self.view.angle, bound).into());
        }
        let step = |next: &'static str, start: Instant| {
            progress(next);
            start.elapsed().as_secs_f64()
        };
        let start = Instant::now();
        let tracer = Tracer::new(&self.map, method, self.march.address, gpu)?;
        let maps = step("tracing rays", start);
        let start = Instant::now();
        let found = tracer.trace(&seen, &self.march)?;
        let traced = step("drawing", start);
        let start = Instant::now();
        let picture = tracer.picture(self, background, finer)?;
        let pictured = step("measuring", start);
        let start = Instant::now();
        let measured = Measured::of(&self.map, self.march.address, &seen, &found);
        let exact = step("done", start);
        let mut found = found.into_iter();
        let hits = rays.iter().map(|ray| ray.and_then(|_| found.next()).unwrap_or_default()).collect();
        let seconds = Seconds { maps, rays: traced, picture: pictured, exact };
        Ok(Drawn { picture, rays, hits, measured, seconds })
    }
}
