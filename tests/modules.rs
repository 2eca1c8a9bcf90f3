//! The modules for shaders outside the crate, used as such shaders use them: put before a shader that this
//! crate does not know (`tests/modules/`), compiled by wgpu, and compared with the reference and with closed
//! forms.

use relievo_testing as harness;

use std::collections::BTreeSet;
use std::num::NonZeroU64;
use std::path::{Path, PathBuf};

use glam::Vec3;
use harness::gpu;
use relievo::gpu::{Buffer, Gpu, shaders::MODULES};
use relievo::ops::animation::Wrap;
use relievo::ops::animation::keyframe_cursor::reference::inside_clip;
use relievo::ops::lod::LodCamera;
use relievo::ops::skinning::palette::reference::dual;
use relievo::ops::surface::{Address, HeightMap, ReliefMethod, SurfaceTextures};
use relievo::ops::terrain::blend::WeightMode;
use relievo::ops::terrain::blend::reference::{
    color_variation, steepness, triplanar_weights, varied, zone_fractions,
};
use relievo::ops::terrain::config::Zone;
use relievo::ops::terrain::cover::{ShaderZone, zone_of};
use relievo::ops::terrain::fixed::{mean_of_four, multiply_high};

/// What a shader of `tests/modules/` makes of `floats`: so many words. `constants` and textures are for those that have
/// them.
fn run(
    gpu: &Gpu,
    name: &str,
    constants: &[(&str, f64)],
    textures: Option<&SurfaceTextures>,
    floats: &[f32],
    words: usize,
) -> Vec<u32> {
    let module = MODULES.iter().find(|module| module.name == name).expect("exported");
    let path = root().join(format!("tests/modules/{name}.wgsl"));
    let user = std::fs::read_to_string(path).expect("there");
    let device = gpu.device();
    let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(name),
        source: wgpu::ShaderSource::Wgsl(format!("{}\n{user}", module.source).into()),
    });
    let (given, results) = (
        Buffer::from_slice(gpu, "given", floats).expect("uploaded"),
        Buffer::<u32>::new(gpu, "results", words).expect("allocated"),
    );
    let layout = bind_group_layout(device, textures.is_some());
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(name),
        layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(name),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        })),
        module: &shader,
        entry_point: Some("main"),
        compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
        cache: None,
    });
    let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
    let views = textures.map(|textures| [view(&textures.heights), view(&textures.acceleration)]);
    // Of the floats alone: wgpu allocates more behind buffers of vertices, and `arrayLength` would count it.
    let bytes = NonZeroU64::new(size_of_val(floats) as u64);
    let floats = wgpu::BufferBinding { buffer: given.raw(), offset: 0, size: bytes };
    let buffers = [wgpu::BindingResource::Buffer(floats), results.raw().as_entire_binding()];
    let resources = buffers.into_iter().chain(views.iter().flatten().map(wgpu::BindingResource::TextureView));
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(name),
        layout: &layout,
        entries: &entries,
    });
    gpu.run(name, |encoder| {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.dispatch_workgroups(1, 1, 1);
    })
    .expect("run");
    results.read_blocking(gpu).expect("read")
}

