//! `relievo fetch`: a level of a model from a server.

use std::fs::{File, OpenOptions};
use std::io::{Seek as _, SeekFrom, Write as _};
use std::path::PathBuf;

use clap::Args;
use relievo::asset::Model;
use relievo::{Error, InputError};
use relievo_delivery::catalog::CatalogModel;
use relievo_delivery::client::{Download, FetchError, PackageStream, get, get_catalog, joined};
use relievo_lab::files::write_file;

use crate::output::say;
use crate::progress::bar;

/// Fetches a level of detail of a model from `relievo serve`, or from any web server that has a package.
///
/// Level 0 is the finest. The extension of the file to write selects its content:
///
/// .rlv: the beginning of the package up to the level. Every command reads it, with this level and the coarser ones. With --from, the
/// file has an earlier part already, and only the difference is fetched.
///
/// .glb: the level alone. .json: its positions, normals, texture coordinates and indices; with --from, what changes a coarser level
/// into it.
///
/// A transfer that was broken off goes on where it broke (FILE.part). Every chunk is checked against its SHA-256.
///
/// relievo fetch http://127.0.0.1:8080 --model rock --level 3 --out rock.rlv
///
/// relievo fetch http://127.0.0.1:8080 --model rock --from 3 --level 0 --out rock.rlv
///
/// relievo fetch http://127.0.0.1:8080/models/rock.rlv --out rock.glb
#[derive(Args)]
pub struct Fetch {
    /// Address of a server, or of a package (.rlv).
    url: String,
    /// The model's name on the server. `catalog.json` lists the names.
    #[arg(long, value_name = "NAME")]
    model: Option<String>,
    /// The level to fetch, counted from 0, the finest.
    #[arg(long, value_name = "LEVEL", default_value_t = 0)]
    level: usize,
    /// The level that the file has already.
    #[arg(long, value_name = "LEVEL")]
    from: Option<usize>,
    /// The file to write. It appears complete, or not at all.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// The server's token.
    #[arg(long, value_name = "TOKEN", env = "RELIEVO_TOKEN", hide_env_values = true)]
    token: Option<String>,
}

impl Fetch {
    pub fn run(&self) -> Result<(), Error> {
        let ending = self.out.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        if !["rlv", "glb", "json"].contains(&&*ending) {
            let bound = "must end in .rlv, .glb or .json";
            return Err(InputError::new("--out", self.out.display(), bound).into());
        }
        if let Some(from) = self.from
            && from <= self.level
        {
            let bound = format!("must be above {}, the level to fetch: level 0 is the finest", self.level);
            return Err(InputError::new("--from", from, bound).into());
        }
        let token = self.token.as_deref();
        let found = self.model.as_ref().map(|name| self.found(name)).transpose()?;
        if ending == "json" {
            let Some(found) = &found else {
                return Err(InputError::new("--model", "none", "must be given for a .json file").into());
            };
            let levels = match self.from {
                Some(from) => format!("{from}-{}", self.level),
                None => self.level.to_string(),
            };
            let url = joined(&self.url, &format!("models/{}/{levels}.json", found.name));
            let bytes = get(&url, token).map_err(Error::from)?;
            write_file(&self.out, &bytes)?;
            return say(format_args!("{} bytes", bytes.len()));
        }
        let url = match &found {
            Some(found) => joined(&self.url, &found.package),
            None => self.url.clone(),
        };
        let first = found.as_ref().map_or(0, |found| found.levels[self.level].end);
        let stream = self.fetched(&url, &ending, first)?;
        // With the finest level come images.
        let complete = if self.level == 0 { Some(stream.complete()) } else { stream.up_to(self.level) };
        let complete = complete.unwrap_or_default();
        match &*ending {
            "rlv" => write_file(&self.out, &complete)?,
            _ => {
                let mut model = Model::from_rlv(&complete).map_err(|source| self.in_file(source))?;
                model.meshes.iter_mut().for_each(|mesh| mesh.levels.clear());
                write_file(&self.out, &model.to_glb().map_err(|source| self.in_file(source))?)?;
            }
        }
        let _ = std::fs::remove_file(self.part());
        say(format_args!(
            "level {} of {}",
            self.level,
            stream.header().map_or(0, |header| header.levels.len())
        ))
    }

