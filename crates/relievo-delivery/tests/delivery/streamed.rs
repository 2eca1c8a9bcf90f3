//! A scene whose objects appear as they arrive.

use std::path::Path;
use std::time::{Duration, Instant};

use relievo::gpu::Gpu;
use relievo::image::RgbaImage;
use relievo::render::{Layer, Offscreen, Renderer};
use relievo::scene::{Camera, Depth, View};
use relievo_delivery::client::{FetchState, FetcherOptions, HttpTransport, StreamedScene};
use relievo_delivery::server::ServeOptions;
use relievo_samples::Samples;
use relievo_scene_file::{SceneFile, World};

use super::host::Host;

const SIZE: [u32; 2] = [160, 96];
const SKY: [f32; 3] = [0.4, 0.6, 0.8];

const SCENE: &str = r#"{
    "terrain": { "config": { "patchSize": 33, "scaleFactor": 3, "seed": "stream" } },
    "meshes": [
        { "file": "rock.glb", "instances": [{ "on": [14, 14], "scale": 2 }, { "on": [22, 16], "scale": 2.5 }] },
        { "file": "builtin:wall", "instances": [{ "on": [18, 10] }] }
    ],
    "characters": [{ "file": "builtin:creature", "clip": "walk", "instances": [{ "on": [17, 20], "scale": 2 }] }],
    "quality": { "pixels": 0.02 },
    "camera": { "at": [17, 9, 33], "look": [17, 3, 12] }
}"#;

/// A server of the scene, and the folder of its files.
fn host() -> (Host, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder");
    let rock = relievo_samples::model("rock").expect("built in").to_glb().expect("a file");
    std::fs::write(folder.path().join("rock.glb"), rock).expect("written");
    let path = folder.path().join("walk.json");
    std::fs::write(&path, SCENE).expect("written");
    let options =
        ServeOptions { scenes: vec![path], listen: "127.0.0.1:0".to_owned(), ..ServeOptions::default() };
    (Host::start(options), folder)
}

struct Player {
    streamed: StreamedScene<HttpTransport>,
    world: World,
    view: View,
    renderer: Renderer,
    target: Offscreen,
    begun: Instant,
}

impl Player {
    fn new(gpu: &Gpu, url: &str, rate: Option<u64>) -> Self {
        let begun = Instant::now();
        let mut transport = HttpTransport::new();
        transport.set_rate(rate);
        let mut streamed = StreamedScene::open(url, transport, FetcherOptions::default());
        let world = loop {
            if let Some(loaded) = streamed.begin(begun.elapsed(), &Samples).expect("a scene") {
                break loaded.build(gpu).expect("built");
            }
            std::thread::sleep(Duration::from_millis(2));
        };
        let mut view = world.scene.view(world.quality).expect("a view");
        view.set(world.camera.camera(0.0, SIZE, Depth::Forward)).expect("a camera");
        let target = Offscreen::new(gpu, SIZE).expect("a target");
        let renderer = Renderer::new(gpu, target.format()).expect("compiled");
        let mut player = Self { streamed, world, view, renderer, target, begun };
        player.renderer.prepare(&player.world.scene).expect("compiled");
        player
    }

    /// Takes in what has arrived. Whether something has.
    fn update(&mut self) -> bool {
        let now = self.begun.elapsed();
        let has_changed = self.streamed.update(&mut self.world, &[&self.view], now).expect("no error");
        if has_changed {
            self.renderer.prepare(&self.world.scene).expect("compiled");
        }
        has_changed
    }

    fn shot(&mut self) -> RgbaImage {
        let gpu = self.world.scene.gpu().clone();
        let mut encoder = gpu.encoder("frame");
        self.world.scene.record(&mut encoder, &mut [&mut self.view]).expect("recorded");
        let (renderer, scene, view) = (&self.renderer, &self.world.scene, &self.view);
        self.target
            .record(&mut encoder, SKY, |pass| renderer.draw(pass, scene, view, Layer::Color))
            .expect("drawn");
        gpu.queue().submit([encoder.finish()]);
        self.target.read(&gpu).expect("a picture")
    }

    fn look(&mut self, from: [f32; 3], to: [f32; 3]) {
        let camera = Camera::looking_at(from.into(), to.into(), 0.8, [0.1, 1000.0], SIZE);
        self.view.set(camera).expect("a camera");
    }

    /// Updates until nothing is missing, and draws until all of it is in use.
    fn settle(&mut self) {
        while !self.streamed.is_settled() {
            self.update();
            std::thread::sleep(Duration::from_millis(2));
        }
        self.update();
        while self.world.scene.is_refining() {
            self.shot();
        }
    }
}

/// The picture of the served scene, read as a whole.
fn whole_picture(gpu: &Gpu, host: &Host) -> RgbaImage {
    let text = String::from_utf8(host.get("/scenes/walk.json", &[]).body).expect("text");
    let read = |path: &Path| {
        let name = path.to_string_lossy().replace("../", "/");
        Ok(host.get(&name, &[]).body)
    };
    let loaded = SceneFile::from_json(&text).expect("a scene").load(&read, &Samples).expect("loaded");
    let mut world = loaded.build(gpu).expect("built");
    let target = Offscreen::new(gpu, SIZE).expect("a target");
    let camera = world.camera.camera(0.0, SIZE, Depth::Forward);
    target.draw(&mut world.scene, camera, SKY).expect("drawn");
    target.read(gpu).expect("a picture")
}

