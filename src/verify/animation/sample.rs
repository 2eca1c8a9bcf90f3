//! Parity of `kernels/animation/sample.wgsl`.

use super::{Draw, SIZES, random_crowd, random_instances};
use crate::Error;
use crate::animation::clip_set::ClipSet;
use crate::animation::crowd::{ClipBuffers, Crowd, Local, packed};
use crate::animation::place::{Instance, Place};
use crate::animation::sample::{ActivePairs, RotationPath, SAMPLE_BOUND, SamplePass};
use crate::gpu::Gpu;
use crate::reference::animation::place::places;
use crate::reference::animation::sample::sample_set;
use crate::verify::baseline::gather::evenly_keyed;
use crate::verify::poison::{POISON, Poisoned};
use crate::verify::{Cases, compare};

/// Every interpolation, at the twin's places: every pair, and lists of some pairs, of none and of all. Pairs that are
/// not listed stay untouched.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    for (case, [bones, count]) in SIZES.into_iter().enumerate() {
        let (_, set, instances) = random_crowd(case as u32, bones, count)?;
        add(cases, &format!("{bones} bones × {count}"), &set, &instances)?;
    }
    // Sets without splines have kernels of their own.
    let set = evenly_keyed(&mut Draw::new(1), 153, 60)?;
    add(cases, "153 bones × 40 without splines", &set, &random_instances(0, &set, 40))
}

fn add(cases: &mut Cases<'_>, name: &str, set: &ClipSet, instances: &[Instance]) -> Result<(), Error> {
    for path in [RotationPath::Slerp, RotationPath::Nlerp] {
        let bench = Bench::new(cases.gpu, set, instances, path)?;
        cases.add(format!("{name}, {path:?}, all"), bench.all()?);
        let pairs = (set.bones() * instances.len()) as u32;
        for (list, every) in [("none", u32::MAX), ("every third", 3), ("backwards", 1)] {
            let chosen: Vec<u32> = (0..pairs).rev().filter(|pair| (pair + 1) % every == 0).collect();
            cases.add(format!("{name}, {path:?}, {list}"), bench.some(&chosen)?);
        }
    }
    Ok(())
}

struct Bench<'a> {
    gpu: &'a Gpu,
    pass: SamplePass,
    clips: ClipBuffers,
    crowd: Crowd,
    output: Poisoned<Local>,
    expected: Vec<Local>,
}

impl<'a> Bench<'a> {
    fn new(gpu: &'a Gpu, set: &ClipSet, instances: &[Instance], path: RotationPath) -> Result<Self, Error> {
        let places: Vec<Place> = places(set, instances, 0.25);
        let mut crowd = Crowd::new(gpu, set, instances)?;
        crowd.places.write(gpu, &places)?;
        let output = Poisoned::new(gpu, crowd.pairs())?;
        crowd.locals = output.buffer.clone();
        let expected = sample_set(set, instances, &places, path).iter().map(packed).collect::<Vec<_>>();
        Ok(Self {
            gpu,
            pass: SamplePass::new(gpu, path)?,
            clips: ClipBuffers::new(gpu, set)?,
            crowd,
            output,
            expected,
        })
    }

    fn all(&self) -> Result<compare::Comparison, Error> {
        self.output.poison(self.gpu)?;
        let job = self.pass.prepare(self.gpu, &self.clips, &self.crowd)?;
        self.gpu.run("verify", |encoder| job.record(encoder))?;
        self.compare(|_| true)
    }

    fn some(&self, chosen: &[u32]) -> Result<compare::Comparison, Error> {
        self.output.poison(self.gpu)?;
        let active = ActivePairs::new(self.gpu, &self.crowd)?;
        active.write(self.gpu, chosen)?;
        let job = self.pass.prepare_active(self.gpu, &self.clips, &self.crowd, &active)?;
        self.gpu.run("verify", |encoder| job.record(encoder))?;
        let mut is_chosen = vec![false; self.expected.len()];
        chosen.iter().for_each(|pair| is_chosen[*pair as usize] = true);
        self.compare(|pair| is_chosen[pair])
    }

    fn compare(&self, is_written: impl Fn(usize) -> bool) -> Result<compare::Comparison, Error> {
        let poison = [[f32::from_bits(POISON); 4]; 3];
        let expected: Vec<Local> = (self.expected.iter().enumerate())
            .map(|(pair, local)| if is_written(pair) { *local } else { poison })
            .collect();
        let largest =
            self.expected.as_flattened().as_flattened().iter().fold(1.0, |a: f32, b| a.max(b.abs()));
        let comparison = self.output.check(self.gpu, |actual: &[Local]| {
            let flat = |locals: &[Local]| locals.as_flattened().as_flattened().to_vec();
            compare::absolute(&flat(actual), &flat(&expected), SAMPLE_BOUND * largest)
        });
        Ok(comparison?)
    }
}
