//! Every kind of pipeline compiles for every kind of target, and draws into render passes and bundles of that target.

use glam::Vec3;
use wgpu::TextureFormat as Format;

use super::mesh::{mesh, painted, placements};
use super::stage::{Canvas, FORMAT, SIZE, Stage, differing, drawn, gpu, renderer, view};
use crate::Error;
use crate::asset::material::Alpha;
use crate::render::renderer::pipelines::PipelineKey;
use crate::render::{DepthFormat, TargetFormat};
use crate::render::{Layer, Renderer};
use crate::scene::TerrainStyle;
use crate::scene::layouts::SceneLayouts;
use crate::scene::specialization::{PartState, Program, Specialization};
use crate::surface::{Green, ReliefMethod, ReliefOptions, ReliefShadow};

/// Parts that cover every entry point and both values of every flag. A part of a relief comes with its method.
fn parts() -> Vec<(Option<ReliefMethod>, Specialization)> {
    let flags = || [false, true].into_iter();
    let states = flags().flat_map(|cut_out| {
        flags().map(move |double_sided| PartState { cut_out, double_sided, ..PartState::default() })
    });
    let meshes = states.flat_map(|state| {
        let mesh = move |textured, normal_mapped| {
            (None, Specialization::mesh(state, textured, normal_mapped, false))
        };
        flags().flat_map(move |textured| flags().map(move |normal_mapped| mesh(textured, normal_mapped)))
    });
    let reliefs = ReliefMethod::ALL.into_iter().flat_map(|method| {
        [
            (ReliefShadow::None, None, false),
            (ReliefShadow::Hard, Some(Green::Up), true),
            (ReliefShadow::Soft, Some(Green::Down), true),
        ]
        .map(|(shadow, normal_map, set)| {
            let options = ReliefOptions { method, shadow, normal_map, silhouette: set, depth: set, mip: set };
            (Some(method), Specialization::relief(&options, set))
        })
    });
    let styles = [TerrainStyle::Textured, TerrainStyle::Wireframe];
    let grounds = styles
        .into_iter()
        .flat_map(|style| [false, true].map(|cut_out| Specialization::terrain(style, cut_out)));
    meshes.chain(reliefs).chain(grounds.map(|ground| (None, ground))).collect()
}

fn formats() -> Vec<TargetFormat> {
    let depth = |format, reversed| Some(DepthFormat { format, reversed });
    let blended = wgpu::ColorTargetState {
        format: Format::Bgra8Unorm,
        blend: Some(wgpu::BlendState::ALPHA_BLENDING),
        write_mask: wgpu::ColorWrites::COLOR,
    };
    vec![
        TargetFormat::new(FORMAT).with_samples(4).reversed(),
        TargetFormat::new(Format::Rgba16Float)
            .with_color(None)
            .with_color(Some(Format::Rg16Uint.into()))
            .with_depth(depth(Format::Depth24PlusStencil8, true)),
        TargetFormat { color: vec![Some(blended)], ..TargetFormat::new(FORMAT) }
            .with_depth(depth(Format::Depth24Plus, false))
            .with_samples(4),
        TargetFormat::new(Format::Rgba32Float).with_depth(None),
        TargetFormat::new(Format::R8Unorm).with_depth(depth(Format::Depth16Unorm, false)),
        TargetFormat::depth_only(Format::Depth32Float),
        TargetFormat::depth_only(Format::Depth16Unorm).with_samples(4).reversed(),
    ]
}

#[test]
fn every_kind_of_pipeline_compiles_for_every_format() {
    let gpu = gpu();
    for (at, format) in formats().into_iter().enumerate() {
        let renderer = Renderer::new(&gpu, &format).expect("a format");
        for layer in format.layers() {
            // All methods of reliefs, and parts in shadow, are tested in one format only. Only meshes can be blended.
            let is_first = at == 0;
            let parts = parts().into_iter().filter(|(method, part)| match layer {
                Layer::Transparent => *part.program() == Program::Mesh,
                _ => method.is_none_or(|method| is_first || method == ReliefMethod::Quadtree),
            });
            for (_, part) in parts {
                let key = PipelineKey::new(layer, &part, true);
                let shadowed = is_first.then(|| key.clone().shadowed(true));
                for key in std::iter::once(key).chain(shadowed) {
                    let source = key.source(&format, false);
                    let pipeline = source.compiled(&gpu, &format, &renderer.layouts, None);
                    assert!(pipeline.is_ok(), "{format:?} {key:?}: {:?}", pipeline.err());
                }
            }
        }
    }
}

#[test]
fn renderers_of_a_device_share_pipelines_without_callers_text() {
    let gpu = gpu();
    let part = Specialization::mesh(PartState::default(), true, false, false);
    let plain = || Renderer::new(&gpu, &TargetFormat::new(FORMAT)).expect("a format");
    let shaded = |color: &str| {
        let text =
            format!("fn shade(surface: Surface, view: View) -> vec4<f32> {{ return vec4<f32>({color}); }}");
        plain().with_shading(&text, None).expect("valid")
    };
    let pipeline = |mut renderer: Renderer, part: &Specialization, layer| {
        let key = PipelineKey::new(layer, part, false);
        renderer.compile(key.clone()).expect("compiled");
        renderer.pipelines[&key].clone()
    };
    let color = |renderer| pipeline(renderer, &part, Layer::Color);
    let first = color(plain());
    assert!(color(plain()) == first);
    assert!(pipeline(shaded("1.0"), &part, Layer::Depth) == pipeline(plain(), &part, Layer::Depth));
    let format = TargetFormat::new(FORMAT).with_samples(4);
    let cut_out = PartState { cut_out: true, ..PartState::default() };
    let others = [
        color(Renderer::new(&gpu, &format).expect("a format")),
        color(plain().casting()),
        color(shaded("1.0")),
        color(shaded("0.5")),
        pipeline(plain(), &part, Layer::Depth),
        pipeline(plain(), &Specialization::mesh(cut_out, true, false, false), Layer::Color),
    ];
    for (at, pipeline) in others.iter().enumerate() {
        assert!(*pipeline != first && !others[..at].contains(pipeline), "{at}");
    }
}

