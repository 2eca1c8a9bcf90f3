//! What is at which path.
//!
//! | path | content |
//! |---|---|
//! | `catalog.json` | models with their levels, scenes, terrain |
//! | `models/NAME.rlv` | a package, by ranges of bytes |
//! | `models/NAME/K.json` | level K as thesis B's JSON; 0 is the finest |
//! | `models/NAME/J-K.json` | the difference from level J to the finer level K |
//! | `scenes/NAME.json` | a scene file, with the paths of what it names |
//! | `objects/HASH.EXT` | packages and other files, by the hash of their content |
//! | `terrain/config.json` | the configuration of the terrain |
//! | `terrain/features/X,Y.json` | injected heights of a patch, possibly none |
//! | `terrain/elevation/…` | tiles of an elevation map |
//! | `health`, `metrics` | for operators |

use std::sync::Arc;

use axum::body::Body;
use axum::extract::{Request, State};
use axum::http::header::{self, HeaderValue};
use axum::http::{HeaderMap, Method, Response, StatusCode};
use serde_json::json;

use super::ServeError;
use super::resource::{Compression, Lifetime, Resource};
use super::respond::respond;
use super::site::{Found, MeshKey, Site};
use crate::sha256;

/// Seconds after which a client should ask again for a model that is being made.
const RETRY_SECONDS: &str = "2";

/// Answers a request, and counts the answer.
pub(super) async fn answer(State(site): State<Site>, request: Request) -> Response<Body> {
    let (method, headers) = (request.method().clone(), request.headers().clone());
    let path = request.uri().path().to_owned();
    let answer = found(&site, &method, &headers, &path).await.unwrap_or_else(|error| {
        tracing::error!(path, %error, "a request failed");
        problem(StatusCode::INTERNAL_SERVER_ERROR, "the server could not read what was asked for")
    });
    let length =
        answer.headers().get(header::CONTENT_LENGTH).and_then(|value| value.to_str().ok()?.parse().ok());
    let sent = if method == Method::HEAD { 0 } else { length.unwrap_or(0) };
    site.0.metrics.answered(answer.status().as_u16(), sent);
    answer
}

async fn found(
    site: &Site,
    method: &Method,
    headers: &HeaderMap,
    path: &str,
) -> Result<Response<Body>, ServeError> {
    if !matches!(*method, Method::GET | Method::HEAD) {
        let mut answer = problem(StatusCode::METHOD_NOT_ALLOWED, "only GET and HEAD are answered");
        answer.headers_mut().insert(header::ALLOW, HeaderValue::from_static("GET, HEAD"));
        return Ok(answer);
    }
    let Some(path) = path.strip_prefix(site.0.options.base()).and_then(|path| path.strip_prefix('/')) else {
        let why = format!("everything is below {}/", site.0.options.base());
        return Ok(problem(StatusCode::NOT_FOUND, &why));
    };
    let Ok(path) = percent_encoding::percent_decode_str(path).decode_utf8() else {
        return Ok(problem(StatusCode::BAD_REQUEST, "the path must be UTF-8"));
    };
    if path == "health" {
        return Ok(health(site));
    }
    if !is_allowed(site, headers) {
        let mut answer =
            problem(StatusCode::UNAUTHORIZED, "needs `Authorization: Bearer` with the server's token");
        answer.headers_mut().insert(header::WWW_AUTHENTICATE, HeaderValue::from_static("Bearer"));
        return Ok(answer);
    }
    let own = match &*path {
        "" => site.0.file("index.html"),
        "metrics" => Some(passing(site.0.metrics.text().into_bytes(), "text/plain; version=0.0.4")),
        path => site.0.file(path),
    };
    if let Some(resource) = own {
        let resource = site.0.in_memory(&resource).await?;
        return respond(&resource, method, headers, site.0.cache.store()).await;
    }
    match made(site, &path).await? {
        Ok(resource) => {
            let resource = site.0.in_memory(&resource).await?;
            respond(&resource, method, headers, site.0.cache.store()).await
        }
        Err(refused) => Ok(refused),
    }
}

