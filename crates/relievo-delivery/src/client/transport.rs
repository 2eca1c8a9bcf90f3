//! Requests, and what carries them out.

use std::collections::BTreeMap;
use std::ops::Range;
use std::time::Duration;

/// Identifies a request of a transport.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct RequestId(pub u64);

/// The answers to requests that run. Requests that end are removed from the list.
pub(super) fn of_running<T>(
    running: &mut BTreeMap<RequestId, T>,
    all: impl IntoIterator<Item = (RequestId, Answer)>,
) -> Vec<(RequestId, Answer)> {
    let is_running = |(id, answer): &(RequestId, Answer)| match answer {
        Answer::End | Answer::Failed(_) => running.remove(id).is_some(),
        Answer::Head(_) | Answer::Bytes(_) => running.contains_key(id),
    };
    all.into_iter().filter(is_running).collect()
}

/// A `GET` request.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Request {
    /// Address of the file.
    pub url: String,
    /// The bytes that are wanted; an end of `u64::MAX` means the end of the file. `None` for the whole file.
    pub range: Option<Range<u64>>,
    /// The tag that the file had when its other bytes were fetched. A file that has changed since is refused.
    pub if_match: Option<String>,
    /// The server's token, if it wants one.
    pub token: Option<String>,
}

impl Request {
    /// A request for a whole file.
    pub fn whole(url: impl Into<String>) -> Self {
        Self { url: url.into(), ..Self::default() }
    }

    /// The headers of the request, by name.
    pub fn headers(&self) -> Vec<(&'static str, String)> {
        let mut headers = Vec::new();
        match &self.range {
            Some(range) if range.end == u64::MAX => {
                headers.push(("range", format!("bytes={}-", range.start)))
            }
            Some(range) => headers.push(("range", format!("bytes={}-{}", range.start, range.end - 1))),
            None => {}
        }
        headers.extend(self.if_match.clone().map(|tag| ("if-match", tag)));
        headers.extend(self.token.as_ref().map(|token| ("authorization", format!("Bearer {token}"))));
        headers
    }
}

/// The head of an answer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Head {
    /// Status of HTTP.
    pub status: u16,
    /// The file's strong tag.
    pub tag: Option<String>,
    /// Index of the first byte that follows, in the file.
    pub start: u64,
    /// Number of bytes of the whole file, if the answer says it.
    pub total: Option<u64>,
    /// When to ask again, if the answer says it.
    pub retry_after: Option<Duration>,
}

impl Head {
    /// Reads a head from its status and a function that gives headers by their lower-case names.
    pub fn read(status: u16, header: impl Fn(&str) -> Option<String>) -> Self {
        let part = header("content-range").and_then(|text| {
            // bytes 10-19/300
            let (part, total) = text.strip_prefix("bytes ")?.split_once('/')?;
            let start = part.split_once('-').and_then(|(start, _)| start.parse().ok());
            Some((start, total.parse().ok()))
        });
        let is_part = status == 206;
        let (start, total) = part.unwrap_or((None, None));
        let length = header("content-length").and_then(|text| text.parse().ok());
        Self {
            status,
            tag: header("etag").filter(|tag| !tag.starts_with("W/")),
            start: if is_part { start.unwrap_or(u64::MAX) } else { 0 },
            total: if is_part { total } else { length.filter(|_| header("content-encoding").is_none()) },
            retry_after: header("retry-after").and_then(|text| text.parse().ok()).map(Duration::from_secs),
        }
    }
}

/// A part of an answer. `Head` comes first, then any number of `Bytes`, then `End`; `Failed` may come at any time and is the
/// last.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// The head.
    Head(Head),
    /// Bytes of the content, in order.
    Bytes(Vec<u8>),
    /// The answer is complete.
    End,
    /// The connection failed, and why.
    Failed(String),
}

/// What carries out requests, without blocking.
pub trait Transport {
    /// Starts a request.
    fn start(&mut self, request: Request) -> RequestId;

    /// Ends a request: no further parts of its answer come. A request that has ended is left as it is.
    fn cancel(&mut self, request: RequestId);

    /// The parts of answers that came since the last call.
    fn poll(&mut self) -> Vec<(RequestId, Answer)>;
}
