//! `relievo serve` and `relievo export`: models, scenes and terrain over HTTP, or as plain files.

use std::path::{Path, PathBuf};
use std::sync::Mutex;

use clap::Args;
use relievo::{Error, InputError};
use relievo_delivery::server::{ServeError, ServeOptions, Server, Site, export};
use relievo_samples::Samples;

use crate::output::say;
use crate::progress::bar;

/// Steps of the progress bar.
const STEPS: f32 = 1000.0;

/// What to serve or to export.
#[derive(Args)]
struct Content {
    /// A folder with models: .glb, .gltf, .obj and .rlv files. Each becomes a package with levels of detail, once; a cache beside
    /// the models keeps it (.relievo).
    #[arg(long, value_name = "DIR", env = "RELIEVO_MODELS")]
    models: Option<String>,
    /// A scene file. The files that it names are included.
    #[arg(long, value_name = "FILE")]
    scene: Vec<PathBuf>,
    /// A folder with terrain: config.json, features/*.json with injected heights, elevation/ with tiles of a map. A configuration
    /// without a seed gets one from the system's entropy, the same for all clients.
    #[arg(long, value_name = "DIR", env = "RELIEVO_TERRAIN")]
    terrain: Option<PathBuf>,
    /// A folder with a page, which is shown at the address itself.
    #[arg(long, value_name = "DIR", env = "RELIEVO_PAGE")]
    page: Option<PathBuf>,
    /// Folder of the cache.
    #[arg(long, value_name = "DIR", env = "RELIEVO_CACHE")]
    cache: Option<PathBuf>,
    /// A JSON file with all of these options, named in camelCase (`cacheQuota`, `limits.connections`). Arguments and variables of
    /// the environment take precedence.
    #[arg(long, value_name = "FILE", env = "RELIEVO_CONFIG")]
    config: Option<PathBuf>,
}

/// Serves models coarsest first, scenes and terrain over HTTP.
///
/// Models become packages before they are served; meanwhile, requests for them are answered with 503. A package is a file whose
/// levels of detail lie from the coarsest to the finest, so a client asks for ranges of bytes. `catalog.json` lists what is
/// there. Levels are also served as JSON: models/NAME/LEVEL.json, models/NAME/FROM-TO.json.
///
/// relievo serve --models models --scene walk.json --listen 127.0.0.1:8080
///
/// relievo fetch http://127.0.0.1:8080 --model rock --level 3 --out rock.rlv
#[derive(Args)]
pub struct Serve {
    #[command(flatten)]
    content: Content,
    /// Address and port to listen on. Port 0 lets the system choose.
    #[arg(long, value_name = "ADDRESS", env = "RELIEVO_LISTEN")]
    listen: Option<String>,
    /// The path below which everything is served, for example /world behind a proxy.
    #[arg(long, value_name = "PATH", env = "RELIEVO_BASE")]
    base: Option<String>,
    /// Requests must have this token (`Authorization: Bearer TOKEN`).
    #[arg(long, value_name = "TOKEN", env = "RELIEVO_TOKEN", hide_env_values = true)]
    token: Option<String>,
    /// An origin whose pages may read the answers. Default: all.
    #[arg(long, value_name = "ORIGIN")]
    origin: Vec<String>,
    /// Largest number of bytes of packages in the cache.
    #[arg(long, value_name = "BYTES", env = "RELIEVO_CACHE_QUOTA")]
    cache_quota: Option<u64>,
    /// What is written to standard error: error, warn, info or debug (each request).
    #[arg(long, value_name = "LEVEL", default_value = "info", env = "RELIEVO_LOG")]
    log: tracing::Level,
}

/// Writes what `relievo serve` would serve as plain files, for any web server or content delivery network.
///
/// Every file whose path has the hash of its content may be cached for ever. Files that compression makes smaller lie beside
/// their compressed forms (.br, .zst, .gz). manifest.json lists all files.
///
/// relievo export --models models --scene walk.json --out site
#[derive(Args)]
pub struct Export {
    #[command(flatten)]
    content: Content,
    /// The folder to write to.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
}

impl Content {
    fn options(&self) -> Result<ServeOptions, Error> {
        let mut options = match &self.config {
            Some(path) => read_options(path)?,
            None => ServeOptions::default(),
        };
        let Self { models, scene, terrain, page, cache, config: _ } = self;
        options.models = models.clone().or(options.models);
        options.terrain = terrain.clone().or(options.terrain);
        options.page = page.clone().or(options.page);
        options.cache = cache.clone().or(options.cache);
        if !scene.is_empty() {
            options.scenes.clone_from(scene);
        }
        Ok(options)
    }
}

