//! Parity of `kernels/animation/place.wgsl`.

use super::edges::{ELAPSED, edges};
use super::{SIZES, random_crowd};
use crate::Error;
use crate::animation::crowd::{ClipBuffers, Crowd};
use crate::animation::place::{PLACE_BOUND, Place, PlacePass};
use crate::reference::animation::place::places;
use crate::verify::poison::{POISON, Poisoned};
use crate::verify::{Cases, compare};

/// Every kind of timeline, loops, clamps, reverse play, clips without length, at the start and later. Room for
/// timelines that a clip lacks stays untouched.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = PlacePass::new(gpu)?;
    for (case, [bones, count]) in SIZES.into_iter().enumerate() {
        let (_, set, instances) = random_crowd(case as u32, bones, count)?;
        let clips = ClipBuffers::new(gpu, &set)?;
        for elapsed in [0.0, 1.375, -3.0] {
            let mut crowd = Crowd::new(gpu, &set, &instances)?;
            let output = Poisoned::<Place>::new(gpu, crowd.places.len())?;
            crowd.places = output.buffer.clone();
            let job = pass.prepare(gpu, &clips, &crowd)?;
            job.set(gpu, elapsed)?;
            gpu.run("verify", |encoder| job.record(encoder))?;
            let expected = places(&set, &instances, elapsed);
            let room = set.timelines_a_clip();
            let is_used =
                |at: usize| at % room < set.clips()[instances[at / room].clip as usize].timelines as usize;
            let comparison = output.check(gpu, |actual| {
                let poison = Place { key: POISON, fraction: f32::from_bits(POISON) };
                // Untouched rooms compare as −1.
                let phase = |place: &Place| match place.key == poison.key {
                    true if place.fraction.to_bits() == POISON => -1.0,
                    _ => place.key as f32 + place.fraction,
                };
                let expected: Vec<f32> = (expected.iter().enumerate())
                    .map(|(at, place)| if is_used(at) { phase(place) } else { -1.0 })
                    .collect();
                let actual: Vec<f32> = actual.iter().map(phase).collect();
                compare::absolute(&actual, &expected, PLACE_BOUND)
            })?;
            cases.add(format!("{bones} bones × {count} after {elapsed} s"), comparison);
        }
    }
    at_edges(cases, &pass)
}

/// Places that are known without a twin.
fn at_edges(cases: &mut Cases<'_>, pass: &PlacePass) -> Result<(), Error> {
    let (gpu, edges) = (cases.gpu, edges()?);
    let (clips, crowd) = (ClipBuffers::new(gpu, &edges.set)?, Crowd::new(gpu, &edges.set, &edges.instances)?);
    let job = pass.prepare(gpu, &clips, &crowd)?;
    job.set(gpu, ELAPSED)?;
    gpu.run("verify", |encoder| job.record(encoder))?;
    let found = crowd.places.read_blocking(gpu)?;
    let phase = |place: &Place| place.key as f32 + place.fraction;
    let (mut actual, mut expected) = (Vec::new(), Vec::new());
    for (found, known) in found.chunks(edges.set.timelines_a_clip()).zip(edges.places()) {
        actual.extend(found[..known.len()].iter().map(phase));
        expected.extend(known.iter().map(phase));
    }
    cases.add("edges", compare::absolute(&actual, &expected, PLACE_BOUND));
    Ok(())
}
