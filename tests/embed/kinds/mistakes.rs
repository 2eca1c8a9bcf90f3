//! Mistakes of callers in kinds are told by the place in their text, or by the field.

use std::iter;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

use relievo::gpu::Gpu;
use relievo::ops::skinning::bounding_sphere::BoundingSphere;
use relievo::render::{OutputProgram, Renderer, TargetFormat};
use relievo::scene::kind::{Kind, KindFrame, KindPart, KindProgram, KindUploads};
use relievo::scene::{Camera, Placement, Quality, Scene};
use relievo::{Error, wgpu};
use wgpu::util::{BufferInitDescriptor, DeviceExt as _};

use crate::frame::{device, devices};

/// A square of one part.
#[derive(Debug)]
pub struct Card {
    program: KindProgram,
    indices: wgpu::Buffer,
    parts: Vec<KindPart>,
    pub errors: Vec<f32>,
    pub radius: f32,
    /// Whether `upload` fails, and the frames that it was asked for.
    pub fails: Arc<AtomicBool>,
    pub frames: Arc<Mutex<Vec<KindFrame>>>,
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
        Self {
            program: program.clone(),
            indices,
            parts: vec![part(own)],
            errors: vec![0.0],
            radius: 1.5,
            fails: Arc::default(),
            frames: Arc::default(),
        }
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

    fn upload(&mut self, frame: &KindFrame, uploads: &mut KindUploads<'_>) -> Result<(), Error> {
        if self.fails.load(Ordering::Relaxed) {
            // Indices cannot be written to.
            return uploads.write(&self.indices, 0, &[0; 4]);
        }
        self.frames.lock().expect("no panic").push(*frame);
        Ok(())
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

/// Two variables of one binding.
const TWICE: &str = "@group(2) @binding(0) var<uniform> card_x: f32;
@group(2) @binding(0) var<uniform> card_y: f32;
";
const USED: &str = "    var surface = relievo_scene_surface(in);
    surface.alpha = card_x;
    return surface;";

#[test]
fn mistakes_in_a_text_are_told_by_their_place() {
    let good = format!("{PLACE}{SURFACE}");
    KindProgram::new("card", &good).expect("valid");
    let cases: [(&str, String, &str, &str); 19] = [
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
        ("card", format!("{good}const card = 1;"), "kind:7:7", "must begin with `card`"),
        ("card", format!("{good}fn größe() {{}}"), "kind:7:4", "must begin with `card`"),
        ("card", format!("diagnostic(off, derivative_uniformity);\n{good}"), "kind:1:1", "directive"),
        ("card", format!("{good}var<workgroup> card_w: f32;"), "kind:7:", "workgroup"),
        (
            "card",
            format!("{TWICE}{good}").replace("    return relievo_scene_surface(in);", USED),
            "kind:",
            "own",
        ),
    ];
    // Comments are no code, in any script.
    let noted = format!("/* {{ größe */ {good}// fn shade( struct UvTargets {{ }}\n");
    KindProgram::new("card", &noted).expect("valid");
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
    let cases: [(&str, String, &str, &str); 12] = [
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
        ("uv", UV.replace("location(0)", "location(1)"), "output:1:", "@location(0)"),
        ("uv", UV.replace("@location(0)", "@builtin(frag_depth)").replace("vec4<f32>", "f32"), "output:", ""),
        ("uv", UV.replace("vec4<f32>,", "f16,"), "output:", ""),
        (
            "uv",
            format!("alias UvTargets = UvTarget;\n{}", UV.replace("struct UvTargets", "struct UvTarget")),
            "output:",
            "",
        ),
    ];
    let noted = UV.replace("struct UvTargets {", "struct UvTargets/* } */\n{ // , @ größe }");
    assert_eq!(OutputProgram::new("uv", &noted).expect("valid").colors(), 1);
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
    let [gpu, beside] = devices();
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
    // What another device has, of the same instance of wgpu and of another.
    for other in [beside, device()] {
        let foreign = Card::new(&other, &program, |part| part);
        assert_eq!(refused(&|card| card.indices = foreign.indices.clone()), "kind.indices");
        assert_eq!(refused(&|card| card.parts = foreign.parts.clone()), "kind.parts[0].group");
    }
}

fn vertices(gpu: &Gpu) -> wgpu::Buffer {
    gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: 64,
        usage: wgpu::BufferUsages::VERTEX,
        mapped_at_creation: false,
    })
}

