//! Parity and benchmark cases of `kernels/skinning/lod.wgsl`.

use glam::{Mat4, Vec3, camera};
use relievo::Error;
use relievo::asset::transform::Affine;
use relievo::gpu::Buffer;
use relievo::skinning::instance_lod::{FadeRange, InstanceLod};
use relievo::skinning::lod::reference::{Seen, lod, may_mirror, seen};
use relievo::skinning::lod::{LevelRanges, LodBuffers, LodPass, LodView, list_stride, list_words, placed};

use crate::cases::animation::Draw;
use crate::cases::terrain::copy_of;
use crate::harness::compare::{Comparison, LeftOut};
use crate::harness::poison::{POISON, Poisoned};
use crate::harness::{Backend, Bench, Cases, Contender, compare};

/// The arguments of a level before the decision: indices, instances and first index of two draws.
const ARGUMENTS: [u32; 10] = [7, 99, 3, 0, 0, 7, 98, 3, 0, 0];

/// The largest error of a fade: it is the quotient of a whole number of steps and their total, at most 1,
/// within 2.5 ULP.
const FADE_BOUND: f32 = 3e-7;

/// The distance from a threshold within which rounding may decide either way: positions are within 200 of the
/// origin, and their sums carry some 20ε of that.
const TOUCH: f32 = 3e-4;

/// The directions of cameras, and the distances of levels. The second camera mirrors.
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

/// The cases cover instances everywhere around several cameras, with every third one mirrored; views that see
/// no instance, and all of them; no levels, one more, and as many as there may be, some of them empty. For
/// instances at the very edge of the view, of a fade step or of a level, the decision is left out of the
/// comparison and counted. Memory beyond the lists must stay untouched.
///
/// # Errors
/// What the device reports.
pub(crate) async fn parity(cases: &mut Cases<'_>) -> Result<(), Error> {
    let gpu = cases.gpu;
    let pass = LodPass::new(gpu)?;
    for (case, count) in (0..).zip([1, 63, 64, 65, 1000]) {
        let mut draw = Draw::new(case ^ 0x10d);
        let mut placement = |instance| {
            let at = [0; 3].map(|_| 100.0 * draw.signed());
            let [x, y, z] = placed(
                Vec3::from(at) * Vec3::new(1.0, 0.1, 1.0),
                3.0 * draw.signed(),
                1.0 + 0.5 * draw.signed(),
            );
            // Mirrored at the ground, as in water.
            [x, if instance % 3 == 1 { [-y[0], -y[1], -y[2], y[3]] } else { y }, z]
        };
        let placements: Vec<Affine> = (0..count).map(&mut placement).collect();
        for (name, towards, levels) in DIRECTIONS {
            let mut view = LodView { levels: LevelRanges::new(levels)?, ..view(towards) };
            if name == MIRROR {
                view.clip_from_world = Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0)) * view.clip_from_world;
            }
            let levels = 1 + levels.len();
            let buffer = Buffer::from_slice(gpu, "placements", &placements)?;
            let (instance_lods, drawn) =
                (Poisoned::<InstanceLod>::new(gpu, count)?, Poisoned::new(gpu, list_words(count, levels))?);
            let arguments = Buffer::from_slice(gpu, "arguments", &ARGUMENTS.repeat(levels))?;
            let buffers = LodBuffers {
                placements: &buffer,
                instance_lods: &instance_lods.buffer,
                drawn: &drawn.buffer,
                arguments: &arguments,
            };
            let job = pass.prepare(gpu, &view, buffers)?;
            // Runs twice, because the number of instances must start again from 0.
            gpu.submit("verify", |encoder| (0..2).for_each(|_| job.record(encoder)))?;
            let arguments = arguments.read(gpu).await?;
            let (mut lists, mut found) = (Vec::new(), Vec::new());
            let kept = drawn.check(gpu, |drawn| split(drawn, &arguments, count, &mut lists)).await?;
            let mirrored = mirrored(&view, &placements, &arguments, &lists);
            let guard = instance_lods
                .check(gpu, |instance_lods| {
                    found = instance_lods.to_vec();
                    compare::exact(&[0], &[0])
                })
                .await?;
            cases.add(format!("{count} instances, {name}: the lists' ends"), kept);
            cases.add(format!("{count} instances, {name}: the instances' end"), guard);
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
        fade_range: FadeRange { start: 10.0, end: 70.0 },
        steps: 16,
        max_influences: 5,
        center: Vec3::new(0.0, 0.9, 0.1),
        radius: 1.2,
        levels: LevelRanges::NONE,
    }
}

/// Splits the lists of all levels by the lengths in the arguments. Memory beyond each list must still be
/// poison, and the other words of the arguments must be unchanged.
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