fn bind_group_layout(device: &wgpu::Device, has_textures: bool) -> wgpu::BindGroupLayout {
    let buffer = |read_only| wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let kinds = [buffer(true), buffer(false), texture, texture];
    let entries: Vec<_> = (0..if has_textures { 4 } else { 2 })
        .map(|binding| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: kinds[binding as usize],
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

/// Whether floats that a shader wrote as bits are within `bound` of what is expected.
#[track_caller]
fn assert_near(words: &[u32], expected: &[f32], bound: f32) {
    let actual: Vec<f32> = words.iter().map(|bits| f32::from_bits(*bits)).collect();
    assert_eq!(actual.len(), expected.len());
    for (at, (actual, expected)) in actual.iter().zip(expected).enumerate() {
        assert!((actual - expected).abs() <= bound, "{at}: {actual} instead of {expected}");
    }
}

fn zones() -> [ShaderZone; 3] {
    let [mut low, mut middle, mut high] =
        [[-8.0, 0.0], [0.0, 10.0], [20.0, 30.0]].map(|[min, max]| zone_of(&Zone::new(min, max, None)));
    middle.rise = [4.0, -0.5];
    low.fall = [-4.0, 2.5];
    low.height_blend = 1.0;
    high.height_blend = 0.5;
    [low, middle, high]
}

/// Weights divide twice, 2.5 units in the last place each, and lines by slope multiply the rounding of the steepness by 4;
/// fractions are at most 1. Of the noise, the largest of the cells' coordinates has 14 bits behind the point left.
#[test]
fn zones_and_their_textures_are_those_of_the_reference() {
    let gpu = gpu();
    let heights = [-100.0, -8.5, -8.0, -3.0, 0.0, 0.25, 7.5, 10.0, 16.0, 25.0, 30.0, 31.0, -5.0, -1.0];
    let count = heights.len();
    let normal = |at: usize| {
        let tilt = at as f32 / count as f32;
        Vec3::new(0.6 * tilt, 1.0 - tilt, 0.8 * tilt).normalize().to_array()
    };
    for (additive, weights) in [(0.0, WeightMode::Normalized), (1.0, WeightMode::Additive)] {
        let words = run(&gpu, "terrain", &[("ADDITIVE", additive)], None, &heights, 9 * count + 6);
        let fractions = |at: usize| {
            zone_fractions(&zones(), heights[at], steepness(normal(at)), &[1.0, 0.75, 0.5], weights)
        };
        assert!((0..count).flat_map(fractions).any(|part| part > 0.01 && part < 0.99), "nothing is blended");
        for (at, own) in words.chunks(9).take(count).enumerate() {
            assert_near(&own[..3], &fractions(at), 4e-6);
            assert_near(&own[3..6], &triplanar_weights(normal(at)), 4e-6);
            let noise = color_variation([heights[at] * heights[at], 1023.5 * (at as f32 / count as f32)]);
            assert_near(&own[6..], &varied([0.5, 0.25, 1.0], noise, 0.5), 1e-4);
        }
    }
}

/// Integer results must be equal to the bit.
#[test]
fn terrain_offsets_are_those_of_the_reference_and_light_falls_as_the_cosine() {
    let words = run(&gpu(), "terrain", &[], None, &[0.0; 4], 42);
    let range = 655_360;
    let offsets: [i32; 4] = std::array::from_fn(|x| {
        let (first, second) = relievo::ops::hash::threefry2x32([17, 4], [x as u32; 8], [5; 8]);
        let sum = (first[0] & 0xffff) + (first[0] >> 16) + (second[0] & 0xffff) + (second[0] >> 16);
        multiply_high((sum << 14) + 0x8000, 2 * range) as i32 - range as i32
    });
    let words = &words[36..];
    assert_eq!(words[..4], offsets.map(|offset| offset as u32));
    let [a, b, c, d] = offsets;
    assert_eq!(words[4], mean_of_four(a, b, c, d) as u32);
    // The normal is (-3, 4, 0) / 5, and the light's ambient part a quarter.
    assert_near(&words[5..], &[0.25 + 0.75 * 0.8], 1e-6);
}

#[test]
fn clips_wrap_and_rotations_turn_at_constant_speed() {
    let times = [-7.25_f32, -2.0, 0.0, 0.125, 0.75, 1.5, 2.0, 4.25, 1e9];
    let words = run(&gpu(), "animation", &[], None, &times, 8 * times.len());
    for (own, time) in words.chunks(8).zip(times) {
        let inside = [Wrap::Loop, Wrap::Clamp].map(|wrap| inside_clip(wrap, 2.0, time));
        // Times and durations are whole multiples of 2^-3, so that every division is exact.
        assert_near(&own[..2], &inside, 0.0);
        let (sine, cosine) = (f64::from(inside[0]) / 2.0 * std::f64::consts::FRAC_PI_4).sin_cos();
        assert_near(&own[2..4], &[sine as f32, cosine as f32], 1e-6);
        // 1250 of 4000 units, and the shorter way to 3900 leads over the clip's end.
        assert_eq!(own[4..], [2, 1350, 65535, 2], "{time}");
    }
}

/// A flat surface at half the depth: from above it, a ray ends at half its way.
#[test]
fn every_method_meets_a_flat_surface() {
    let gpu = gpu();
    let map = HeightMap::new(8, 8, vec![0.5; 64]).expect("valid");
    let directions = [0.0_f32, 0.3, -0.6, 0.8];
    for method in ReliefMethod::ALL {
        let textures = SurfaceTextures::new(&gpu, &map, method, Address::Wrap).expect("made");
        let constants = [("METHOD", method.code().into())];
        let words = run(&gpu, "surface", &constants, Some(&textures), &directions, 3 * directions.len());
        for (own, x) in words.chunks(3).zip(directions) {
            let slope = x / (1.0 - x * x).sqrt();
            let (way, height) = match method {
                ReliefMethod::Plain => (0.0, 1.0),
                // This method lacks the division by the cosine.
                ReliefMethod::ParallaxLimited => (0.5 * x, 0.5),
                _ => (0.5 * slope, 0.5),
            };
            // The tolerance is that of the binary steps: 2^-17 of the way.
            assert_near(own, &[0.25 - 0.125 * way, height, 1.0], 2e-5);
        }
    }
}

/// Vertices and bones are passed in the kernels' layout, and come out where the bones' matrices take them.
#[test]
fn vertices_go_where_a_palette_of_dual_quaternions_takes_them() {
    // A rotation by 90 degrees, a mirror, a non-uniform scale with shear, and a translation.
    let bones = [
        [[0.0, -1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 2.0], [0.0, 0.0, 1.0, 3.0]],
        [[-1.0, 0.0, 0.0, 0.5], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -0.5]],
        [[2.0, 0.5, 0.0, 0.0], [0.0, 0.5, 0.25, 0.0], [0.0, 0.0, 4.0, 1.0]],
        [[1.0, 0.0, 0.0, -8.0], [0.0, 1.0, 0.0, 0.25], [0.0, 0.0, 1.0, 0.0]],
    ];
    let vertex = |at: usize| [1.0 + at as f32, 2.0, -3.0, 0.6, 0.0, 0.8, 0.0, 1.0, 0.0, -1.0];
    let duals = bones.iter().map(dual).flat_map(|bone| [bone.real, bone.dual, bone.diagonal, bone.above]);
    let given: Vec<f32> = (0..4).flat_map(vertex).chain(duals.flatten()).collect();
    let words = run(&gpu(), "skinning", &[], None, &given, 40);
    for (at, own) in words.chunks(10).enumerate() {
        let [x, y, z] = bones[at];
        let [px, py, pz, nx, ny, nz, tangent @ ..] = vertex(at);
        let position = [x, y, z].map(|row| row[0] * px + row[1] * py + row[2] * pz + row[3]);
        let cross = |a: [f32; 4], b: [f32; 4]| {
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
        };
        let normal = [cross(y, z), cross(z, x), cross(x, y)].map(|c| c[0] * nx + c[1] * ny + c[2] * nz);
        assert_near(&own[..3], &position, 5e-6);
        assert_near(&own[3..6], &normal, 5e-6);
        assert_near(&own[6..], &tangent, 0.0);
    }
}

/// What a camera allows is within the rounding of its formula, some 2e-6, of the reference's; placements are exact but for
/// the square root in the rotation.
#[test]
fn cameras_allow_what_the_reference_says() {
    let camera = LodCamera {
        eye: Vec3::new(1.0, 2.0, 3.0),
        focal: 500.0,
        ahead: Vec3::NEG_Z,
        pixels: 2.0,
        near: 0.25,
        perspective: 1.0,
        pixel_count: 1e6,
        unused: 0.0,
    };
    let spheres =
        [[1.0, 2.0, -97.0, 0.0], [11.0, -6.0, -7.0, 1.0], [1.0, 2.0, 2.0, 0.9], [4.0, 6.0, 15.0, 1.0]];
    let words = run(&gpu(), "lod", &[], None, spheres.as_flattened(), spheres.len() + 9);
    let expected = spheres.map(|[x, y, z, radius]| camera.allows(Vec3::new(x, y, z), radius));
    // A pixel takes 1/500 of the distance, of which 1e-4 is kept back.
    assert!((expected[0] - 0.9999 * 2.0 * 100.0 / 502.0).abs() < 1e-3 && expected[1] > 0.01, "{expected:?}");
    assert!(expected[2] == 0.0 && expected[3] > 0.01, "{expected:?}");
    assert_near(&words[..4], &expected, 4e-6);
    assert_near(&words[4..7], &[257.0, 2.0, -252.5], 0.0);
    assert_near(&words[7..], &[0.0, 0.0, -2.0, 0.0, -1.0, 0.0], 1e-6);
}

/// Declarations of a module without a comment above them.
fn bare(source: &str) -> Vec<&str> {
    let declares =
        |line: &str| ["fn ", "struct ", "const ", "alias "].iter().any(|word| line.starts_with(word));
    let is_told = |line: &str| line.starts_with("//");
    // Constants may share the comment of the one above them.
    let shares = |before: &str, line: &str| before.starts_with("const ") && line.starts_with("const ");
    let pairs = std::iter::once("").chain(source.lines()).zip(source.lines());
    pairs
        .filter(|(before, line)| declares(line) && !is_told(before) && !shares(before, line))
        .map(|(_, line)| line)
        .collect()
}

#[test]
fn every_declaration_of_a_module_has_a_comment() {
    for module in MODULES {
        assert_eq!(bare(module.source), Vec::<&str>::new(), "{}", module.name);
        assert!(module.source.lines().filter(|line| line.starts_with("fn ")).count() > 2, "{}", module.name);
    }
    assert_eq!(bare("// One.\nfn a() {}\nconst B = 1;\nconst C = 2;"), ["const B = 1;"]);
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn wgsl_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("readable").map(|entry| entry.expect("readable").path());
    entries.flat_map(|path| if path.is_dir() { wgsl_files(&path) } else { vec![path] }).collect()
}

/// Whether a file, or one that it imports, binds something, chooses by override constants, or starts a pipeline.
fn is_bound(file: &Path) -> bool {
    let source = std::fs::read_to_string(file).expect("readable");
    let imported = |line: &str| {
        let path = line.strip_prefix("import package::")?.rsplit_once("::")?.0.replace("::", "/");
        Some(root().join(path).with_extension("wgsl"))
    };
    ["@group(", "@compute", "@vertex", "\noverride "].iter().any(|word| source.contains(word))
        || source.lines().filter_map(imported).any(|file| is_bound(&file))
}

/// Each file once, so that all modules can stand in one shader. Those of `wgsl/render/` are of the crate's own drawing.
#[test]
fn every_file_that_a_shader_could_import_is_in_one_module() {
    let mut exported = Vec::new();
    for module in MODULES {
        let files = module.source.lines().filter_map(|line| line.strip_prefix("// From relievo's "));
        exported.extend(files.filter_map(|file| file.strip_suffix('.')).map(str::to_owned));
    }
    let importable: BTreeSet<String> = (wgsl_files(&root().join("wgsl")).iter())
        .filter(|file| !file.starts_with(root().join("wgsl/render")) && !is_bound(file))
        .map(|file| file.strip_prefix(root()).expect("below").to_string_lossy().replace('\\', "/"))
        .collect();
    assert!(!importable.is_empty());
    assert_eq!(exported.iter().cloned().collect::<BTreeSet<_>>(), importable);
    assert_eq!(exported.len(), importable.len(), "a file is in two modules: {exported:?}");
}
