//! Injected heights, called features (thesis B sections 3.3.1 and 4.4): reading files, and finding the features that a window
//! needs.

#[cfg(feature = "gpu")]
mod index;

use std::collections::BTreeMap;
use std::path::Path;

use serde::Deserialize;

use crate::terrain::config::{Border, HEIGHT_LIMIT, HEIGHT_ONE, HeightGenerator, PATCH_EDGE, TerrainConfig};
use crate::terrain::config::{from_json_object, read_text};
use crate::terrain::fixed::FeatureMode;
use crate::terrain::pad::reference::pad;
use crate::terrain::pad::surrounds;
use crate::terrain::window::Lattice;
use crate::terrain::window::Window;
use crate::{Error, InputError};

#[cfg(feature = "gpu")]
pub use index::{FeatureGrid, FeatureIndex};

/// One file of features for one patch, in thesis B's JSON format.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
pub struct FeatureFile {
    /// Coordinates of the patch to which the points belong.
    pub patch_coordinates: [i32; 2],
    /// Points as consecutive triples x, y, height. x and y count samples of the patch from 0; heights are in height units.
    pub precomputed_heights: Vec<f64>,
}

impl FeatureFile {
    /// Reads a feature file from JSON text.
    ///
    /// # Errors
    /// [`InputError`] for text that is not valid JSON or does not match the fields of [`FeatureFile`].
    pub fn from_json(text: &str) -> Result<Self, InputError> {
        from_json_object("features", text)
    }

    /// Reads a feature file from disk.
    ///
    /// # Errors
    /// [`Error::File`] when the file cannot be read; [`Error::InputFile`] for the errors of [`FeatureFile::from_json`].
    pub fn from_file(path: &Path) -> Result<Self, Error> {
        Self::from_json(&read_text(path)?)
            .map_err(|source| Error::InputFile { path: path.to_owned(), source })
    }

    /// Points as (x, y, height in 1/65536 units), after checking that they lie in the patch and that their heights are in range.
    fn points(&self, config: &TerrainConfig) -> Result<Vec<(i32, i32, i32)>, InputError> {
        let values = &self.precomputed_heights;
        if !values.len().is_multiple_of(3) {
            let bound = "its length must be a multiple of 3 (x, y, height, …)";
            return Err(InputError::new("precomputed_heights", format!("[{} numbers]", values.len()), bound));
        }
        let last = f64::from(config.patch_size - 1);
        let field = |index: usize| format!("precomputed_heights[{index}]");
        let mut points = Vec::with_capacity(values.len() / 3);
        for (point, triple) in values.chunks_exact(3).enumerate() {
            for (axis, &value) in triple[..2].iter().enumerate() {
                if !(value.fract() == 0.0 && (0.0..=last).contains(&value)) {
                    let bound = format!("must be a whole number in 0..={last} (a patch has one sample more)");
                    return Err(InputError::new(field(3 * point + axis), value, bound));
                }
            }
            let height = (triple[2] * HEIGHT_ONE).round_ties_even();
            if height.is_nan() || height.abs() > HEIGHT_LIMIT as f64 {
                let bound = "must be a finite height below 16384 in size";
                return Err(InputError::new(field(3 * point + 2), triple[2], bound));
            }
            points.push((triple[0] as i32, triple[1] as i32, height as i32));
        }
        Ok(points)
    }
}

/// Injected heights (features) of a whole world, indexed by position.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Features {
    /// How an injected height changes the computed height of its point.
    pub mode: FeatureMode,
    // For each world: heights of the points by (Y, X) in world coordinates. `seamless` terrain has a single world, (0, 0). In the
    // other border modes each patch is its own world, and world coordinates start at the patch.
    worlds: BTreeMap<[i32; 2], BTreeMap<(i64, i64), i32>>,
}

impl Features {
    /// Collects and checks feature files.
    ///
    /// # Errors
    /// [`InputError`] for a coordinate outside its patch, for a list whose length is not a multiple of 3, for heights that are
    /// not finite or could overflow, and for a lattice point with two different heights.
    pub fn new(config: &TerrainConfig, files: &[FeatureFile], mode: FeatureMode) -> Result<Self, InputError> {
        config.validate()?;
        let mut features = Self { mode, worlds: BTreeMap::new() };
        for file in files {
            features.add(config, file)?;
        }
        features.check(config)?;
        Ok(features)
    }

