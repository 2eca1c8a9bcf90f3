//! Tiles of an elevation map that are loaded on a thread, when they are needed.

use std::collections::{BTreeMap, VecDeque};
use std::fmt::{Debug, Formatter};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use image::{DynamicImage, EncodableLayout as _, ExtendedColorType, Limits, LumaA};
use serde::{Deserialize, Serialize};

use super::{
    ElevationInfo, ElevationLayout, ElevationSource, ElevationTile, ElevationTiles, TILE_SIZE, TileNumber,
};
use crate::asset::{encode_png, open_image};
use crate::terrain::config::{from_json_object, read_text};
use crate::{Error, InputError};

/// Number of tiles that a loader keeps: 64 MiB of heights.
const KEPT: usize = 256;

/// The file that lists a folder's tiles.
const INDEX: &str = "elevation.json";

/// Loads tiles on a thread of its own, in the order in which they were first asked for. The last 256 that were asked for are kept.
pub struct ElevationLoader {
    info: ElevationInfo,
    shared: Arc<Shared>,
}

struct Shared {
    state: Mutex<State>,
    /// Signals that a tile is wanted, or that the loader is gone.
    changed: Condvar,
}

#[derive(Default)]
struct State {
    /// Tiles to load, the next one first.
    wanted: VecDeque<TileNumber>,
    tiles: BTreeMap<TileNumber, Slot>,
    /// Number of requests so far.
    asked: u64,
    is_closed: bool,
}

/// A tile that was asked for.
struct Slot {
    /// Number of the last request.
    asked: u64,
    /// `None` while it is on its way.
    tile: Option<Result<Arc<ElevationTile>, Error>>,
}

impl Debug for ElevationLoader {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> std::fmt::Result {
        formatter.debug_struct("ElevationLoader").field("info", &self.info).finish_non_exhaustive()
    }
}

impl ElevationLoader {
    /// A loader that calls `load` on its thread for each tile. The thread ends with the loader.
    pub fn new(
        info: ElevationInfo,
        load: impl Fn(TileNumber) -> Result<ElevationTile, Error> + Send + 'static,
    ) -> Self {
        let shared = Arc::new(Shared { state: Mutex::default(), changed: Condvar::new() });
        let own = shared.clone();
        std::thread::spawn(move || {
            while let Some(number) = own.next() {
                let tile = catch_unwind(AssertUnwindSafe(|| load(number))).unwrap_or_else(|_| {
                    let bound = "must load: the loader's function panicked";
                    Err(InputError::new("elevation.tile", format!("{number:?}"), bound).into())
                });
                let tile = tile.map(Arc::new);
                own.store(number, tile);
            }
        });
        Self { info, shared }
    }

    /// A loader of the tiles in a folder that [`ElevationTiles::write`] wrote.
    ///
    /// # Errors
    /// [`Error::File`] if the folder's `elevation.json` cannot be read; [`Error::InputFile`] if it is not valid.
    pub fn from_folder(folder: &Path) -> Result<Self, Error> {
        let path = folder.join(INDEX);
        let index: Index = from_json_object("elevation", &read_text(&path)?)
            .map_err(|source| Error::InputFile { path: path.clone(), source })?;
        let info = ElevationInfo { layout: index.layout, levels: index.levels, apart: index.apart };
        let facts: BTreeMap<TileNumber, TileEntry> = index
            .tiles
            .into_iter()
            .map(|entry| (TileNumber { level: entry.level, at: entry.at }, entry))
            .collect();
        let folder = folder.to_owned();
        Ok(Self::new(info, move |number| {
            let path = folder.join(tile_name(number));
            let absent = || Error::file(&path, "elevation.json lists no such tile");
            let TileEntry { deviation, second_difference, .. } = *facts.get(&number).ok_or_else(absent)?;
            Ok(ElevationTile { heights: read_heights(&path)?, deviation, second_difference })
        }))
    }
}

impl Drop for ElevationLoader {
    fn drop(&mut self) {
        self.shared.lock().is_closed = true;
        self.shared.changed.notify_all();
    }
}

impl ElevationSource for ElevationLoader {
    fn info(&self) -> ElevationInfo {
        self.info
    }

