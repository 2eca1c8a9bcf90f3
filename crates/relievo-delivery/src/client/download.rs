//! Single files, fetched while the caller waits.

use std::io::Read as _;
use std::path::Path;
use std::time::Duration;

use relievo::InputError;

use super::native::{agent, ask};
use super::stream::PackageStream;
use super::transport::Request;
use super::{FetchError, is_passing, joined};
use crate::catalog::{CATALOG, Catalog};

/// Largest number of bytes of a file that is fetched as a whole.
const MOST: u64 = 256 << 20;
const MOST_TEXT: u64 = 64 << 10;

/// Attempts without a single new byte before a download gives up.
const ATTEMPTS: u32 = 5;
const PAUSE: Duration = Duration::from_millis(250);

/// Fetches a whole file, of at most 256 MiB.
///
/// # Errors
/// [`FetchError`].
pub fn get(url: &str, token: Option<&str>) -> Result<Vec<u8>, FetchError> {
    get_by(&agent(), url, token)
}

/// [`get`] with connections that are kept.
pub(super) fn get_by(agent: &ureq::Agent, url: &str, token: Option<&str>) -> Result<Vec<u8>, FetchError> {
    let request = Request { token: token.map(str::to_owned), ..Request::whole(url) };
    let network = |reason: String| FetchError::Network { url: url.to_owned(), reason };
    let (head, body) = ask(agent, &request).map_err(network)?;
    let mut bytes = Vec::new();
    body.into_reader().take(MOST + 1).read_to_end(&mut bytes).map_err(|error| network(error.to_string()))?;
    if head.status != 200 {
        return Err(refused(url, head.status, &bytes));
    }
    if bytes.len() as u64 > MOST {
        let source = InputError::new("length", "more", format!("must be at most {MOST} bytes"));
        return Err(FetchError::Content { url: url.to_owned(), source });
    }
    Ok(bytes)
}

/// Fetches the catalog of a server.
///
/// # Errors
/// [`FetchError`].
pub fn get_catalog(base: &str, token: Option<&str>) -> Result<Catalog, FetchError> {
    let url = joined(base, CATALOG);
    let unreadable = |error: serde_json::Error| FetchError::Content {
        url: url.clone(),
        source: InputError::new("catalog", "JSON", format!("cannot be read: {error}")),
    };
    serde_json::from_slice(&get(&url, token)?).map_err(unreadable)
}

/// The error of an answer that is no success.
pub(super) fn refused(url: &str, status: u16, body: &[u8]) -> FetchError {
    let body = &body[..body.len().min(MOST_TEXT as usize)];
    let said = serde_json::from_slice::<serde_json::Value>(body).ok();
    let said = said.and_then(|said| Some(said.get("error")?.as_str()?.to_owned()));
    FetchError::Status { url: url.to_owned(), status, message: said.unwrap_or_default() }
}

/// A download of a package that can be broken off and resumed.
#[derive(Debug, Clone)]
pub struct Download {
    /// Address of the package.
    pub url: String,
    /// The server's token, if it wants one.
    pub token: Option<String>,
    /// The hash of the package, if it is known: another one is refused.
    pub hash: Option<String>,
    /// What is there.
    pub stream: PackageStream,
}

impl Download {
    /// A download from the beginning.
    pub fn new(url: impl Into<String>) -> Self {
        Self { url: url.into(), token: None, hash: None, stream: PackageStream::new() }
    }

    /// Goes on with the beginning of the package that a file holds. The last chunk may be incomplete.
    ///
    /// # Errors
    /// [`FetchError::Content`] for a file that is no beginning of a package.
    pub fn resume(&mut self, path: &Path, bytes: &[u8]) -> Result<(), FetchError> {
        self.stream = PackageStream::resumed(bytes)
            .map_err(|error| FetchError::Content { url: path.display().to_string(), source: error.0 })?;
        Ok(())
    }

    /// Fetches what is missing up to a level, 0 for the finest; with level 0, images too. Broken connections and damaged chunks are
    /// fetched again from where they broke. `watch` gets the stream after each piece; if it returns false, the download stops, and
    /// may be resumed.
    ///
    /// # Errors
    /// [`FetchError`] once five attempts in a row have brought nothing, and for answers that are no success.
    pub fn run(
        &mut self,
        level: usize,
        watch: &mut dyn FnMut(&PackageStream) -> bool,
    ) -> Result<(), FetchError> {
        let agent = agent();
        let mut failures = 0;
        loop {
            if let Some(header) = self.stream.header()
                && level >= header.levels.len()
            {
                let bound = format!("must be below {}, the number of levels", header.levels.len());
                let source = InputError::new("level", level, bound);
                return Err(FetchError::Content { url: self.url.clone(), source });
            }
            let images = || self.stream.missing_images().filter(|_| level == 0);
            let Some(range) = self.stream.missing(level).or_else(images) else { return Ok(()) };
            let before = self.stream.checked();
            match self.attempt(&agent, range, watch) {
                Ok(true) => {}
                Ok(false) => return Ok(()),
                Err(error @ FetchError::Status { status, .. }) if !is_passing(status) => return Err(error),
                Err(error) => {
                    failures = if self.stream.checked() > before { 0 } else { failures + 1 };
                    if failures >= ATTEMPTS {
                        return Err(error);
                    }
                    std::thread::sleep(PAUSE * failures);
                }
            }
        }
    }

    /// One request. Whether the caller wants to go on.
    fn attempt(
        &mut self,
        agent: &ureq::Agent,
        range: std::ops::Range<u64>,
        watch: &mut dyn FnMut(&PackageStream) -> bool,
    ) -> Result<bool, FetchError> {
        let url = self.url.clone();
        let network = |reason: String| FetchError::Network { url: url.clone(), reason };
        let content = |source| FetchError::Content { url: url.clone(), source };
        let request = Request {
            url: url.clone(),
            range: Some(range.clone()),
            if_match: self.hash.as_ref().map(|hash| format!("\"{hash}\"")),
            token: self.token.clone(),
        };
        let (head, body) = ask(agent, &request).map_err(network)?;
        let mut reader = body.into_reader();
        if !matches!(head.status, 200 | 206) {
            let mut text = Vec::new();
            // What the server says is only for the message.
            let _ = reader.by_ref().take(MOST_TEXT).read_to_end(&mut text);
            return Err(refused(&url, head.status, &text));
        }
        if head.start > range.start {
            let bound = format!("must be {}, what was asked for", range.start);
            return Err(content(InputError::new("content-range", head.start, bound)));
        }
        // A server that knows no ranges sends the whole file.
        let mut skipped = range.start - head.start;
        let (mut at, mut piece) = (range.start, vec![0; 16 << 10]);
        while at < range.end {
            let count = reader.read(&mut piece).map_err(|error| network(error.to_string()))?;
            if count == 0 {
                // The first request may ask for more than there is. What came is kept.
                return match at > range.start {
                    true => Ok(true),
                    false => Err(network(format!("the connection ended after byte {at}"))),
                };
            }
            let skip = (count as u64).min(skipped);
            skipped -= skip;
            let new = &piece[skip as usize..count];
            let new = &new[..new.len().min((range.end - at) as usize)];
            if new.is_empty() {
                continue;
            }
            self.stream.push(at, new).map_err(|error| content(error.0))?;
            at += new.len() as u64;
            if !watch(&self.stream) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}
