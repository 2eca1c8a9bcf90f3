//! Tests of target formats: their checks, and the attachments that pipelines write.

use super::*;

#[test]
fn formats_that_no_pass_has_are_refused_by_field() {
    let good = || TargetFormat::new(Format::Rgba8UnormSrgb);
    let with = |color: Vec<Option<wgpu::ColorTargetState>>| TargetFormat { color, ..good() };
    let depth = |format| Some(DepthFormat { format, reversed: true });
    let surface = |first: Format| {
        let mut color = TargetFormat::surface().color;
        color[0] = Some(first.into());
        color
    };
    let mut blended = surface(Format::Rgba16Float);
    blended[1].as_mut().expect("a colour").blend = Some(wgpu::BlendState::REPLACE);
    for (format, path) in [
        (good().with_samples(2), "format.samples"),
        (good().with_depth(depth(Format::Stencil8)), "format.depth.format"),
        (with(vec![Some(Format::R32Uint.into())]), "format.color[0].format"),
        (with(vec![Some(Format::Depth32Float.into())]), "format.color[0].format"),
        (good().with_color(Some(Format::Depth24Plus.into())), "format.color[1].format"),
        (with(vec![None; 9]), "format.color.len"),
        (with(vec![None]).with_depth(None), "format"),
        (TargetFormat { color: vec![], ..TargetFormat::surface() }, "format.color[0]"),
        (
            TargetFormat { color: surface(Format::Rgba8Unorm), ..TargetFormat::surface() },
            "format.color[0].format",
        ),
        (
            TargetFormat { attachments: Attachments::Measure, ..TargetFormat::surface() },
            "format.color[0].format",
        ),
        (TargetFormat { color: blended, ..TargetFormat::surface() }, "format.color[1].blend"),
        (TargetFormat::surface().with_depth(None), "format.depth"),
        (TargetFormat::measure().with_samples(4), "format.samples"),
        (TargetFormat { attachments: Attachments::Velocity, ..good() }, "format.color[0].format"),
    ] {
        assert_eq!(format.validate().expect_err("refused").path, path, "{format:?}");
    }
    for format in [
        good().with_samples(4).reversed(),
        good().with_color(None).with_color(Some(Format::R32Uint.into())).with_depth(None),
        TargetFormat::depth_only(Format::Depth24PlusStencil8),
        with(vec![None, Some(Format::Rgba16Float.into())]),
        TargetFormat::surface().with_samples(4).reversed(),
        TargetFormat { color: surface(Format::Rgba32Float), ..TargetFormat::surface() },
        TargetFormat::measure(),
        TargetFormat::velocity().with_samples(4),
    ] {
        assert_eq!(format.validate(), Ok(()), "{format:?}");
    }
}

#[test]
fn only_the_first_color_is_written_and_only_in_color() {
    let blended = wgpu::ColorTargetState {
        format: Format::Rgba8Unorm,
        blend: Some(wgpu::BlendState::ALPHA_BLENDING),
        write_mask: wgpu::ColorWrites::COLOR,
    };
    let format = TargetFormat {
        color: vec![Some(blended.clone()), None, Some(blended.clone())],
        ..TargetFormat::new(Format::R8Unorm)
    };
    let masks = |layer| {
        let targets = format.targets(layer);
        targets
            .into_iter()
            .map(|target| target.map(|target| (target.write_mask, target.blend)))
            .collect::<Vec<_>>()
    };
    let left = Some((wgpu::ColorWrites::empty(), None));
    assert_eq!(masks(Layer::Color), [Some((blended.write_mask, blended.blend)), None, left]);
    assert_eq!(masks(Layer::Depth), [left, None, left]);
}
