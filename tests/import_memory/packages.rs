//! Packages with damaged and hostile bytes: each is refused by name or read, within memory in proportion to its bytes.

use std::ops::ControlFlow;
use std::sync::LazyLock;

use relievo::asset::package::PackageHeader;
use relievo::asset::{Model, MorphTarget, morph::MorphDelta};
use relievo::ops::skinning::cook;
use sha2::{Digest as _, Sha256};

use super::{MEMORY, alone};

/// Bytes that every package may take, and those for each of its bytes.
const ANY: usize = 64 << 20;
const A_BYTE: usize = 100;

fn cooked(model: &Model) -> Vec<u8> {
    cook(&model.clone().into(), &mut |_| ControlFlow::Continue(())).expect("cooked").expect("not broken off")
}

/// The package of the creature.
static CREATURE: LazyLock<Vec<u8>> = LazyLock::new(|| cooked(&relievo_samples::creature().expect("valid")));

/// Number of damaged and hostile files. `RELIEVO_MUTATIONS=1000000` tries more.
const MUTATIONS: usize = 75_000;

/// `count` times the factor by which `RELIEVO_MUTATIONS` exceeds [`MUTATIONS`].
fn scaled(count: usize) -> usize {
    let wanted = std::env::var("RELIEVO_MUTATIONS").ok();
    count * wanted.map_or(MUTATIONS, |wanted| wanted.parse().expect("a number")) / MUTATIONS
}

/// Reads a package and its images, within its memory.
fn read(bytes: &[u8]) -> Result<Model, relievo::InputError> {
    let before = MEMORY.current_usage();
    MEMORY.reset_peak_usage();
    let outcome = Model::from_rlv(bytes).and_then(|model| {
        model.images.iter().try_for_each(|image| image.texels().map(|_| ()))?;
        Ok(model)
    });
    let peak = MEMORY.peak_usage().saturating_sub(before);
    assert!(peak <= ANY + A_BYTE * bytes.len(), "{peak} bytes for {}: {:?}", bytes.len(), outcome.err());
    outcome
}

fn sealed(json: &[u8], rest: &[u8]) -> Vec<u8> {
    let length = (json.len() as u32).to_le_bytes();
    [b"RLV\n", &length[..], Sha256::digest(json).as_slice(), json, rest].concat()
}

/// Numbers from a seed (SplitMix64).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ mixed >> 31) % count as u64) as usize
    }

    /// Changes bytes at some places, cuts the end off, or moves a part.
    fn mutate(&mut self, bytes: &mut Vec<u8>) {
        match self.below(8) {
            0 => bytes.truncate(self.below(bytes.len())),
            1 => {
                let [from, to] = [0; 2].map(|_| self.below(bytes.len()));
                let length = self.below(bytes.len() - from.max(to)).min(64);
                bytes.copy_within(from..from + length, to);
            }
            2 => bytes.insert(self.below(bytes.len()), self.below(256) as u8),
            kind => {
                for _ in 0..1 << (kind - 3) {
                    let at = self.below(bytes.len());
                    bytes[at] ^= 1 << self.below(8);
                }
            }
        }
    }
}

/// A package of a few hundred bytes with everything that a package can have.
fn small() -> Vec<u8> {
    let mut model = relievo_samples::wall().expect("valid");
    model.images = vec![image::RgbaImage::from_pixel(2, 2, image::Rgba([1, 2, 3, 255])).into()];
    let mesh = &mut model.meshes[0];
    let delta = MorphDelta { position: [0.5, 0.0, 0.0], ..MorphDelta::default() };
    mesh.targets = vec![MorphTarget { vertices: vec![1, 3], deltas: vec![delta; 2] }];
    mesh.weights = vec![0.5];
    mesh.second_uv = vec![[0.25, 0.5]; mesh.vertices()];
    mesh.colors = vec![[0.5, 1.0, 0.0, 1.0]; mesh.vertices()];
    cooked(&model)
}

/// Damaged files: the sums of the header tell. A change that changes nothing is no damage.
#[test]
fn damaged_packages_are_refused_by_name() {
    let _alone = alone();
    let whole = small();
    let levels = PackageHeader::read(&whole).expect("a header").0.levels;
    let mut numbers = Numbers(1);
    for _ in 0..scaled(25_000) {
        let mut bytes = whole.clone();
        numbers.mutate(&mut bytes);
        // What ends with a level is a model with this level.
        let is_level = levels.iter().any(|level| level.chunk.end == bytes.len()) && whole.starts_with(&bytes);
        if bytes == whole || is_level {
            continue;
        }
        let error = read(&bytes).expect_err("refused");
        let is_named = error.path.starts_with("package.") || bytes.len() < 4;
        assert!(is_named, "{error}");
    }
}

