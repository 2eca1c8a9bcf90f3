//! What a million clients cost: serves a folder of models on this machine, measures bytes and requests, and computes the rest.
//!
//! cargo run --release -p relievo-delivery --features server --example cost -- MODELS

use std::io::{Read as _, Write as _};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

use relievo_delivery::catalog::{Catalog, ModelState};
use relievo_delivery::server::{ServeOptions, Server, Site};

/// Clients that the table is for, and the time within which they come.
const CLIENTS: f64 = 1e6;
const HOURS: f64 = 24.0;

/// Connections that ask at once, and how long each kind of request is measured.
const CONNECTIONS: usize = 16;
const MEASURED: Duration = Duration::from_secs(4);

/// Largest error of what a client fetches, as a fraction of the coarsest level's: most objects are seen from afar.
const NEAR: f32 = 0.02;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let models = std::env::args().nth(1).ok_or("which folder of models?")?;
    let options =
        ServeOptions { models: Some(models), listen: "127.0.0.1:0".to_owned(), ..ServeOptions::default() };
    let runtime = tokio::runtime::Runtime::new()?;
    let site = runtime.block_on(Site::open(options, Box::new(relievo_samples::Samples)))?;
    for (name, error) in runtime.block_on(site.cook(&|_, _| ())) {
        eprintln!("{name}: {error}");
    }
    let server = runtime.block_on(Server::bind(&site))?;
    let address = server.address()?;
    runtime.spawn(server.run(std::future::pending()));
    let catalog = site.catalog();
    let ready: Vec<_> = catalog.models.iter().filter(|model| model.state == ModelState::Ready).collect();
    let (mut first, mut near, mut all) = (0, 0, 0);
    println!(
        "| model | first picture, bytes | to 2 % of the coarsest level's error | all levels and images |\n|---|---|---|---|"
    );
    for model in &ready {
        let coarsest = model.levels.last().ok_or("a level")?;
        let enough = model.levels.iter().rev().find(|level| level.error <= NEAR * coarsest.error);
        let enough = enough.or(model.levels.first()).ok_or("a level")?;
        println!("| {} | {} | {} | {} |", model.name, coarsest.end, enough.end, model.bytes);
        (first, near, all) = (first + coarsest.end, near + enough.end, all + model.bytes);
    }
    println!("| all | {first} | {near} | {all} |\n");
    let rates = measured(address, &catalog)?;
    println!("| request | per second |\n|---|---|");
    rates.iter().for_each(|rate| println!("| {} | {:.0} |", rate.name, rate.a_second));
    let bytes_a_second = rates[0].a_second * rates[0].bytes;
    let requests = ready.iter().map(|model| 2.0 + 0.5 * model.levels.len() as f64).sum::<f64>();
    println!("\nA client of all models fetches {near} bytes in about {requests:.0} requests.\n");
    println!(
        "| {CLIENTS:.0} clients in {HOURS:.0} hours | bytes | mean rate | servers like this one |\n|---|---|---|---|"
    );
    let line = |name: &str, share: f64| {
        let bytes = share * CLIENTS * near as f64;
        let rate = bytes / (HOURS * 3600.0);
        let servers =
            (rate / bytes_a_second).max(share * CLIENTS * requests / (HOURS * 3600.0) / rates[0].a_second);
        println!("| {name} | {:.0} GB | {:.0} Mbit/s | {:.2} |", bytes / 1e9, rate * 8.0 / 1e6, servers);
    };
    line("no cache between", 1.0);
    line("a network that answers 99 % from its caches", 0.01);
    // Objects never change: a network fetches each once for each of its places.
    let places = 100.0;
    println!(
        "| a network of {places:.0} places that keeps objects | {:.2} GB | | |",
        places * all as f64 / 1e9
    );
    Ok(())
}

/// How often a kind of request is answered.
struct Rate {
    name: &'static str,
    a_second: f64,
    /// Mean bytes of an answer.
    bytes: f64,
}

/// Rates of ranges of packages, of meshes as JSON that are in memory, and of what has not changed.
fn measured(address: SocketAddr, catalog: &Catalog) -> Result<Vec<Rate>, Box<dyn std::error::Error>> {
    let (mut ranges, mut meshes, mut same) = (Vec::new(), Vec::new(), Vec::new());
    for model in catalog.models.iter().filter(|model| model.state == ModelState::Ready) {
        for pair in model.levels.windows(2).take(8) {
            let range = format!("range: bytes={}-{}\r\n", pair[1].end, pair[0].end - 1);
            ranges.push(format!("GET /{} HTTP/1.1\r\nhost: localhost\r\n{range}\r\n", model.package));
        }
        let mesh = format!(
            "GET /models/{}/{}.json HTTP/1.1\r\nhost: localhost\r\n",
            model.name,
            model.levels.len() / 2
        );
        meshes.push(format!("{mesh}accept-encoding: br\r\n\r\n"));
        same.push(format!("GET /{} HTTP/1.1\r\nhost: localhost\r\nif-none-match: *\r\n\r\n", model.package));
    }
    let kinds = [
        ("a level as a range of bytes", ranges),
        ("a level as JSON, in memory", meshes),
        ("a package that has not changed", same),
    ];
    kinds
        .into_iter()
        .map(|(name, requests)| {
            let answers = std::thread::scope(|scope| {
                let ask = || ask(address, &requests);
                let all: Vec<_> = (0..CONNECTIONS).map(|_| scope.spawn(ask)).collect();
                all.into_iter().map(|one| one.join().unwrap_or(Ok((0, 0)))).collect::<Result<Vec<_>, _>>()
            })?;
            let (count, bytes) = answers.into_iter().fold((0, 0), |sum, own| (sum.0 + own.0, sum.1 + own.1));
            let a_second = count as f64 / MEASURED.as_secs_f64();
            Ok(Rate { name, a_second, bytes: bytes as f64 / (count as f64).max(1.0) })
        })
        .collect()
}

/// Asks one request after the other on one connection. Returns the number of answers and of their bytes.
fn ask(address: SocketAddr, requests: &[String]) -> Result<(u64, u64), std::io::Error> {
    let mut stream = TcpStream::connect(address)?;
    stream.set_nodelay(true)?;
    let (begun, mut sums, mut buffer) = (Instant::now(), (0, 0), vec![0; 1 << 16]);
    for request in requests.iter().cycle() {
        if begun.elapsed() >= MEASURED {
            break;
        }
        stream.write_all(request.as_bytes())?;
        let (mut head, mut read, mut wanted) = (Vec::new(), 0_u64, None);
        while wanted.is_none_or(|wanted| read < wanted) {
            let count = stream.read(&mut buffer)?;
            if count == 0 {
                return Err(std::io::ErrorKind::UnexpectedEof.into());
            }
            read += count as u64;
            if wanted.is_none() {
                head.extend_from_slice(&buffer[..count]);
                let end = head.windows(4).position(|four| four == b"\r\n\r\n");
                wanted = end.map(|end| {
                    let text = String::from_utf8_lossy(&head[..end]).to_ascii_lowercase();
                    let length = text
                        .lines()
                        .find_map(|line| line.strip_prefix("content-length: ")?.parse::<u64>().ok());
                    let length = if text.starts_with("http/1.1 304") { 0 } else { length.unwrap_or(0) };
                    end as u64 + 4 + length
                });
            }
        }
        sums = (sums.0 + 1, sums.1 + read);
    }
    Ok(sums)
}
