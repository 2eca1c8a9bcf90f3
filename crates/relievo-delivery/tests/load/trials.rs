//! What a server must stand, whatever it reads its models from.

use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard};
use std::time::{Duration, Instant};

use peak_alloc::PeakAlloc;
use relievo::asset::package::PackageHeader;
use relievo_delivery::sha256;

use crate::host::{Host, creature, rock};
use crate::random::Random;

/// Counts what is allocated and not freed. What the process holds would say less: with hundreds of threads the C library
/// keeps freed memory in as many heaps.
#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// The allocator counts all threads, so one trial runs at a time.
fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// Every level of a model twice, as a range of bytes and as JSON. Returns the times of the requests.
fn fetch_all(base: &str, name: &str, whole: &[u8], ranges: &[Range<usize>]) -> Vec<Duration> {
    let agent: ureq::Agent = ureq::Agent::config_builder().http_status_as_error(false).build().into();
    let mut times = Vec::new();
    let mut ask = |path: &str, header: Option<(&str, String)>| {
        let begun = Instant::now();
        let call = agent.get(format!("{base}/{path}"));
        let call = header.into_iter().fold(call, |call, (name, value)| call.header(name, value));
        let mut answer = call.call().expect("an answer");
        let body = answer.body_mut().read_to_vec().expect("a body");
        times.push(begun.elapsed());
        (answer.status().as_u16(), body, answer.headers().get("etag").cloned())
    };
    for range in ranges {
        let wanted = ("range", format!("bytes={}-{}", range.start, range.end - 1));
        let (status, body, _) = ask(&format!("models/{name}.rlv"), Some(wanted));
        assert!(status == 206 && body == whole[range.clone()], "{name} {range:?}");
    }
    for level in 0..ranges.len() {
        let path = format!("models/{name}/{level}.json");
        let (status, first, tag) = ask(&path, None);
        assert_eq!(status, 200);
        let tag = tag.expect("a tag").to_str().expect("text").to_owned();
        let (status, second, _) = ask(&path, Some(("if-none-match", tag)));
        assert!(status == 304 && second.is_empty() && !first.is_empty());
    }
    times
}

/// Two hundred clients at once get every level twice, without an error, and without growth of memory over the second half.
pub fn two_hundred_clients(host: &Host) {
    const CLIENTS: usize = 200;
    let _alone = alone();
    let base = host.base();
    // Large enough from the beginning, since memory is measured.
    let (mut times, mut levels, mut grown) = (Vec::with_capacity(1 << 17), 0, Vec::new());
    // The second half must not need more memory than the first.
    for name in ["rock", "creature"].repeat(4) {
        let whole = if name == "rock" { rock() } else { creature() };
        let header = PackageHeader::read(whole).expect("a header").0;
        let others = header.levels[1..].iter().map(|level| level.chunk.range());
        let ranges: Vec<_> = std::iter::once(0..header.levels[0].chunk.end).chain(others).collect();
        if grown.len() < 2 {
            levels += ranges.len();
        }
        std::thread::scope(|scope| {
            let client = || fetch_all(&base, name, whole, &ranges);
            let clients: Vec<_> = (0..CLIENTS).map(|_| scope.spawn(client)).collect();
            times.extend(clients.into_iter().flat_map(|client| client.join().expect("no error")));
        });
        grown.push(MEMORY.current_usage());
    }
    times.sort();
    let [p50, p99] = [50, 99].map(|part| times[times.len() * part / 100]);
    println!("{} requests, p50 {p50:?}, p99 {p99:?}, memory {grown:?}", times.len());
    let growth = grown[7].saturating_sub(grown[3]);
    assert!(growth < 64 << 10, "{growth} bytes in the second half");
    let metrics = String::from_utf8(host.get("/metrics", &[]).body).expect("text");
    let made = metrics.lines().find(|line| line.starts_with("relievo_mesh_misses_total")).expect("a counter");
    assert_eq!(made, format!("relievo_mesh_misses_total {levels}"), "each level is made once");
}

/// A thousand malformed requests, each of which gets a clear status. The server's limit for a head must be 1 s.
pub fn malformed_requests(host: &Host) {
    let _alone = alone();
    let mut random = Random(6);
    let odd = [
        "/../../etc/passwd",
        "/models/../../rock.glb",
        "/%00",
        "/models/rock/-1.json",
        "/models/rock/1e9.json",
        "/models/rock/99999999999999999999.json",
        "/objects/",
        "//",
        "/models//0.json",
        "/terrain/features/a,b.json",
        "/models/rock/0-0.json",
        "/\u{fffd}",
        "/models/%2e%2e%2f",
        "/catalog.json/..",
        "/scenes/../catalog.json?x=%zz",
    ];
    let ranges = [
        "bytes=-",
        "bytes=5",
        "bytes=-0",
        "bytes=1-0",
        "bytes=0-1,2-3,4-",
        "octets=0-1",
        "bytes=\u{7f}",
        "bytes=-99999999999999",
    ];
    let methods = ["POST", "PUT", "DELETE", "PATCH", "TRACE", "BREW", "get", "CONNECT"];
    let mut slow = Vec::new();
    for at in 0..1000 {
        let pick =
            |list: &[&'static str], random: &mut Random| list[random.below(list.len() as u64) as usize];
        let answer = match at % 5 {
            0 => host.get(pick(&odd, &mut random), &[]),
            1 => host.get("/models/rock.rlv", &[("range", pick(&ranges, &mut random))]),
            2 => host.ask(
                pick(&methods, &mut random),
                pick(&["/catalog.json", "/models/rock.rlv"], &mut random),
                &[],
            ),
            3 => {
                let long = "x".repeat(1 << (8 + random.below(10)));
                host.get("/catalog.json", &[("x-long", &long)])
            }
            _ if at % 100 == 4 => {
                // Senders that stop in the middle of a head.
                let mut stream = TcpStream::connect(host.address).expect("a connection");
                stream.write_all(b"GET /catalog.json HTTP/1.1\r\nhost: ").expect("sent");
                slow.push(stream);
                continue;
            }
            _ => {
                let noise: Vec<u8> = (0..random.below(300)).map(|_| random.below(256) as u8).collect();
                host.send(&[&noise[..], b"\r\n\r\n"].concat())
            }
        };
        // A clear status, or for noise a closed connection.
        let clear = matches!(answer.status, 200 | 206 | 400 | 404 | 405 | 414 | 416 | 431);
        assert!(clear || answer.status == 0 && at % 5 == 4, "request {at}: {}", answer.status);
        assert!(!String::from_utf8_lossy(&answer.body).contains("root:"), "request {at}");
        if at % 50 == 0 {
            assert_eq!(host.get("/health", &[]).status, 200, "after request {at}");
        }
    }
    for mut stream in slow {
        stream.set_read_timeout(Some(Duration::from_secs(20))).expect("a timeout");
        let mut rest = Vec::new();
        let ended = stream.read_to_end(&mut rest);
        assert!(ended.is_ok(), "the server closes what is too slow: {ended:?}");
    }
    let whole = host.get("/models/rock.rlv", &[]);
    assert_eq!(sha256(&whole.body), sha256(rock()));
}
