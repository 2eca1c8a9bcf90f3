//! `relievo info`: the adapters, the chosen device's driver and limits, and the passes.

use relievo::Error;
use relievo::gpu::{adapters, shaders};
use relievo_lab::harness::{TimedBy, Timer};

use crate::Context;
use crate::output::say;

pub fn run(context: &Context) -> Result<(), Error> {
    say(format_args!("relievo {}", env!("CARGO_PKG_VERSION")))?;
    say("\nadapters (choose with --adapter or RELIEVO_ADAPTER):")?;
    for adapter in adapters() {
        say(format_args!("  {adapter}"))?;
    }
    let gpu = context.gpu()?;
    say(format_args!("\nchosen: {}", gpu.adapter()))?;
    let timing = match Timer::new(&gpu)?.timed_by() {
        TimedBy::Timestamp => "the device's timestamps",
        TimedBy::Wall => "wall time (the adapter has no timestamps)",
    };
    say(format_args!("timing: {timing}"))?;
    let limits = gpu.device().limits();
    say("limits (WebGPU's defaults suffice for every pass):")?;
    for (name, value) in [
        ("maxStorageBufferBindingSize", limits.max_storage_buffer_binding_size),
        ("maxBufferSize", limits.max_buffer_size),
        ("maxTextureDimension2D", limits.max_texture_dimension_2d.into()),
        ("maxComputeInvocationsPerWorkgroup", limits.max_compute_invocations_per_workgroup.into()),
        ("maxComputeWorkgroupsPerDimension", limits.max_compute_workgroups_per_dimension.into()),
        ("maxStorageBuffersPerShaderStage", limits.max_storage_buffers_per_shader_stage.into()),
    ] {
        say(format_args!("  {name:<34} {value}"))?;
    }
    say("\npasses:")?;
    for shader in shaders::ALL {
        let entries: Vec<_> = shader.entry_points.iter().map(|entry| entry.name).collect();
        let names: Vec<_> = shader.overrides.iter().map(|constant| constant.name).collect();
        let overrides = if names.is_empty() { String::new() } else { format!("  [{}]", names.join(", ")) };
        say(format_args!("  {:<18} {}{overrides}", shader.name, entries.join(" + ")))?;
    }
    Ok(())
}
