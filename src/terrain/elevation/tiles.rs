//! The tiles of a whole elevation map.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::sync::Arc;

use super::{
    ElevationInfo, ElevationLayout, ElevationMap, ElevationSource, ElevationTile, TILE_SIZE, TileNumber,
};
use crate::parallel;
use crate::terrain::config::{HEIGHT_LIMIT, HEIGHT_ONE, TerrainConfig};
use crate::terrain::features::Features;
use crate::terrain::field::region;
use crate::terrain::remainder::remainder;
use crate::terrain::window::Region;
use crate::{Error, InputError};

/// The coarsest tiles have at least this many samples along each edge of the map.
const FEWEST_SAMPLES: u32 = 8;

/// Distance in samples around a tile over which [`ElevationTile::second_difference`] is taken.
const REACH: i64 = 8;

/// The tiles of a whole elevation map, in memory. The map's border is blended with the terrain's generated heights.
#[derive(Debug, Clone)]
pub struct ElevationTiles {
    info: ElevationInfo,
    tiles: BTreeMap<TileNumber, Arc<ElevationTile>>,
}

impl ElevationTiles {
    /// Cuts a map into tiles for a terrain. Needs 16 bytes for each sample of a square that holds the map.
    ///
    /// # Errors
    /// [`InputError`] as [`ElevationMap::validate`], or that names `heights` if finer heights between the map's samples could
    /// exceed the range of fixed-point heights.
    pub fn new(config: &TerrainConfig, map: &ElevationMap) -> Result<Self, InputError> {
        map.validate(config)?;
        let lattice = Lattice::new(config, map);
        let bent = lattice.second_differences();
        let largest =
            lattice.heights.iter().map(|height| i64::from(height.unsigned_abs())).max().unwrap_or(0);
        let between = remainder(config, map.layout.coarser(), bent.iter().copied().max().unwrap_or(0).into());
        let reached = (largest + between) as f64 / HEIGHT_ONE;
        let most = HEIGHT_LIMIT as f64 / HEIGHT_ONE;
        let bound = || format!("must not let finer heights exceed {most}; they could reach {reached}");
        InputError::check(reached <= most, "heights", format!("[{} samples]", map.heights.len()), bound)?;
        let numbers: Vec<TileNumber> =
            (0..=lattice.levels).flat_map(|level| lattice.tiles_of(level)).collect();
        let made = |number: &TileNumber| (*number, Arc::new(lattice.tile(*number, &bent)));
        let tiles = parallel::map(&numbers, made).into_iter().collect();
        let info = ElevationInfo { layout: map.layout, levels: lattice.levels, apart: lattice.apart };
        Ok(Self { info, tiles })
    }

    /// All tiles.
    pub fn tiles(&self) -> impl Iterator<Item = (TileNumber, &ElevationTile)> {
        self.tiles.iter().map(|(number, tile)| (*number, &**tile))
    }
}

impl ElevationSource for ElevationTiles {
    fn info(&self) -> ElevationInfo {
        self.info
    }

    fn tile(&self, number: TileNumber) -> Result<Option<Arc<ElevationTile>>, Error> {
        let absent =
            || InputError::new("tile", format!("{number:?}"), "must lie within 4 samples of the map");
        Ok(Some(self.tiles.get(&number).ok_or_else(absent)?.clone()))
    }
}

/// The heights of the map's lattice: those of the map, and generated ones around it, in a square.
struct Lattice {
    /// Column and row of the first height.
    first: [i64; 2],
    width: usize,
    heights: Vec<i32>,
    layout: ElevationLayout,
    levels: u32,
    apart: u32,
}

impl Lattice {
    fn new(config: &TerrainConfig, map: &ElevationMap) -> Self {
        let (layout, size) = (map.layout, map.layout.size);
        let levels = (size[0].min(size[1]) / FEWEST_SAMPLES).max(1).ilog2();
        // Cells of the coarsest tiles that contain samples near the map reach this far beyond it.
        let around = (1 << levels) + 2 * REACH;
        let first = layout.first.map(|first| i64::from(first) - around);
        let width = size[0].max(size[1]) as usize + 2 * around as usize;
        let samples = Region { first, width: width as u32, coarser: layout.coarser() };
        let mut heights = region(config, &Features::default(), samples);
        let mut apart = 0;
        for (row, map_row) in map.heights.chunks_exact(size[0] as usize).enumerate() {
            let start = (row + around as usize) * width + around as usize;
            for (column, (height, given)) in heights[start..].iter_mut().zip(map_row).enumerate() {
                let weight = weight(column, size[0], map.margin) * weight(row, size[1], map.margin);
                let given = (f64::from(*given) * HEIGHT_ONE).round_ties_even();
                let generated = f64::from(*height);
                *height = (generated + (given - generated) * weight).round_ties_even() as i32;
                apart = apart.max((f64::from(*height) - generated).abs() as u32);
            }
        }
        Self { first, width, heights, layout, levels, apart }
    }

