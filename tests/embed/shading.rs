//! The caller's shading: equal to the crate's where it repeats it, with what it is given and with resources of its own,
//! and its mistakes.

use glam::Vec3;
use relievo::asset::material::Alpha;
use relievo::gpu::{Gpu, Uniform};
use relievo::render::{Layer, Renderer, TargetFormat};
use relievo::scene::{Camera, Placement, Quality, Relief, View};
use relievo::wgpu;
use relievo_samples::maps::BuiltInMap;

use crate::frame::{COLOR, Frame, device};
use crate::harness::{Difference, Tolerance};
use crate::raw::Raw;
use crate::rays::{cube, model, pixels_beside, plain};
use crate::world::{SIZE, World};

/// The crate's own shading, beside names of all kinds that the crate's shaders have too.
const REPEATED: &str = "
struct Vertex { color: vec3<f32> }
const CLUSTER = 1.0;
fn lambert(vertex: Vertex, view: View, direct: f32) -> vec3<f32> {
    return vertex.color * view.light_color * (view.ambient + (CLUSTER - view.ambient) * direct);
}
var<private> materials: f32 = 1.0;
fn shade(surface: Surface, view: View) -> vec4<f32> {
    let direct = max(dot(surface.normal, view.light), 0.0) * surface.sunlit;
    return vec4<f32>(lambert(Vertex(surface.color), view, direct), materials);
} // The end, without a new line";

/// Ground, characters, a wall with relief and self-shadow, and cubes that are cut out.
fn everything(gpu: &Gpu) -> (World, View) {
    let mut world = World::new(gpu, 6);
    let heights = BuiltInMap::Cobbles.height_map(64).expect("a map");
    let mut relief = Relief::wall(3.0, heights, BuiltInMap::Cobbles.albedo(64).expect("colours"));
    relief.options.shadow = relievo::ops::surface::ReliefShadow::Hard;
    let wall = world.scene.add_relief(&relief, 1).expect("added");
    let place = Placement::at([-6.0, 6.0, -4.0]).turned(0.5).scaled(6.0);
    world.scene.spawn(wall, place).expect("room");
    let material = plain([0.9, 0.3, 0.2, 0.6], Alpha::Dithered);
    let cubes = world.scene.add_mesh(&model(&cube(), material, true), 1).expect("added");
    world.scene.spawn(cubes, Placement::at([5.0, 7.0, -3.0]).turned(0.7).scaled(1.5)).expect("room");
    world.scene.set_tint(world.crowd[0], [0.4, 0.9, 1.0, 1.0]).expect("there");
    let light = relievo::asset::Light { color: Vec3::new(1.0, 0.9, 0.7), ..Default::default() };
    world.scene.set_light(light).expect("a light");
    let view = world.view(1.0);
    (world, view)
}

#[test]
fn shading_that_repeats_the_crates_own_gives_its_picture() {
    let gpu = device();
    let (mut world, mut view) = everything(&gpu);
    let frame = Frame::plain(&gpu, SIZE);
    let own = frame.renderer(&gpu, &world.scene);
    let expected = frame.shot(&mut world.scene, &mut view, &own);
    let shaded = |source: &str, world: &mut World, view: &mut View| {
        let renderer = Renderer::new(&gpu, &frame.format).expect("a format");
        let mut renderer = renderer.with_shading(source, None).expect("valid");
        renderer.prepare(&world.scene).expect("compiled");
        frame.shot(&mut world.scene, view, &renderer)
    };
    let same = Tolerance { levels: 1, outliers: 0.0, flip: 0.0005 };
    let found = Difference::of(&shaded(REPEATED, &mut world, &mut view), &expected, same.levels);
    println!("{found:?}");
    assert!(found.within(same), "{found:?}");
    // Another light is told from this one, and so is a picture without the relief's own shadow.
    for (from, to) in [("max(dot(", "min(dot("), (" * surface.sunlit", "")] {
        let other = shaded(&REPEATED.replace(from, to), &mut world, &mut view);
        assert!(!Difference::of(&other, &expected, same.levels).within(same), "{to}");
    }
}

