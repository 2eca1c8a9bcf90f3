//! Answers of a server, byte by byte.

use std::io::Read as _;

use relievo_delivery::catalog::{Catalog, ModelState};
use relievo_delivery::server::{Manifest, ServeOptions, Site, export};
use relievo_delivery::sha256;

use super::host::{Host, built_ins, models, options, rock, runtime};

#[test]
fn a_catalog_lists_models_with_their_levels() {
    let host = Host::start(options(models()));
    let answer = host.get("/catalog.json", &[]);
    let catalog: Catalog = serde_json::from_slice(&answer.body).expect("a catalog");
    let names: Vec<_> = catalog.models.iter().map(|model| &*model.name).collect();
    assert_eq!(names, ["creature", "rock"]);
    let own = &catalog.models[1];
    assert_eq!(
        (own.state.clone(), own.bytes, own.levels[0].triangles),
        (ModelState::Ready, rock().len() as u64, 6912)
    );
    assert!(
        own.levels.windows(2).all(|pair| pair[0].triangles > pair[1].triangles && pair[0].end > pair[1].end)
    );
    // The package is what `cook` makes in this process, under a path that contains its hash.
    let package = host.get(&format!("/{}", own.package), &[]);
    assert_eq!(own.package, format!("objects/{}.rlv", sha256(rock())));
    assert!(package.body == rock());
    assert_eq!(package.header("cache-control"), Some("public, max-age=31536000, immutable"));
    // By its name the same, but to be asked for each time.
    let named = host.get("/models/rock.rlv", &[]);
    assert!(named.body == rock());
    assert_eq!(named.header("cache-control"), Some("no-cache"));
    assert_eq!(named.header("etag"), package.header("etag"));
}

#[test]
fn ranges_and_conditions_are_those_of_http() {
    let host = Host::start(options(models()));
    let (whole, path) = (rock(), "/models/rock.rlv");
    let tag = format!("\"{}\"", sha256(whole));
    let length = whole.len();
    let part = |range: &str| host.get(path, &[("range", range)]);
    let cases = [
        ("bytes=0-9", 0..10),
        ("bytes=100-", 100..length),
        ("bytes=-7", length - 7..length),
        (&format!("bytes={}-{}", length - 1, length + 50), length - 1..length),
        ("bytes=0-0", 0..1),
    ];
    for (range, expected) in cases {
        let answer = part(range);
        assert_eq!(answer.status, 206, "{range}");
        assert!(answer.body == whole[expected.clone()], "{range}");
        let content = format!("bytes {}-{}/{length}", expected.start, expected.end - 1);
        assert_eq!(answer.header("content-range"), Some(&*content));
    }
    for range in [format!("bytes={length}-"), format!("bytes={}-", u64::MAX), "bytes=9-3".to_owned()] {
        let answer = part(&range);
        assert_eq!((answer.status, answer.body.len()), (416, 0), "{range}");
        assert_eq!(answer.header("content-range"), Some(&*format!("bytes */{length}")));
    }
    // What is no range of bytes, and several ranges, mean the whole file.
    for range in ["lines=1-2", "bytes=a-b", "bytes=0-1,5-6", "bytes=99999999999999999999999-"] {
        assert!(matches!(part(range).status, 200 | 416), "{range}: {}", part(range).status);
    }
    let get = |headers: &[(&str, &str)]| host.get(path, headers);
    assert_eq!(get(&[("if-none-match", &tag)]).status, 304);
    assert_eq!(get(&[("if-none-match", "*")]).status, 304);
    assert_eq!(get(&[("if-none-match", "\"other\"")]).status, 200);
    assert_eq!(get(&[("if-match", &tag), ("range", "bytes=5-6")]).status, 206);
    assert_eq!(get(&[("if-match", "\"other\""), ("range", "bytes=5-6")]).status, 412);
    assert_eq!(get(&[("if-range", &tag), ("range", "bytes=5-6")]).status, 206);
    assert_eq!(get(&[("if-range", "\"other\""), ("range", "bytes=5-6")]).status, 200);
    let head = host.ask("HEAD", path, &[]);
    assert_eq!((head.status, head.body.len()), (200, 0));
    assert_eq!(head.header("content-length"), Some(&*length.to_string()));
}

