//! Benchmark cases of `skinning/skin`: skinning of crowds.

use crate::Error;
use crate::asset::mesh::MeshLevel;
use crate::asset::transform::rows;
use crate::gpu::{Buffer, Gpu, Job};
use crate::harness::{Backend, Bench, Contender};
use crate::skinning::bench::{CROWDS, RING, Scene, seen_of, tube};
use crate::skinning::buffers::ActiveClusters;
use crate::skinning::clusters::CLUSTER;
use crate::skinning::instance_lod::InstanceLod;
use crate::skinning::morph::reference::morph;
use crate::skinning::palette::Palette;
use crate::skinning::skin::SkinPass;
use crate::skinning::skin::reference::skin;
use crate::skinning::vertex::{Blend, Vertex};
use crate::terrain::bench::copy_of;

/// Measures vertices with eight, four, two influences and one.
///
/// # Errors
/// What the device reports.
pub fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
    let gpu = bench.gpu;
    let pass = SkinPass::new(gpu, Blend::Linear)?;
    let vertices = RING * RING;
    for influences in [8, 4, 2, 1] {
        for instances in CROWDS {
            let scene = Scene::new(gpu, influences, 0, instances)?;
            // The kernel reads a vertex, its influences and its bones' rows, and writes a vertex.
            let words = 10 + influences.div_ceil(2) + (influences - 1) + 12 * influences + 10;
            let batch = batch(gpu, instances, 4 * words / 2);
            let jobs = batches(gpu, &pass, &scene, [instances, batch])?;
            let copied = copy_of(gpu, words * vertices * batch / 2)?;
            let mesh = &scene.model.meshes[0];
            let palette = Palette::Linear(scene.model.skins[0].inverse_binds.iter().map(rows).collect());
            let unskinned = morph(mesh, &[]);
            let reference = || {
                for _ in 0..instances {
                    drop(std::hint::black_box(skin(
                        &unskinned,
                        &mesh.influences,
                        &palette,
                        InstanceLod::FULL,
                    )));
                }
            };
            // The same output without influences.
            let unmoved = copy_of(gpu, 20 * vertices * batch / 2)?;
            let contenders = vec![
                Contender::recorded(Backend::Gpu, |encoder| jobs.iter().for_each(|job| job.record(encoder))),
                Contender::recorded(Backend::Copy, |encoder| {
                    jobs.iter().for_each(|_| copied.record(encoder))
                }),
                Contender::recorded(Backend::Limit, |encoder| {
                    jobs.iter().for_each(|_| unmoved.record(encoder))
                }),
                Contender::host(Backend::Reference, reference),
            ];
            let all = instances * vertices;
            let case = format!("{influences} influences, 10k × {instances}");
            bench.case(case, (all, "vertex"), (4 * words * all) as u64, contenders)?;
        }
    }
    some(bench, &pass)?;
    seen(bench, &pass)?;
    levelled(bench, &pass)?;
    faded(bench, &pass)
}

/// Measures a list with every eighth cluster of a hundred instances.
fn some(bench: &mut Bench<'_>, pass: &SkinPass) -> Result<(), Error> {
    let gpu = bench.gpu;
    let scene = Scene::new(gpu, 4, 0, CROWDS[1])?;
    let output = Buffer::new(gpu, "skinned", CROWDS[1] * RING * RING)?;
    let active = ActiveClusters::new(gpu, &scene.mesh, &scene.crowd)?;
    let chosen: Vec<u32> = (0..(CROWDS[1] * scene.mesh.clusters()) as u32).step_by(8).collect();
    active.write(gpu, &chosen)?;
    let job = pass.prepare_active(gpu, &scene.mesh, &scene.crowd, &output, &active)?;
    let vertices = CLUSTER * chosen.len();
    let copied = copy_of(gpu, 73 * vertices / 2)?;
    let mesh = &scene.model.meshes[0];
    let palette = Palette::Linear(scene.model.skins[0].inverse_binds.iter().map(rows).collect());
    let unskinned = morph(mesh, &[]);
    let contenders = vec![
        Contender::recorded(Backend::Gpu, |encoder| job.record(encoder)),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            for _ in 0..vertices / unskinned.len() {
                drop(std::hint::black_box(skin(&unskinned, &mesh.influences, &palette, InstanceLod::FULL)));
            }
        }),
    ];
    bench.case("an eighth of 4, 10k × 100", (vertices, "vertex"), 292 * vertices as u64, contenders)
}