    fn at(&self, column: i64, row: i64) -> i32 {
        self.heights[(row - self.first[1]) as usize * self.width + (column - self.first[0]) as usize]
    }

    /// The largest second difference at each height but those of the rim.
    fn second_differences(&self) -> Vec<u32> {
        let (width, height) = (self.width, &self.heights);
        let own = |at: usize| i64::from(height[at]);
        parallel::map_range(height.len(), |at| {
            let (column, row) = (at % width, at / width);
            if column == 0 || row == 0 || column + 1 == width || row + 1 >= height.len() / width {
                return 0;
            }
            let along_x = own(at - 1) - 2 * own(at) + own(at + 1);
            let along_y = own(at - width) - 2 * own(at) + own(at + width);
            let twist = own(at) + own(at + width + 1) - own(at + 1) - own(at + width);
            along_x.unsigned_abs().max(along_y.unsigned_abs()).max(twist.unsigned_abs()) as u32
        })
    }

    /// The tiles of a level in or near the map.
    fn tiles_of(&self, level: u32) -> Vec<TileNumber> {
        let size = i64::from(TILE_SIZE);
        let tiles = self
            .layout
            .cells(level)
            .map(|cells| cells.start().div_euclid(size)..=cells.end().div_euclid(size));
        let [columns, rows] = tiles;
        let number = |row: i64, column: i64| TileNumber { level, at: [column as i32, row as i32] };
        rows.flat_map(|row| columns.clone().map(move |column| number(row, column))).collect()
    }

    fn tile(&self, number: TileNumber, bent: &[u32]) -> ElevationTile {
        let (size, step) = (i64::from(TILE_SIZE), 1_i64 << number.level);
        let first = number.at.map(|at| i64::from(at) * size);
        let [columns, rows] = self.layout.samples();
        let height = |column: i64, row: i64| {
            let is_given = columns.contains(&column) && rows.contains(&row);
            if is_given { self.at(column, row) } else { 0 }
        };
        let heights = (0..size * size)
            .map(|at| height((first[0] + at % size) * step, (first[1] + at / size) * step))
            .collect();
        if number.level == 0 {
            return ElevationTile { heights, deviation: 0, second_difference: 0 };
        }
        let [cell_columns, cell_rows] = [0, 1].map(|axis| {
            let cells = &self.layout.cells(number.level)[axis];
            first[axis].max(*cells.start())..=(first[axis] + size - 1).min(*cells.end())
        });
        let cells = cell_rows.clone().flat_map(|row| cell_columns.clone().map(move |column| [column, row]));
        let deviation = cells.map(|cell| self.deviation(cell, step)).max().unwrap_or(0);
        let near =
            |cells: &RangeInclusive<i64>| cells.start() * step - REACH..=((cells.end() + 1) * step + REACH);
        let (near_columns, near_rows) = (near(&cell_columns), near(&cell_rows));
        let rows_of = (self.heights.len() / self.width) as i64;
        let near_rows =
            (*near_rows.start() - self.first[1]).max(0)..=(*near_rows.end() - self.first[1]).min(rows_of - 1);
        let near_columns = (*near_columns.start() - self.first[0]).max(0)
            ..=(*near_columns.end() - self.first[0]).min(self.width as i64 - 1);
        let row = |row: i64| {
            let start = row as usize * self.width;
            bent[start + *near_columns.start() as usize..=start + *near_columns.end() as usize].iter()
        };
        let second_difference = near_rows.flat_map(row).copied().max().unwrap_or(0);
        ElevationTile { heights, deviation, second_difference }
    }

    /// The largest distance between the heights in a cell of a coarser level and the cell's triangles, rounded up.
    fn deviation(&self, cell: [i64; 2], step: i64) -> u32 {
        let [x, y] = cell.map(|at| at * step);
        let corner = |dx: i64, dy: i64| i64::from(self.at(x + dx * step, y + dy * step));
        let [north_west, north_east, south_west, south_east] =
            [corner(0, 0), corner(1, 0), corner(0, 1), corner(1, 1)];
        let distance = |at: i64| {
            let (u, v) = (at % (step + 1), at / (step + 1));
            let surface = if u + v <= step {
                north_west * (step - u - v) + north_east * u + south_west * v
            } else {
                south_east * (u + v - step) + north_east * (step - v) + south_west * (step - u)
            };
            (i64::from(self.at(x + u, y + v)) * step - surface).unsigned_abs().div_ceil(step as u64)
        };
        (0..(step + 1).pow(2)).map(distance).max().unwrap_or(0) as u32
    }
}

/// The weight of a map's sample: 0 at the border, 1 from `margin` samples inwards.
fn weight(at: usize, size: u32, margin: u32) -> f64 {
    let inwards = (at as u32).min(size - 1 - at as u32);
    if inwards >= margin {
        return 1.0;
    }
    let t = f64::from(inwards) / f64::from(margin);
    t * t * (3.0 - 2.0 * t)
}
