//! `prepare` refuses buffers, sizes and parameters that do not fit, and names the field. It accepts what just fits.

use relievo::Error;
use relievo::gpu::{Buffer, Gpu};
use relievo::ops::terrain::blend::{BlendBuffers, BlendPass, Shading, WeightMode};
use relievo::ops::terrain::border::BorderPass;
use relievo::ops::terrain::config::{Border, TerrainConfig};
use relievo::ops::terrain::cover::{Cover, MapZone};
use relievo::ops::terrain::despike::{Despike, DespikeBuffers, DespikePass};
use relievo::ops::terrain::features::{FeatureIndex, Features};
use relievo::ops::terrain::fields::Fields;
use relievo::ops::terrain::fixed::FeatureMode;
use relievo::ops::terrain::hydraulic::{Hydraulic, HydraulicBuffers, HydraulicPass};
use relievo::ops::terrain::morph::{HeightMorphPass, MorphBuffers};
use relievo::ops::terrain::normals::NormalsPass;
use relievo::ops::terrain::pad::PadPass;
use relievo::ops::terrain::regions::{HeightBuffers, HeightScratch, RegionPass};
use relievo::ops::terrain::texture::TerrainTexture;
use relievo::ops::terrain::thermal::{Thermal, ThermalBuffers, ThermalPass};
use relievo::ops::terrain::window::Windows;

use crate::harness::gpu;

#[track_caller]
fn refuses<T>(result: Result<T, Error>, parts: &[&str]) {
    let Err(error) = result else { panic!("accepted what should be refused with {parts:?}") };
    assert!(matches!(error, Error::Input(_)), "{error}");
    let text = error.to_string();
    for part in parts {
        assert!(text.contains(part), "\"{text}\" does not say \"{part}\"");
    }
}

fn buffer<T: bytemuck::Pod>(gpu: &Gpu, len: usize) -> Buffer<T> {
    Buffer::new(gpu, "test", len).expect("allocated")
}

fn fields(gpu: &Gpu, width: u32, count: u32) -> Fields {
    Fields::new(gpu, "test", width, count).expect("allocated")
}

/// Fields whose width and count exceed their buffer.
fn short(gpu: &Gpu) -> Fields {
    Fields { heights: buffer(gpu, 49), width: 5, count: 2 }
}

#[test]
fn fields_without_samples_are_empty_not_huge() {
    let gpu = gpu();
    let fields = fields(&gpu, 3, 1);
    assert_eq!([0, 1, 2, u32::MAX].map(|samples| fields.cropped(samples).width), [3, 1, 0, 0]);
}

#[test]
fn normals() {
    let gpu = gpu();
    let pass = NormalsPass::new(&gpu).expect("compiled");
    let prepare = |scale, windows: &Fields, gradients, normals| {
        pass.prepare(&gpu, scale, windows, &buffer(&gpu, gradients), &buffer(&gpu, normals)).map(|_| ())
    };
    let windows = fields(&gpu, 5, 2);
    assert!(prepare(1.0, &windows, 18, 54).is_ok());
    refuses(prepare(1.0, &windows, 17, 54), &["gradients = [17 elements]", "at least 18"]);
    refuses(prepare(1.0, &windows, 18, 53), &["normals = [53 elements]", "at least 54"]);
    for scale in [0.0, -1.0, f64::NAN, 2e6] {
        refuses(prepare(scale, &windows, 18, 54), &["terrain_scale = ", "0.000001..=1000000"]);
    }
    for width in 0..=2 {
        let thin = fields(&gpu, width, 1);
        refuses(prepare(1.0, &thin, 18, 54), &[&format!("windows.width = {width}: "), "exceed 2"]);
    }
    refuses(prepare(1.0, &short(&gpu), 18, 54), &["windows.heights = [49 elements]", "at least 50"]);
}