    fn tile(&self, number: TileNumber) -> Result<Option<Arc<ElevationTile>>, Error> {
        let mut state = self.shared.lock();
        state.asked += 1;
        let asked = state.asked;
        let Some(slot) = state.tiles.get_mut(&number) else {
            state.tiles.insert(number, Slot { asked, tile: None });
            state.wanted.push_back(number);
            self.shared.changed.notify_all();
            return Ok(None);
        };
        slot.asked = asked;
        match &slot.tile {
            None => Ok(None),
            Some(Ok(tile)) => Ok(Some(tile.clone())),
            // It is loaded again if it is asked for once more.
            Some(Err(_)) => match state.tiles.remove(&number).and_then(|slot| slot.tile) {
                Some(Err(error)) => Err(error),
                _ => Ok(None),
            },
        }
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next tile to load; `None` once the loader is gone. Waits for one.
    fn next(&self) -> Option<TileNumber> {
        let mut state = self.lock();
        loop {
            if state.is_closed {
                return None;
            }
            if let Some(number) = state.wanted.pop_front() {
                return Some(number);
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// Stores a tile, and forgets the ones that were not asked for for longest.
    fn store(&self, number: TileNumber, tile: Result<Arc<ElevationTile>, Error>) {
        let mut state = self.lock();
        if let Some(slot) = state.tiles.get_mut(&number) {
            slot.tile = Some(tile);
        }
        while state.tiles.values().filter(|slot| slot.tile.is_some()).count() > KEPT {
            let loaded = state.tiles.iter().filter(|(_, slot)| slot.tile.is_some());
            let Some(oldest) = loaded.min_by_key(|(_, slot)| slot.asked).map(|(number, _)| *number) else {
                break;
            };
            state.tiles.remove(&oldest);
        }
    }
}

impl ElevationTiles {
    /// Writes all tiles into a folder, which is made if it is not there: `elevation.json`, and for each tile a PNG of 16-bit grey and
    /// alpha, the upper and the lower half of height + 2^31. `progress` is called after each tile.
    ///
    /// # Errors
    /// [`Error::Output`] if a file cannot be written.
    pub fn write(&self, folder: &Path, mut progress: impl FnMut()) -> Result<(), Error> {
        let mut entries = Vec::new();
        for (number, tile) in self.tiles() {
            let path = folder.join(tile_name(number));
            if let Some(parent) = path.parent() {
                std::fs::create_dir_all(parent).map_err(|error| Error::output(parent, error))?;
            }
            let samples = tile.heights.iter().flat_map(|height| {
                let word = *height as u32 ^ 0x8000_0000;
                [(word >> 16) as u16, word as u16]
            });
            let samples: Vec<u16> = samples.collect();
            if samples.len() != 2 * (TILE_SIZE * TILE_SIZE) as usize {
                return Err(Error::output(&path, "a tile has another size"));
            }
            let encoded = encode_png([TILE_SIZE; 2], samples.as_bytes(), ExtendedColorType::La16);
            let encoded = encoded.map_err(|error| Error::output(&path, error))?;
            std::fs::write(&path, encoded).map_err(|error| Error::output(&path, error))?;
            let (deviation, second_difference) = (tile.deviation, tile.second_difference);
            entries.push(TileEntry { level: number.level, at: number.at, deviation, second_difference });
            progress();
        }
        let ElevationInfo { layout, levels, apart } = self.info();
        // The list is written last: a folder without it is not whole.
        let index = Index { layout, levels, apart, tiles: entries };
        let path = folder.join(INDEX);
        let text = serde_json::to_string(&index).map_err(|error| Error::output(&path, error))?;
        std::fs::write(&path, text).map_err(|error| Error::output(&path, error))
    }
}

/// The name of a tile's file in its folder.
fn tile_name(TileNumber { level, at: [column, row] }: TileNumber) -> String {
    format!("{level}/{column}_{row}.png")
}

fn read_heights(path: &Path) -> Result<Vec<i32>, Error> {
    let image = open_image(path, Limits::default())?;
    let DynamicImage::ImageLumaA16(image) = image else {
        return Err(Error::file(path, "must be a PNG of 16-bit grey and alpha"));
    };
    if image.dimensions() != (TILE_SIZE, TILE_SIZE) {
        let source = InputError::new(
            "size",
            format!("{:?}", image.dimensions()),
            format!("must be {TILE_SIZE} × {TILE_SIZE} samples"),
        );
        return Err(Error::InputFile { path: path.to_owned(), source });
    }
    let height =
        |LumaA([high, low]): &LumaA<u16>| ((u32::from(*high) << 16 | u32::from(*low)) ^ 0x8000_0000) as i32;
    Ok(image.pixels().map(height).collect())
}

/// `elevation.json`.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct Index {
    layout: ElevationLayout,
    levels: u32,
    apart: u32,
    tiles: Vec<TileEntry>,
}

/// A tile in `elevation.json`.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct TileEntry {
    level: u32,
    at: [i32; 2],
    deviation: u32,
    second_difference: u32,
}
