//! A square of relief under a parallel projection: every pixel sees it at the same angle, so that errors and
//! costs can be attributed to that angle.

use relievo::InputError;
use relievo::ops::surface::relief::ReliefRay;

/// The view of a textured square. In tangent space u points right, v down the image, and the normal towards the
/// viewer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SquareView {
    /// Angle between the eye and the square's normal in degrees, 0 to below 90.
    pub angle: f64,
    /// Angle of the eye around the normal in degrees: at 0 the eye is below the image's bottom edge, at 90 to
    /// its right.
    pub azimuth: f64,
    /// Tiles along an edge of the square, > 0.
    pub tiles: f64,
    /// Pixels of the picture along x and y.
    pub size: [u32; 2],
}

/// The largest fraction of the picture that the square fills.
const FILLED: f64 = 0.94;

impl SquareView {
    /// Refuses views from behind, and pictures without pixels.
    ///
    /// # Errors
    /// [`InputError`].
    pub fn validate(&self) -> Result<(), InputError> {
        let refuse = |field: &str, value: String, bound: &str| Err(InputError::new(field, value, bound));
        if !(0.0..90.0).contains(&self.angle) {
            return refuse("angle", self.angle.to_string(), "must be at least 0 and below 90 degrees");
        }
        if !self.azimuth.is_finite() {
            return refuse("azimuth", self.azimuth.to_string(), "must be a finite number of degrees");
        }
        if !(1e-3..=64.0).contains(&self.tiles) {
            return refuse("tiles", self.tiles.to_string(), "must be in 0.001..=64");
        }
        if let Some(axis) = self.size.iter().position(|edge| !(1..=8192).contains(edge)) {
            return refuse(
                &format!("size[{axis}]"),
                self.size[axis].to_string(),
                "must be in 1..=8192 pixels",
            );
        }
        Ok(())
    }

    /// The same view with `factor` times the pixels along each edge.
    pub fn scaled(self, factor: u32) -> Self {
        Self { size: self.size.map(|edge| edge * factor), ..self }
    }

    /// The unit vector towards the eye, in tangent space.
    pub fn towards(&self) -> [f64; 3] {
        let ((sine, cosine), (east, south)) = (sin_cos(self.angle), sin_cos(self.azimuth));
        [sine * east, sine * south, cosine]
    }

    /// The unit vectors to the right and up in the picture, in tangent space.
    pub fn axes(&self) -> [[f64; 3]; 2] {
        let ((sine, cosine), (east, south)) = (sin_cos(self.angle), sin_cos(self.azimuth));
        [[south, -east, 0.0], [-cosine * east, -cosine * south, sine]]
    }

    /// Pixels per edge length of the square.
    pub fn zoom(&self) -> f64 {
        let [right, up] = self.axes();
        let extent = |axis: [f64; 3]| axis[0].abs() + axis[1].abs();
        let [width, height] = self.size.map(f64::from);
        FILLED * (width / extent(right)).min(height / extent(up))
    }

    /// The texture coordinates at which a point of the picture (pixels from the top left) sees the square;
    /// `None` beyond it.
    pub(crate) fn uv(&self, x: f64, y: f64) -> Option<[f64; 2]> {
        let zoom = self.zoom();
        let [width, height] = self.size.map(f64::from);
        let (across, up) = ((x - width / 2.0) / zoom, (height / 2.0 - y) / zoom);
        let ((_, cosine), (east, south)) = (sin_cos(self.angle), sin_cos(self.azimuth));
        let place = [across * south - up * east / cosine + 0.5, -across * east - up * south / cosine + 0.5];
        let is_inside = place.iter().all(|axis| (0.0..=1.0).contains(axis));
        is_inside.then(|| place.map(|axis| axis * self.tiles))
    }

    /// The change of uv from one pixel to the next, along x and along y.
    pub(crate) fn uv_steps(&self) -> [[f64; 2]; 2] {
        let ((_, cosine), (east, south)) = (sin_cos(self.angle), sin_cos(self.azimuth));
        let step = self.tiles / self.zoom();
        [[south * step, -east * step], [east / cosine * step, south / cosine * step]]
    }

    /// The ray through a point of the picture, if that sees the square. The relief has a depth of `scale` (uv
    /// units), and the square lies at height `plane` in it.
    pub(crate) fn ray(&self, x: f64, y: f64, scale: f32, plane: f32) -> Option<ReliefRay> {
        let view = self.towards().map(|axis| axis as f32);
        self.uv(x, y).map(|uv| ReliefRay::new(uv.map(|axis| axis as f32), view, scale, plane))
    }

    /// The rays through the centers of all pixels, row by row.
    pub fn rays(&self, scale: f32, plane: f32) -> Vec<Option<ReliefRay>> {
        let [width, height] = self.size;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        pixels.map(|(x, y)| self.ray(f64::from(x) + 0.5, f64::from(y) + 0.5, scale, plane)).collect()
    }
}

