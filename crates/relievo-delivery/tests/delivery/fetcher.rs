//! What a fetcher asks for, against a transport in memory: order, cancelling, faults, the cache.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use relievo::asset::package::PackageHeader;
use relievo_delivery::client::{
    Answer, FetchError, FetchState, Fetcher, FetcherOptions, Head, ModelKey, Request, RequestId, Transport,
    Want,
};
use relievo_delivery::sha256;

use super::host::{creature, pebble, rock};
use super::random::Random;

/// Files in memory. Each poll brings some bytes of each request.
#[derive(Default)]
struct Memory {
    files: BTreeMap<String, Arc<Vec<u8>>>,
    /// Bytes of each request for a poll.
    piece: usize,
    running: BTreeMap<RequestId, (Request, u64, bool)>,
    next: u64,
    asked: Vec<Request>,
    cancelled: usize,
    fault: Option<Fault>,
}

/// Changes the answer to a request.
type Fault = Box<dyn FnMut(&Request, Answer) -> Vec<Answer>>;

impl Memory {
    fn new(piece: usize) -> Self {
        let rock = ("rock".to_owned(), Arc::new(rock().to_vec()));
        let creature = ("creature".to_owned(), Arc::new(creature().to_vec()));
        Self { files: BTreeMap::from([rock, creature]), piece, ..Self::default() }
    }

    /// One file alone.
    fn of(name: &str, bytes: Arc<Vec<u8>>, piece: usize) -> Self {
        Self { files: BTreeMap::from([(name.to_owned(), bytes)]), piece, ..Self::default() }
    }
}

impl Transport for Memory {
    fn start(&mut self, request: Request) -> RequestId {
        let id = RequestId(self.next);
        self.next += 1;
        self.asked.push(request.clone());
        let start = request.range.as_ref().map_or(0, |range| range.start);
        self.running.insert(id, (request, start, false));
        id
    }

    fn cancel(&mut self, request: RequestId) {
        self.cancelled += usize::from(self.running.remove(&request).is_some());
    }

    fn poll(&mut self) -> Vec<(RequestId, Answer)> {
        let mut answers = Vec::new();
        let mut ended = Vec::new();
        for (id, (request, at, begun)) in &mut self.running {
            let mut own = Vec::new();
            match self.files.get(&request.url) {
                None => own.push(Answer::Head(Head { status: 404, ..Head::default() })),
                Some(file) => {
                    let end =
                        request.range.as_ref().map_or(u64::MAX, |range| range.end).min(file.len() as u64);
                    if !std::mem::replace(begun, true) {
                        let tag = Some(format!("\"{}\"", sha256(file)));
                        let status = if request.range.is_none() {
                            200
                        } else if request.if_match.as_ref().is_none_or(|wanted| Some(wanted) == tag.as_ref())
                        {
                            206
                        } else {
                            412
                        };
                        let total = Some(file.len() as u64);
                        own.push(Answer::Head(Head { status, tag, start: *at, total, retry_after: None }));
                    }
                    let stop = (*at + self.piece as u64).min(end);
                    own.push(Answer::Bytes(file[*at as usize..stop as usize].to_vec()));
                    *at = stop;
                    if stop == end {
                        own.push(Answer::End);
                        ended.push(*id);
                    }
                }
            }
            for answer in own {
                match &mut self.fault {
                    Some(fault) => {
                        answers.extend(fault(request, answer).into_iter().map(|answer| (*id, answer)))
                    }
                    None => answers.push((*id, answer)),
                }
            }
        }
        ended.iter().for_each(|id| drop(self.running.remove(id)));
        answers
    }
}

const STEP: Duration = Duration::from_millis(10);

fn want(model: ModelKey, error: f32, weight: f32) -> Want {
    Want { model, error, weight }
}

/// Updates until nothing is missing, or for `most` steps. Returns the number of steps.
fn settle(fetcher: &mut Fetcher<Memory>, now: &mut Duration, most: usize) -> usize {
    for step in 0..most {
        *now += STEP;
        fetcher.update(*now);
        if fetcher.is_settled() {
            return step;
        }
    }
    panic!("not settled after {most} steps");
}