/// A kind whose upload fails draws nothing stale: the frame is not recorded, and the next one starts afresh.
#[test]
fn a_failed_upload_is_told_and_done_again() {
    let gpu = device();
    let program = KindProgram::new("card", &format!("{PLACE}{SURFACE}")).expect("valid");
    let card = Card::new(&gpu, &program, |part| part);
    let (fails, frames) = (card.fails.clone(), card.frames.clone());
    let mut scene = Scene::new(&gpu).expect("compiled");
    let object = scene.add_kind(card, 1).expect("added");
    scene.spawn(object, Placement::default()).expect("room");
    let mut view = scene.view(Quality::default()).expect("a view");
    let eye = glam::Vec3::new(0.0, 0.0, 5.0);
    view.set(Camera::looking_at(eye, glam::Vec3::ZERO, 0.8, [0.1, 50.0], [64, 64])).expect("a camera");
    let mut frame = |scene: &mut Scene| {
        scene.advance(0.5).expect("finite");
        let mut encoder = gpu.encoder("frame");
        let recorded = scene.record(&mut encoder, &mut [&mut view]);
        gpu.queue().submit([encoder.finish()]);
        recorded
    };
    frame(&mut scene).expect("recorded");
    frame(&mut scene).expect("recorded");
    fails.store(true, Ordering::Relaxed);
    let error = frame(&mut scene).expect_err("a failed upload").to_string();
    assert!(error.starts_with("buffer.usage"), "{error}");
    fails.store(false, Ordering::Relaxed);
    frame(&mut scene).expect("recorded");
    frame(&mut scene).expect("recorded");
    scene.refresh().expect("afresh");
    frame(&mut scene).expect("recorded");
    // More than there is room for.
    for _ in 0..70 {
        scene.spawn(object, Placement::default()).expect("room");
    }
    frame(&mut scene).expect("recorded");
    let frames = frames.lock().expect("no panic");
    let fresh: Vec<bool> = frames.iter().map(|frame| frame.is_fresh).collect();
    assert_eq!(fresh, [true, false, true, false, true, true]);
    assert_eq!((frames[1].seconds, frames[1].last_seconds), (1.0, 0.5));
}

/// Texts of the caller's that declare a name twice are refused before anything is compiled.
#[test]
fn names_that_two_texts_declare_are_told() {
    let gpu = device();
    let program =
        KindProgram::new("uv", &format!("{PLACE}{SURFACE}fn uv_write() {{}}").replace("card", "uv"));
    let uv = OutputProgram::new("uv", UV).expect("valid");
    let mut scene = Scene::new(&gpu).expect("compiled");
    scene.add_kind(Card::new(&gpu, &program.expect("valid"), |part| part), 1).expect("added");
    let format = TargetFormat::of_output(&uv, &[wgpu::TextureFormat::Rgba16Float]);
    let mut renderer = Renderer::new(&gpu, &format).expect("a format");
    let error = renderer.prepare(&scene).expect_err("refused").to_string();
    assert!(error.starts_with("uv.name = `uv_write`") && error.contains("the output"), "{error}");
    let shade =
        "fn uv_place() {} fn shade(surface: Surface, view: View) -> vec4<f32> { return vec4<f32>(1.0); }";
    let renderer =
        Renderer::new(&gpu, &TargetFormat::new(wgpu::TextureFormat::Rgba8Unorm)).expect("a format");
    let mut renderer = renderer.with_shading(shade, None).expect("valid");
    let error = renderer.prepare(&scene).expect_err("refused").to_string();
    assert!(error.starts_with("uv.name = `uv_place`") && error.contains("the shading"), "{error}");
}
