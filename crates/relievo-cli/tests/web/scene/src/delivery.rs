//! What a client gets from a server, in the browser and natively.

use std::time::Duration;

use relievo::asset::package::PackageHeader;
use relievo::ops::terrain::export::sha256 as hash_of;
use relievo::ops::terrain::field::field;
use relievo::ops::terrain::recipe::Recipe;
use relievo_delivery::catalog::Catalog;
use relievo_delivery::client::{FetchError, Fetcher, FetcherOptions, FileKey, Transport, Want, joined};
use relievo_delivery::mesh_json::{MeshDifference, MeshJson};
use relievo_delivery::sha256;

type Error = Box<dyn std::error::Error>;

/// A fetcher, and what it fetches from.
struct Client<T, P> {
    base: String,
    fetcher: Fetcher<T>,
    pause: P,
}

impl<T: Transport, P: AsyncFn() -> Duration> Client<T, P> {
    /// Fetches what was added, until nothing is missing.
    async fn settle(&mut self) {
        while !self.fetcher.is_settled() {
            let now = (self.pause)().await;
            self.fetcher.update(now);
        }
    }

    /// Asks for a file.
    fn add(&mut self, path: &str) -> FileKey {
        self.fetcher.add_file(&joined(&self.base, path))
    }

    fn file(&self, file: FileKey) -> Result<Vec<u8>, FetchError> {
        Ok(self.fetcher.file(file)?.unwrap_or_default().to_vec())
    }
}

/// Fetches all that a server has. Returns lines: of each model the hash of its package, the hash of each of its levels as JSON, and
/// the number of differences between two levels that give the finer one; the hash of the terrain's heights; the error for a file that
/// does not exist. `pause` lets other work go on, and returns the time.
pub async fn fetched<T: Transport>(
    base: &str,
    transport: T,
    pause: impl AsyncFn() -> Duration,
) -> Result<Vec<String>, Error> {
    let fetcher = Fetcher::new(transport, FetcherOptions::default());
    let mut client = Client { base: base.to_owned(), fetcher, pause };
    let [catalog, config] = ["catalog.json", "terrain/config.json"].map(|path| client.add(path));
    client.settle().await;
    let catalog: Catalog = serde_json::from_slice(&client.file(catalog)?)?;
    let keys: Vec<_> = catalog
        .models
        .iter()
        .map(|model| client.fetcher.add(&joined(&client.base, &model.package)))
        .collect();
    // Coarsely first, then wholly: a second request goes on where the first one ended.
    for error in [f32::MAX, 0.0] {
        let want = |key: &_| Want { model: *key, error, weight: 1.0 };
        client.fetcher.want(&keys.iter().map(want).collect::<Vec<_>>());
        client.settle().await;
    }
    let mut lines = Vec::new();
    for (model, key) in catalog.models.iter().zip(keys) {
        let bytes = client.fetcher.bytes(key);
        lines.push(format!("{} {}", model.name, sha256(&bytes)));
        let levels = PackageHeader::read(&bytes)?.0.levels.len();
        let wholes: Vec<_> =
            (0..levels).map(|level| client.add(&format!("models/{}/{level}.json", model.name))).collect();
        let pairs = (1..levels).flat_map(|from| (0..from).map(move |to| [from, to]));
        let pairs: Vec<_> = pairs
            .map(|[from, to]| (from, to, client.add(&format!("models/{}/{from}-{to}.json", model.name))))
            .collect();
        client.settle().await;
        let mut meshes: Vec<MeshJson> = Vec::new();
        for (level, key) in wholes.into_iter().enumerate() {
            let mesh: MeshJson = serde_json::from_slice(&client.file(key)?)?;
            lines.push(format!("{} {level} {}", model.name, hash(&mesh)?));
            meshes.push(mesh);
        }
        let mut equal = 0;
        for (from, to, key) in pairs {
            let difference: MeshDifference = serde_json::from_slice(&client.file(key)?)?;
            let mut mesh = meshes[from].clone();
            mesh.apply(&difference)?;
            equal += usize::from(mesh == meshes[to]);
        }
        lines.push(format!("{} {equal} differences", model.name));
    }
    let recipe = Recipe::from_json(&String::from_utf8(client.file(config)?)?)?;
    lines.push(format!("heights {}", hash_of(&field(&recipe, &[[0, 0]], 0)?[0])));
    let missing = client.add("models/none.rlv");
    client.settle().await;
    lines.push(client.file(missing).err().map_or_else(|| "there".to_owned(), |error| error.to_string()));
    Ok(lines)
}

/// The hash of a level.
fn hash(mesh: &MeshJson) -> Result<String, Error> {
    Ok(sha256(&serde_json::to_vec(mesh)?))
}