/// Checks that the second draw of each list reaches all mirrored instances.
fn mirrored(view: &LodView, placements: &[Affine], arguments: &[u32], lists: &[Vec<u32>]) -> Comparison {
    let is_mirrored = |drawn: &u32| may_mirror(view, &placements[*drawn as usize]);
    let last = |list: &Vec<u32>| list.iter().rposition(is_mirrored).map_or(0, |index| index as u32 + 1);
    let found: Vec<u32> = arguments.chunks(10).map(|arguments| arguments[6]).collect();
    compare::exact(&found, &lists.iter().map(last).collect::<Vec<_>>())
}

/// Checks that lists and InstanceLods agree for every instance and, except for instances at an edge, that they
/// are right. Instances at an edge are left out of the second check only, and counted: one in 200 is allowed,
/// so none in small cases.
fn compared(
    view: &LodView,
    placements: &[Affine],
    instance_lods: &[InstanceLod],
    lists: &[Vec<u32>],
) -> Comparison {
    let count = placements.len();
    let mut times = vec![vec![0; count]; lists.len()];
    let mut foreign = 0;
    for (times, list) in times.iter_mut().zip(lists) {
        for instance in list {
            *times.get_mut(*instance as usize).unwrap_or(&mut foreign) += 1;
        }
    }
    let (mut actual, mut expected) = (vec![foreign as f32], vec![0.0]);
    let mut at_edges = 0;
    for (instance, (found, placement)) in instance_lods.iter().zip(placements).enumerate() {
        let all: u32 = times.iter().map(|times| times[instance]).sum();
        let own = times.get(found.mesh_lod as usize).map_or(0, |times| times[instance]);
        let is_seen = f32::from(found.max_influences > 0);
        actual.extend([all as f32, own as f32]);
        expected.extend([is_seen, is_seen]);
        if is_at_an_edge(view, placement) {
            at_edges += 1;
            continue;
        }
        let wanted = lod(view, placement);
        actual.extend([found.influence_fade, found.max_influences as f32, found.mesh_lod as f32]);
        expected.extend([wanted.influence_fade, wanted.max_influences as f32, wanted.mesh_lod as f32]);
    }
    let left_out = LeftOut { count: at_edges, of: count, most: count / 200 };
    compare::absolute(&actual, &expected, FADE_BOUND).leaving_out(left_out)
}

/// Whether rounding may decide either way: the instance is at the very edge of the view, of a fade step or of a
/// level.
fn is_at_an_edge(view: &LodView, placement: &Affine) -> bool {
    let Seen { depth, projected_distance, fade_fraction } = seen(view, placement);
    let step = fade_fraction * view.steps as f32;
    let at_step = fade_fraction > 0.0 && fade_fraction < 1.0 && (step - step.round()).abs() < TOUCH;
    // z²/d changes twice as much as z does, and as much as d does.
    let at_level =
        view.levels.distances().iter().any(|begin| (projected_distance - begin).abs() < 3.0 * TOUCH);
    // An instance out of view has neither fade nor level.
    depth.abs() < TOUCH || depth > 0.0 && (at_step || at_level)
}

