//! Downloads that are broken off and resumed, and answers that are not what they should be.

use relievo::asset::package::PackageHeader;
use relievo_delivery::client::{Download, FetchError, PackageStream};
use relievo_delivery::sha256;

use super::host::{Host, creature, models, options, rock};
use super::random::Random;

#[test]
fn a_download_broken_off_a_thousand_times_is_identical_and_nothing_is_fetched_twice() {
    let host = Host::start(options(models()));
    let whole = creature();
    let mut random = Random(1);
    let mut breaks = 0;
    while breaks < 1000 {
        let mut kept = Vec::new();
        let mut received = 0;
        loop {
            let mut download = Download::new(format!("{}/models/creature.rlv", host.base()));
            download.hash = Some(sha256(whole));
            download.resume("kept".as_ref(), &kept).expect("a beginning");
            let stop = kept.len() as u64 + random.below(whole.len() as u64 / 8);
            let mut ended = false;
            let before = download.stream.len();
            download
                .run(0, &mut |stream| {
                    ended = stream.len() > stop;
                    !ended
                })
                .expect("fetched");
            received += download.stream.len() - before;
            kept = download.stream.beginning();
            if ended {
                breaks += 1;
                // A program may end in the middle of a chunk, and of a write.
                let lost = random.below(3) * random.below(100);
                received -= lost.min(kept.len() as u64);
                kept.truncate(kept.len().saturating_sub(lost as usize));
            } else {
                break;
            }
        }
        assert!(kept == whole);
        assert_eq!(received, whole.len() as u64);
    }
}

#[test]
fn only_what_is_missing_is_asked_for() {
    let host = Host::start(options(models()));
    let url = format!("{}/models/rock.rlv", host.base());
    let fetch = |kept: &[u8], level: usize| {
        let mut download = Download::new(&url);
        download.resume("kept".as_ref(), kept).expect("a beginning");
        // A catalog tells where the level ends.
        let header = PackageHeader::read(rock()).expect("a header").0;
        download.stream.expect_first(header.levels[header.levels.len() - 1 - level].chunk.end as u64);
        download.run(level, &mut |_| true).expect("fetched");
        download.stream
    };
    let coarse = fetch(&[], 9);
    assert_eq!((coarse.level(), coarse.len()), (Some(9), coarse.complete().len() as u64));
    let finer = fetch(&coarse.complete(), 4);
    assert_eq!(finer.level(), Some(4));
    assert!(finer.complete() == rock()[..finer.complete().len()]);
    // A level that is there takes no request: the address need not even exist.
    let mut nothing = Download::new("http://127.0.0.1:9/none");
    nothing.resume("kept".as_ref(), &finer.complete()).expect("a beginning");
    nothing.run(4, &mut |_| true).expect("nothing to fetch");
    let error = nothing.run(99, &mut |_| true).expect_err("no such level");
    assert!(error.to_string().contains("level = 99"), "{error}");
}

#[test]
fn another_package_under_the_same_name_is_refused() {
    let host = Host::start(options(models()));
    let mut download = Download::new(format!("{}/models/rock.rlv", host.base()));
    download.hash = Some(sha256(creature()));
    let error = download.run(0, &mut |_| true).expect_err("another package");
    assert!(matches!(error, FetchError::Status { status: 412, .. }), "{error}");
    // The beginning of one package cannot go on with another one.
    let mut mixed = Download::new(format!("{}/models/rock.rlv", host.base()));
    mixed.resume("kept".as_ref(), &creature()[..20_000]).expect("a beginning");
    let error = mixed.run(0, &mut |_| true).expect_err("another package");
    assert!(error.to_string().contains("SHA-256"), "{error}");
    let mut missing = Download::new(format!("{}/models/none.rlv", host.base()));
    let error = missing.run(0, &mut |_| true).expect_err("no such model").to_string();
    assert!(error.contains("404") && error.contains("catalog.json lists the models"), "{error}");
}

#[test]
fn streams_accept_any_pieces_and_refuse_damaged_ones() {
    let whole = creature();
    let mut random = Random(2);
    for _ in 0..20 {
        let mut stream = PackageStream::new();
        let mut damaged = 0;
        while (stream.len() as usize) < whole.len() {
            let range = stream.missing(0).or_else(|| stream.missing_images()).expect("something is missing");
            let start = range.start as usize;
            let end = (start + 1 + random.below(9000) as usize).min(range.end as usize).min(whole.len());
            let mut piece = whole[start..end].to_vec();
            if random.below(8) == 0 {
                let at = random.below(piece.len() as u64) as usize;
                piece[at] ^= 1 << random.below(8);
            }
            let levels = stream.levels();
            if stream.push(range.start, &piece).is_err() {
                damaged += 1;
                assert!(stream.levels() >= levels, "what was complete stays");
            }
        }
        assert!(stream.beginning() == whole && stream.complete() == whole);
        assert!(damaged > 0);
    }
    for (bytes, words) in [
        (&b"no package at all, but long enough to be one in principle"[..], "package.magic"),
        (b"RLV\n\xff\xff\xff\xff and so on", "package"),
    ] {
        let error = PackageStream::resumed(bytes).expect_err("no package").to_string();
        assert!(error.contains(words), "{error}");
    }
    let mut stream = PackageStream::resumed(&whole[..5000]).expect("a beginning");
    let error = stream.push(77, &whole[77..99]).expect_err("not what comes next").to_string();
    assert!(error.contains("package.start = 77"), "{error}");
}
