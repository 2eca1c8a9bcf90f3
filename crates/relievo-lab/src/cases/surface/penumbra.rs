//! Bounds on soft shadow in f64, whatever a device rounds. `docs/relief-bounds.md` has the derivation.

use crate::shade::{ShadePoint, ShadeView};
use relievo::ops::surface::map::{Address, HeightMap};
use relievo::ops::surface::relief::{LEAST_COSINE, MAX_STEPS};
use relievo::shared::surface::shadow::SURFACE_SHADOW_BIAS;

use crate::cases::surface::bounds::{ULP, off};

/// The height difference below which a point does not shade itself.
pub(crate) const BIAS: f64 = SURFACE_SHADOW_BIAS as f64;

/// A map with its steepness at each texel (`surface::verify::bounds::steepness`).
#[derive(Debug, Clone, Copy)]
pub struct Terrain<'a> {
    /// The heights.
    pub map: &'a HeightMap,
    /// The largest change in height per texel along x, and along y.
    pub steepness: &'a [[f64; 2]],
    /// What lies beyond the map's edge.
    pub address: Address,
}

impl Terrain<'_> {
    /// Height and steepness at `uv`, interpolated bilinearly.
    fn at(&self, uv: [f64; 2]) -> [f64; 2] {
        let size = [self.map.width(), self.map.height()];
        let [x, y] = [0, 1].map(|i| uv[i] * f64::from(size[i]) - 0.5);
        let (left, top) = (x.floor() as i64, y.floor() as i64);
        let place = |index: i64, edge: u32| match self.address {
            Address::Wrap => index.rem_euclid(edge.into()),
            Address::Clamp => index.clamp(0, i64::from(edge) - 1),
        };
        let texel = |dx: i64, dy: i64| {
            let index = (place(top + dy, size[1]) * i64::from(size[0]) + place(left + dx, size[0])) as usize;
            [f64::from(self.map.heights()[index]), self.steepness[index].iter().sum()]
        };
        let (right, below) = (x - x.floor(), y - y.floor());
        let [a, b, c, d] = [texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1)];
        [0, 1].map(|i| {
            (a[i] * (1.0 - right) + b[i] * right) * (1.0 - below)
                + (c[i] * (1.0 - right) + d[i] * right) * below
        })
    }
}

/// The least and the most light that may reach a point, 0 to 1.
pub(crate) fn penumbra(terrain: &Terrain<'_>, view: &ShadeView, point: &ShadePoint) -> [f64; 2] {
    let [light_x, light_y, light_z] = point.light.map(f64::from);
    if light_z <= 0.0 {
        return [0.0; 2];
    }
    let size = [terrain.map.width(), terrain.map.height()].map(f64::from);
    let steepness = -f64::from(point.scale) / light_z.max(LEAST_COSINE.into());
    let slope = [light_x * steepness, light_y * steepness];
    let uv = point.hit.uv.map(f64::from);
    let texels =
        |ulps: &dyn Fn(usize) -> f64| (0..2).map(|i| ULP * size[i] * (ulps(i) + 2.0)).fold(0.0, f64::max);
    let looked_up = |uv: f64| if terrain.address == Address::Wrap { 1.0 } else { 2.0 * uv };
    let [own, own_steepness] = terrain.at(uv);
    let own_off = off(own_steepness, texels(&|i| looked_up(uv[i].abs())));
    let height = f64::from(point.hit.height);
    let start_off = if height > own + own_off { 0.0 } else { own_off };
    let rise = 1.0 - height.max(own);
    // How far a point on the way to the light may be off, in texels.
    let position = texels(&|i| {
        let (way, farthest) = (rise * slope[i].abs(), uv[i].abs() + rise * slope[i].abs());
        20.0 * way + 2.0 * farthest + looked_up(farthest)
    });
    let travel = (slope[0] * size[0]).abs().max((slope[1] * size[1]).abs());
    let count = view.shadow_steps.clamp(1, MAX_STEPS);
    let mut most = [0.0_f64; 2];
    for step in 1..=count {
        let fraction = f64::from(step) / f64::from(count + 1);
        let travelled = fraction * fraction;
        let [height, steepness] = terrain.at([0, 1].map(|i| uv[i] - rise * travelled * slope[i]));
        let excess = height - (1.0 - rise * (1.0 - travelled)) - BIAS;
        let excess_off =
            off(steepness, position) + start_off * (1.0 + steepness * travel * travelled) + 12.0 * ULP;
        let near = travelled * rise + f64::from(1e-3_f32);
        let shade = excess / (f64::from(view.softness) * near);
        let relative = 16.0 * ULP + start_off * travelled / near;
        let shade_off = excess_off / (f64::from(view.softness) * near) + shade.abs() * relative;
        most = [most[0].max(shade - shade_off), most[1].max(shade + shade_off)];
    }
    [1.0 - most[1].min(1.0), 1.0 - most[0].min(1.0)]
}