#[test]
fn the_coarsest_levels_come_first_and_then_what_removes_most() {
    let options = FetcherOptions { parallel: 1, ..FetcherOptions::default() };
    let mut fetcher = Fetcher::new(Memory::new(4 << 10), options);
    let (near, far) = (fetcher.add("creature"), fetcher.add("rock"));
    assert_eq!(fetcher.add("rock"), far);
    fetcher.want(&[want(near, 0.0, 100.0), want(far, 0.0, 1.0)]);
    let mut order = Vec::new();
    let mut now = Duration::ZERO;
    while !fetcher.is_settled() {
        now += STEP;
        order.extend(fetcher.update(now).into_iter().map(|fetched| (fetched.model, fetched.levels)));
    }
    // Both are there coarsely before either is fine. In the end, each is whole.
    let first = |model| order.iter().position(|(own, _)| *own == model).expect("it arrived");
    let finest =
        |model: ModelKey, count| order.iter().position(|own| *own == (model, count)).expect("it is whole");
    let counts =
        [creature(), rock()].map(|bytes| PackageHeader::read(bytes).expect("a header").0.levels.len());
    assert!(first(far) < finest(near, counts[0]));
    assert!(finest(near, counts[0]) < finest(far, counts[1]), "the one with more weight is done first");
    assert!(fetcher.bytes(near) == creature() && fetcher.bytes(far) == rock());
    assert!(
        fetcher.model(near).expect("a model").expect("it is there")
            == relievo::asset::Model::from_rlv(creature()).expect("a package")
    );
    assert_eq!(fetcher.traffic().received, (creature().len() + rock().len()) as u64, "nothing came twice");
}

#[test]
fn as_much_as_views_need_and_no_more() {
    let mut fetcher = Fetcher::new(Memory::new(1 << 20), FetcherOptions::default());
    let model = fetcher.add("rock");
    let header = PackageHeader::read(rock()).expect("a header").0;
    let mut now = Duration::ZERO;
    let first = 32 << 10;
    for (at, level) in header.levels.iter().enumerate() {
        fetcher.want(&[want(model, level.error, 1.0)]);
        settle(&mut fetcher, &mut now, 100);
        let there = fetcher.bytes(model).len();
        // The first request brings more than one level; images lie behind the finest.
        match at + 1 == header.levels.len() {
            true => assert_eq!(there, rock().len()),
            false => {
                assert!(there == level.chunk.end || level.chunk.end < first && there <= first, "{there}")
            }
        }
    }
    let requests = fetcher.traffic().requests;
    fetcher.want(&[want(model, header.levels[0].error, 1.0)]);
    settle(&mut fetcher, &mut now, 100);
    assert_eq!(fetcher.traffic().requests, requests, "a coarser level is there already");
}

#[test]
fn what_is_not_wanted_any_more_is_broken_off_and_resumed_later() {
    let mut fetcher = Fetcher::new(Memory::new(500), FetcherOptions::default());
    let (one, other) = (fetcher.add("creature"), fetcher.add("rock"));
    let mut now = Duration::ZERO;
    let mut random = Random(3);
    for _ in 0..60 {
        let (model, weight) = (if random.below(2) == 0 { one } else { other }, 1.0);
        fetcher.want(&[want(model, 0.0, weight)]);
        for _ in 0..random.below(6) {
            now += STEP;
            fetcher.update(now);
        }
    }
    assert!(fetcher.traffic().cancelled > 10);
    fetcher.want(&[want(one, 0.0, 1.0), want(other, 0.0, 1.0)]);
    settle(&mut fetcher, &mut now, 10_000);
    assert!(fetcher.bytes(one) == creature() && fetcher.bytes(other) == rock());
    assert_eq!(fetcher.traffic().received, (creature().len() + rock().len()) as u64, "nothing came twice");
}

#[test]
fn a_full_cache_forgets_what_is_not_wanted_and_never_stalls() {
    let options = FetcherOptions { cache: 1000, ..FetcherOptions::default() };
    let mut fetcher = Fetcher::new(Memory::new(1 << 20), options);
    let (one, other) = (fetcher.add("creature"), fetcher.add("rock"));
    let mut now = Duration::ZERO;
    fetcher.want(&[want(one, 0.0, 1.0), want(other, 0.0, 1.0)]);
    settle(&mut fetcher, &mut now, 100);
    assert_eq!(fetcher.traffic().kept, (creature().len() + rock().len()) as u64, "both are wanted");
    fetcher.want(&[want(other, 0.0, 1.0)]);
    fetcher.update(now);
    assert_eq!(fetcher.traffic().kept, rock().len() as u64);
    assert!(fetcher.model(one).expect("no error").is_none());
    fetcher.want(&[want(one, 0.0, 1.0)]);
    settle(&mut fetcher, &mut now, 100);
    assert!(fetcher.bytes(one) == creature());
}

