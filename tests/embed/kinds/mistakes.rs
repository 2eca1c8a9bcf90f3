//! Mistakes of callers in kinds are told by the place in their text, or by the field.

use std::iter;

use relievo::gpu::Gpu;
use relievo::render::{OutputProgram, Renderer, TargetFormat};
use relievo::scene::Scene;
use relievo::scene::kind::{Kind, KindPart, KindProgram};
use relievo::skinning::bounding_sphere::BoundingSphere;
use relievo::{Error, wgpu};
use wgpu::util::{BufferInitDescriptor, DeviceExt as _};

use crate::frame::device;

/// A square of one part.
#[derive(Debug)]
pub struct Card {
    program: KindProgram,
    indices: wgpu::Buffer,
    parts: Vec<KindPart>,
    pub errors: Vec<f32>,
    pub radius: f32,
}

impl Card {
    pub fn new(gpu: &Gpu, program: &KindProgram, part: impl Fn(KindPart) -> KindPart) -> Self {
        let usage = wgpu::BufferUsages::INDEX;
        let contents: Vec<u8> = [0_u32, 1, 2, 2, 1, 3].iter().flat_map(|index| index.to_le_bytes()).collect();
        let indices = gpu.device().create_buffer_init(&BufferInitDescriptor {
            label: Some("card"),
            contents: &contents,
            usage,
        });
        let own = KindPart::new(program.bind(gpu, &[]).expect("nothing to bind"), iter::once(0..6).collect());
        Self { program: program.clone(), indices, parts: vec![part(own)], errors: vec![0.0], radius: 1.5 }
    }
}

impl Kind for Card {
    fn program(&self) -> &KindProgram {
        &self.program
    }

    fn indices(&self) -> &wgpu::Buffer {
        &self.indices
    }

    fn parts(&self) -> &[KindPart] {
        &self.parts
    }

    fn errors(&self) -> &[f32] {
        &self.errors
    }

    fn bounding_sphere(&self) -> BoundingSphere {
        BoundingSphere { center: glam::Vec3::ZERO, radius: self.radius }
    }

    fn rebuild(&self, gpu: &Gpu) -> Result<Box<dyn Kind>, Error> {
        Ok(Box::new(Self::new(gpu, &self.program, |part| part)))
    }
}

const PLACE: &str = "fn card_place(entry: u32, vertex: u32) -> relievo_SceneVertex {
    return relievo_scene_placed(entry, vec3<f32>(), vec3<f32>(0.0, 1.0, 0.0), vec4<f32>(1.0), vec4<f32>());
}
";
const SURFACE: &str = "fn card_surface(in: relievo_SceneFragment) -> Surface {
    return relievo_scene_surface(in);
}
";

#[test]
fn mistakes_in_a_text_are_told_by_their_place() {
    let good = format!("{PLACE}{SURFACE}");
    KindProgram::new("card", &good).expect("valid");
    let cases: [(&str, String, &str, &str); 14] = [
        ("Card", good.clone(), "kind.name", "lower-case"),
        ("card", SURFACE.to_owned(), "kind:4:1", "must be `fn card_place(entry: u32, vertex: u32)"),
        (
            "card",
            PLACE.to_owned(),
            "kind:4:1",
            "must be `fn card_surface(in: relievo_SceneFragment) -> Surface`",
        ),
        ("card", good.replace("card_surface", "surface"), "kind:4:4", "must begin with `card`"),
        ("card", format!("{good}const relievo_card = 1;"), "kind:7:7", "must begin with `card`"),
        ("card", good.replace("vec4<f32>(1.0)", "vec3<f32>(1.0)"), "kind:2:", ""),
        ("card", good.replace("scene_surface", "scene_surfaces"), "kind:5:", "relievo_scene_surfaces"),
        (
            "card",
            good.replace("vertex: u32", "vertex: f32"),
            "kind:7:1",
            "fn card_place(entry: u32, vertex: u32)",
        ),
        (
            "card",
            format!("@group(1) @binding(0) var<uniform> card_x: f32;\n{good}"),
            "kind:1:",
            "bind group 2",
        ),
        (
            "card",
            format!("@group(2) @binding(0) var<storage, read_write> card_x: array<f32>;\n{good}"),
            "kind:1:",
            "storage buffer that is read",
        ),
        ("card", format!("{good}fn card_more() -> f32 {{ return 1; \n"), "kind:8:1", ""),
        ("card", format!("{good}@fragment fn card_more() {{}}\n"), "kind:7:", "entry point"),
        ("card", format!("{good}override CARD_X = 1.0;\n"), "kind:7:", "override"),
        (
            "card",
            good.replace(
                "    return relievo_scene_surface",
                "    discard;\n    return relievo_scene_surface",
            ),
            "kind:5:5",
            "must not discard",
        ),
    ];
    for (name, text, path, bound) in cases {
        let error = KindProgram::new(name, &text).expect_err(&text);
        assert!(error.path.starts_with(path), "{error}\n{text}");
        assert!(error.to_string().contains(bound), "{error}\n{text}");
    }
}

