//! Benchmark cases of `skinning/lod`: culling and level of detail of crowds.

use glam::{Mat4, Vec3, camera};

use crate::Error;
use crate::asset::transform::Affine;
use crate::gpu::Buffer;
use crate::harness::{Backend, Bench, Contender};
use crate::skinning::instance_lod::{FadeRange, InstanceLod};
use crate::skinning::lod::reference::lod;
use crate::skinning::lod::{LevelRanges, LodBuffers, LodPass, LodView, placed};
use crate::terrain::bench::copy_of;

/// Measures a field of instances of which a quarter is seen.
///
/// # Errors
/// What the device reports.
pub(crate) fn cases(bench: &mut Bench<'_>) -> Result<(), Error> {
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