/// Sine and cosine of an angle in degrees; exact at multiples of 90.
fn sin_cos(degrees: f64) -> (f64, f64) {
    match degrees.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        other => libm::sincos(other.to_radians()),
    }
}

/// The unit vector towards a light, in tangent space. `azimuth` is as in [`SquareView`], and `elevation` the
/// angle above the square, both in degrees.
///
/// # Errors
/// [`InputError`] that names `light.azimuth` where it is not finite, and `light.elevation` outside 0 to 90 degrees.
pub fn towards_light(azimuth: f64, elevation: f64) -> Result<[f64; 3], InputError> {
    if !azimuth.is_finite() {
        return Err(InputError::new("light.azimuth", azimuth, "must be a finite number of degrees"));
    }
    if !(0.0..=90.0).contains(&elevation) {
        return Err(InputError::new("light.elevation", elevation, "must be in 0..=90 degrees"));
    }
    let view = SquareView { angle: 90.0 - elevation, azimuth, tiles: 1.0, size: [1, 1] };
    Ok(view.towards())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(angle: f64, azimuth: f64) -> SquareView {
        SquareView { angle, azimuth, tiles: 3.0, size: [400, 300] }
    }

    #[test]
    fn straight_down_the_image_is_upright_and_whole() {
        let view = view(0.0, 0.0);
        let edge = FILLED * 300.0;
        let [left, top] = [200.0 - edge / 2.0 + 0.01, 150.0 - edge / 2.0 + 0.01];
        let corner = view.uv(left, top).expect("inside");
        assert!(corner[0] < 0.001 && corner[1] < 0.001, "{corner:?}");
        let center = view.uv(200.0, 150.0).expect("inside");
        assert!((center[0] - 1.5).abs() < 1e-12 && (center[1] - 1.5).abs() < 1e-12);
        assert_eq!(view.uv(left - 1.0, top), None);
    }

    /// A pixel's point on the square projects back to the pixel after moving along the eye's direction.
    #[test]
    fn pixels_see_what_projects_to_them() {
        for (angle, azimuth) in [(0.0, 0.0), (30.0, 0.0), (60.0, 50.0), (80.0, -120.0), (45.0, 180.0)] {
            let view = view(angle, azimuth);
            let [right, up] = view.axes();
            let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            assert!(dot(right, up).abs() < 1e-12 && dot(right, view.towards()).abs() < 1e-12);
            assert!(dot(up, view.towards()).abs() < 1e-12);
            for (x, y) in [(200.0, 150.0), (210.0, 160.0), (150.0, 149.0)] {
                let uv = view.uv(x, y).expect("inside");
                let place = [uv[0] / 3.0 - 0.5, uv[1] / 3.0 - 0.5, 0.0];
                let seen = [200.0 + view.zoom() * dot(place, right), 150.0 - view.zoom() * dot(place, up)];
                assert!((seen[0] - x).abs() < 1e-9 && (seen[1] - y).abs() < 1e-9, "{angle} {azimuth}");
                let next = view.uv(x + 1.0, y).expect("inside");
                let step = view.uv_steps()[0];
                assert!((next[0] - uv[0] - step[0]).abs() < 1e-9 && (next[1] - uv[1] - step[1]).abs() < 1e-9);
                let below = view.uv(x, y + 1.0).expect("inside");
                let step = view.uv_steps()[1];
                assert!(
                    (below[0] - uv[0] - step[0]).abs() < 1e-9 && (below[1] - uv[1] - step[1]).abs() < 1e-9
                );
            }
        }
    }

    #[test]
    fn views_of_nothing_are_refused() {
        let field = |view: SquareView| view.validate().expect_err("refused").path;
        for angle in [90.0, -1.0, f64::NAN] {
            assert_eq!(field(view(angle, 0.0)), "angle");
        }
        assert_eq!(field(view(0.0, f64::INFINITY)), "azimuth");
        assert_eq!(field(SquareView { tiles: 0.0, ..view(0.0, 0.0) }), "tiles");
        assert_eq!(field(SquareView { size: [0, 4], ..view(0.0, 0.0) }), "size[0]");
        for (azimuth, elevation, path, value, bound) in [
            (0.0, 91.0, "light.elevation", "91", "must be in 0..=90 degrees"),
            (0.0, f64::NAN, "light.elevation", "NaN", "must be in 0..=90 degrees"),
            (f64::INFINITY, 91.0, "light.azimuth", "inf", "must be a finite number of degrees"),
        ] {
            let expected = relievo::InputError::new(path, value, bound);
            assert_eq!(towards_light(azimuth, elevation), Err(expected));
        }
    }
}