#[test]
fn what_the_device_does_not_allow_of_a_format_is_refused_by_name() {
    let gpu = gpu();
    // Formats of 32-bit floats allow no blending and no multisampling.
    let blended = wgpu::ColorTargetState {
        format: Format::Rgba32Float,
        blend: Some(wgpu::BlendState::ALPHA_BLENDING),
        write_mask: wgpu::ColorWrites::ALL,
    };
    let refused = |format: &TargetFormat| match Renderer::new(&gpu, format) {
        Err(crate::Error::Input(error)) => error.path,
        other => format!("{other:?}"),
    };
    let format = TargetFormat { color: vec![Some(blended)], ..TargetFormat::new(FORMAT) };
    assert_eq!(refused(&format), "format.color[0].blend");
    assert_eq!(refused(&TargetFormat::new(Format::Rgba32Float).with_samples(4)), "format.samples");
}

#[test]
fn a_bundle_draws_what_a_pass_draws_and_other_colors_stay() {
    let gpu = gpu();
    let layouts = SceneLayouts::new(&gpu).expect("valid");
    let (drawable, indices) = mesh(&gpu, &layouts, &painted(Alpha::Mask(0.5), false), 3);
    let seen = view(Vec3::new(0.4, 0.8, 4.5), true);
    let stage = Stage::new(&gpu, &layouts, seen, &placements(), &[[0, indices]]);
    let format = TargetFormat::new(FORMAT)
        .with_color(Some(Format::Rgba8Unorm.into()))
        .with_depth(Some(DepthFormat { format: Format::Depth24PlusStencil8, reversed: true }));
    let expected =
        drawn(&gpu, &TargetFormat::new(FORMAT).reversed(), &drawable, &stage, None, &[Layer::Color]);
    let renderer = renderer(&gpu, &format, &drawable);
    let canvas = Canvas::new(&gpu, &format);
    let found = canvas.draw(&gpu, |pass| {
        for layer in [Layer::Depth, Layer::Color] {
            let object = stage.object(&drawable, None);
            renderer.draw_objects(pass, &stage.seen(), [object].into_iter(), layer).expect("prepared");
        }
    });
    assert_eq!((differing(&found, &expected, 1), canvas.changed(&gpu, 1)), (0, 0));
    let mut bundle = gpu.device().create_render_bundle_encoder(&wgpu::RenderBundleEncoderDescriptor {
        label: None,
        color_formats: &[Some(FORMAT), Some(Format::Rgba8Unorm)],
        depth_stencil: Some(wgpu::RenderBundleDepthStencil {
            format: Format::Depth24PlusStencil8,
            depth_read_only: false,
            stencil_read_only: false,
        }),
        sample_count: 1,
        multiview: None,
    });
    let (view, object) = (stage.seen(), stage.object(&drawable, None));
    renderer.draw_objects(&mut bundle, &view, [object].into_iter(), Layer::Color).expect("prepared");
    let bundle = bundle.finish(&wgpu::RenderBundleDescriptor::default());
    let canvas = Canvas::new(&gpu, &format);
    let found = canvas.draw(&gpu, |pass| pass.execute_bundles([&bundle]));
    assert_eq!((differing(&found, &expected, 0), canvas.changed(&gpu, 1)), (0, 0));
    assert_eq!(found.len(), (SIZE[0] * SIZE[1]) as usize);
}

#[test]
fn what_cannot_be_drawn_is_told_by_its_path() {
    let gpu = gpu();
    let layouts = SceneLayouts::new(&gpu).expect("valid");
    let (drawable, indices) = mesh(&gpu, &layouts, &painted(Alpha::Opaque, false), 3);
    let stage = Stage::new(&gpu, &layouts, view(Vec3::Z, false), &placements(), &[[0, indices]]);
    let refused = |renderer: &Renderer, layer| {
        let mut error = None;
        Canvas::new(&gpu, renderer.format()).draw(&gpu, |pass| {
            let objects = [stage.object(&drawable, None)].into_iter();
            error = renderer.draw_objects(pass, &stage.seen(), objects, layer).err();
        });
        error.expect("refused").path
    };
    let with = |format: TargetFormat| renderer(&gpu, &format, &drawable);
    let good = TargetFormat::new(FORMAT);
    assert_eq!(refused(&with(TargetFormat::depth_only(Format::Depth32Float)), Layer::Color), "layer");
    assert_eq!(refused(&with(good.clone().with_depth(None)), Layer::Depth), "layer");
    assert_eq!(refused(&with(good.clone().reversed()), Layer::Color), "view.camera.depth");
    assert_eq!(refused(&Renderer::new(&gpu, &good).expect("a format"), Layer::Color), "scene");
    let wrong = Renderer::new(&gpu, &good.with_samples(3)).expect_err("refused");
    assert!(matches!(wrong, Error::Input(error) if error.path == "format.samples"));
}
