//! Lattices of points in world coordinates: the base lattice, where subdivision starts, and lookup of the features on a lattice.

use crate::terrain::config::{HEIGHT_LIMIT, HeightInterpolation, PATCH_EDGE, TerrainConfig};
use crate::terrain::features::Features;
use crate::terrain::fixed::{Draw, inject};
use crate::terrain::window::{Lattice, Region, Span};

/// Heights of the base lattice of `seamless` terrain, where subdivision starts: random heights on the points of `spans`.
pub(crate) fn base_lattice(config: &TerrainConfig, features: &Features, spans: [Span; 2]) -> Vec<i32> {
    let draw = Draw::new(config);
    let spacing = config.sample_spacing() << config.levels();
    let injected = Injected::new(features, spans, spacing, 1, false);
    let width = spans[0].width();
    let mut grid = vec![0; width * spans[1].width()];
    for (y, heights) in (spans[1].first..).zip(grid.chunks_exact_mut(width)) {
        let [x, world_y] = [spans[0].first, y].map(|index| world(index, spacing));
        draw.add_row(heights, config.level_range(0), x, spacing as u32, world_y);
        injected.inject_row(features, y, spans[0].first, 1, heights);
    }
    if config.interpolation == HeightInterpolation::Smooth {
        grid.iter_mut().for_each(|height| *height = limited(*height));
    }
    grid
}

/// The four corners of a patch that is generated alone.
pub(crate) fn corners(config: &TerrainConfig, features: &Features, patch: [i32; 2]) -> Vec<i32> {
    let mut corners = config.fixed_corners().to_vec();
    let lattice = Lattice { origin: [0, 0], width: 2, spacing: PATCH_EDGE };
    for (x, y, height) in features.on_lattice(Features::world_of(config, patch), lattice, false) {
        let corner = &mut corners[(2 * y + x) as usize];
        *corner = inject(features.mode, *corner, height);
    }
    corners
}

/// Heights that replace those of one lattice; all finer lattices follow from them.
pub(crate) struct Given<'a> {
    /// Number of levels by which the lattice is coarser than the terrain.
    pub coarser: u32,
    /// The height of the lattice's point with these indices; `None` where none is given.
    pub at: &'a dyn Fn([i64; 2]) -> Option<i32>,
}

impl Given<'_> {
    /// Replaces the heights of a lattice that is `coarser` levels coarser than the terrain, if it is the one of the given heights.
    pub(crate) fn replace(given: Option<&Self>, coarser: u32, spans: [Span; 2], heights: &mut [i32]) {
        let Some(given) = given.filter(|given| given.coarser == coarser) else { return };
        for (y, row) in (spans[1].first..).zip(heights.chunks_exact_mut(spans[0].width())) {
            for (x, height) in (spans[0].first..).zip(row) {
                *height = (given.at)([x, y]).unwrap_or(*height);
            }
        }
    }
}

/// One subdivision, from a coarser lattice to the lattice with half its spacing.
pub(crate) struct Subdivision<'a> {
    pub coarse: [Span; 2],
    pub fine: [Span; 2],
    /// Range of the random offsets; with smooth interpolation, those of the centers of cells.
    pub range: u32,
    /// Range of the random offsets of points on edges, with smooth interpolation.
    pub edge_range: u32,
    spacing: i64,
    features: &'a Features,
    draw: &'a Draw,
    injected: Injected,
}

impl Subdivision<'_> {
    /// Adds random offsets to the heights of the points (x, y), (x + 2, y), …, and injects features.
    pub(crate) fn draw_row(&self, heights: &mut [i32], range: u32, x: i64, y: i64) {
        let step = 2 * self.spacing as u32;
        self.draw.add_row(heights, range, world(x, self.spacing), step, world(y, self.spacing));
        self.injected.inject_row(self.features, y, x, 2, heights);
    }
}

/// Heights of a region, in rows of `region.width` samples. `subdivide` makes a lattice from the next coarser one; points up to `rim`
/// beyond it may have features. `given` heights replace those of their lattice.
pub(crate) fn subdivided(
    config: &TerrainConfig,
    features: &Features,
    given: Option<&Given<'_>>,
    region: Region,
    rim: u32,
    subdivide: impl Fn(&Subdivision<'_>, &[i32]) -> Vec<i32>,
) -> Vec<i32> {
    let levels = region.levels(config);
    let draw = &Draw::new(config);
    let mut grid = base_lattice(config, features, levels[0]);
    for (level, pair) in (0..).zip(levels.windows(2)) {
        let left = config.levels() - level - 1;
        let [coarse, fine] = [pair[0], pair[1]];
        let spacing = config.sample_spacing() << left;
        let injected = Injected::new(features, fine, spacing, rim, true);
        let (range, edge_range) = (config.level_range(level), config.edge_range(level));
        grid = subdivide(
            &Subdivision { coarse, fine, range, edge_range, spacing, features, draw, injected },
            &grid,
        );
        Given::replace(given, left, fine, &mut grid);
    }
    grid
}

/// Clamps a height to ±[`HEIGHT_LIMIT`].
pub(crate) fn limited(height: i32) -> i32 {
    height.clamp(-HEIGHT_LIMIT as i32, HEIGHT_LIMIT as i32)
}

/// World coordinate of the lattice point with index `index`, modulo 2^32.
pub(crate) fn world(index: i64, spacing: i64) -> u32 {
    (index * spacing) as u32
}

/// Features on the lattice of one level, sorted by row and column.
pub(crate) struct Injected {
    points: Vec<(u32, u32, i32)>,
    origin: [i64; 2],
}

impl Injected {
    /// Finds the features on a window's lattice, which is first extended by `rim` points on every side. The extension is needed
    /// because features outside the window also influence points inside. `new_only` excludes points of the coarser lattice.
    pub(crate) fn new(features: &Features, spans: [Span; 2], spacing: i64, rim: u32, new_only: bool) -> Self {
        let origin = spans.map(|span| span.first - i64::from(rim));
        let width = spans[0].width().max(spans[1].width()) as u32 + 2 * rim;
        let lattice = Lattice { origin: origin.map(|index| index * spacing), width, spacing };
        Self { points: features.on_lattice([0, 0], lattice, new_only), origin }
    }

    /// Injects features into `heights`. `heights[i]` belongs to the lattice point (x + i·step, y). Coordinates are in units of
    /// the lattice's spacing.
    pub(crate) fn inject_row(&self, features: &Features, y: i64, x: i64, step: i64, heights: &mut [i32]) {
        let row = (y - self.origin[1]) as u32;
        let start = self.points.partition_point(|point| point.1 < row);
        for &(column, _, height) in self.points[start..].iter().take_while(|point| point.1 == row) {
            let distance = i64::from(column) + self.origin[0] - x;
            if distance.rem_euclid(step) == 0
                && let Some(computed) = usize::try_from(distance / step).ok().and_then(|i| heights.get_mut(i))
            {
                *computed = inject(features.mode, *computed, height);
            }
        }
    }
}
