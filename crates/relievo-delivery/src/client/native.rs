//! HTTP outside of browsers, on threads.

use std::collections::BTreeMap;
use std::io::Read as _;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::transport::{Answer, Head, Request, RequestId, Transport, of_running};

/// Bytes that are read at once.
const PIECE: usize = 16 << 10;

/// Without any byte for this long, a connection counts as broken.
const SILENCE: Duration = Duration::from_secs(20);

/// Requests over HTTP and HTTPS. Each request has a thread while it lasts; connections are kept and used again.
pub struct HttpTransport {
    agent: ureq::Agent,
    next: u64,
    running: BTreeMap<RequestId, Arc<AtomicBool>>,
    sender: Sender<(RequestId, Answer)>,
    answers: Receiver<(RequestId, Answer)>,
    limit: Arc<Limit>,
}

/// The rate of all transfers together.
struct Limit {
    /// Bytes a second; 0 for no limit.
    rate: AtomicU64,
    /// When the next byte may come.
    free: Mutex<Instant>,
}

impl Default for HttpTransport {
    fn default() -> Self {
        Self::new()
    }
}

impl HttpTransport {
    /// A transport without requests.
    pub fn new() -> Self {
        let (sender, answers) = channel();
        let limit = Arc::new(Limit { rate: AtomicU64::new(0), free: Mutex::new(Instant::now()) });
        Self { agent: agent(), next: 0, running: BTreeMap::new(), sender, answers, limit }
    }

    /// Limits the rate of all transfers together, in bytes a second; `None` for no limit.
    pub fn set_rate(&mut self, rate: Option<u64>) {
        self.limit.rate.store(rate.unwrap_or(0), Ordering::Relaxed);
    }
}

/// What keeps connections. Statuses that are no success are answers, not errors.
pub(super) fn agent() -> ureq::Agent {
    ureq::Agent::config_builder()
        .http_status_as_error(false)
        .timeout_connect(Some(SILENCE))
        .timeout_recv_response(Some(SILENCE))
        .timeout_recv_body(None)
        .user_agent(concat!("relievo/", env!("CARGO_PKG_VERSION")))
        .build()
        .into()
}

impl Transport for HttpTransport {
    fn start(&mut self, request: Request) -> RequestId {
        let id = RequestId(self.next);
        self.next += 1;
        let ended = Arc::new(AtomicBool::new(false));
        self.running.insert(id, ended.clone());
        let (agent, sender, limit) = (self.agent.clone(), self.sender.clone(), self.limit.clone());
        std::thread::spawn(move || {
            let send = |answer| !ended.load(Ordering::Relaxed) && sender.send((id, answer)).is_ok();
            let last = match carry_out(&agent, &request, &limit, &send) {
                Ok(()) => Answer::End,
                Err(why) => Answer::Failed(why),
            };
            send(last);
        });
        id
    }

    fn cancel(&mut self, request: RequestId) {
        if let Some(ended) = self.running.remove(&request) {
            ended.store(true, Ordering::Relaxed);
        }
    }

    fn poll(&mut self) -> Vec<(RequestId, Answer)> {
        of_running(&mut self.running, self.answers.try_iter())
    }
}

impl Drop for HttpTransport {
    fn drop(&mut self) {
        self.running.values().for_each(|ended| ended.store(true, Ordering::Relaxed));
    }
}

/// Carries out a request until its end, or until `send` says that nobody listens.
fn carry_out(
    agent: &ureq::Agent,
    request: &Request,
    limit: &Limit,
    send: &dyn Fn(Answer) -> bool,
) -> Result<(), String> {
    let (head, mut body) = ask(agent, request)?;
    let total = head.total;
    let is_success = (200..300).contains(&head.status);
    if !send(Answer::Head(head)) {
        return Ok(());
    }
    let mut reader = body.as_reader();
    let (mut piece, mut received) = (vec![0; PIECE], 0_u64);
    loop {
        let count = reader.read(&mut piece).map_err(|error| error.to_string())?;
        if count == 0 {
            break;
        }
        received += count as u64;
        limit.wait(count);
        if !send(Answer::Bytes(piece[..count].to_vec())) {
            return Ok(());
        }
    }
    match (total, &request.range) {
        (Some(total), None) if is_success && received < total => {
            Err(format!("the connection ended after {received} of {total} bytes"))
        }
        _ => Ok(()),
    }
}

/// Sends a request. Returns the head of the answer, and its body.
pub(super) fn ask(agent: &ureq::Agent, request: &Request) -> Result<(Head, ureq::Body), String> {
    let call = request
        .headers()
        .into_iter()
        .fold(agent.get(&request.url), |call, (name, value)| call.header(name, value));
    // What is asked for by ranges must not be encoded.
    let call = if request.range.is_some() { call.header("accept-encoding", "identity") } else { call };
    let answer = call.call().map_err(|error| error.to_string())?;
    let header = |name: &str| Some(answer.headers().get(name)?.to_str().ok()?.to_owned());
    let head = Head::read(answer.status().as_u16(), header);
    Ok((head, answer.into_body()))
}

impl Limit {
    /// Waits until `count` bytes more may have come.
    fn wait(&self, count: usize) {
        let rate = self.rate.load(Ordering::Relaxed);
        if rate == 0 {
            return;
        }
        let until = {
            let mut free = self.free.lock().unwrap_or_else(PoisonError::into_inner);
            *free = (*free).max(Instant::now()) + Duration::from_secs_f64(count as f64 / rate as f64);
            *free
        };
        std::thread::sleep(until.saturating_duration_since(Instant::now()));
    }
}
