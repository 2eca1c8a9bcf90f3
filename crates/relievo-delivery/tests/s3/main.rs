//! A server whose models and cache lie in an object store. `make test-s3` starts one (moto), and gives its address and credentials
//! in the usual variables of the environment.

#[path = "../delivery/host.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod host;
#[path = "../delivery/random.rs"]
mod random;
#[path = "../load/trials.rs"]
mod trials;

use relievo_delivery::server::{ServeOptions, Site};
use relievo_delivery::sha256;

use host::{Host, built_ins, cook_on_three, creature, rock, runtime};

/// What moto takes for the owner of everything: it checks no signature.
const OWNER: &str =
    "AWS4-HMAC-SHA256 Credential=test/20260101/us-east-1/s3/aws4_request, SignedHeaders=host, Signature=0";

/// A bucket of the store, written and read without relievo.
struct Bucket {
    url: String,
    name: String,
}

impl Bucket {
    fn new(name: &str) -> Self {
        let endpoint = std::env::var("AWS_ENDPOINT").expect("run `make test-s3`");
        let bucket = Self { url: format!("{endpoint}/{name}"), name: name.to_owned() };
        bucket.put("", b"");
        bucket
    }

    fn put(&self, path: &str, content: &[u8]) {
        let answer = ureq::put(format!("{}/{path}", self.url))
            .header("authorization", OWNER)
            .send(content)
            .expect("written");
        assert_eq!(answer.status().as_u16(), 200);
    }

    fn delete(&self, path: &str) {
        ureq::delete(format!("{}/{path}", self.url)).header("authorization", OWNER).call().expect("deleted");
    }

    fn get(&self, path: &str) -> Vec<u8> {
        let mut answer =
            ureq::get(format!("{}/{path}", self.url)).header("authorization", OWNER).call().expect("there");
        answer.body_mut().read_to_vec().expect("whole")
    }

    /// The keys that begin with `prefix`.
    fn keys(&self, prefix: &str) -> Vec<String> {
        let list = String::from_utf8(self.get(&format!("?list-type=2&prefix={prefix}"))).expect("text");
        let keys = list.split("<Key>").skip(1).filter_map(|part| part.split("</Key>").next());
        keys.map(str::to_owned).collect()
    }

    /// The models of the other tests, in the folder `models`.
    fn with_models(self) -> Self {
        let rock = relievo_samples::model("rock").expect("built in").to_glb().expect("a file");
        self.put("models/rock.glb", &rock);
        self.put("models/creature.rlv", creature());
        self.put("models/notes.txt", b"no model");
        self
    }

    fn options(&self) -> ServeOptions {
        ServeOptions {
            models: Some(format!("s3://{}/models", self.name)),
            listen: "127.0.0.1:0".to_owned(),
            ..ServeOptions::default()
        }
    }
}

#[test]
fn two_hundred_clients_get_every_level_twice() {
    let bucket = Bucket::new("clients").with_models();
    trials::two_hundred_clients(&Host::start(bucket.options()));
}

#[test]
fn a_thousand_malformed_requests_harm_nobody() {
    let mut limited = Bucket::new("malformed").with_models().options();
    limited.limits.header_seconds = 1.0;
    trials::malformed_requests(&Host::start(limited));
}

#[test]
fn servers_that_share_a_bucket_cook_a_model_once() {
    let bucket = Bucket::new("shared").with_models();
    let open = || runtime().block_on(Site::open(bucket.options(), built_ins())).expect("a site");
    let (catalog, worked) = cook_on_three(&open);
    assert_eq!(worked, 1, "only one of them worked");
    let path = format!("models/.relievo/objects/{}.rlv", sha256(rock()));
    assert!(bucket.get(&path) == rock());
    assert_eq!(bucket.keys("models/.relievo/locks"), [""; 0], "locks are removed");
    // A damaged package is made again, and a model that was exchanged becomes another package.
    bucket.put(&path, &rock()[..1000]);
    assert_eq!(cook_on_three(&open).1, 1);
    assert!(bucket.get(&path) == rock());
    let wall = relievo_samples::model("wall").expect("built in").to_glb().expect("a file");
    bucket.put("models/rock.glb", &wall);
    let (changed, worked) = cook_on_three(&open);
    assert!(worked == 1 && changed != catalog);
}

#[test]
fn the_lock_of_a_server_that_is_gone_is_taken_over() {
    let bucket = Bucket::new("locked").with_models();
    let cook = || {
        let site = runtime().block_on(Site::open(bucket.options(), built_ins())).expect("a site");
        assert!(runtime().block_on(site.cook(&|_, _| {})).is_empty());
    };
    cook();
    let cooked = bucket.keys("models/.relievo/cooked");
    let locks: Vec<String> =
        cooked.iter().map(|key| key.replace("cooked", "locks").replace(".json", "")).collect();
    cooked.iter().for_each(|key| bucket.delete(key));
    locks.iter().for_each(|key| bucket.put(key, b"somebody"));
    let begun = std::time::Instant::now();
    cook();
    let waited = begun.elapsed().as_secs_f64();
    assert!(waited > 5.0 && waited < 90.0, "{waited} s");
    assert_eq!(bucket.keys("models/.relievo/cooked"), cooked);
    assert_eq!(bucket.keys("models/.relievo/locks"), [""; 0]);
}

#[test]
fn objects_that_vanish_and_stores_that_are_away_are_told() {
    let bucket = Bucket::new("vanishing").with_models();
    // The creature is too large to be kept in memory, so every answer comes from the store.
    let mut options = bucket.options();
    options.limits.memory = 1 << 20;
    assert!(creature().len() > 1 << 16);
    let host = Host::start(options);
    let path = "/models/creature.rlv";
    let part = host.get(path, &[("range", "bytes=100-1099")]);
    assert_eq!((part.status, &part.body[..]), (206, &creature()[100..1100]));
    assert_eq!(sha256(&host.get(path, &[]).body), sha256(creature()));
    bucket.delete(&format!("models/.relievo/objects/{}.rlv", sha256(creature())));
    let gone = host.get(path, &[]);
    assert!(matches!(gone.status, 404 | 500 | 503), "{}", gone.status);
    assert_eq!(host.get("/models/rock.rlv", &[]).body, rock());
    let mut missing = bucket.options();
    missing.models = Some("s3://no-such-bucket/models".to_owned());
    let error = runtime().block_on(Site::open(missing, built_ins())).err().expect("refused").to_string();
    assert!(error.contains("no-such-bucket") || error.contains("NoSuchBucket"), "{error}");
}