/// In front of three cubes.
fn close() -> Camera {
    Camera::looking_at(Vec3::new(1.0, 4.0, 2.0), Vec3::new(0.0, 2.0, -6.0), 0.9, [0.5, 100.0], [96, 64])
}

/// A scene of three tinted cubes, each with a word.
fn cubes(gpu: &Gpu) -> (World, View) {
    let mut world = World::empty(gpu, 1);
    world.scene.set_visible(world.land, false).expect("terrain");
    let material = plain([0.5, 0.25, 1.0, 1.0], Alpha::Opaque);
    let cubes = world.scene.add_mesh(&model(&cube(), material, false), 3).expect("added");
    for at in 0..3 {
        let place = Placement::at([3.0 * at as f32 - 3.0, 2.0, -6.0]).turned(0.4 * at as f32);
        let instance = world.scene.spawn(cubes, place).expect("room");
        world.scene.set_user_data(instance, 10 + at).expect("there");
        world.scene.set_tint(instance, [1.0, 0.2 * at as f32, 0.6, 1.0]).expect("in range");
    }
    let mut view = world.scene.view(Quality::default()).expect("a view");
    view.set(close()).expect("a camera");
    (world, view)
}

/// What a shading returns for every pixel, in f32.
fn values(gpu: &Gpu, world: &mut World, view: &mut View, expression: &str) -> Vec<[f32; 4]> {
    let raw = Raw::new(gpu, TargetFormat::new(wgpu::TextureFormat::Rgba32Float), [96, 64]);
    let source = format!("fn shade(surface: Surface, view: View) -> vec4<f32> {{ return {expression}; }}");
    let renderer = Renderer::new(gpu, &raw.format).expect("a format");
    let mut renderer = renderer.with_shading(&source, None).expect("valid");
    renderer.prepare(&world.scene).expect("compiled");
    raw.frame(&mut world.scene, view, &renderer, &[Layer::Color]);
    raw.floats(gpu, 0)
}

/// What surfaces and views are given is what other layers write and what the host set.
#[test]
fn shading_knows_surfaces_and_views() {
    let gpu = device();
    let (mut world, mut view) = cubes(&gpu);
    let measure = Raw::new(&gpu, TargetFormat::measure(), [96, 64]);
    let renderer = measure.renderer(&gpu, &world.scene);
    measure.frame(&mut world.scene, &mut view, &renderer, &[Layer::Measure]);
    let (positions, ids) = (measure.floats(&gpu, 0), measure.words(&gpu, 1));
    let surfaces = Raw::new(&gpu, TargetFormat::surface(), [96, 64]);
    let renderer = surfaces.renderer(&gpu, &world.scene);
    surfaces.frame(&mut world.scene, &mut view, &renderer, &[Layer::Surface]);
    let normals = surfaces.floats(&gpu, 0);
    let mut of = |expression: &str| values(&gpu, &mut world, &mut view, expression);
    let places = of("vec4<f32>(surface.position, surface.alpha)");
    let facing = of("vec4<f32>(surface.normal, dot(surface.normal, surface.geometric_normal))");
    let numbers =
        of("vec4<f32>(f32(surface.object), f32(surface.instance), f32(surface.user_data), surface.sunlit)");
    let pixels = of("vec4<f32>(surface.pixel, surface.uv)");
    let tints = of("surface.tint");
    let colors = of("vec4<f32>(surface.color, 1.0)");
    let lights = of("vec4<f32>(view.light * view.ambient, view.light_color.z)");
    let eyes = of("view.eye + vec4<f32>(vec3<f32>(view.cell), 0.0)");
    let clips = of("view.clip_from_world * vec4<f32>(surface.position, 1.0)");
    let light = relievo::asset::Light::default();
    let (eye, toward) = (close().eye_offset(), light.direction.normalize() * light.ambient);
    let near = |found: [f32; 4], wanted: [f32; 4], bound: f32| {
        found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() <= bound)
    };
    let mut seen = [0; 3];
    for (at, id) in ids.iter().enumerate().filter(|(_, id)| id[0] != 0) {
        seen[id[1] as usize] += 1;
        let [x, y] = [at % 96, at / 96].map(|edge| edge as f32 + 0.5);
        let [_, green, ..] = tints[at];
        assert!(near(places[at], positions[at], 1e-5), "{at}");
        assert!(near(facing[at], [normals[at][0], normals[at][1], normals[at][2], 1.0], 5e-4), "{at}");
        assert_eq!(numbers[at], [id[0] as f32, id[1] as f32, (10 + id[1]) as f32, 1.0]);
        assert!(pixels[at][..2] == [x, y] && pixels[at][2..].iter().all(|uv| uv.abs() < 1.001), "{at}");
        assert!(near(tints[at], [1.0, 0.2 * id[1] as f32, 0.6, 1.0], 0.002), "{:?}", tints[at]);
        assert!(near(colors[at], [0.5, 0.25 * green, 0.6, 1.0], 1e-5), "{:?}", colors[at]);
        assert!(near(lights[at], toward.extend(1.0).into(), 1e-5), "{:?}", lights[at]);
        assert!(near(eyes[at], eye.extend(1.0).into(), 1e-4), "{:?}", eyes[at]);
        let clip = clips[at];
        let place = [0.5 + 0.5 * clip[0] / clip[3], 0.5 - 0.5 * clip[1] / clip[3]];
        let off = [96.0 * place[0] - x, 64.0 * place[1] - y];
        assert!(off.iter().all(|off| off.abs() < 1e-3 + pixels_beside() as f32), "{place:?}");
    }
    assert!(seen.iter().all(|pixels| *pixels > 30), "{seen:?}");
}

