//! Parity and benchmark cases of `kernels/animation/bounds.wgsl`.

use relievo::Error;
use relievo::asset::keyframe::RotationPath;
use relievo::asset::transform::Affine;
use relievo::gpu::Buffer;
use relievo::ops::animation::bounds::reference::bounds;
use relievo::ops::animation::bounds::{BOUNDS_BOUND, BoundsPass, MotionBounds, bone_radii};
use relievo::ops::animation::crowd::Crowd;
use relievo::ops::animation::keyframe_cursor::reference::cursors;
use relievo::ops::animation::local_to_model::reference::local_to_model;
use relievo::ops::animation::sample::reference::sample_set;

use crate::cases::animation::scene::{CROWDS, Scene};
use crate::cases::animation::{Draw, SIZES, random_crowd};
use crate::cases::measure;
use crate::harness::poison::Poisoned;
use crate::harness::{Bench, Cases, compare};

/// The cases cover matrices of every size, sheared, singular and mirrored, around the model's origin and far
/// from it. Sides are compared relative to the instance's largest, and the exact box, in double precision, must
/// lie inside.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    for (case, [bones, count]) in SIZES.into_iter().enumerate() {
        let (_, set, instances) = random_crowd(case as u32, bones, count)?;
        let (model_matrices, bone_radii) = random_poses(case as u32, bones, count);
        let crowd = Crowd::new(gpu, &set, &instances)?;
        crowd.model_matrices.buffer().write(gpu, &model_matrices)?;
        let expected = bounds(&model_matrices, &bone_radii);
        let output = Poisoned::<MotionBounds>::new(gpu, count)?;
        let job = BoundsPass::new(gpu)?.prepare(gpu, &crowd, &bone_radii, &output.buffer)?;
        gpu.submit("verify", |encoder| job.record(encoder))?;
        let name = format!("{bones} bones × {count}");
        let sides = |boxes: &[MotionBounds]| relative_sizes(boxes, &expected);
        let near =
            |actual: &[MotionBounds]| compare::absolute(&sides(actual), &sides(&expected), BOUNDS_BOUND);
        cases.check(name.clone(), &output, near).await?;
        let holds = |actual: &[MotionBounds]| {
            let inside = contain(actual, &model_matrices, &bone_radii);
            compare::exact(&inside, &vec![true; inside.len()])
        };
        cases.check(format!("{name}, the exact box inside"), &output, holds).await?;
    }
    Ok(())
}

/// Matrices with rows of very different lengths, some of them 0.
fn random_poses(case: u32, bones: usize, count: usize) -> (Vec<Affine>, Vec<f32>) {
    let mut draw = Draw::new(case ^ 0xb0c5);
    let bone_radii = (0..bones).map(|bone| if bone % 5 == 3 { 0.0 } else { draw.signed().abs() }).collect();
    let mut model_matrices = Vec::with_capacity(bones * count);
    for _ in 0..count {
        let size = [1.0, 1e-6, 3e4][draw.word() as usize % 3];
        let away = [0.0, 1.0, 1e3][draw.word() as usize % 3] * size;
        model_matrices.extend((0..bones).map(|_| {
            [0; 3].map(|_| {
                let long = size * [0.0, 1e-3, 1.0, 1.0][draw.word() as usize % 4];
                let [x, y, z] = [0; 3].map(|_| draw.signed() * long);
                [x, y, z, away + draw.signed() * size]
            })
        }));
    }
    (model_matrices, bone_radii)
}

/// The sides divided by the largest side of the expected box.
fn relative_sizes(boxes: &[MotionBounds], expected: &[MotionBounds]) -> Vec<f32> {
    let each = |(found, expected): (&MotionBounds, &MotionBounds)| {
        let sides = |bounds: &MotionBounds| [bounds.low, bounds.high].concat();
        let largest = sides(expected).into_iter().fold(f32::MIN_POSITIVE, |a, b| a.max(b.abs()));
        sides(found).into_iter().map(move |side| side / largest)
    };
    boxes.iter().zip(expected).flat_map(each).collect()
}

/// For each side of each instance, whether every bone's ellipsoid is inside.
fn contain(boxes: &[MotionBounds], model_matrices: &[Affine], bone_radii: &[f32]) -> Vec<bool> {
    let mut inside = Vec::with_capacity(6 * boxes.len());
    for (bounds, model_matrices) in boxes.iter().zip(model_matrices.chunks(bone_radii.len())) {
        for axis in 0..3 {
            let (low, high) = (f64::from(bounds.low[axis]), f64::from(bounds.high[axis]));
            let ends = model_matrices.iter().zip(bone_radii).map(|(model, bone_radius)| {
                let [x, y, z, center] = model[axis].map(f64::from);
                let half = f64::from(*bone_radius) * (x * x + y * y + z * z).sqrt();
                [center - half, center + half]
            });
            inside.push(ends.clone().all(|[least, _]| low <= least));
            inside.push(ends.clone().all(|[_, largest]| high >= largest));
        }
    }
    inside
}

/// Measures all instances, from their model matrices.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = BoundsPass::new(gpu)?;
    for count in CROWDS {
        let scene = Scene::new(gpu, count)?;
        let found = cursors(&scene.set, &scene.instances, 0.4);
        let locals = sample_set(&scene.set, &scene.instances, &found, RotationPath::Slerp);
        let bones = scene.skeleton.len();
        let model_matrices: Vec<_> =
            locals.chunks(bones).flat_map(|locals| local_to_model(&scene.skeleton, locals)).collect();
        scene.crowd.model_matrices.buffer().write(gpu, &model_matrices)?;
        let bone_radii = bone_radii(&scene.skeleton);
        let job = pass.prepare(gpu, &scene.crowd, &bone_radii, &Buffer::new(gpu, "bounds", count)?)?;
        // The kernel reads the model matrices and writes 8 words per instance.
        let words = 12 * scene.pairs() + 8 * count;
        let name = format!("{count} × 153");
        measure(bench, name, count, "instance", words, &|encoder| job.record(encoder), || {
            bounds(&model_matrices, &bone_radii)
        })?;
    }
    Ok(())
}