#[test]
fn a_server_that_fails_is_asked_again_later_and_later() {
    let mut memory = Memory::new(3000);
    let mut random = Random(4);
    // A third of all answers fail, are cut short, damaged, or come from a server that is busy.
    memory.fault = Some(Box::new(move |_, answer| match (random.below(12), answer) {
        (0, _) => vec![Answer::Failed("connection reset".to_owned())],
        (1, Answer::Head(head)) => vec![Answer::Head(Head { status: 503, ..head })],
        (2, Answer::Bytes(bytes)) => vec![Answer::Bytes(bytes[..bytes.len() / 2].to_vec()), Answer::End],
        (3, Answer::Bytes(mut bytes)) => {
            let at = random.below(bytes.len().max(1) as u64) as usize;
            bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 4);
            vec![Answer::Bytes(bytes)]
        }
        (_, answer) => vec![answer],
    }));
    let mut fetcher = Fetcher::new(memory, FetcherOptions::default());
    let models = [fetcher.add("creature"), fetcher.add("rock")];
    let mut now = Duration::ZERO;
    fetcher.want(&models.map(|model| want(model, 0.0, 1.0)));
    let mut waited = 0;
    for _ in 0..200_000 {
        now += STEP;
        fetcher.update(now);
        waited += usize::from(matches!(fetcher.state(models[0]), FetchState::Waiting { .. }));
        if fetcher.is_settled() {
            break;
        }
    }
    assert!(waited > 0);
    for (model, whole) in models.into_iter().zip([creature(), rock()]) {
        // Three damaged answers for the same chunk in a row are given up.
        match fetcher.state(model) {
            FetchState::Failed(error) => assert!(error.to_string().contains("SHA-256"), "{error}"),
            _ => assert!(fetcher.bytes(model) == whole),
        }
    }
}

#[test]
fn a_server_that_answers_without_a_byte_is_not_flooded() {
    let mut memory = Memory::new(1 << 20);
    memory.fault = Some(Box::new(|request, answer| match answer {
        // The first request brings the header; then nothing comes any more.
        Answer::Bytes(_) if request.range.as_ref().is_some_and(|range| range.start > 0) => vec![Answer::End],
        answer => vec![answer],
    }));
    let mut fetcher = Fetcher::new(memory, FetcherOptions::default());
    let model = fetcher.add("creature");
    fetcher.want(&[want(model, 0.0, 1.0)]);
    let mut now = Duration::ZERO;
    for _ in 0..1000 {
        now += STEP;
        fetcher.update(now);
    }
    // 0.25, 0.5, 1, 2, 4 s: in ten seconds, hardly more than the first request and five.
    let requests = fetcher.traffic().requests;
    assert!((5..9).contains(&requests), "{requests} requests");
    assert!(matches!(fetcher.state(model), FetchState::Waiting { .. }));
}

#[test]
fn a_missing_file_fails_and_a_changed_one_begins_again() {
    let mut fetcher = Fetcher::new(Memory::new(2000), FetcherOptions::default());
    let (model, missing) = (fetcher.add("rock"), fetcher.add("none"));
    let mut now = Duration::ZERO;
    fetcher.want(&[want(model, 0.0, 1.0), want(missing, 0.0, 1.0)]);
    for _ in 0..4 {
        now += STEP;
        fetcher.update(now);
    }
    assert!(matches!(fetcher.state(missing), FetchState::Failed(FetchError::Status { status: 404, .. })));
    assert!(!fetcher.bytes(model).is_empty());
    // The model is made again, with other content.
    fetcher.transport_mut().files.insert("rock".to_owned(), Arc::new(creature().to_vec()));
    settle(&mut fetcher, &mut now, 10_000);
    assert!(fetcher.bytes(model) == creature(), "{:?}", fetcher.state(model));
}

#[test]
fn files_come_a_few_at_once_and_those_named_by_a_hash_are_checked() {
    let mut memory = Memory::new(1000);
    let content = |at: u8| vec![at; 3000];
    let named: Vec<String> = (0..20).map(|at| format!("objects/{}.png", sha256(&content(at)))).collect();
    for (at, name) in (0..).zip(&named) {
        memory.files.insert(name.clone(), Arc::new(content(at)));
    }
    let mut fetcher = Fetcher::new(memory, FetcherOptions::default());
    let keys: Vec<_> = named.iter().map(|name| fetcher.add_file(name)).collect();
    let mut now = Duration::ZERO;
    while !fetcher.is_settled() {
        now += STEP;
        fetcher.update(now);
        assert!(fetcher.transport_mut().running.len() <= 4);
    }
    assert!((0..).zip(&keys).all(|(at, key)| fetcher.file(*key) == Ok(Some(&content(at)[..]))));
    assert_eq!(fetcher.traffic().requests, 20);
    // A bit flips once: the file is asked for again. It always flips: that is an error.
    for (faults, requests) in [(1, 2), (9, 3)] {
        let mut memory = Memory::new(1000);
        memory.files.insert(named[0].clone(), Arc::new(content(0)));
        let mut left = faults;
        memory.fault = Some(Box::new(move |_, answer| match answer {
            Answer::Bytes(mut bytes) if left > 0 && bytes.len() == 1000 => {
                bytes[500] ^= 4;
                left -= 1;
                vec![Answer::Bytes(bytes)]
            }
            answer => vec![answer],
        }));
        let mut fetcher = Fetcher::new(memory, FetcherOptions::default());
        let [key, missing] = [&*named[0], "none"].map(|name| fetcher.add_file(name));
        settle(&mut fetcher, &mut now, 1000);
        match fetcher.file(key) {
            Ok(found) => assert!(faults == 1 && found == Some(&content(0)[..])),
            Err(error) => assert!(faults > 1 && error.to_string().contains("sha256 = "), "{error}"),
        }
        assert!(matches!(fetcher.file(missing), Err(FetchError::Status { status: 404, .. })));
        assert_eq!(fetcher.traffic().requests, requests + 1);
        assert_eq!(fetcher.transport_mut().running.len(), 0, "nothing runs on");
    }
}