#[test]
fn blend() {
    let gpu = gpu();
    let pass = BlendPass::new(&gpu).expect("compiled");
    let config = TerrainConfig::new(3, 10.0, "").expect("valid");
    let textures = TerrainTexture::of_zones(&config.zones).expect("built in");
    refuses(Cover::new(&config, &textures[1..]).map(|_| ()).map_err(Error::from), &["textures.len = 3"]);
    let cover = Cover::new(&config, &textures).expect("valid");
    let good = Shading::default();
    let windows = fields(&gpu, 5, 2);
    let prepare = |cover: &Cover, shading, windows: &Fields, [places, pixels]: [usize; 2]| {
        let places = Buffer::new(&gpu, "places", places).expect("allocated");
        let buffers = BlendBuffers { windows, places: &places, pixels: &buffer(&gpu, pixels) };
        pass.prepare(&gpu, cover, &shading, buffers).map(|_| ())
    };
    let of = |zones: &[MapZone]| Cover { zones: zones.to_vec(), ..cover.clone() };
    let zone = cover.zones[0];
    assert!(prepare(&of(&[zone; 32]), good, &windows, [2, 18]).is_ok());
    refuses(prepare(&cover, good, &windows, [2, 17]), &["pixels = [17 elements]", "at least 18"]);
    refuses(prepare(&cover, good, &windows, [1, 18]), &["places = [1 elements]", "at least 2"]);
    let endless = Cover { terrain_scale: f64::INFINITY, ..cover.clone() };
    refuses(prepare(&endless, good, &windows, [2, 18]), &["terrain_scale = inf"]);
    refuses(prepare(&Cover { tile: 0.0, ..cover.clone() }, good, &windows, [2, 18]), &["tile = 0"]);
    refuses(
        prepare(&Cover { variation: 1.5, ..cover.clone() }, good, &windows, [2, 18]),
        &["variation = 1.5"],
    );
    refuses(prepare(&of(&[]), good, &windows, [2, 18]), &["zones = [0 zones]", "1 to 32"]);
    refuses(prepare(&of(&[zone; 33]), good, &windows, [2, 18]), &["zones = [33 zones]", "1 to 32"]);
    let with = |change: &dyn Fn(&mut MapZone)| {
        let mut bad = zone;
        change(&mut bad);
        prepare(&of(&[zone, bad]), good, &windows, [2, 18])
    };
    refuses(with(&|bad| bad.zone.max = bad.zone.min), &["zones[1].max = ", "above min"]);
    refuses(with(&|bad| bad.zone.min = f32::NAN), &["zones[1].min = NaN"]);
    refuses(with(&|bad| bad.zone.rise[1] = f32::INFINITY), &["zones[1].rise[1] = inf"]);
    refuses(with(&|bad| bad.zone.fall[0] = 1e7), &["zones[1].fall[0] = 10000000"]);
    refuses(with(&|bad| bad.zone.height_blend = -0.5), &["zones[1].height_blend = -0.5", "0..=1"]);
    refuses(with(&|bad| bad.zone.repeats = 1.5), &["zones[1].repeats = 1.5", "whole"]);
    refuses(with(&|bad| bad.zone.repeats = 17.0), &["zones[1].repeats = 17", "1..=16"]);
    refuses(with(&|bad| bad.edge_log2 = 10), &["zones[1].edge_log2 = 10", "0..=9"]);
    refuses(with(&|bad| bad.first = u32::MAX), &["zones[1].first = 4294967295", "room"]);
    let weights = WeightMode::Additive;
    let dark = Shading { light: [0.0; 3], weights, ..good };
    refuses(prepare(&cover, dark, &windows, [2, 18]), &["light = [0.0, 0.0, 0.0]", "length 1"]);
    let blind = Shading { light: [f32::NAN, 0.0, 0.0], ..good };
    refuses(prepare(&cover, blind, &windows, [2, 18]), &["light = [NaN, 0.0, 0.0]"]);
    refuses(prepare(&cover, Shading { ambient: 1.5, ..good }, &windows, [2, 18]), &["ambient = 1.5"]);
    refuses(prepare(&cover, good, &fields(&gpu, 2, 1), [2, 18]), &["windows.width = 2"]);
    refuses(prepare(&cover, good, &short(&gpu), [2, 18]), &["windows.heights = [49 elements]"]);
}

#[test]
fn despike() {
    let gpu = gpu();
    let pass = DespikePass::with_features(&gpu).expect("compiled");
    let params = Despike { threshold: 1.0 };
    let index = |widths: &[u32]| FeatureIndex::new(&gpu, widths, 2, 1).expect("allocated");
    let prepare = |windows: &Fields, widths: &[u32], cropped: usize| {
        let cropped = Fields { heights: buffer(&gpu, cropped), width: 3, count: 2 };
        let buffers = DespikeBuffers { windows, features: &index(widths), cropped: &cropped };
        pass.prepare(&gpu, params, buffers).map(|_| ())
    };
    let windows = fields(&gpu, 5, 2);
    assert!(prepare(&windows, &[5], 18).is_ok());
    refuses(prepare(&windows, &[5], 17), &["cropped.heights = [17 elements]", "at least 18"]);
    refuses(prepare(&windows, &[6, 5], 18), &["features.width = 6: must be that of the windows, 5"]);
    refuses(prepare(&windows, &[], 18), &["features.width = 0"]);
    refuses(prepare(&fields(&gpu, 1, 1), &[1], 18), &["windows.width = 1"]);
    refuses(prepare(&short(&gpu), &[5], 18), &["windows.heights = [49 elements]"]);
}