    fn in_file(&self, source: InputError) -> Error {
        Error::InputFile { path: self.out.clone(), source }
    }

    /// Where an unfinished transfer is kept.
    fn part(&self) -> PathBuf {
        let mut name = self.out.clone().into_os_string();
        name.push(".part");
        name.into()
    }

    /// The model in the server's catalog.
    fn found(&self, name: &str) -> Result<CatalogModel, Error> {
        let catalog = get_catalog(&self.url, self.token.as_deref()).map_err(Error::from)?;
        let known: Vec<String> = catalog.models.iter().map(|model| model.name.clone()).collect();
        let found = catalog.models.into_iter().find(|model| model.name == name);
        let found = found.ok_or_else(|| {
            InputError::new(
                "--model",
                name,
                format!("must be one of the server's models: {}", known.join(", ")),
            )
        })?;
        if found.package.is_empty() {
            return Err(Error::file(joined(&self.url, name), format!("is not ready: {:?}", found.state)));
        }
        for (path, level) in [("--level", Some(self.level)), ("--from", self.from)] {
            if let Some(level) = level.filter(|level| *level >= found.levels.len()) {
                let bound = format!("must be below {}, the number of the model's levels", found.levels.len());
                return Err(InputError::new(path, level, bound).into());
            }
        }
        Ok(found)
    }

    /// Fetches the package up to the level. What arrives is kept in a file beside the one to write.
    fn fetched(&self, url: &str, ending: &str, first: u64) -> Result<PackageStream, Error> {
        let part = self.part();
        let mut download = Download::new(url);
        download.token.clone_from(&self.token);
        let kept = if part.is_file() { Some(&part) } else { None };
        let kept = kept.or_else(|| Some(&self.out).filter(|_| self.from.is_some() && ending == "rlv"));
        if let Some(path) = kept {
            let bytes = std::fs::read(path).map_err(|error| Error::file(path, error))?;
            download.resume(path, &bytes).map_err(|error| match error {
                FetchError::Content { source, .. } => Error::InputFile { path: path.clone(), source },
                other => other.into(),
            })?;
            if let (Some(from), true) = (self.from, path == &self.out)
                && download.stream.level().is_none_or(|level| level > from)
            {
                let found =
                    download.stream.level().map_or_else(|| "none".to_owned(), |level| level.to_string());
                let bound = format!("must have level {from}; it has level {found}");
                return Err(InputError::new("--out", self.out.display(), bound).into());
            }
        }
        download.stream.expect_first(first);
        let failed = |error| Error::output(&part, error);
        let mut file =
            OpenOptions::new().create(true).write(true).truncate(false).open(&part).map_err(failed)?;
        let mut written = 0;
        write_since(&mut file, &mut written, &download.stream).map_err(failed)?;
        let mut problem = None;
        let shown = bar(1, "bytes");
        let outcome = download.run(self.level, &mut |stream| {
            let more = stream.missing(self.level).map_or(0, |range| range.end - range.start);
            shown.set_length(stream.len() + more);
            shown.set_position(stream.len());
            problem = write_since(&mut file, &mut written, stream).err();
            problem.is_none()
        });
        shown.finish_and_clear();
        match problem {
            Some(problem) => Err(failed(problem)),
            None => outcome.map_err(Error::from).map(|()| download.stream),
        }
    }
}

/// Writes what a file lacks of a stream. If the stream has become shorter, as a chunk was damaged, the file becomes shorter too.
fn write_since(file: &mut File, written: &mut u64, stream: &PackageStream) -> std::io::Result<()> {
    if *written > stream.len() {
        *written = 0;
    }
    let new = stream.since(*written);
    file.seek(SeekFrom::Start(*written))?;
    file.write_all(&new)?;
    *written += new.len() as u64;
    file.set_len(*written)
}
