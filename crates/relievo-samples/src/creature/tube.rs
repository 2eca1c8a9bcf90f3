//! Closed tubes around chains of bones. The creature's body consists of such tubes.

use glam::DVec3;
use relievo::asset::influences::Influence;

/// A cross-section of a tube: an ellipse through which the tube passes.
#[derive(Debug, Clone, Copy)]
pub struct Section {
    /// Center of the ellipse, in metres.
    pub center: DVec3,
    /// Radii of the ellipse, in metres: first across the tube's reference direction, then along it.
    pub radii: [f64; 2],
    /// Bone that the tube follows from this section to the next.
    pub bone: u32,
}

/// A tube through a series of cross-sections, with rounded ends.
pub struct Tube<'a> {
    /// Cross-sections in order; at least two.
    pub sections: &'a [Section],
    /// Direction of the second radius of every section, after projection onto the plane perpendicular to the tube.
    pub reference: DVec3,
    /// Number of vertices around the tube.
    pub sides: usize,
    /// Number of rings of vertices per pair of neighbouring sections.
    pub rings: usize,
    /// Number of rings in each rounded end, including the pole.
    pub cap: usize,
    /// Length in metres over which the influence passes from one bone to the next.
    pub blend: f64,
}

/// Vertices and triangles, before normals are computed.
#[derive(Default)]
pub struct Surface {
    pub positions: Vec<DVec3>,
    pub uv: Vec<[f64; 2]>,
    pub influences: Vec<Vec<Influence>>,
    pub indices: Vec<u32>,
}

/// Length in metres that one tile of the texture covers on the surface.
const TILE: f64 = 0.25;

/// A ring of vertices: center, radii, and distance along the tube in metres.
#[derive(Clone, Copy)]
struct Ring {
    center: DVec3,
    radii: [f64; 2],
    along: f64,
}

impl Surface {
    /// Adds the vertices and triangles of a tube.
    pub fn add(&mut self, tube: &Tube<'_>) {
        let (rings, starts) = tube.rings();
        let first = self.positions.len();
        let widest = rings.iter().flat_map(|ring| ring.radii).fold(0.0, f64::max);
        let repeats = (std::f64::consts::TAU * widest / TILE).round().max(1.0);
        for at in 0..rings.len() {
            let ring = rings[at];
            let influences = tube.influences(&starts, ring.along);
            let [across, upright] = tube.axes(&rings, at);
            for side in 0..=tube.sides {
                let turn = side as f64 / tube.sides as f64;
                // The first and the last column of vertices form the seam. Their positions must be equal to the bit.
                let angle = std::f64::consts::TAU * (side % tube.sides) as f64 / tube.sides as f64;
                let [x, y] = [ring.radii[0] * libm::cos(angle), ring.radii[1] * libm::sin(angle)];
                self.positions.push(ring.center + across * x + upright * y);
                self.uv.push([turn * repeats, ring.along / TILE]);
                self.influences.push(influences.clone());
            }
        }
        let corner = |ring: usize, side: usize| (first + ring * (tube.sides + 1) + side) as u32;
        for ring in 0..rings.len() - 1 {
            for side in 0..tube.sides {
                let [a, b] = [corner(ring, side), corner(ring, side + 1)];
                let [c, d] = [corner(ring + 1, side + 1), corner(ring + 1, side)];
                // At a pole there is one triangle per side instead of two.
                if ring > 0 {
                    self.indices.extend([a, b, d]);
                }
                if ring + 2 < rings.len() {
                    self.indices.extend([b, c, d]);
                }
            }
        }
    }
}

impl Tube<'_> {
    /// All rings from pole to pole, and for each section its distance along the tube in metres.
    fn rings(&self) -> (Vec<Ring>, Vec<f64>) {
        let mut rings: Vec<Ring> = Vec::new();
        let mut starts = Vec::new();
        let mut along = 0.0;
        for section in 0..self.sections.len() {
            let last = section + 1 == self.sections.len();
            for step in 0..if last { 1 } else { self.rings } {
                let (center, radii) = self.between(section, step as f64 / self.rings as f64);
                along += rings.last().map_or(0.0, |before| center.distance(before.center));
                if step == 0 {
                    starts.push(along);
                }
                rings.push(Ring { center, radii, along });
            }
        }
        let [mut start, end] = [[0, 1], [rings.len() - 1, rings.len() - 2]]
            .map(|[at, next]| cap(self.cap, rings[at], rings[next]));
        start.reverse();
        start.extend(rings);
        start.extend(end);
        (start, starts)
    }

    /// Center and radii at t, 0 to 1, on a Catmull–Rom curve from a section to the next.
    fn between(&self, section: usize, t: f64) -> (DVec3, [f64; 2]) {
        let all = self.sections;
        let at = |offset: usize| &all[(section + offset).saturating_sub(1).min(all.len() - 1)];
        let [a, b, c, d] = [at(0), at(1), at(2), at(3)];
        let curve = |a: f64, b: f64, c: f64, d: f64| {
            b + 0.5 * t * ((c - a) + t * ((2.0 * a - 5.0 * b + 4.0 * c - d) + t * (3.0 * (b - c) + d - a)))
        };
        let center = |axis: usize| curve(a.center[axis], b.center[axis], c.center[axis], d.center[axis]);
        let radius = |at: usize| curve(a.radii[at], b.radii[at], c.radii[at], d.radii[at]);
        (DVec3::new(center(0), center(1), center(2)), [radius(0), radius(1)])
    }

    /// Unit vectors along the two radii of ring `at`.
    fn axes(&self, rings: &[Ring], at: usize) -> [DVec3; 2] {
        let (before, after) = (rings[at.saturating_sub(1)], rings[(at + 1).min(rings.len() - 1)]);
        let direction = (after.center - before.center).normalize();
        let across = direction.cross(self.reference).normalize();
        [across, direction.cross(across)]
    }

    /// Bones that influence the distance `along` the tube. The weight of a bone is its fraction of a window with length `blend`
    /// around that distance.
    fn influences(&self, starts: &[f64], along: f64) -> Vec<Influence> {
        let (low, high) = (along - self.blend / 2.0, along + self.blend / 2.0);
        let owned = |at: usize| {
            let from = if at == 0 { f64::NEG_INFINITY } else { starts[at] };
            let to = starts.get(at + 1).copied().unwrap_or(f64::INFINITY);
            (to.min(high) - from.max(low)).max(0.0) / self.blend
        };
        (self.sections.iter().enumerate())
            .map(|(at, section)| Influence { bone: section.bone, weight: owned(at) as f32 })
            .collect()
    }
}

/// Rings of a rounded end, from the tube's last ring to the pole. `inner` is the ring before the last one.
fn cap(steps: usize, ring: Ring, inner: Ring) -> Vec<Ring> {
    let outward = (ring.center - inner.center).normalize();
    let depth = ring.radii[0].min(ring.radii[1]);
    let sign = if ring.along > inner.along { 1.0 } else { -1.0 };
    (1..=steps)
        .map(|step| {
            let angle = std::f64::consts::FRAC_PI_2 * step as f64 / steps as f64;
            // All vertices of a pole must have the same position, to the bit.
            let shrink = if step == steps { 0.0 } else { libm::cos(angle) };
            let beyond = depth * libm::sin(angle);
            Ring {
                center: ring.center + outward * beyond,
                radii: ring.radii.map(|radius| radius * shrink),
                along: ring.along + sign * beyond,
            }
        })
        .collect()
}