/// A uniform and a texture of the caller's in bind group 3, which stays set from object to object.
#[test]
fn group_three_is_the_callers() {
    let gpu = device();
    let (mut world, mut view) = cubes(&gpu);
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    };
    let buffer = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let texture = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    let layout = gpu.device().create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("the program's"),
        entries: &[entry(0, buffer), entry(1, texture)],
    });
    let tone = Uniform::new(&gpu, "tone", &glam::Vec4::new(0.25, 0.5, 0.75, 1.0)).expect("uploaded");
    let image = gpu.device().create_texture(&wgpu::TextureDescriptor {
        label: Some("the program's"),
        size: wgpu::Extent3d { width: 3, height: 1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let texels: Vec<u8> = [1.0_f32, 2.0, 4.0].iter().flat_map(|value| value.to_le_bytes()).collect();
    gpu.queue().write_texture(image.as_image_copy(), &texels, Default::default(), image.size());
    let group = gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("the program's"),
        layout: &layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: tone.raw().as_entire_binding() },
            wgpu::BindGroupEntry {
                binding: 1,
                resource: wgpu::BindingResource::TextureView(&image.create_view(&Default::default())),
            },
        ],
    });
    let source = "@group(3) @binding(0) var<uniform> tone: vec4<f32>;
@group(3) @binding(1) var ramp: texture_2d<f32>;
fn shade(surface: Surface, view: View) -> vec4<f32> {
    return tone * textureLoad(ramp, vec2<u32>(surface.user_data - 10u, 0u), 0).x;
}";
    let raw = Raw::new(&gpu, TargetFormat::new(wgpu::TextureFormat::Rgba32Float), [96, 64]);
    let renderer = Renderer::new(&gpu, &raw.format).expect("a format");
    let mut renderer = renderer.with_shading(source, Some(&layout)).expect("valid");
    renderer.prepare(&world.scene).expect("compiled");
    let mut encoder = gpu.encoder("frame");
    world.scene.record(&mut encoder, &mut [&mut view]).expect("recorded");
    raw.pass(&mut encoder, |pass| {
        pass.set_bind_group(3, &group, &[]);
        renderer.draw(pass, &world.scene, &view, Layer::Color).expect("drawn");
    });
    gpu.queue().submit([encoder.finish()]);
    let found = raw.floats(&gpu, 0);
    let count = |factor: f32| {
        let wanted = [0.25, 0.5, 0.75, 1.0].map(|value: f32| value * factor);
        found.iter().filter(|color| **color == wanted).count()
    };
    let counts = [1.0, 2.0, 4.0].map(count);
    let drawn = found.iter().filter(|color| **color != [0.0; 4]).count();
    assert!(counts.iter().all(|pixels| *pixels > 30) && counts.iter().sum::<usize>() == drawn, "{counts:?}");
}