#[test]
fn thermal() {
    let gpu = gpu();
    let pass = ThermalPass::new(&gpu).expect("compiled");
    let prepare = |iterations, scale, windows: &Fields, other| {
        let other = Fields { heights: buffer(&gpu, other), width: 5, count: 2 };
        let params = Thermal { iterations, ..Thermal::default() };
        pass.prepare(&gpu, params, scale, ThermalBuffers { windows, other: &other }).map(|_| ())
    };
    let windows = fields(&gpu, 5, 2);
    assert!(prepare(2, 1.0, &windows, 18).is_ok() && prepare(0, 1.0, &windows, 50).is_ok());
    refuses(prepare(2, 1.0, &windows, 17), &["other.heights = [17 elements]", "at least 18"]);
    refuses(prepare(3, 1.0, &windows, 50), &["windows.width = 5: ", "exceed 6"]);
    refuses(prepare(1, 0.0, &windows, 50), &["terrain_scale = 0"]);
    refuses(prepare(1, 1.0, &short(&gpu), 50), &["windows.heights = [49 elements]"]);
}

#[test]
fn hydraulic() {
    let gpu = gpu();
    let pass = HydraulicPass::new(&gpu).expect("compiled");
    let prepare = |iterations, scale, windows: &Fields, [other, flows, more]: [usize; 3]| {
        let other = Fields { heights: buffer(&gpu, other), width: 5, count: 2 };
        let params = Hydraulic { iterations, ..Hydraulic::default() };
        let (flows, other_flows) = (&buffer(&gpu, flows), &buffer(&gpu, more));
        let buffers = HydraulicBuffers { windows, other: &other, flows, other_flows };
        pass.prepare(&gpu, params, scale, buffers).map(|_| ())
    };
    let windows = fields(&gpu, 5, 2);
    assert_eq!(HydraulicPass::flow_points(&windows), 18);
    assert!(prepare(2, 1.0, &windows, [18; 3]).is_ok() && prepare(0, 1.0, &windows, [1; 3]).is_ok());
    refuses(prepare(2, 1.0, &windows, [17, 18, 18]), &["other.heights = [17 elements]", "at least 18"]);
    refuses(prepare(2, 1.0, &windows, [18, 17, 18]), &["flows = [17 elements]", "at least 18"]);
    refuses(prepare(2, 1.0, &windows, [18, 18, 17]), &["other_flows = [17 elements]", "at least 18"]);
    refuses(prepare(3, 1.0, &windows, [50; 3]), &["windows.width = 5: ", "exceed 6"]);
    refuses(prepare(2049, 1.0, &windows, [50; 3]), &["hydraulic.iterations = 2049", "2048"]);
    refuses(prepare(1, 0.0, &windows, [50; 3]), &["terrain_scale = 0"]);
    refuses(prepare(1, 1.0, &short(&gpu), [50; 3]), &["windows.heights = [49 elements]"]);
}

#[test]
fn border() {
    let gpu = gpu();
    let pass = BorderPass::new(&gpu).expect("compiled");
    let around = [[None; 4], [Some(0), None, None, None]];
    let prepare = |width, parts: &[Fields]| pass.prepare(&gpu, width, &around, parts).map(|_| ());
    let one = |width| fields(&gpu, width, 1);
    assert!(prepare(4, &[fields(&gpu, 5, 2)]).is_ok());
    assert!(prepare(4, &[one(5), one(5)]).is_ok());
    refuses(prepare(4, &[one(5)]), &["neighbours.len = 2: ", "at most 1"]);
    refuses(prepare(4, &[short(&gpu)]), &["parts[0].heights = [49 elements]", "at least 50"]);
    refuses(prepare(4, &[one(5), one(9)]), &["parts[1].width = 9", "must be 5"]);
    for width in [0, 5, u32::MAX] {
        refuses(prepare(width, &[fields(&gpu, 5, 2)]), &[&format!("width = {width}: "), "below size = 5"]);
    }
    refuses(prepare(1, &[one(0)]), &["width = 1"]);
    refuses(prepare(1, &[]), &["width = 1"]);
    let own = [[None; 4], [None, None, Some(1), None]];
    let found = pass.prepare(&gpu, 1, &own, &[fields(&gpu, 5, 2)]).map(|_| ());
    refuses(found, &["neighbours[1][2] = 1: must be below 1: a patch blends towards earlier ones"]);
}

