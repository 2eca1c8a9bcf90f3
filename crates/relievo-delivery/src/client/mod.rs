//! The client: asks for what a program wants to show, the most useful first.

#[cfg(target_arch = "wasm32")]
mod browser;
#[cfg(not(target_arch = "wasm32"))]
mod download;
mod fetcher;
#[cfg(not(target_arch = "wasm32"))]
mod native;
#[cfg(feature = "scene")]
mod scene;
mod stream;
mod transport;

#[cfg(target_arch = "wasm32")]
pub use browser::BrowserTransport;
#[cfg(not(target_arch = "wasm32"))]
pub use download::{Download, get, get_catalog};
pub use fetcher::{FetchState, Fetched, Fetcher, FetcherOptions, FileKey, ModelKey, Traffic, Want};
#[cfg(not(target_arch = "wasm32"))]
pub use native::HttpTransport;
#[cfg(feature = "scene")]
pub use scene::StreamedScene;
#[cfg(all(feature = "scene", not(target_arch = "wasm32")))]
pub use scene::get_scene;
pub use stream::{Damaged, PackageStream};
pub use transport::{Answer, Head, Request, RequestId, Transport};

use relievo::InputError;

/// Why something could not be fetched.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FetchError {
    /// The server answered with a status that is no success.
    #[error("{url}: status {status}{}", why(.message))]
    Status {
        /// What was asked for.
        url: String,
        /// Status of HTTP, such as 404.
        status: u16,
        /// What the server said, if it said anything.
        message: String,
    },
    /// The server cannot be reached, or the connection broke.
    #[error("{url}: {reason}")]
    Network {
        /// What was asked for.
        url: String,
        /// What the system said.
        reason: String,
    },
    /// What arrived is not what it should be.
    #[error("{url}: {source}")]
    Content {
        /// What was asked for.
        url: String,
        /// What is wrong with it.
        source: InputError,
    },
}

impl From<FetchError> for relievo::Error {
    fn from(error: FetchError) -> Self {
        match error {
            FetchError::Content { url, source } => Self::InputFile { path: url.into(), source },
            FetchError::Network { url, reason } => Self::file(url, reason),
            FetchError::Status { url, status, message } => {
                Self::file(url, format!("status {status}{}", why(&message)))
            }
        }
    }
}

fn why(message: &str) -> String {
    if message.is_empty() { String::new() } else { format!(" ({message})") }
}

/// Joins the base of a server and a path below it.
pub fn joined(base: &str, path: &str) -> String {
    format!("{}/{}", base.trim_end_matches('/'), path.trim_start_matches('/'))
}

/// The address of a file that a scene file names, from the address of the scene file.
#[cfg(feature = "scene")]
pub fn beside(url: &str, path: &std::path::Path) -> String {
    let mut folder: Vec<&str> = url.split(['?', '#']).next().unwrap_or_default().split('/').collect();
    folder.pop();
    let path = path.to_string_lossy().replace('\\', "/");
    for part in path.split('/') {
        match part {
            "." | "" => {}
            // The scheme, an empty part and the host stay.
            ".." if folder.len() > 3 => drop(folder.pop()),
            ".." => {}
            part => folder.push(part),
        }
    }
    folder.join("/")
}

/// Whether a status may be another one soon.
fn is_passing(status: u16) -> bool {
    matches!(status, 408 | 425 | 429 | 500 | 502 | 503 | 504)
}

#[cfg(all(test, feature = "scene"))]
mod tests {
    #[test]
    fn files_lie_beside_the_scene_file() {
        let beside = |url: &str, path: &str| super::beside(url, path.as_ref());
        assert_eq!(
            beside("http://a.org/w/scenes/walk.json", "../objects/1.rlv"),
            "http://a.org/w/objects/1.rlv"
        );
        assert_eq!(beside("http://a.org/walk.json?x=1/2", "rock.rlv"), "http://a.org/rock.rlv");
        assert_eq!(beside("http://a.org/walk.json", "../../../x.png"), "http://a.org/x.png");
    }
}