/// What is made when it is asked for.
async fn made(site: &Site, path: &str) -> Result<Result<Arc<Resource>, Response<Body>>, ServeError> {
    let missing = |why: &str| Ok(Err(problem(StatusCode::NOT_FOUND, why)));
    if let Some(patch) = path.strip_prefix("terrain/features/").and_then(|name| name.strip_suffix(".json")) {
        let patch = patch.split_once(',').and_then(|(x, y)| Some([x.parse().ok()?, y.parse().ok()?]));
        return match (patch, site.0.file(super::terrain::CONFIG)) {
            (_, None) => missing("there is no terrain"),
            (None, _) => missing("a patch is two integers: terrain/features/X,Y.json"),
            (Some(patch), Some(_)) => {
                Ok(Ok(Arc::new(passing(site.0.features.of(patch), "application/json"))))
            }
        };
    }
    let not_ready = |what: &str| {
        let mut answer = problem(StatusCode::SERVICE_UNAVAILABLE, &format!("the {what} is being prepared"));
        answer.headers_mut().insert(header::RETRY_AFTER, HeaderValue::from_static(RETRY_SECONDS));
        Ok(Err(answer))
    };
    let failed = |what: &str, why: &str| {
        let why = format!("the {what} could not be prepared: {why}");
        Ok(Err(problem(StatusCode::INTERNAL_SERVER_ERROR, &why)))
    };
    match site.0.scene(path) {
        Found::Ready(scene) => return Ok(Ok(Arc::new(scene))),
        Found::Failed(why) => return failed("scene", &why),
        Found::Cooking => return not_ready("scene"),
        Found::Missing => {}
    }
    let Some(model) = path.strip_prefix("models/") else {
        return missing("there is no such file; catalog.json lists what is there");
    };
    let (name, levels) = match model.rsplit_once('/') {
        Some((name, levels)) => (name, Some(levels)),
        None => (model.strip_suffix(".rlv").unwrap_or(model), None),
    };
    let package = match site.0.model(name) {
        Found::Ready(package) => package,
        Found::Missing => return missing("there is no such model; catalog.json lists the models"),
        Found::Failed(why) => return failed("model", &why),
        Found::Cooking => return not_ready("model"),
    };
    let Some(levels) = levels else {
        return Ok(Ok(Arc::new(site.0.resource_of(&package, Lifetime::Revalidated))));
    };
    let count = package.header.levels.len();
    let Some((from, level)) = levels_of(levels) else {
        return missing("levels are models/NAME/LEVEL.json or models/NAME/FROM-TO.json");
    };
    if level >= count || from.is_some_and(|from| from >= count || from <= level) {
        let why = format!("levels are 0 to {}; a difference is from a coarser one to a finer one", count - 1);
        return missing(&why);
    }
    Ok(Ok(site.0.mesh(MeshKey { package: package.hash, from, level }).await?))
}

/// `K.json` or `J-K.json`.
fn levels_of(name: &str) -> Option<(Option<usize>, usize)> {
    let levels = name.strip_suffix(".json")?;
    match levels.split_once('-') {
        Some((from, to)) => Some((Some(from.parse().ok()?), to.parse().ok()?)),
        None => Some((None, levels.parse().ok()?)),
    }
}

fn is_allowed(site: &Site, headers: &HeaderMap) -> bool {
    let Some(token) = &site.0.options.token else { return true };
    let given = headers.get(header::AUTHORIZATION).and_then(|value| value.to_str().ok());
    let given = given.and_then(|value| value.strip_prefix("Bearer ")).unwrap_or_default();
    // Hashes, so that the time of the comparison tells nothing about the token.
    sha256(given.trim().as_bytes()) == sha256(token.as_bytes())
}

fn health(site: &Site) -> Response<Body> {
    let [cooking, ready, failed] = site.0.states();
    let status =
        json!({ "status": "ok", "models": { "cooking": cooking, "ready": ready, "failed": failed } });
    text(StatusCode::OK, status.to_string())
}

/// An answer that says what is wrong.
pub(super) fn problem(status: StatusCode, why: &str) -> Response<Body> {
    text(status, json!({ "status": status.as_u16(), "error": why }).to_string())
}

fn text(status: StatusCode, text: String) -> Response<Body> {
    let length = text.len();
    let mut response = Response::new(Body::from(text));
    *response.status_mut() = status;
    let headers = response.headers_mut();
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static("application/json"));
    headers.insert(header::CACHE_CONTROL, HeaderValue::from_static("no-store"));
    headers.insert(header::CONTENT_LENGTH, length.into());
    response
}

/// A short answer that is made each time.
fn passing(bytes: Vec<u8>, media: &'static str) -> Resource {
    Resource::new(bytes, media, Lifetime::Revalidated, Compression::Never)
}