/// Hostile files: the sums fit the damaged bytes, so that the decoder sees them. It may find a valid model in them.
#[test]
fn hostile_packages_do_no_harm() {
    let _alone = alone();
    let mut refused = 0;
    let rock = cooked(&relievo_samples::rock().expect("valid"));
    for (whole, count) in [(&small(), 50_000), (&rock, 150), (&CREATURE, 50)] {
        let (header, first) = PackageHeader::read(whole).expect("a header");
        let mut numbers = Numbers(2);
        for _ in 0..scaled(count) {
            let mut header = header.clone();
            let mut rest = Vec::new();
            let damaged = numbers.below(1 + header.levels.len() + header.images.len());
            let levels = header.levels.iter_mut().map(|level| &mut level.chunk);
            let chunks = std::iter::once(&mut header.model).chain(levels).chain(&mut header.images);
            for (at, chunk) in chunks.enumerate() {
                let mut own = whole[chunk.range()].to_vec();
                if at == damaged && !own.is_empty() {
                    numbers.mutate(&mut own);
                }
                (chunk.start, chunk.end) = (rest.len(), rest.len() + own.len());
                chunk.sha256 = Sha256::digest(&own).iter().map(|byte| format!("{byte:02x}")).collect();
                rest.extend(own);
            }
            if numbers.below(4) == 0 {
                let level = numbers.below(header.levels.len());
                header.levels[level].vertices = numbers.below(1 << 17);
                header.levels[level].triangles = numbers.below(1 << 17);
            }
            let bytes = placed(header, first, &rest);
            refused += usize::from(read(&bytes).is_err());
        }
    }
    assert!(refused > scaled(25_000), "{refused}");
}

/// A package of a header whose chunks begin at 0, and its chunks.
fn placed(mut header: PackageHeader, mut first: usize, rest: &[u8]) -> Vec<u8> {
    let mut before = 0;
    loop {
        let levels = header.levels.iter_mut().map(|level| &mut level.chunk);
        for chunk in std::iter::once(&mut header.model).chain(levels).chain(&mut header.images) {
            (chunk.start, chunk.end) = (chunk.start - before + first, chunk.end - before + first);
        }
        let json = serde_json::to_vec(&header).expect("JSON");
        if json.len() + 40 == first {
            return sealed(&json, rest);
        }
        (before, first) = (first, json.len() + 40);
    }
}

/// Levels of zeros or noise whose header claims as much as it may.
#[test]
fn claims_allocate_in_proportion() {
    let _alone = alone();
    let whole = &CREATURE;
    let (header, first) = PackageHeader::read(whole).expect("a header");
    let mut numbers = Numbers(3);
    for length in [0, 10, 1000, 100_000] {
        for is_noise in [false, true] {
            let mut own = header.clone();
            let mut rest = whole[own.model.range()].to_vec();
            (own.model.start, own.model.end) = (0, rest.len());
            for level in &mut own.levels {
                let chunk: Vec<u8> =
                    (0..length).map(|_| if is_noise { numbers.below(256) as u8 } else { 0 }).collect();
                (level.chunk.start, level.chunk.end) = (rest.len(), rest.len() + length);
                level.chunk.sha256 =
                    Sha256::digest(&chunk).iter().map(|byte| format!("{byte:02x}")).collect();
                (level.vertices, level.triangles) = (1 << 17, 1 << 18);
                rest.extend(chunk);
            }
            assert!(read(&placed(own, first, &rest)).is_err());
        }
    }
}

/// Processor time of all threads of the program so far, in seconds.
#[cfg(unix)]
fn processor_seconds() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// Reading a package takes milliseconds, and a small fraction of the time to make it.
#[cfg(unix)]
#[test]
fn packages_are_read_in_milliseconds() {
    let _alone = alone();
    let source = relievo_samples::creature().expect("valid");
    let started = processor_seconds();
    let whole = cooked(&source);
    let cooked = processor_seconds() - started;
    let read = (0..5).map(|_| {
        let started = processor_seconds();
        Model::from_rlv(&whole).expect("read");
        processor_seconds() - started
    });
    let read = read.fold(f64::INFINITY, f64::min);
    assert!(read < 0.05 && 50.0 * read < cooked, "{read} s to read, {cooked} s to cook");
}