impl Serve {
    pub fn run(&self) -> Result<(), Error> {
        let mut options = self.content.options()?;
        options.listen = self.listen.clone().unwrap_or(options.listen);
        options.base = self.base.clone().unwrap_or(options.base);
        options.token = self.token.clone().or(options.token);
        options.cache_quota = self.cache_quota.unwrap_or(options.cache_quota);
        if !self.origin.is_empty() {
            options.origins.clone_from(&self.origin);
        }
        tracing_subscriber::fmt().with_max_level(self.log).with_writer(std::io::stderr).init();
        let base = options.base.trim_end_matches('/').to_owned();
        runtime()?.block_on(async {
            let site = Site::open(options, Box::new(Samples)).await.map_err(told)?;
            let server = Server::bind(&site).await.map_err(told)?;
            say(format_args!("http://{}{base}/", server.address().map_err(told)?))?;
            let cooking = tokio::spawn(async move { prepare(&site).await });
            server.run(stopped()).await.map_err(told)?;
            cooking.abort();
            Ok(())
        })
    }
}

impl Export {
    pub fn run(&self) -> Result<(), Error> {
        let options = self.content.options()?;
        runtime()?.block_on(async {
            let site = Site::open(options, Box::new(Samples)).await.map_err(told)?;
            if let Some((_, error)) = prepare(&site).await?.into_iter().next() {
                return Err(told(error));
            }
            let manifest = export(&site, &self.out, &|_| ()).await.map_err(told)?;
            let bytes: u64 = manifest.files.iter().map(|file| file.bytes).sum();
            say(format_args!("{} files, {bytes} bytes", manifest.files.len()))
        })
    }
}

/// Makes all models into packages, with a progress bar, and prints a line for each.
async fn prepare(site: &Site) -> Result<Vec<(String, ServeError)>, Error> {
    let shown = Mutex::new((String::new(), bar(STEPS as u64, "models")));
    let failed = site
        .cook(&|name, fraction| {
            let mut shown = shown.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            if shown.0 != name {
                name.clone_into(&mut shown.0);
                shown.1.set_message(name.to_owned());
            }
            shown.1.set_position((STEPS * fraction) as u64);
        })
        .await;
    shown.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner).1.finish_and_clear();
    let catalog = site.catalog();
    for model in &catalog.models {
        if let (Some(finest), Some(coarsest)) = (model.levels.first(), model.levels.last()) {
            say(format_args!(
                "{}: {} levels, {} to {} triangles, {} bytes, the first picture after {}",
                model.name,
                model.levels.len(),
                coarsest.triangles,
                finest.triangles,
                model.bytes,
                coarsest.end
            ))?;
        }
    }
    catalog.scenes.iter().try_for_each(say)?;
    catalog.terrain.iter().try_for_each(say)?;
    for (name, error) in &failed {
        tracing::error!("{name} is not served: {error}");
    }
    Ok(failed)
}

/// Completes when the program is asked to end.
async fn stopped() {
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        if let Ok(mut terminated) = signal(SignalKind::terminate()) {
            tokio::select! {
                _ = tokio::signal::ctrl_c() => {}
                _ = terminated.recv() => {}
            }
            return;
        }
    }
    let _ = tokio::signal::ctrl_c().await;
}

fn read_options(path: &Path) -> Result<ServeOptions, Error> {
    let text = std::fs::read_to_string(path).map_err(|error| Error::file(path, error))?;
    serde_json::from_str(&text).map_err(|error| {
        let source = InputError::new("options", "JSON", format!("cannot be read: {error}"));
        Error::InputFile { path: path.to_owned(), source }
    })
}

fn runtime() -> Result<tokio::runtime::Runtime, Error> {
    tokio::runtime::Runtime::new().map_err(|error| Error::output("runtime", error))
}

/// An error of the server as one of the library.
fn told(error: ServeError) -> Error {
    match error {
        ServeError::Input(error) => error.into(),
        ServeError::File { path, source } => Error::InputFile { path, source },
        ServeError::Io { what, source } => Error::file(Path::new(&what), source),
        ServeError::Store(error) => InputError::new("models", "store", error.to_string()).into(),
    }
}
