//! Servers that share a cache, and a cache that is full.

use std::time::Duration;

use relievo_delivery::server::{ServeOptions, Site};
use relievo_delivery::sha256;

use super::host::{Host, built_ins, cook_on_three, creature, options, rock, runtime};

#[test]
fn two_servers_cook_a_model_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let glb = relievo_samples::model("rock").expect("built in").to_glb().expect("a file");
    std::fs::write(folder.path().join("rock.glb"), glb).expect("written");
    let open = || runtime().block_on(Site::open(options(folder.path()), built_ins())).expect("a site");
    assert_eq!(cook_on_three(&open).1, 1, "only one of them worked");
    let kept = std::fs::read(folder.path().join(".relievo/objects").join(format!("{}.rlv", sha256(rock()))));
    assert!(kept.expect("a package") == rock());
    assert_eq!(std::fs::read_dir(folder.path().join(".relievo/locks")).expect("a folder").count(), 0);
    // A damaged package is made again.
    let path = folder.path().join(".relievo/objects").join(format!("{}.rlv", sha256(rock())));
    std::fs::write(&path, &rock()[..1000]).expect("written");
    assert_eq!(cook_on_three(&open).1, 1);
    assert!(std::fs::read(&path).expect("a package") == rock());
}

#[test]
fn the_lock_of_a_server_that_is_gone_is_taken_over() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("rock.rlv"), rock()).expect("written");
    let open = || runtime().block_on(Site::open(options(folder.path()), built_ins())).expect("a site");
    let site = open();
    // The key is in the cache once the model was made.
    runtime().block_on(site.cook(&|_, _| {}));
    let cooked = std::fs::read_dir(folder.path().join(".relievo/cooked")).expect("a folder").next();
    let path = cooked.expect("one file").expect("readable").path();
    let key = path.file_stem().expect("a key").to_owned();
    std::fs::remove_file(&path).expect("removed");
    std::fs::write(folder.path().join(".relievo/locks").join(key), "somebody").expect("written");
    let begun = std::time::Instant::now();
    let site = open();
    assert!(runtime().block_on(site.cook(&|_, _| {})).is_empty());
    let waited = begun.elapsed();
    assert!(waited > Duration::from_secs(5) && waited < Duration::from_secs(60), "{waited:?}");
    assert!(path.is_file());
}

#[test]
fn a_full_cache_and_a_later_format_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("a.rlv"), rock()).expect("written");
    std::fs::write(folder.path().join("b.rlv"), creature()).expect("written");
    std::fs::write(folder.path().join("c.rlv"), later(rock())).expect("written");
    let quota = rock().len() as u64 + 10;
    let own = ServeOptions { cache_quota: quota, ..options(folder.path()) };
    let site = runtime().block_on(Site::open(own, built_ins())).expect("a site");
    let failed = runtime().block_on(site.cook(&|_, _| {}));
    let why: Vec<String> = failed.iter().map(|(name, error)| format!("{name}: {error}")).collect();
    assert_eq!(why.len(), 2, "{why:?}");
    assert!(why[0].starts_with("b: cacheQuota = "), "{why:?}");
    assert!(why[1].starts_with("c: c.rlv: package.version = 2: must be at most 1"), "{why:?}");
    let host = Host::of(site);
    assert_eq!(host.get("/models/a.rlv", &[]).status, 200);
    assert!(host.get("/models/b.rlv", &[]).error().contains("cacheQuota"));
    assert!(host.get("/models/c.rlv", &[]).error().contains("later version"));
    // Packages that are not used make room.
    std::fs::remove_file(folder.path().join("a.rlv")).expect("removed");
    let own = ServeOptions { cache_quota: quota, ..options(folder.path()) };
    let site = runtime().block_on(Site::open(own, built_ins())).expect("a site");
    assert_eq!(runtime().block_on(site.cook(&|_, _| {})).len(), 1);
}

/// The same package in a later version of the format.
fn later(package: &[u8]) -> Vec<u8> {
    let length = u32::from_le_bytes(package[4..8].try_into().expect("four bytes")) as usize;
    let header = String::from_utf8(package[40..40 + length].to_vec()).expect("JSON");
    let header = header.replacen("\"version\":1", "\"version\":2", 1);
    let sum: Vec<u8> = (0..64)
        .step_by(2)
        .map(|at| u8::from_str_radix(&sha256(header.as_bytes())[at..at + 2], 16).expect("a byte"))
        .collect();
    [&package[..8], &sum, header.as_bytes(), &package[40 + length..]].concat()
}