const UV: &str = "struct UvTargets {
    @location(0) uv: vec4<f32>,
}
fn uv_write(surface: Surface) -> UvTargets {
    return UvTargets(vec4<f32>(surface.uv, 0.0, 1.0));
}
";

#[test]
fn mistakes_in_an_output_are_told_by_their_place() {
    let uv = OutputProgram::new("uv", UV).expect("valid");
    let cases: [(&str, String, &str, &str); 8] = [
        ("uv_2", UV.to_owned(), "output.name", "letters and digits"),
        (
            "uv",
            UV.replace("uv_write", "uv_writes"),
            "output:7:1",
            "fn uv_write(surface: Surface) -> UvTargets",
        ),
        ("uv", UV.replace("UvTargets", "UvTarget"), "output:7:1", "struct UvTargets"),
        ("uv", format!("{UV}fn more() {{}}\n"), "output:7:4", "must begin with `uv`"),
        ("uv", UV.replace("surface.uv,", "surface.xy,"), "output:5:", ""),
        (
            "uv",
            format!("{UV}@group(3) @binding(0) var<uniform> uv_x: f32;\n"),
            "output:7:",
            "must not be bound",
        ),
        ("uv", UV.replace("    return", "    discard;\n    return"), "output:5:5", "must not discard"),
        ("uv", UV.replace("surface: Surface", "surface: f32"), "output:", ""),
    ];
    for (name, text, path, bound) in cases {
        let error = OutputProgram::new(name, &text).expect_err(&text);
        assert!(error.path.starts_with(path), "{error}\n{text}");
        assert!(error.to_string().contains(bound), "{error}\n{text}");
    }
    let format = TargetFormat::of_output(&uv, &[]);
    assert_eq!(format.validate().expect_err("refused").path, "format.color[0]");
    // Colours of another kind than the text writes.
    let gpu = device();
    let format = TargetFormat::of_output(&uv, &[wgpu::TextureFormat::Rgba16Uint]);
    let mut renderer = Renderer::new(&gpu, &format).expect("a format");
    let mut scene = Scene::new(&gpu).expect("compiled");
    let program = KindProgram::new("card", &format!("{PLACE}{SURFACE}")).expect("valid");
    scene.add_kind(Card::new(&gpu, &program, |part| part), 1).expect("added");
    let error = renderer.prepare(&scene).expect_err("refused").to_string();
    assert!(error.contains("Rgba16Uint") || error.contains("Uint"), "{error}");
}

#[test]
fn what_a_kind_says_of_itself_is_checked_by_field() {
    let gpu = device();
    let program = KindProgram::new("card", &format!("{PLACE}{SURFACE}")).expect("valid");
    let mut scene = Scene::new(&gpu).expect("compiled");
    let mut refused = |change: &dyn Fn(&mut Card)| {
        let mut card = Card::new(&gpu, &program, |part| part);
        change(&mut card);
        match scene.add_kind(card, 1).expect_err("refused") {
            Error::Input(error) => error.path,
            other => other.to_string(),
        }
    };
    assert_eq!(refused(&|card| card.errors = vec![]), "kind.errors.len");
    assert_eq!(refused(&|card| card.errors = vec![0.5]), "kind.errors[0]");
    assert_eq!(refused(&|card| card.errors = vec![0.0, 0.2, 0.1]), "kind.errors[2]");
    assert_eq!(refused(&|card| card.errors = vec![0.0, f32::NAN]), "kind.errors[1]");
    assert_eq!(refused(&|card| card.errors = vec![0.0, 1.0]), "kind.parts[0].levels.len");
    assert_eq!(refused(&|card| card.radius = -1.0), "kind.bounding_sphere");
    assert_eq!(refused(&|card| card.parts.clear()), "kind.parts.len");
    assert_eq!(refused(&|card| card.parts[0].levels = iter::once(0..7).collect()), "kind.parts[0].levels[0]");
    assert_eq!(refused(&|card| card.parts[0].levels = iter::once(0..9).collect()), "kind.parts[0].levels[0]");
    assert_eq!(refused(&|card| card.indices = vertices(&gpu)), "kind.indices.usage");
}

fn vertices(gpu: &Gpu) -> wgpu::Buffer {
    gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 64,
        usage: wgpu::BufferUsages::VERTEX,
        mapped_at_creation: false,
    })
}
