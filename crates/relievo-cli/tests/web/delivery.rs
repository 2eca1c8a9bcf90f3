//! A client in the browser gets the same bytes, levels and heights as a native one.

use std::sync::OnceLock;
use std::time::{Duration, Instant};

use relievo::asset::package::PackageHeader;
use relievo_delivery::client::HttpTransport;
use relievo_delivery::server::ServeOptions;
use relievo_delivery::sha256;

use crate::host::{Host, creature, models, options, rock, runtime};
use crate::received::fetched;
use crate::scene::said;

/// A server with two models, and terrain whose seed it chooses.
pub fn host() -> &'static Host {
    static HOST: OnceLock<(Host, tempfile::TempDir)> = OnceLock::new();
    let (host, _) = HOST.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder");
        let config = r#"{ "patchSize": 129, "scaleFactor": 14 }"#;
        std::fs::write(folder.path().join("config.json"), config).expect("written");
        let terrain = Some(folder.path().to_owned());
        (Host::start(ServeOptions { terrain, ..options(models()) }), folder)
    });
    host
}

#[test]
fn packages_differences_and_heights_are_the_same_natively_and_in_the_browser() {
    let begun = Instant::now();
    let pause = async || {
        std::thread::sleep(Duration::from_millis(1));
        begun.elapsed()
    };
    let lines = runtime().block_on(fetched(&host().base(), HttpTransport::new(), pause)).expect("fetched");
    let said = said();
    assert!(said["failed"].is_null(), "{}", said["failed"].as_str().unwrap_or_default());
    let delivered: Vec<&str> =
        said["delivered"].as_array().expect("lines").iter().filter_map(|line| line.as_str()).collect();
    assert_eq!(delivered, lines);
    for (name, bytes) in [("rock", rock()), ("creature", creature())] {
        assert!(lines.contains(&format!("{name} {}", sha256(bytes))), "{lines:?}");
        let levels = PackageHeader::read(bytes).expect("a header").0.levels.len();
        assert!(lines.contains(&format!("{name} {} differences", levels * (levels - 1) / 2)), "{lines:?}");
    }
    assert!(lines.iter().any(|line| line.starts_with("heights ") && line.len() > 70), "{lines:?}");
    assert!(lines.last().is_some_and(|line| line.contains("status 404")), "{lines:?}");
}