    /// Adds the points of one file. Call [`Features::check`] after the last file.
    ///
    /// # Errors
    /// [`InputError`] as [`Features::new`].
    pub fn add(&mut self, config: &TerrainConfig, file: &FeatureFile) -> Result<(), InputError> {
        let patch = file.patch_coordinates;
        // Refuse a patch for which no valid window exists: its features would never be used.
        Window { patch, apron: 0 }.validate(config)?;
        let spacing = config.sample_spacing();
        let seamless = config.border == Border::Seamless;
        let world = self.worlds.entry(Self::world_of(config, patch)).or_default();
        let origin = if seamless { patch.map(|index| i64::from(index) * PATCH_EDGE) } else { [0, 0] };
        for (index, (x, y, height)) in file.points(config)?.into_iter().enumerate() {
            let key = (origin[1] + i64::from(y) * spacing, origin[0] + i64::from(x) * spacing);
            let earlier = *world.entry(key).or_insert(height);
            if earlier != height {
                let bound = format!(
                    "patch ({}, {}) point ({x}, {y}) already has the height {}; a lattice point has one",
                    patch[0],
                    patch[1],
                    f64::from(earlier) / HEIGHT_ONE
                );
                let field = format!("precomputed_heights[{}]", 3 * index + 2);
                return Err(InputError::new(field, f64::from(height) / HEIGHT_ONE, bound));
            }
        }
        Ok(())
    }

    /// Refuses features whose heights could overflow when the configuration's random offsets are added.
    ///
    /// # Errors
    /// [`InputError`] when a height with these features could exceed the range of fixed-point heights, and for features with a
    /// generator other than diamond-square.
    pub fn check(&self, config: &TerrainConfig) -> Result<(), InputError> {
        let bound =
            || "only the generator \"diamondSquare\" spreads injected heights to the samples around them";
        let spreads = config.generator == HeightGenerator::DiamondSquare;
        InputError::check(
            self.is_empty() || spreads,
            "precomputed_heights",
            format!("[{} points]", self.len()),
            bound,
        )?;
        config.check_overflow(self.largest(), self.mode == FeatureMode::Additive)
    }

    /// Injected points of `seamless` terrain, by row and column in world coordinates.
    #[cfg(feature = "gpu")]
    pub(crate) fn of_points(mode: FeatureMode, points: BTreeMap<(i64, i64), i32>) -> Self {
        Self { mode, worlds: BTreeMap::from([([0, 0], points)]) }
    }

    /// The injected points of `seamless` terrain, by row and column in world coordinates.
    #[cfg(feature = "gpu")]
    pub(crate) fn points(&self) -> impl Iterator<Item = (&(i64, i64), &i32)> {
        self.worlds.get(&[0, 0]).into_iter().flatten()
    }

    /// The injected points of `seamless` terrain that `is_own` chooses by column and row in world coordinates, and all others.
    #[cfg(feature = "gpu")]
    pub(crate) fn divided(&self, is_own: impl Fn([i64; 2]) -> bool) -> [Self; 2] {
        let points = self.points().map(|(at, height)| (*at, *height));
        let (own, other) = points.partition(|((row, column), _)| is_own([*column, *row]));
        [own, other].map(|points| Self::of_points(self.mode, points))
    }

    /// Whether there are no injected points.
    pub fn is_empty(&self) -> bool {
        self.worlds.values().all(BTreeMap::is_empty)
    }

    /// Number of injected points.
    pub fn len(&self) -> usize {
        self.worlds.values().map(BTreeMap::len).sum()
    }

    /// Mode in which features are injected; `None` if there are no features.
    #[cfg(feature = "gpu")]
    pub fn injection(&self) -> Option<FeatureMode> {
        (!self.is_empty()).then_some(self.mode)
    }

    fn largest(&self) -> i64 {
        self.worlds
            .values()
            .flat_map(BTreeMap::values)
            .map(|height| i64::from(*height).abs())
            .max()
            .unwrap_or(0)
    }