/// Measures a field of instances of which a quarter is seen.
///
/// # Errors
/// What the device reports.
pub(crate) fn benchmark(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = LodPass::new(gpu)?;
    let look: Mat4 = camera::rh::view::look_at_mat4(Vec3::Y, Vec3::new(0.0, 1.0, 1.0), Vec3::Y);
    let clip_from_world = camera::rh::proj::directx::perspective(1.2, 1.0, 0.1, 1000.0) * look;
    let view = LodView {
        clip_from_world,
        eye: Vec3::Y,
        fade_range: FadeRange { start: 10.0, end: 100.0 },
        steps: 64,
        max_influences: 8,
        center: Vec3::Y,
        radius: 1.0,
        levels: LevelRanges::NONE,
    };
    for count in [1000, 100_000] {
        let placement = |index: usize| {
            let (x, z) = ((index % 400) as f32 - 200.0, (index / 400) as f32 * 2.0 - 250.0);
            placed(Vec3::new(x, 0.0, z), index as f32, 1.0)
        };
        let placements: Vec<Affine> = (0..count).map(placement).collect();
        let buffer = Buffer::from_slice(gpu, "placements", &placements)?;
        let instance_lods = Buffer::from_slice(gpu, "instance_lods", &vec![InstanceLod::FULL; count])?;
        let (drawn, arguments) = (Buffer::new(gpu, "drawn", count)?, Buffer::new(gpu, "arguments", 10)?);
        let buffers = LodBuffers {
            placements: &buffer,
            instance_lods: &instance_lods,
            drawn: &drawn,
            arguments: &arguments,
        };
        let job = pass.prepare(gpu, &view, buffers)?;
        // The kernel reads a placement, and writes an InstanceLod and an index.
        let copied = copy_of(gpu, 16 * count / 2)?;
        let contenders = vec![
            Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
            Contender::job(Backend::Copy, &copied),
            Contender::host(Backend::Reference, || {
                drop(std::hint::black_box(
                    placements.iter().map(|placement| lod(&view, placement)).collect::<Vec<_>>(),
                ));
            }),
        ];
        bench.case(format!("{count} instances"), (count, "instance"), 64 * count as u64, contenders)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A view, placements along its axis, and the reference's decisions, with all instances in the lists of
    /// their levels.
    struct Right {
        view: LodView,
        placements: Vec<Affine>,
        instance_lods: Vec<InstanceLod>,
        lists: Vec<Vec<u32>>,
    }

    impl Right {
        /// `far` gives the distance of each instance along the axis of the view.
        fn new(far: impl Iterator<Item = f32>) -> Self {
            let view = view(Vec3::Z);
            let levels = LevelRanges::new(&[20.0, 40.0]).expect("ascending");
            let view = LodView { levels, ..view };
            let center = view.center;
            let placements: Vec<Affine> =
                far.map(|far| placed(view.eye + Vec3::Z * far - center, 0.0, 1.0)).collect();
            let instance_lods: Vec<_> = placements.iter().map(|placement| lod(&view, placement)).collect();
            let mut lists = vec![vec![]; 3];
            for (instance, instance_lod) in
                (0..).zip(&instance_lods).filter(|(_, instance_lod)| instance_lod.max_influences > 0)
            {
                lists[instance_lod.mesh_lod as usize].push(instance);
            }
            Self { view, placements, instance_lods, lists }
        }

        fn compared(&self) -> Comparison {
            compared(&self.view, &self.placements, &self.instance_lods, &self.lists)
        }

        fn with(&self, change: impl FnOnce(&mut Vec<InstanceLod>, &mut Vec<Vec<u32>>)) -> Comparison {
            let (mut instance_lods, mut lists) = (self.instance_lods.clone(), self.lists.clone());
            change(&mut instance_lods, &mut lists);
            compared(&self.view, &self.placements, &instance_lods, &lists)
        }
    }

    #[test]
    fn what_is_wrong_of_one_instance_is_seen() {
        let right = Right::new((0..400).map(|at| 3.03 + 0.25 * at as f32));
        let left_out = right.compared().left_out.expect("says so");
        assert!(right.compared().holds && left_out.count == 0, "{:?}", right.compared());
        let unseen = right
            .instance_lods
            .iter()
            .position(|instance_lod| instance_lod.max_influences == 0)
            .expect("some");
        assert!(right.lists.iter().all(|list| list.len() > 20));
        type Change = fn(&mut Vec<InstanceLod>, &mut Vec<Vec<u32>>);
        let faults: [Change; 8] = [
            |instance_lods, _| instance_lods[100].influence_fade += 1.0 / 16.0,
            |instance_lods, _| instance_lods[100].influence_fade = f32::NAN,
            |instance_lods, _| instance_lods[100].max_influences -= 1,
            |instance_lods, _| instance_lods[100].mesh_lod += 1,
            |_, lists| lists[1].truncate(3),
            |_, lists| lists[1].push(0),
            |_, lists| lists[0].push(7777),
            |_, lists| {
                let moved = lists[0].pop();
                lists[1].extend(moved);
            },
        ];
        for (number, fault) in faults.into_iter().enumerate() {
            assert!(!right.with(fault).holds, "fault {number}");
        }
        assert!(!right.with(|_, lists| lists[0].push(unseen as u32)).holds);
        assert!(!right.with(|instance_lods, _| instance_lods[unseen].max_influences = 5).holds);
    }

    /// Level 1 begins at 20. One instance of 400 at this edge must hide neither an error in the others nor its
    /// own absence from the lists.
    #[test]
    fn one_at_an_edge_is_left_out_alone_and_few_may_be() {
        let far = |at: usize, edges: usize| if at < edges { 20.0 } else { 3.03 + 0.25 * at as f32 };
        let right = |edges| Right::new((0..400).map(move |at| far(at, edges)));
        let one = right(1);
        assert!(one.compared().holds);
        assert_eq!(one.compared().left_out, Some(LeftOut { count: 1, of: 400, most: 2 }));
        let other_side = |instance_lods: &mut Vec<InstanceLod>, lists: &mut Vec<Vec<u32>>| {
            let level = instance_lods[0].mesh_lod as usize;
            lists[level].retain(|instance| *instance != 0);
            lists[1 - level].push(0);
            instance_lods[0].mesh_lod = 1 - level as u32;
        };
        assert!(one.with(other_side).holds);
        assert!(
            !one.with(|instance_lods, _| instance_lods[0].mesh_lod = 1 - instance_lods[0].mesh_lod).holds
        );
        assert!(!one.with(|instance_lods, _| instance_lods[1].max_influences -= 1).holds);
        assert!(right(2).compared().holds);
        let three = right(3).compared();
        assert!(!three.holds && three.fault.expect("a fault").contains("3 of 400 are left out"));
        assert!(!Right::new(std::iter::once(20.0)).compared().holds, "one of one proves nothing");
    }
}