/// Measures a hundred instances of which a quarter is seen, without a list: nanoseconds per vertex of those
/// that are seen.
fn seen(bench: &mut Bench<'_>, pass: &SkinPass) -> Result<(), Error> {
    let gpu = bench.gpu;
    let scene = Scene::new(gpu, 4, 0, CROWDS[1])?;
    scene.crowd.instance_lods.write(gpu, &seen_of(CROWDS[1], 4))?;
    let work =
        Work { instances: CROWDS[1] / 4, vertices: RING * RING, words: 73, instance_lod: InstanceLod::FULL };
    crowd(bench, pass, &scene, "4, a quarter of 10k × 100 seen, no list", &work)
}

/// Measures a hundred instances at a level with a quarter of the vertices, without a list: nanoseconds per
/// vertex of the level's clusters.
fn levelled(bench: &mut Bench<'_>, pass: &SkinPass) -> Result<(), Error> {
    let gpu = bench.gpu;
    let mut model = tube(4, 0)?;
    let mesh = &mut model.meshes[0];
    let quarter = mesh.indices[..mesh.indices.len() / 12 * 3].to_vec();
    mesh.levels = vec![MeshLevel { indices: quarter, error: 0.0 }];
    let scene = Scene::of(gpu, model, CROWDS[1])?;
    let level = InstanceLod::level(1)?;
    scene.crowd.instance_lods.write(gpu, &[level; CROWDS[1]])?;
    let each = CLUSTER * scene.clusters.level(1).clusters as usize;
    let work = Work { instances: CROWDS[1], vertices: each, words: 73, instance_lod: level };
    crowd(bench, pass, &scene, "4, 10k × 100 at a level of a quarter, no list", &work)
}

/// The part of a crowd that is skinned. Which vertices of an instance these are does not matter to the
/// reference.
struct Work {
    instances: usize,
    vertices: usize,
    /// Words that are loaded and stored per vertex.
    words: usize,
    instance_lod: InstanceLod,
}

/// Measures a hundred instances without a list: nanoseconds per skinned vertex.
fn crowd(
    bench: &mut Bench<'_>,
    pass: &SkinPass,
    scene: &Scene,
    name: &str,
    work: &Work,
) -> Result<(), Error> {
    let gpu = bench.gpu;
    let output = Buffer::new(gpu, "skinned", CROWDS[1] * RING * RING)?;
    let job = pass.prepare(gpu, &scene.mesh, &scene.crowd, 0..CROWDS[1], &output)?;
    let all = work.instances * work.vertices;
    let copied = copy_of(gpu, work.words * all / 2)?;
    let mesh = &scene.model.meshes[0];
    let palette = Palette::Linear(scene.model.skins[0].inverse_binds.iter().map(rows).collect());
    let unskinned = morph(mesh, &[]);
    let contenders = vec![
        Contender::job(Backend::Gpu, &job),
        Contender::job(Backend::Copy, &copied),
        Contender::host(Backend::Reference, || {
            let some = &unskinned[..work.vertices];
            for _ in 0..work.instances {
                drop(std::hint::black_box(skin(some, &mesh.influences, &palette, work.instance_lod)));
            }
        }),
    ];
    bench.case(name, (all, "vertex"), (4 * work.words * all) as u64, contenders)
}

/// Measures a hundred instances at full fade: the weight that decides is read, and one bone.
fn faded(bench: &mut Bench<'_>, pass: &SkinPass) -> Result<(), Error> {
    let gpu = bench.gpu;
    let scene = Scene::new(gpu, 4, 0, CROWDS[1])?;
    let rigid = InstanceLod { influence_fade: 1.0, ..InstanceLod::FULL };
    scene.crowd.instance_lods.write(gpu, &[rigid; CROWDS[1]])?;
    // The kernel reads a vertex, a bone, a weight and the bone's rows, and writes a vertex.
    let work = Work { instances: CROWDS[1], vertices: RING * RING, words: 34, instance_lod: rigid };
    crowd(bench, pass, &scene, "4 faded to 1, 10k × 100", &work)
}

/// The number of instances, a divisor of `instances`, whose vertices of `bytes` bytes fit one buffer.
fn batch(gpu: &Gpu, instances: usize, bytes: usize) -> usize {
    let room = gpu.max_binding() as usize / (RING * RING * bytes.max(size_of::<Vertex>()));
    (1..=instances).rev().find(|batch| instances.is_multiple_of(*batch) && *batch <= room.max(1)).unwrap_or(1)
}

/// Jobs for all instances, batch by batch into the same buffer.
fn batches(
    gpu: &Gpu,
    pass: &SkinPass,
    scene: &Scene,
    [instances, batch]: [usize; 2],
) -> Result<Vec<Job>, Error> {
    let output = Buffer::new(gpu, "skinned", batch * RING * RING)?;
    let firsts = (0..instances).step_by(batch);
    firsts.map(|first| pass.prepare(gpu, &scene.mesh, &scene.crowd, first..first + batch, &output)).collect()
}
