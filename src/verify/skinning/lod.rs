//! Parity of `kernels/skinning/lod.wgsl`.

use glam::{Mat4, Vec3, camera};

use crate::Error;
use crate::animation::transform::Affine;
use crate::gpu::Buffer;
use crate::reference::skinning::lod::{Seen, lod, seen};
use crate::skinning::lod::{LodPass, LodView, standing};
use crate::skinning::weights::Reduction;
use crate::verify::animation::Draw;
use crate::verify::compare::Comparison;
use crate::verify::poison::Poisoned;
use crate::verify::{Cases, compare};

/// How near to a decision rounding may decide otherwise: places are within 200 of the origin, and their sums carry some
/// 20ε of that.
const TOUCH: f32 = 3e-4;

/// Instances everywhere around several cameras; nobody in sight, and all. Those at the very edge of the view and of a
/// step of the fade are left out, and counted.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = LodPass::new(gpu)?;
    for (case, count) in (0..).zip([1, 63, 64, 65, 1000]) {
        let mut draw = Draw::new(case ^ 0x10d);
        let mut place = |_| {
            let at = [0; 3].map(|_| 100.0 * draw.signed());
            standing(
                Vec3::from(at) * Vec3::new(1.0, 0.1, 1.0),
                3.0 * draw.signed(),
                1.0 + 0.5 * draw.signed(),
            )
        };
        let placements: Vec<Affine> = (0..count).map(&mut place).collect();
        for (name, towards) in [("south", Vec3::Z), ("aside", Vec3::new(1.0, -0.2, 0.3)), ("up", Vec3::Y)] {
            let view = view(towards);
            let buffer = Buffer::from_slice(gpu, "placements", &placements)?;
            let (reductions, drawn) =
                (Poisoned::<Reduction>::new(gpu, count)?, Poisoned::<u32>::new(gpu, count)?);
            let arguments = Buffer::from_slice(gpu, "arguments", &[7, 99, 0, 0, 0])?;
            let job = pass.prepare(gpu, &view, &buffer, &reductions.buffer, &drawn.buffer, &arguments)?;
            // Twice: the number of instances begins anew.
            gpu.run("verify", |encoder| (0..2).for_each(|_| job.record(encoder)))?;
            let number = arguments.read_blocking(gpu)?;
            let guard = drawn.check(gpu, |_| compare::exact(&[0], &[0]))?;
            let list = drawn.buffer.read_blocking(gpu)?;
            let comparison = reductions
                .check(gpu, |reductions| compared(&view, &placements, reductions, &list, &number))?;
            cases.add(format!("{count} instances, {name}"), if guard.holds { comparison } else { guard });
        }
    }
    Ok(())
}

fn view(towards: Vec3) -> LodView {
    let eye = Vec3::new(3.0, 2.0, -20.0);
    let up = if towards == Vec3::Y { Vec3::X } else { Vec3::Y };
    let look = camera::rh::view::look_at_mat4(eye, eye + towards, up);
    let clip_from_world: Mat4 = camera::rh::proj::directx::perspective(0.9, 1.5, 0.1, 90.0) * look;
    LodView {
        clip_from_world,
        eye,
        near: 10.0,
        far: 70.0,
        steps: 16,
        most: 5,
        center: Vec3::new(0.0, 0.9, 0.1),
        radius: 1.2,
    }
}

/// For each instance whether it is listed, its fade, and its most influences.
fn compared(
    view: &LodView,
    placements: &[Affine],
    reductions: &[Reduction],
    list: &[u32],
    number: &[u32],
) -> Comparison {
    let listed = &list[..(number[1] as usize).min(placements.len())];
    let (mut actual, mut expected, mut touching) = (Vec::new(), Vec::new(), 0_usize);
    for (instance, placement) in placements.iter().enumerate() {
        let Seen { depth, way } = seen(view, placement);
        let step = way * view.steps as f32;
        let at_step = way > 0.0 && way < 1.0 && (step - step.round()).abs() < TOUCH;
        if depth.abs() < TOUCH || at_step {
            touching += 1;
            continue;
        }
        let times = listed.iter().filter(|drawn| **drawn == instance as u32).count();
        let (found, wanted) = (reductions[instance], lod(view, placement));
        actual.extend([times as f32, found.fade, found.most as f32]);
        expected.extend([f32::from(wanted.most > 0), wanted.fade, wanted.most as f32]);
    }
    if touching * 20 > placements.len() + 20 || number[0] != 7 {
        return Comparison::failed(
            placements.len(),
            format!("{touching} too near to tell, arguments {number:?}"),
        );
    }
    // One instance may touch and go.
    if expected.is_empty() { compare::exact(&[0], &[0]) } else { compare::absolute(&actual, &expected, 1e-6) }
}