/// Mutated answers: a model, or an error by name; no panic, no endless work. `RELIEVO_MUTATIONS` sets their number. Every
/// processor gets [`PART`] of them at a time.
#[test]
fn mutated_answers_give_a_model_or_an_error() {
    let count = std::env::var("RELIEVO_MUTATIONS").ok().and_then(|text| text.parse().ok()).unwrap_or(500);
    let threads = std::thread::available_parallelism().map_or(1, |threads| threads.get() as u64);
    let (part, failed) = (AtomicU64::new(0), AtomicU64::new(0));
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                loop {
                    let first = PART * part.fetch_add(1, Ordering::Relaxed);
                    if first >= count {
                        break;
                    }
                    failed.fetch_add(mutated(first, PART.min(count - first)), Ordering::Relaxed);
                    if first > 0 && first.is_multiple_of(100 * PART) {
                        println!("{first} of {count} answers");
                    }
                }
            });
        }
    });
    let failed = failed.into_inner();
    assert!(failed > count / 10, "{failed} of {count}");
}

/// Number of mutated answers that follow from one seed.
const PART: u64 = 100;

/// Fetches a model with mutated answers so many times. The number of times that it was not fetched.
fn mutated(seed: u64, count: u64) -> u64 {
    let mut random = Random(5 + seed);
    let mut failed = 0;
    let models = [("creature", creature()), ("pebble", pebble())]
        .map(|(name, bytes)| (name, Arc::new(bytes.to_vec())));
    for at in 0..count {
        // Mostly the small one, which is read in a hundredth of the time.
        let (name, bytes) = &models[usize::from(at % 20 > 0)];
        let piece = 1 + random.below(bytes.len() as u64 / 3) as usize;
        let mut memory = Memory::of(name, bytes.clone(), piece);
        let (kind, seed) = (random.below(6), random.below(u64::MAX));
        let mut own = Random(seed);
        memory.fault = Some(Box::new(move |_, answer| match (kind, answer) {
            (0, Answer::Head(head)) => vec![Answer::Head(Head { start: own.below(9) * 1000, ..head })],
            (1, Answer::Head(head)) => vec![Answer::Head(Head { total: Some(own.below(99_999)), ..head })],
            (2, Answer::Head(head)) => vec![Answer::Head(Head { status: own.below(600) as u16, ..head })],
            (3, Answer::Bytes(mut bytes)) => {
                for _ in 0..own.below(4) {
                    let at = own.below(bytes.len().max(1) as u64) as usize;
                    bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte = own.below(256) as u8);
                }
                vec![Answer::Bytes(bytes)]
            }
            (4, Answer::Bytes(bytes)) => {
                let cut = own.below(bytes.len() as u64 + 1) as usize;
                vec![Answer::Bytes(bytes[cut..].to_vec()), Answer::Bytes(bytes[..cut].to_vec())]
            }
            (5, Answer::Bytes(bytes)) => vec![Answer::Bytes([&bytes[..], &bytes[..]].concat()), Answer::End],
            (_, answer) => vec![answer],
        }));
        let mut fetcher = Fetcher::new(memory, FetcherOptions::default());
        let model = fetcher.add(name);
        fetcher.want(&[want(model, 0.0, 1.0)]);
        let mut now = Duration::ZERO;
        for _ in 0..200 {
            now += Duration::from_secs(1);
            fetcher.update(now);
            if fetcher.is_settled() {
                break;
            }
        }
        if let Some(found) = fetcher.model(model).expect("sound parts") {
            let levels = fetcher.header(model).expect("a header").levels.len();
            assert!(levels > 0 && !found.meshes.is_empty());
        }
        failed += u64::from(!matches!(fetcher.state(model), FetchState::Idle));
        assert!(bytes.starts_with(&fetcher.bytes(model)), "nothing damaged is kept");
    }
    failed
}