#[test]
fn text_is_compressed_and_packages_are_not() {
    let host = Host::start(options(models()));
    let plain = host.get("/models/rock/3.json", &[]);
    assert_eq!((plain.header("content-encoding"), plain.header("vary")), (None, Some("accept-encoding")));
    let sizes = ["gzip", "br", "zstd"].map(|name| {
        let answer = host.get("/models/rock/3.json", &[("accept-encoding", name)]);
        assert_eq!(answer.header("content-encoding"), Some(name));
        assert_ne!(answer.header("etag"), plain.header("etag"));
        let mut text = Vec::new();
        match name {
            "gzip" => {
                flate2::read::GzDecoder::new(&*answer.body).read_to_end(&mut text).expect("gzip");
            }
            "br" => {
                brotli::Decompressor::new(&*answer.body, 4096).read_to_end(&mut text).expect("brotli");
            }
            _ => text = zstd::bulk::decompress(&answer.body, 1 << 24).expect("zstd"),
        }
        assert!(text == plain.body, "{name}");
        answer.body.len()
    });
    assert!(sizes.iter().all(|size| size * 2 < plain.body.len()), "{sizes:?} of {}", plain.body.len());
    // A range is one of the plain file.
    let part = host.get("/models/rock/3.json", &[("accept-encoding", "br"), ("range", "bytes=0-99")]);
    assert!(part.header("content-encoding").is_none() && part.body == plain.body[..100]);
    let package = host.get("/models/rock.rlv", &[("accept-encoding", "br, gzip, zstd")]);
    assert!(package.header("content-encoding").is_none() && package.body == rock());
}

#[test]
fn mistakes_are_told() {
    let host = Host::start(ServeOptions { base: "/world/".to_owned(), ..options(models()) });
    let expect = |path: &str, status: u16, words: &str| {
        let answer = host.get(path, &[]);
        assert_eq!(answer.status, status, "{path}");
        assert!(answer.error().contains(words), "{path}: {}", answer.error());
    };
    expect("/catalog.json", 404, "everything is below /world/");
    expect("/world/models/none.rlv", 404, "no such model");
    expect("/world/models/rock/99.json", 404, "levels are 0 to ");
    expect("/world/models/rock/2-5.json", 404, "from a coarser one to a finer one");
    expect("/world/models/rock/x.json", 404, "FROM-TO.json");
    expect("/world/terrain/features/0,0.json", 404, "no terrain");
    expect("/world/%ff", 400, "UTF-8");
    assert_eq!(host.get("/world/health", &[]).json()["models"]["ready"], 2);
    let posted = host.ask("POST", "/world/catalog.json", &[("content-length", "0")]);
    assert_eq!((posted.status, posted.header("allow")), (405, Some("GET, HEAD")));
    assert!(host.get("/world/metrics", &[]).body.starts_with(b"# HELP relievo_"));
    // Nothing outside of what is served can be reached.
    for path in [
        "/world/../notes.txt",
        "/world/notes.txt",
        "/world/..%2f..%2fetc/passwd",
        "/world/models/..%2frock.glb",
        "/world/models/%2e%2e/%2e%2e/etc/passwd",
        "/world/objects/../cooked",
        "/world//etc/passwd",
        "/world/.relievo/seed",
        "/world/rock.glb",
    ] {
        assert_eq!(host.get(path, &[]).status, 404, "{path}");
    }
}

#[test]
fn a_token_is_needed_where_there_is_one() {
    let host = Host::start(ServeOptions { token: Some("open-sesame".to_owned()), ..options(models()) });
    let status = |value: &str| host.get("/catalog.json", &[("authorization", value)]).status;
    assert_eq!(host.get("/catalog.json", &[]).status, 401);
    assert_eq!(
        ["Bearer open-sesame", "Bearer wrong", "open-sesame", "Bearer "].map(status),
        [200, 401, 401, 401]
    );
    assert_eq!(host.get("/catalog.json", &[]).header("www-authenticate"), Some("Bearer"));
    assert_eq!(host.get("/health", &[]).status, 200);
    let error =
        relievo_delivery::client::get_catalog(&host.base(), Some("wrong")).expect_err("a wrong token");
    assert!(error.to_string().contains("401") && error.to_string().contains("Bearer"), "{error}");
    relievo_delivery::client::get_catalog(&host.base(), Some("open-sesame")).expect("the right token");
}

#[test]
fn pages_of_other_origins_may_read_what_they_are_allowed_to() {
    let origins = vec!["https://example.org".to_owned()];
    let host = Host::start(ServeOptions { origins, ..options(models()) });
    let of = |origin: &str| host.get("/catalog.json", &[("origin", origin)]);
    assert_eq!(of("https://example.org").header("access-control-allow-origin"), Some("https://example.org"));
    assert_eq!(of("https://other.org").header("access-control-allow-origin"), None);
    let asked = host.ask(
        "OPTIONS",
        "/models/rock.rlv",
        &[
            ("origin", "https://example.org"),
            ("access-control-request-method", "GET"),
            ("access-control-request-headers", "range,if-match,authorization"),
        ],
    );
    assert_eq!(asked.status, 200);
    assert!(asked.header("access-control-allow-headers").is_some_and(|headers| headers.contains("range")));
}

