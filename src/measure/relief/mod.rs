//! Surface mapping of the caller's own maps: a picture with any method, and every method's error and cost against the exact
//! intersection.

mod compare;
mod tracer;

use std::time::Instant;

use image::RgbaImage;
use serde::Serialize;

use crate::gpu::Gpu;
use crate::surface::{
    Green, HeightMap, Hit, March, Material, Measured, Method, Mips, Ray, Shadow, SquareView,
};
use crate::{Error, InputError};
pub use compare::{Comparison, Entry};
use tracer::Tracer;

/// A square of relief under a parallel projection, so that every pixel sees it at the same angle.
#[derive(Debug, Clone)]
pub struct ReliefSquare {
    /// Heights.
    pub map: HeightMap,
    /// Colours.
    pub albedo: Mips,
    /// Normals in tangent space; else those of the heights.
    pub normals: Option<Mips>,
    /// Where green of the normals points.
    pub green: Green,
    /// Self-shadow.
    pub shadow: Shadow,
    /// Whether what leaves the square is cut away.
    pub silhouette: bool,
    /// How rays are marched.
    pub march: March,
    /// Depth and light; the light in the square's tangent space.
    pub material: Material,
    /// Where it is seen from.
    pub view: SquareView,
}

/// A picture with what was measured on the way.
#[derive(Debug, Clone)]
pub struct Drawn {
    /// The picture.
    pub picture: RgbaImage,
    /// The ray of each pixel's centre, row by row, where it sees the square.
    pub rays: Vec<Option<Ray>>,
    /// What they met; default ones where there is no ray.
    pub hits: Vec<Hit>,
    /// Error and cost of these rays.
    pub measured: Measured,
    /// How long it took.
    pub seconds: Seconds,
}

/// Wall time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Seconds {
    /// Of making acceleration maps, and compiling.
    pub maps: f64,
    /// Of tracing the rays of all pixels' centres.
    pub rays: f64,
    /// Of drawing.
    pub picture: f64,
    /// Of the exact intersections.
    pub exact: f64,
}

impl ReliefSquare {
    /// Draws the square over a linear `background` with `finer` × `finer` samples a pixel (one where the device has no room
    /// for more), and measures the method. Without a device, the CPU does. `progress` hears what comes next, after
    /// each of four steps.
    ///
    /// # Errors
    /// [`InputError`] for a view in which no pixel sees the square, and what cannot be drawn; [`crate::gpu::GpuError`].
    pub fn draw(
        &self,
        method: Method,
        gpu: Option<&Gpu>,
        (background, finer): ([f32; 3], u32),
        progress: &dyn Fn(&'static str),
    ) -> Result<Drawn, Error> {
        let rays = self.view.rays(self.material.scale, self.material.plane);
        let seen: Vec<Ray> = rays.iter().flatten().copied().collect();
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