#[test]
fn objects_appear_and_become_finer_until_the_picture_is_that_of_the_whole_scene() {
    let gpu = relievo_testing::gpu();
    let (host, _folder) = host();
    let expected = whole_picture(&gpu, &host);
    let url = format!("{}/scenes/walk.json", host.base());
    let mut player = Player::new(&gpu, &url, None);
    let mut pictures = vec![player.shot()];
    while !player.streamed.is_settled() {
        if player.update() {
            pictures.push(player.shot());
        }
    }
    player.settle();
    pictures.push(player.shot());
    assert!(pictures.last() == Some(&expected), "not the picture of the whole scene");
    pictures.dedup();
    assert!(pictures.len() >= 4, "{} pictures", pictures.len());
    assert_eq!(player.world.objects.len(), 4);
}

#[test]
fn a_coarse_picture_comes_first_on_slow_connections() {
    let gpu = relievo_testing::gpu();
    let (host, _folder) = host();
    // Thesis B's two connections.
    for (name, rate) in [("15.91 Mbit/s", 15_910_000 / 8), ("2 Mbit/s", 2_000_000 / 8)] {
        let mut player = Player::new(&gpu, &format!("{}/scenes/walk.json", host.base()), Some(rate));
        let mut first = None;
        while !player.streamed.is_settled() {
            player.update();
            let is_whole = player.world.objects.len() == 4;
            if first.is_none() && is_whole {
                first = Some((player.begun.elapsed(), player.streamed.fetcher().traffic().received));
            }
            std::thread::sleep(Duration::from_millis(1));
        }
        let (time, bytes) = (player.begun.elapsed(), player.streamed.fetcher().traffic().received);
        let (first_time, first_bytes) = first.expect("all objects");
        println!(
            "{name}: all objects after {first_time:?} and {first_bytes} bytes; all that is needed after {time:?} and {bytes} bytes"
        );
        assert!(first_bytes * 2 < bytes, "{first_bytes} of {bytes}");
        let least = bytes as f64 / rate as f64;
        assert!(time.as_secs_f64() > 0.9 * least - 0.1, "faster than the connection: {time:?}, {least} s");
    }
}

#[test]
fn a_server_that_dies_and_returns_is_found_again() {
    let gpu = relievo_testing::gpu();
    let (host, folder) = host();
    let mut player = Player::new(&gpu, &format!("{}/scenes/walk.json", host.base()), None);
    // While nothing is seen, everything is there coarsely.
    player.look([17.0, 9.0, 33.0], [17.0, 9.0, 99.0]);
    player.settle();
    assert_eq!(player.world.objects.len(), 4);
    player.view.set(player.world.camera.camera(0.0, SIZE, Depth::Forward)).expect("a camera");
    let before = player.shot();
    let address = host.address;
    drop(host);
    let dead = Instant::now();
    // The rock and the creature; all of the wall was there already.
    let waiting = |player: &Player| {
        let states = player.streamed.packages().map(|(_, key)| player.streamed.fetcher().state(key));
        states.filter(|state| matches!(state, FetchState::Waiting { .. })).count()
    };
    while waiting(&player) < 2 {
        assert!(dead.elapsed() < Duration::from_secs(20), "nothing was noticed");
        let began = Instant::now();
        player.update();
        assert!(began.elapsed() < Duration::from_millis(500), "an update waited");
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(player.shot() == before, "what is there is drawn");
    let options = ServeOptions {
        scenes: vec![folder.path().join("walk.json")],
        listen: address.to_string(),
        ..ServeOptions::default()
    };
    let host = Host::start(options);
    player.settle();
    assert!(player.shot() == whole_picture(&gpu, &host));
}

#[test]
fn when_the_connection_becomes_slow_the_walk_goes_on_with_what_is_there() {
    let gpu = relievo_testing::gpu();
    let (host, _folder) = host();
    let mut player = Player::new(&gpu, &format!("{}/scenes/walk.json", host.base()), Some(500_000));
    while player.world.objects.len() < 4 {
        player.update();
    }
    player.streamed.fetcher_mut().transport_mut().set_rate(Some(50_000 / 8));
    let mut longest = Duration::ZERO;
    for frame in 0..40 {
        // Past the objects, away from them, and back.
        let angle = frame as f32 * 0.16;
        player.look([17.0, 6.0, 27.0], [17.0 + 20.0 * angle.sin(), 3.0, 27.0 - 20.0 * angle.cos()]);
        let began = Instant::now();
        player.update();
        longest = longest.max(began.elapsed());
        player.shot();
    }
    println!("longest update {longest:?}, {:?}", player.streamed.fetcher().traffic());
    assert!(longest < Duration::from_secs(2), "frozen for {longest:?}");
    assert!(player.streamed.fetcher().traffic().cancelled > 0, "what left the view was not broken off");
    // What is there is right: with the connection back, the picture is that of the whole scene.
    player.view.set(player.world.camera.camera(0.0, SIZE, Depth::Forward)).expect("a camera");
    player.streamed.fetcher_mut().transport_mut().set_rate(None);
    player.settle();
    assert!(player.shot() == whole_picture(&gpu, &host));
}