#[test]
fn morph() {
    let gpu = gpu();
    let pass = HeightMorphPass::new(&gpu).expect("compiled");
    let prepare = |from, to, heights| {
        let [from, to, heights] = [from, to, heights].map(|len| buffer(&gpu, len));
        pass.prepare(&gpu, MorphBuffers { from: &from, to: &to, heights: &heights }).map(|_| ())
    };
    assert!(prepare(4, 4, 4).is_ok());
    refuses(prepare(4, 5, 4), &["to.len = 5: must be 4, as from.len"]);
    refuses(prepare(4, 4, 3), &["heights.len = 3: must be 4, as from.len"]);
}

#[test]
fn pad() {
    let gpu = gpu();
    let pass = PadPass::new(&gpu).expect("compiled");
    let own = |index| std::array::from_fn(|tile| (tile == 4).then_some(index));
    let prepare = |apron, surrounds: &[[Option<usize>; 9]], parts: &[Fields], windows| {
        pass.prepare(&gpu, apron, surrounds, parts, &buffer(&gpu, windows)).map(|_| ())
    };
    let one = |width| fields(&gpu, width, 1);
    let (surrounds, two) = ([own(0), own(1)], [fields(&gpu, 5, 2)]);
    assert!(prepare(1, &surrounds, &two, 98).is_ok());
    assert!(prepare(1, &surrounds, &[one(5), one(5)], 98).is_ok());
    refuses(prepare(1, &surrounds, &[one(5)], 98), &["surrounds[1][4] = 1: must be below 1"]);
    refuses(prepare(1, &surrounds, &[short(&gpu)], 98), &["parts[0].heights = [49 elements]", "at least 50"]);
    refuses(prepare(1, &surrounds, &[one(5), one(9)], 98), &["parts[1].width = 9", "must be 5"]);
    refuses(prepare(1, &surrounds, &two, 97), &["windows = [97 elements]", "at least 98"]);
    refuses(prepare(1, &[[None; 9]], &two, 98), &["surrounds[0][4] = none"]);
    refuses(prepare(5, &surrounds, &two, 450), &["apron = 5"]);
    refuses(prepare(0, &surrounds, &[one(0)], 98), &["apron = 0"]);
    refuses(prepare(0, &surrounds, &[], 98), &["apron = 0"]);
}

#[test]
fn generation() {
    let gpu = gpu();
    let config = TerrainConfig::new(5, 1.0, "short").expect("valid");
    let height = RegionPass::new(&gpu, &config, Some(FeatureMode::Keep)).expect("compiled");
    let scratch = HeightScratch::new(&gpu, &config, Windows { count: 2, apron: 1 }).expect("allocated");
    let points = Windows { count: 2, apron: 1 }.points(&config);
    let prepare = |apron, output| {
        let buffers = HeightBuffers { output: &buffer(&gpu, output), scratch: &scratch };
        height.prepare(&gpu, &config, Windows { count: 2, apron }, 0, buffers)
    };
    let job = prepare(1, points).expect("prepared");
    refuses(prepare(1, points - 1).map(|_| ()), &["output = [97 elements]", "at least 98"]);
    refuses(prepare(2, 2 * points).map(|_| ()), &["scratch = "]);
    refuses(prepare(u32::MAX, points).map(|_| ()), &["apron = 4294967295: must be at most 4096"]);
    let three = [[0, 0], [1, 0], [2, 0]];
    let features = Features::default();
    refuses(job.set(&gpu, &three, &features), &["patches.len = 3: must be at most 2, the batch's count"]);

    let config = TerrainConfig { border: Border::Wrap, ..config };
    let wrap = RegionPass::new(&gpu, &config, None).expect("compiled");
    let prepare = |output, scratch_for| {
        let scratch =
            HeightScratch::new(&gpu, &config, Windows { count: scratch_for, apron: 0 }).expect("allocated");
        let buffers = HeightBuffers { output: &buffer(&gpu, output), scratch: &scratch };
        wrap.prepare(&gpu, &config, Windows { count: 2, apron: 0 }, 0, buffers).map(|_| ())
    };
    assert!(prepare(50, 2).is_ok());
    refuses(prepare(49, 2), &["output = [49 elements]", "at least 50"]);
    refuses(prepare(50, 1), &["scratch = [9 elements]", "at least 18"]);
    let buffers = HeightBuffers { output: &buffer(&gpu, points), scratch: &scratch };
    let other = height.prepare(&gpu, &config, Windows { count: 2, apron: 0 }, 0, buffers);
    refuses(
        other.map(|_| ()),
        &["is_seamless: false", "is_seamless: true", "for which the pass was compiled"],
    );
}
