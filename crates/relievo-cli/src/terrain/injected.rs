//! Heights that `relievo terrain` injects: feature files, and samples of a PNG.

use std::path::PathBuf;

use relievo::Error;
use relievo::ops::terrain::config::TerrainConfig;
use relievo::ops::terrain::features::{FeatureFile, Features};

use super::Terrain;
use super::export::{HeightImage, HeightRange};
use super::grid::Grid;
use crate::memory;

impl Terrain {
    /// The features of all files, for windows of `width` samples per row.
    pub(super) fn read_features(
        &self,
        config: &TerrainConfig,
        grid: Grid,
        width: u32,
    ) -> Result<Features, Error> {
        let mut features = Features::new(config, &[], self.feature_mode)?;
        let mut add = |path: &PathBuf, file: &FeatureFile| {
            let added = features.add(config, file).and_then(|()| features.check(config));
            added.map_err(|source| Error::InputFile { path: path.clone(), source: source.in_json() })
        };
        for path in &self.features {
            add(path, &FeatureFile::from_file(path)?)?;
        }
        if let (Some(path), Some(every)) = (&self.heights_from, self.every) {
            let image = HeightImage::from_file(path)?;
            let range = self.heights_range.or(image.range);
            let symmetric = HeightRange { low: -config.scale_factor, high: config.scale_factor };
            // The number of samples inside both the image and the grid.
            let samples = grid.samples(width).min(image.samples.len() as u128);
            let injected = samples / u128::from(every.max(1)).pow(2);
            let [columns, rows] = self.patches;
            memory::check(&format!("{columns}x{rows}"), grid.bytes(width, injected as u64))?;
            for file in image.features(config, grid.first, grid.size, every, range.unwrap_or(symmetric))? {
                add(path, &file)?;
            }
        }
        Ok(features)
    }
}