/// The alpha that a shading returns is what the format's blending uses.
#[test]
fn alpha_is_blended_as_the_format_says() {
    let gpu = device();
    let (mut world, mut view) = cubes(&gpu);
    let mut format = TargetFormat::new(wgpu::TextureFormat::Rgba8Unorm);
    format.color[0].as_mut().expect("a colour").blend = Some(wgpu::BlendState::ALPHA_BLENDING);
    let mut raw = Raw::new(&gpu, format, [96, 64]);
    raw.clear = wgpu::Color { r: 1.0, g: 0.0, b: 0.0, a: 1.0 };
    let source =
        "fn shade(surface: Surface, view: View) -> vec4<f32> { return vec4<f32>(0.0, 1.0, 0.0, 0.25); }";
    let renderer = Renderer::new(&gpu, &raw.format).expect("a format");
    let mut renderer = renderer.with_shading(source, None).expect("valid");
    renderer.prepare(&world.scene).expect("compiled");
    raw.frame(&mut world.scene, &mut view, &renderer, &[Layer::Color]);
    let found = raw.floats(&gpu, 0);
    let is = |color: &[f32; 4], wanted: [f32; 3]| {
        color.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 0.005)
    };
    let mixed = found.iter().filter(|color| is(color, [0.75, 0.25, 0.0])).count();
    let clear = found.iter().filter(|color| is(color, [1.0, 0.0, 0.0])).count();
    assert!(mixed > 100 && mixed + clear == found.len(), "{mixed} and {clear} of {}", found.len());
}

/// Texts, with the line and the column of their mistake, and a word of its reason.
fn mistakes() -> Vec<(String, usize, usize, &'static str)> {
    let good = GOOD;
    vec![
        (
            "fn shade(surface: Surface, view: View) -> vec4<f32> {\n    return vec3<f32>(1.0)\n}".to_owned(),
            3,
            1,
            ";",
        ),
        (format!("// One\n  fn f() -> f32 {{ return unknown; }}\n{good}"), 2, 26, "unknown"),
        (format!("{good}\n\nfn f(a: f32) -> f32 {{ return 1u; }}"), 3, 30, "return"),
        (format!("{good}\nfn f(view: View) -> f32 {{ return view.nothing; }}"), 2, 39, "nothing"),
        ("fn shade(surface: Surface) -> vec4<f32> { return vec4<f32>(1.0); }".to_owned(), 1, 1, "view: View"),
        (good.replace("shade", "paint"), 1, 1 + good.len(), "fn shade"),
        (
            good.replace("-> vec4<f32> { return vec4<f32>", "-> vec3<f32> { return vec3<f32>"),
            1,
            1,
            "vec4<f32>",
        ),
        (
            format!("fn f() {{\n    discard;\n}}\n{}", good.replace("{ return", "{ f(); return")),
            2,
            5,
            "discard",
        ),
        (good.replace("{ return", "{ if view.ambient > 2.0 { discard; } return"), 1, 79, "discard"),
        (format!("override X: f32 = 1.0;\n{good}"), 1, 1, "override"),
        (format!("{good}\n@fragment fn main() {{}}"), 2, 14, "entry points"),
        (format!("@group(0) @binding(9) var<uniform> a: vec4<f32>;\n{good}"), 1, 23, "group 3"),
        (format!("{good}\nstruct Surface {{ a: f32 }}"), 2, 8, "Surface"),
        (format!("fn relievo_f() {{}}\n{good}"), 1, 4, "relievo_"),
        (format!("{good}\nvar<private> relievo_a: f32 = 1.0;"), 2, 14, "relievo_"),
        (format!("/* relievo_a\n/* */ */ const relievo_b = 1.0;\n{good}"), 2, 16, "relievo_"),
        (format!("{good}\nconst relievo_typed: f32 = 1.0;"), 2, 7, "relievo_"),
        (format!("override relievo_c: f32 = 1.0;\n{good}"), 1, 10, "relievo_"),
        (format!("alias relievo_T = f32;\n{good}"), 1, 7, "relievo_"),
        (format!("struct relievo_S {{ a: f32 }}\n{good}"), 1, 8, "relievo_"),
        (good.replace("{ return", "{ let relievo_d = 1.0; return"), 1, 59, "relievo_"),
        (format!("{good}\n/* open"), 2, 1, "comment"),
        (format!("{good}\nfn f() -> f32 {{ return relievo_lambert(1.0); }}"), 2, 24, "relievo_lambert"),
    ]
}