#[test]
fn an_export_holds_what_the_server_answers() {
    let site = runtime().block_on(Site::open(options(models()), built_ins())).expect("a site");
    runtime().block_on(site.cook(&|_, _| {}));
    let host = Host::of(site.clone());
    let folder = tempfile::tempdir().expect("a folder");
    let manifest = runtime().block_on(export(&site, folder.path(), &|_| {})).expect("exported");
    let text = std::fs::read(folder.path().join("manifest.json")).expect("a manifest");
    assert_eq!(serde_json::from_slice::<Manifest>(&text).expect("a manifest"), manifest);
    assert!(manifest.files.iter().any(|file| file.path == "models/rock/1-0.json"));
    for file in &manifest.files {
        let own = std::fs::read(folder.path().join(&file.path)).expect("a file");
        let answer = host.get(&format!("/{}", file.path), &[]);
        assert!(own == answer.body && sha256(&own) == file.sha256, "{}", file.path);
        assert_eq!(
            (own.len() as u64, &*file.media),
            (file.bytes, answer.header("content-type").expect("a type"))
        );
        for ending in &file.encodings {
            let path = folder.path().join(format!("{}.{ending}", file.path));
            assert!(std::fs::metadata(path).expect("a file").len() < file.bytes, "{}.{ending}", file.path);
        }
    }
}

#[test]
fn options_are_checked() {
    let refused = |options: ServeOptions| options.validate().expect_err("refused").to_string();
    assert!(refused(ServeOptions::default()).starts_with("models = none"));
    let own = options(models());
    assert!(refused(ServeOptions { base: "world".to_owned(), ..own.clone() }).starts_with("base = world"));
    assert!(refused(ServeOptions { token: Some(String::new()), ..own.clone() }).starts_with("token"));
    assert!(
        refused(ServeOptions { origins: vec!["example.org".to_owned()], ..own.clone() })
            .starts_with("origins[0]")
    );
    let mut limited = own;
    limited.limits.idle_seconds = 0.0;
    assert_eq!(refused(limited), "limits.idleSeconds = 0: must be in 0.1..=3600");
    let same = tempfile::tempdir().expect("a folder");
    for name in ["a.glb", "a.obj"] {
        std::fs::write(same.path().join(name), "").expect("written");
    }
    let twice = runtime().block_on(Site::open(options(same.path()), built_ins()));
    let error = twice.err().expect("two files of one name").to_string();
    assert!(error.contains("must have another name than"), "{error}");
}

/// A scene whose models are still being made into packages is no missing file.
#[test]
fn a_scene_is_prepared_before_it_is_served() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = |file: &str| {
        format!(
            r#"{{ "meshes": [{{ "file": "{file}", "instances": [{{ "at": [0, 0, 0] }}] }}],
                 "camera": {{ "at": [0, 1, 4], "look": [0, 0, 0] }} }}"#
        )
    };
    std::fs::write(folder.path().join("rock.rlv"), rock()).expect("written");
    std::fs::write(folder.path().join("broken.glb"), "no model").expect("written");
    std::fs::write(folder.path().join("good.json"), scene("rock.rlv")).expect("written");
    std::fs::write(folder.path().join("bad.json"), scene("broken.glb")).expect("written");
    let scenes = ["good.json", "bad.json"].map(|name| folder.path().join(name));
    let own = ServeOptions { scenes: scenes.to_vec(), models: None, ..options(folder.path()) };
    let site = runtime().block_on(Site::open(own, built_ins())).expect("a site");
    let host = Host::of(site.clone());
    let early = host.get("/scenes/good.json", &[]);
    assert_eq!((early.status, early.header("retry-after")), (503, Some("2")));
    assert_eq!(host.get("/scenes/none.json", &[]).status, 404);
    let failed = runtime().block_on(site.cook(&|_, _| {}));
    assert_eq!(failed.len(), 1);
    assert_eq!(host.get("/scenes/good.json", &[]).status, 200);
    let bad = host.get("/scenes/bad.json", &[]);
    assert!(bad.status == 500 && bad.error().contains("broken.glb"), "{} {}", bad.status, bad.error());
}

#[test]
fn a_model_that_cannot_be_used_is_told_and_the_others_are_served() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("broken.glb"), "no model").expect("written");
    std::fs::write(folder.path().join("rock.rlv"), rock()).expect("written");
    let site = runtime().block_on(Site::open(options(folder.path()), built_ins())).expect("a site");
    let host = Host::of(site.clone());
    let early = host.get("/models/rock.rlv", &[]);
    assert_eq!((early.status, early.header("retry-after")), (503, Some("2")));
    let failed = runtime().block_on(site.cook(&|_, _| {}));
    assert_eq!(failed.len(), 1);
    assert_eq!(failed[0].0, "broken");
    assert_eq!(host.get("/models/rock.rlv", &[]).status, 200);
    let broken = host.get("/models/broken.rlv", &[]);
    assert!(broken.status == 500 && broken.error().contains("broken.glb"), "{}", broken.error());
    assert_eq!(host.get("/health", &[]).json()["models"]["failed"], 1);
}
