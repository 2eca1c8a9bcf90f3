//! Finds what shaders need beyond the limits that every WebGPU device has.

use naga::valid::ModuleInfo;
use naga::{AddressSpace, ShaderStage, TypeInner};

/// WebGPU's default limits (W3C, "WebGPU", section 3.6.2) that a single shader can exceed.
const DEFAULTS: &[(&str, u32)] = &[
    ("maxBindGroups", 4),
    ("maxStorageBuffersPerShaderStage", 8),
    ("maxUniformBuffersPerShaderStage", 12),
    ("maxSampledTexturesPerShaderStage", 16),
    ("maxSamplersPerShaderStage", 16),
    ("maxComputeInvocationsPerWorkgroup", 256),
    ("maxComputeWorkgroupSizeX", 256),
    ("maxComputeWorkgroupSizeY", 256),
    ("maxComputeWorkgroupSizeZ", 64),
    ("maxComputeWorkgroupStorageSize", 16_384),
];

/// The limits that a shader needs raised, with the values it needs.
pub fn beyond_defaults(module: &naga::Module, info: &ModuleInfo) -> Vec<(&'static str, u32)> {
    let needs = |limit: &str| {
        let groups = module.global_variables.iter().filter_map(|(_, variable)| variable.binding.as_ref());
        match limit {
            "maxBindGroups" => groups.map(|binding| binding.group + 1).max().unwrap_or(0),
            "maxStorageBuffersPerShaderStage" => {
                most_bound(module, info, |space, _| matches!(space, AddressSpace::Storage { .. }))
            }
            "maxUniformBuffersPerShaderStage" => {
                most_bound(module, info, |space, _| space == AddressSpace::Uniform)
            }
            "maxSampledTexturesPerShaderStage" => {
                most_bound(module, info, |_, inner| matches!(inner, TypeInner::Image { .. }))
            }
            "maxSamplersPerShaderStage" => {
                most_bound(module, info, |_, inner| matches!(inner, TypeInner::Sampler { .. }))
            }
            _ => most_of_workgroups(module, info, limit),
        }
    };
    (DEFAULTS.iter().map(|(limit, default)| (*limit, needs(limit), *default)))
        .filter(|(_, needed, default)| needed > default)
        .map(|(limit, needed, _)| (limit, needed))
        .collect()
}

/// The largest number of bindings of a kind that one stage uses. A pipeline's layout counts those of every
/// entry point of the stage.
fn most_bound(
    module: &naga::Module,
    info: &ModuleInfo,
    is_kind: impl Fn(AddressSpace, &TypeInner) -> bool,
) -> u32 {
    let in_stage = |stage| {
        (module.global_variables.iter())
            .filter(|(_, variable)| {
                variable.binding.is_some() && is_kind(variable.space, &module.types[variable.ty].inner)
            })
            .filter(|(handle, _)| {
                let entries = module.entry_points.iter().enumerate();
                entries
                    .filter(|(_, entry)| entry.stage == stage)
                    .any(|(index, _)| !info.get_entry_point(index)[*handle].is_empty())
            })
            .count() as u32
    };
    [ShaderStage::Vertex, ShaderStage::Fragment, ShaderStage::Compute]
        .map(in_stage)
        .into_iter()
        .max()
        .unwrap_or(0)
}

/// The largest workgroup of any entry point, measured as `limit` does.
fn most_of_workgroups(module: &naga::Module, info: &ModuleInfo, limit: &str) -> u32 {
    let of_entry = |(index, entry): (usize, &naga::EntryPoint)| {
        let [x, y, z] = entry.workgroup_size;
        match limit {
            "maxComputeInvocationsPerWorkgroup" => x * y * z,
            "maxComputeWorkgroupSizeX" => x,
            "maxComputeWorkgroupSizeY" => y,
            "maxComputeWorkgroupSizeZ" => z,
            "maxComputeWorkgroupStorageSize" => workgroup_bytes(module, info, index),
            other => panic!("{other}: teach build/limits.rs this limit"),
        }
    };
    module.entry_points.iter().enumerate().map(of_entry).max().unwrap_or(0)
}

/// Bytes of workgroup memory of an entry point, with each variable rounded up to 16 as WebGPU requires.
fn workgroup_bytes(module: &naga::Module, info: &ModuleInfo, entry: usize) -> u32 {
    let variables = module.global_variables.iter();
    let used = variables.filter(|(handle, variable)| {
        variable.space == AddressSpace::WorkGroup && !info.get_entry_point(entry)[*handle].is_empty()
    });
    used.map(|(_, variable)| module.types[variable.ty].inner.size(module.to_ctx()).next_multiple_of(16)).sum()
}