const GOOD: &str = "fn shade(surface: Surface, view: View) -> vec4<f32> { return vec4<f32>(1.0); }";

/// A layout that does not fit the text, or the device, is refused before anything is drawn.
#[test]
fn layouts_that_do_not_fit_are_refused() {
    let gpu = device();
    let renderer = || Renderer::new(&gpu, &TargetFormat::new(COLOR)).expect("a format");
    let layout = |entries: &[(u32, wgpu::BindingType)]| {
        let entry = |(binding, ty): &(u32, wgpu::BindingType)| wgpu::BindGroupLayoutEntry {
            binding: *binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: *ty,
            count: None,
        };
        let entries: Vec<_> = entries.iter().map(entry).collect();
        let descriptor = wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries };
        gpu.device().create_bind_group_layout(&descriptor)
    };
    let buffer = |ty| wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    let (uniform, sampler) = (
        buffer(wgpu::BufferBindingType::Uniform),
        wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
    );
    let text = "@group(3) @binding(2) var<uniform> tone: vec4<f32>;
fn shade(surface: Surface, view: View) -> vec4<f32> { return tone; }";
    let wrong =
        |entries: &[(u32, wgpu::BindingType)]| match renderer().with_shading(text, Some(&layout(entries))) {
            Ok(_) => "nothing".to_owned(),
            Err(relievo::Error::Input(error)) => error.path,
            Err(other) => panic!("no input error: {other}"),
        };
    let many: Vec<_> = (0..9).map(|at| (at, uniform)).collect();
    let cases = [
        (wrong(&[]), "shading.layout"),
        (wrong(&[(1, uniform)]), "shading.layout"),
        (wrong(&[(2, sampler)]), "shading.layout"),
        (wrong(&many), "shading.layout"),
        (wrong(&many[..8]), "nothing"),
        (wrong(&[(2, uniform)]), "nothing"),
    ];
    for (at, (found, wanted)) in cases.iter().enumerate() {
        assert_eq!(found, wanted, "{at}");
    }
}

/// Each mistake is told with its own line and column, and a word of its reason.
#[test]
fn mistakes_are_told_with_their_lines() {
    let gpu = device();
    let renderer = || Renderer::new(&gpu, &TargetFormat::new(COLOR)).expect("a format");
    let layout =
        gpu.device().create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &[] });
    let mut wrong = Vec::new();
    for (source, line, column, word) in mistakes() {
        let error = input(renderer().with_shading(&source, Some(&layout)));
        let is_near = error.path == format!("shading:{line}:{column}") && error.bound.contains(word);
        if !is_near {
            wrong.push(format!("{source:?}: {error:?}, not {line}:{column} {word}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let bound = format!("@group(3) @binding(0) var<uniform> a: vec4<f32>;\n{GOOD}");
    let error = input(renderer().with_shading(&bound, None));
    assert!(error.bound.contains("no layout"), "{error}");
    for text in [GOOD.to_owned(), format!("// relievo_a\nconst my_relievo_a = 1.0; /* relievo_b */\n{GOOD}")]
    {
        renderer().with_shading(&text, None).expect(&text);
    }
    let error = input(renderer().with_shading(&GOOD.replace("shade", "paint"), None));
    assert_eq!(error.value, "no function `shade`");
}

/// The mistake of the caller's.
fn input(result: Result<Renderer, relievo::Error>) -> relievo::InputError {
    match result.expect_err("refused") {
        relievo::Error::Input(error) => error,
        other => panic!("no input error: {other}"),
    }
}
