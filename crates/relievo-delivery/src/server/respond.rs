//! Answers with a file: conditions, ranges of bytes, encodings.

use std::ops::{Bound, Range};

use axum::body::{Body, Bytes};
use axum::http::header::{self, HeaderMap, HeaderValue};
use axum::http::{Method, Response, StatusCode};
use headers::{ETag, HeaderMapExt as _, IfMatch, IfNoneMatch, IfRange};
use object_store::{GetOptions, GetRange};
use relievo::InputError;

use super::ServeError;
use super::compress::{Encoding, accepts};
use super::resource::{Content, Lifetime, Resource};
use super::store::Store;

/// Answers a `GET` or `HEAD` request for a file.
pub(super) async fn respond(
    resource: &Resource,
    method: &Method,
    headers: &HeaderMap,
    store: &Store,
) -> Result<Response<Body>, ServeError> {
    let wants_range = headers.contains_key(header::RANGE);
    let accepted = resource.encoded.iter().find(|(encoding, _)| !wants_range && accepts(headers, *encoding));
    let encoding = accepted.map(|(encoding, _)| *encoding);
    let tag = tag(resource, encoding)?;
    let mut response = Response::new(Body::empty());
    describe(response.headers_mut(), resource, encoding, &tag);
    if headers.typed_get::<IfMatch>().is_some_and(|wanted| !wanted.precondition_passes(&tag)) {
        return Ok(short(response, StatusCode::PRECONDITION_FAILED));
    }
    if headers.typed_get::<IfNoneMatch>().is_some_and(|known| !known.precondition_passes(&tag)) {
        return Ok(short(response, StatusCode::NOT_MODIFIED));
    }
    if let Some((_, bytes)) = accepted {
        set_length(&mut response, bytes.len() as u64);
        if method == Method::GET {
            *response.body_mut() = bytes.clone().into();
        }
        return Ok(response);
    }
    let is_same = headers.typed_get::<IfRange>().is_none_or(|known| !known.is_modified(Some(&tag), None));
    let wanted = if wants_range && is_same { range(headers, resource.length) } else { Wanted::All };
    let part = match wanted {
        Wanted::All => 0..resource.length,
        Wanted::Part(part) => {
            *response.status_mut() = StatusCode::PARTIAL_CONTENT;
            let value = format!("bytes {}-{}/{}", part.start, part.end - 1, resource.length);
            set(&mut response, header::CONTENT_RANGE, &value);
            part
        }
        Wanted::Nothing => {
            set(&mut response, header::CONTENT_RANGE, &format!("bytes */{}", resource.length));
            return Ok(short(response, StatusCode::RANGE_NOT_SATISFIABLE));
        }
    };
    set_length(&mut response, part.end - part.start);
    if method == Method::GET {
        *response.body_mut() = body(&resource.content, part, store).await?;
    }
    Ok(response)
}

async fn body(content: &Content, part: Range<u64>, store: &Store) -> Result<Body, ServeError> {
    match content {
        Content::Memory(bytes) => {
            let part = part.start as usize..part.end as usize;
            Ok(bytes.slice(part).into())
        }
        Content::Stored(_) if part.is_empty() => Ok(Bytes::new().into()),
        Content::Stored(path) => {
            let options = GetOptions { range: Some(GetRange::Bounded(part)), ..GetOptions::default() };
            Ok(Body::from_stream(store.raw().get_opts(path, options).await?.into_stream()))
        }
    }
}

fn describe(headers: &mut HeaderMap, resource: &Resource, encoding: Option<Encoding>, tag: &ETag) {
    headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(resource.media));
    headers.insert(header::ACCEPT_RANGES, HeaderValue::from_static("bytes"));
    headers.insert(header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff"));
    headers.insert(
        header::CACHE_CONTROL,
        HeaderValue::from_static(match resource.lifetime {
            Lifetime::Immutable => "public, max-age=31536000, immutable",
            Lifetime::Revalidated => "no-cache",
        }),
    );
    headers.typed_insert(tag.clone());
    if !resource.encoded.is_empty() {
        headers.insert(header::VARY, HeaderValue::from_static("accept-encoding"));
    }
    if let Some(encoding) = encoding {
        headers.insert(header::CONTENT_ENCODING, HeaderValue::from_static(encoding.name()));
    }
}

/// The tag of a file in an encoding. It is strong: the same tag means the same bytes.
fn tag(resource: &Resource, encoding: Option<Encoding>) -> Result<ETag, ServeError> {
    let text = match encoding {
        None => format!("\"{}\"", resource.hash),
        Some(encoding) => format!("\"{}-{}\"", resource.hash, encoding.name()),
    };
    text.parse().map_err(|_| InputError::new("tag", text.as_str(), "must be a tag").into())
}

enum Wanted {
    All,
    Part(Range<u64>),
    Nothing,
}

/// The range of bytes that a request wants. Several ranges, and what is no range of bytes, mean all.
fn range(headers: &HeaderMap, length: u64) -> Wanted {
    let Some(wanted) = headers.typed_get::<headers::Range>() else { return Wanted::All };
    let mut ranges = wanted.satisfiable_ranges(length);
    let (Some((start, end)), None) = (ranges.next(), ranges.next()) else {
        let count = wanted.satisfiable_ranges(length).count();
        return if count == 0 { Wanted::Nothing } else { Wanted::All };
    };
    let start = match start {
        Bound::Included(start) => start,
        Bound::Excluded(start) => start.saturating_add(1),
        Bound::Unbounded => 0,
    };
    let end = match end {
        Bound::Included(end) => end.saturating_add(1),
        Bound::Excluded(end) => end,
        Bound::Unbounded => length,
    };
    let end = end.min(length);
    if start < end { Wanted::Part(start..end) } else { Wanted::Nothing }
}

/// An answer without content.
fn short(mut response: Response<Body>, status: StatusCode) -> Response<Body> {
    *response.status_mut() = status;
    response.headers_mut().remove(header::CONTENT_TYPE);
    response.headers_mut().remove(header::CONTENT_ENCODING);
    response
}

fn set_length(response: &mut Response<Body>, length: u64) {
    response.headers_mut().insert(header::CONTENT_LENGTH, length.into());
}

fn set(response: &mut Response<Body>, name: header::HeaderName, value: &str) {
    if let Ok(value) = HeaderValue::from_str(value) {
        response.headers_mut().insert(name, value);
    }
}
