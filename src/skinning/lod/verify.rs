//! Parity of `kernels/skinning/lod.wgsl`.

use glam::{Mat4, Vec3, camera};

use crate::Error;
use crate::animation::verify::Draw;
use crate::asset::transform::Affine;
use crate::gpu::Buffer;
use crate::harness::compare::Comparison;
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Cases, compare};
use crate::skinning::lod::reference::{Seen, lod, may_mirror, seen};
use crate::skinning::lod::{LevelRanges, LodPass, LodView, list_stride, list_words, standing};
use crate::skinning::reduction::Reduction;

/// Of a level: indices, instances and the first index of two draws, before the decision.
const ARGUMENTS: [u32; 10] = [7, 99, 3, 0, 0, 7, 98, 3, 0, 0];

/// How near to a decision rounding may decide otherwise: places are within 200 of the origin, and their sums carry some
/// 20ε of that.
const TOUCH: f32 = 3e-4;

/// Where cameras look, and where levels begin. The second is a mirror image.
const DIRECTIONS: [(&str, Vec3, &[f32]); 4] = [
    ("south", Vec3::Z, &[]),
    (MIRROR, Vec3::new(1.0, -0.2, 0.3), &[40.0]),
    ("up", Vec3::Y, &[-1.0, 9.0, 20.0]),
    (
        "back",
        Vec3::new(0.1, 0.0, -1.0),
        &[0.0, 10.0, 20.0, 25.0, 30.0, 30.0, 35.0, 40.0, 45.0, 50.0, 60.0, 70.0, 80.0, 90.0, f32::MAX],
    ),
];

const MIRROR: &str = "aside, mirrored";

/// Instances everywhere around several cameras, every third mirrored; nobody in sight, and all; without levels, with one more, and with as many
/// as there may be, some of them empty. Those at the very edge of the view, of a step of the fade and of a level are left
/// out, and counted. What is not listed stays as it was.
///
/// # Errors
/// What the device reports.
pub fn cases(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = LodPass::new(gpu)?;
    for (case, count) in (0..).zip([1, 63, 64, 65, 1000]) {
        let mut draw = Draw::new(case ^ 0x10d);
        let mut place = |instance| {
            let at = [0; 3].map(|_| 100.0 * draw.signed());
            let [x, y, z] = standing(
                Vec3::from(at) * Vec3::new(1.0, 0.1, 1.0),
                3.0 * draw.signed(),
                1.0 + 0.5 * draw.signed(),
            );
            // Above the ground, as in water.
            [x, if instance % 3 == 1 { [-y[0], -y[1], -y[2], y[3]] } else { y }, z]
        };
        let placements: Vec<Affine> = (0..count).map(&mut place).collect();
        for (name, towards, levels) in DIRECTIONS {
            let mut view = LodView { levels: LevelRanges::new(levels)?, ..view(towards) };
            if name == MIRROR {
                view.clip_from_world = Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0)) * view.clip_from_world;
            }
            let levels = 1 + levels.len();
            let buffer = Buffer::from_slice(gpu, "placements", &placements)?;
            let (reductions, drawn) =
                (Poisoned::<Reduction>::new(gpu, count)?, Poisoned::new(gpu, list_words(count, levels))?);
            let arguments = Buffer::from_slice(gpu, "arguments", &ARGUMENTS.repeat(levels))?;
            let job = pass.prepare(gpu, &view, &buffer, &reductions.buffer, &drawn.buffer, &arguments)?;
            // Twice: the number of instances begins anew.
            gpu.run("verify", |encoder| (0..2).for_each(|_| job.record(encoder)))?;
            let arguments = arguments.read_blocking(gpu)?;
            let (mut lists, mut found) = (Vec::new(), Vec::new());
            let kept = drawn.check(gpu, |drawn| split(drawn, &arguments, count, &mut lists))?;
            let mirrored = mirrored(&view, &placements, &arguments, &lists);
            let guard = reductions.check(gpu, |reductions| {
                found = reductions.to_vec();
                compare::exact(&[0], &[0])
            })?;
            cases.add(format!("{count} instances, {name}: the lists' ends"), kept);
            cases.add(format!("{count} instances, {name}: the reductions' end"), guard);
            cases.add(format!("{count} instances, {name}: the last mirrored one"), mirrored);
            cases.add(format!("{count} instances, {name}"), compared(&view, &placements, &found, &lists));
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
        levels: LevelRanges::NONE,
    }
}

/// The lists of all levels, as long as the arguments say. What is behind each is still poison, and the arguments' other
/// words are as they were.
fn split(drawn: &[u32], arguments: &[u32], count: usize, lists: &mut Vec<Vec<u32>>) -> Comparison {
    let stride = if arguments.len() == 10 { count } else { list_stride(count) };
    let mut behind = Vec::new();
    for (list, arguments) in drawn.chunks(stride).zip(arguments.chunks(10)) {
        let (listed, rest) = list.split_at((arguments[1] as usize).min(list.len()));
        lists.push(listed.to_vec());
        behind.extend(rest.iter().map(|word| word ^ POISON));
        let kept = [0, 2, 3, 4, 5, 7, 8, 9];
        behind.extend(kept.map(|at: usize| arguments[at] ^ ARGUMENTS[at]));
    }
    compare::exact(&behind, &vec![0; behind.len()])
}

/// How many of each list have all of those that are mirrored.
fn mirrored(view: &LodView, placements: &[Affine], arguments: &[u32], lists: &[Vec<u32>]) -> Comparison {
    let is_mirrored = |drawn: &u32| may_mirror(view, &placements[*drawn as usize]);
    let last = |list: &Vec<u32>| list.iter().rposition(is_mirrored).map_or(0, |place| place as u32 + 1);
    let found: Vec<u32> = arguments.chunks(10).map(|arguments| arguments[6]).collect();
    compare::exact(&found, &lists.iter().map(last).collect::<Vec<_>>())
}

/// For each instance how often it is listed, and how often for its level; its fade, most influences and level.
fn compared(
    view: &LodView,
    placements: &[Affine],
    reductions: &[Reduction],
    lists: &[Vec<u32>],
) -> Comparison {
    let (mut actual, mut expected, mut touching) = (Vec::new(), Vec::new(), 0_usize);
    for (instance, placement) in placements.iter().enumerate() {
        let Seen { depth, away, way } = seen(view, placement);
        let step = way * view.steps as f32;
        let at_step = way > 0.0 && way < 1.0 && (step - step.round()).abs() < TOUCH;
        // z²/d moves with z twice as far, and with d as far.
        let at_level = view.levels.distances().iter().any(|begin| (away - begin).abs() < 3.0 * TOUCH);
        // Who is out of view has neither.
        if depth.abs() < TOUCH || depth > 0.0 && (at_step || at_level) {
            touching += 1;
            continue;
        }
        let (found, wanted) = (reductions[instance], lod(view, placement));
        let times = |list: &Vec<u32>| list.iter().filter(|drawn| **drawn == instance as u32).count();
        let all: usize = lists.iter().map(times).sum();
        let own = times(&lists[wanted.level as usize]);
        let is_seen = f32::from(wanted.most > 0);
        actual.extend([all as f32, own as f32, found.fade, found.most as f32, found.level as f32]);
        expected.extend([is_seen, is_seen, wanted.fade, wanted.most as f32, wanted.level as f32]);
    }
    if touching * 20 > placements.len() + 20 {
        return Comparison::failed(placements.len(), format!("{touching} too near to tell"));
    }
    // One instance may touch and go.
    if expected.is_empty() { compare::exact(&[0], &[0]) } else { compare::absolute(&actual, &expected, 1e-6) }
}