    /// Injected points on a square lattice, as (column, row, height), sorted by row and then column. The lattice is in the
    /// coordinates of the world `world`. `new_only` excludes points that also lie on the lattice with twice the spacing.
    pub(crate) fn on_lattice(
        &self,
        world: [i32; 2],
        lattice: Lattice,
        new_only: bool,
    ) -> Vec<(u32, u32, i32)> {
        let Some(points) = self.worlds.get(&world) else { return Vec::new() };
        let Lattice { origin, width, spacing } = lattice;
        let [last_x, last_y] = origin.map(|start| start + i64::from(width.max(1) - 1) * spacing);
        let is_on = |value: i64, step: i64| value.rem_euclid(step) == 0;
        let mut found = Vec::new();
        // The next row of the lattice that may have points, at any column.
        let next_row = |from: i64| {
            let (&(y, _), _) = points.range((from.min(last_y), i64::MIN)..=(last_y, i64::MAX)).next()?;
            let row = y + (-y).rem_euclid(spacing);
            (from <= row && row <= last_y).then_some(row)
        };
        let rows = std::iter::successors(next_row(origin[1]), |row| next_row(row + spacing));
        for row in rows {
            let points = points.range((row, origin[0])..=(row, last_x)).filter(|((_, x), _)| {
                is_on(*x, spacing) && !(new_only && is_on(*x, 2 * spacing) && is_on(row, 2 * spacing))
            });
            let index = |value: i64, start: i64| ((value - start) / spacing) as u32;
            found.extend(
                points.map(|((_, x), height)| (index(*x, origin[0]), index(row, origin[1]), *height)),
            );
        }
        found
    }

    /// Positions (column, row) of the injected points in the window of each patch, sorted by row. In the modes `wrap` and
    /// `blend`, samples around a patch are copied from other patches or from the opposite side of the patch itself. Their
    /// features are copied with them.
    pub(crate) fn in_windows(
        &self,
        config: &TerrainConfig,
        patches: &[[i32; 2]],
        apron: u32,
    ) -> Vec<Vec<(u32, u32)>> {
        if config.border == Border::Seamless || self.is_empty() {
            let points = |patch: &[i32; 2]| {
                let lattice = Window { patch: *patch, apron }.lattice(config);
                let points = self.on_lattice(Self::world_of(config, *patch), lattice, false);
                points.into_iter().map(|(x, y, _)| (x, y)).collect()
            };
            return patches.iter().map(points).collect();
        }
        let size = config.patch_size;
        let marks: Vec<Vec<i32>> = (patches.iter())
            .map(|patch| {
                let mut marks = vec![0; (size * size) as usize];
                let lattice = Window { patch: *patch, apron: 0 }.lattice(config);
                for (x, y, _) in self.on_lattice(Self::world_of(config, *patch), lattice, false) {
                    marks[(y * size + x) as usize] = 1;
                }
                marks
            })
            .collect();
        let width = size + 2 * apron;
        (surrounds(config, patches).into_iter())
            .map(|around| {
                let around = around.map(|tile| tile.map(|index| marks[index].as_slice()));
                let window = pad(size as usize, apron as usize, around);
                let marked = window.into_iter().enumerate().filter(|(_, mark)| *mark != 0);
                marked.map(|(at, _)| (at as u32 % width, at as u32 / width)).collect()
            })
            .collect()
    }

    /// World that contains a patch: (0, 0) for `seamless` terrain, otherwise the patch's own coordinates.
    pub(crate) fn world_of(config: &TerrainConfig, patch: [i32; 2]) -> [i32; 2] {
        if config.border == Border::Seamless { [0, 0] } else { patch }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The points of a lattice are those that a look at each point finds.
    #[test]
    fn lattices_have_all_of_their_points() {
        let mut word = 1_u64;
        let mut draw = |count: i64| {
            word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (word >> 33) as i64 % count
        };
        let points: BTreeMap<(i64, i64), i32> =
            (0..400).map(|at| ((draw(80) - 40, draw(80) - 40), at)).collect();
        let features =
            Features { mode: FeatureMode::Keep, worlds: BTreeMap::from([([0, 0], points.clone())]) };
        let mut found = 0;
        for _ in 0..2000 {
            let spacing = 1 << draw(5);
            let origin = [0; 2].map(|_| (draw(120) - 60).div_euclid(spacing) * spacing);
            let lattice = Lattice { origin, width: draw(9) as u32, spacing };
            let new_only = draw(2) == 1;
            let width = i64::from(lattice.width.max(1));
            let mut all = Vec::new();
            for (row, column) in (0..width).flat_map(|row| (0..width).map(move |column| (row, column))) {
                let [x, y] = [origin[0] + column * spacing, origin[1] + row * spacing];
                let is_old = x % (2 * spacing) == 0 && y % (2 * spacing) == 0;
                if let Some(height) = points.get(&(y, x)).filter(|_| !(new_only && is_old)) {
                    all.push((column as u32, row as u32, *height));
                }
            }
            found += all.len();
            assert_eq!(features.on_lattice([0, 0], lattice, new_only), all, "{spacing} {origin:?}");
        }
        assert!(found > 500, "{found}");
    }
}
