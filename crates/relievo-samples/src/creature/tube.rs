//! Closed tubes around chains of bones, of which the creature's body consists.

use glam::DVec3;
use relievo::asset::influences::Influence;

/// A cross-section through which a tube passes.
#[derive(Debug, Clone, Copy)]
pub struct Section {
    /// Its center.
    pub center: DVec3,
    /// The radii across the tube's reference direction and along it.
    pub radii: [f64; 2],
    /// The bone that the tube follows from this section on.
    pub bone: u32,
}

/// A tube through cross-sections, with rounded ends.
pub struct Tube<'a> {
    /// The sections; at least two.
    pub sections: &'a [Section],
    /// The direction of the second radii, after projection onto the plane perpendicular to the tube.
    pub reference: DVec3,
    /// Vertices around the tube.
    pub sides: usize,
    /// Rings between two sections.
    pub rings: usize,
    /// Rings of each rounded end, including its pole.
    pub cap: usize,
    /// The length, in metres, over which the influence of one bone passes into the next one's.
    pub blend: f64,
}

/// Vertices and triangles before normals are computed.
#[derive(Default)]
pub struct Surface {
    pub positions: Vec<DVec3>,
    pub uv: Vec<[f64; 2]>,
    pub influences: Vec<Vec<Influence>>,
    pub indices: Vec<u32>,
}

/// The length in metres that one tile of the texture covers.
const TILE: f64 = 0.25;

/// A ring of the tube: its position, radii, and distance along the tube in metres.
#[derive(Clone, Copy)]
struct Ring {
    center: DVec3,
    radii: [f64; 2],
    along: f64,
}

impl Surface {
    /// Adds a tube.
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
                // The two columns of the seam have equal positions, to the bit.
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
                // A pole has one triangle per side.
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
    /// The rings from pole to pole, and the distance along the tube at which each section lies, in metres.
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

    /// The point on a Catmull–Rom curve from a section to the next.
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

    /// Unit vectors of the two radii of a ring.
    fn axes(&self, rings: &[Ring], at: usize) -> [DVec3; 2] {
        let (before, after) = (rings[at.saturating_sub(1)], rings[(at + 1).min(rings.len() - 1)]);
        let direction = (after.center - before.center).normalize();
        let across = direction.cross(self.reference).normalize();
        [across, direction.cross(across)]
    }

    /// The bones around a distance along the tube, each with the fraction that it covers of a window there.
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

/// A rounded end, from a ring to its pole.
fn cap(steps: usize, ring: Ring, inner: Ring) -> Vec<Ring> {
    let outward = (ring.center - inner.center).normalize();
    let depth = ring.radii[0].min(ring.radii[1]);
    let sign = if ring.along > inner.along { 1.0 } else { -1.0 };
    (1..=steps)
        .map(|step| {
            let angle = std::f64::consts::FRAC_PI_2 * step as f64 / steps as f64;
            // A pole is a single point, to the bit.
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
