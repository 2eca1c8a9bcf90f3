//! Resource use of every kind of object under WebGPU's default limits, in every entry point, as documented at
//! [`Renderer::with_shading`](crate::render::Renderer::with_shading) and [`KindProgram::new`].

use naga::front::wgsl::parse_str;
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{AddressSpace, Binding, Module, ShaderStage, TypeInner};

use crate::scene::kind::KindProgram;
use crate::scene::program::LEAST;
use crate::scene::specialization::Program;

/// Resource use of a shader stage: bindings by class, and inter-stage locations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
struct Taken {
    storage: usize,
    uniforms: usize,
    textures: usize,
    samplers: usize,
    locations: usize,
}

impl Taken {
    fn is_within(&self, most: &Self) -> bool {
        let all =
            |taken: &Self| [taken.storage, taken.uniforms, taken.textures, taken.samplers, taken.locations];
        all(self).iter().zip(all(most)).all(|(taken, most)| *taken <= most)
    }
}

/// The largest resource use of vertex and fragment stages. The rest of WebGPU's default limits is left to the caller.
const VERTEX: Taken = Taken { storage: 8, uniforms: 4, textures: 0, samplers: 0, locations: 7 };
const FRAGMENT: Taken = Taken { storage: 5, uniforms: 4, textures: 5, samplers: 3, locations: 7 };

/// Number of inter-stage locations that a type takes: one per member of a struct, one for other types.
fn locations(module: &Module, ty: naga::Handle<naga::Type>) -> usize {
    match &module.types[ty].inner {
        TypeInner::Struct { members, .. } => {
            let is_location =
                |member: &&naga::StructMember| matches!(member.binding, Some(Binding::Location { .. }));
            members.iter().filter(is_location).count()
        }
        _ => 0,
    }
}

/// Resource use of each entry point.
fn taken(text: &str) -> Vec<(String, ShaderStage, Taken)> {
    let module = parse_str(text).expect("WGSL");
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::default());
    let info = validator.validate(&module).expect("valid");
    let of_entry = |(index, entry): (usize, &naga::EntryPoint)| {
        let mut taken = Taken::default();
        for (handle, variable) in module.global_variables.iter() {
            if variable.binding.is_none() || info.get_entry_point(index)[handle].is_empty() {
                continue;
            }
            match (variable.space, &module.types[variable.ty].inner) {
                (AddressSpace::Uniform, _) => taken.uniforms += 1,
                (AddressSpace::Storage { .. }, _) => taken.storage += 1,
                (_, TypeInner::Sampler { .. }) => taken.samplers += 1,
                _ => taken.textures += 1,
            }
        }
        taken.locations = match entry.stage {
            ShaderStage::Vertex => {
                entry.function.result.as_ref().map_or(0, |result| locations(&module, result.ty))
            }
            _ => entry.function.arguments.iter().map(|argument| locations(&module, argument.ty)).sum(),
        };
        (entry.name.clone(), entry.stage, taken)
    };
    module.entry_points.iter().enumerate().map(of_entry).collect()
}

#[test]
fn every_kind_stays_within_its_part_of_the_limits_in_every_output() {
    let own = Program::Own(KindProgram::least().expect("valid"));
    let mut largest = [Taken::default(); 2];
    for program in [Program::Mesh, Program::Relief, Program::Terrain, own] {
        let all = taken(program.text());
        assert!(all.len() >= 8, "{}: {} entry points", program.name(), all.len());
        for (entry, stage, taken) in all {
            let is_fragment = stage == ShaderStage::Fragment;
            let most = if is_fragment { FRAGMENT } else { VERTEX };
            assert!(taken.is_within(&most), "{} {entry}: {taken:?}", program.name());
            let Taken { storage, uniforms, textures, samplers, locations } =
                &mut largest[usize::from(is_fragment)];
            *storage = taken.storage.max(*storage);
            *uniforms = taken.uniforms.max(*uniforms);
            *textures = taken.textures.max(*textures);
            *samplers = taken.samplers.max(*samplers);
            *locations = taken.locations.max(*locations);
        }
    }
    println!("vertex: {:?}, fragment: {:?}", largest[0], largest[1]);
    // Resource use of a kind without bindings, as `KindProgram::new` documents it.
    let least = Taken { storage: 3, uniforms: 2, textures: 1, samplers: 1, locations: 7 };
    let own = taken(KindProgram::least().expect("valid").text());
    assert!(own.iter().all(|(_, _, taken)| taken.is_within(&least)), "{own:?}");
    // The documented numbers are exact, because larger ones would keep bindings from the caller.
    assert_eq!((largest[0].storage, largest[0].locations), (VERTEX.storage, VERTEX.locations));
    assert_eq!((largest[1].textures, largest[1].samplers), (FRAGMENT.textures, FRAGMENT.samplers));
    // A kind that uses one resource too many is detected.
    let more = LEAST.replace("return relievo_scene_surface(in)", "var surface = relievo_scene_surface(in); surface.color *= least_a * least_b * least_c * least_d; return surface");
    let bound: String = (0..4)
        .map(|at| {
            format!("@group(2) @binding({at}) var<uniform> least_{}: vec3<f32>;\n", ["a", "b", "c", "d"][at])
        })
        .collect();
    let over = KindProgram::new("least", &(bound + &more)).expect("valid");
    let is_over = |(_, _, taken): &(String, ShaderStage, Taken)| !taken.is_within(&FRAGMENT);
    assert!(taken(over.text()).iter().any(is_over));
}
