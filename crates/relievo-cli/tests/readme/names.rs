//! What README.md, CONTRIBUTING.md and docs/*.md name in their prose, each for the compiler to find: an item, a method, a field or a variant.
//! The comment of a line is the name as it stands there; `tests/readme.rs` compares these with the documents.
#![allow(dead_code, unused_imports, reason = "it is compiled, not run")]

use relievo::asset::Model;
use relievo::asset::material::Alpha;
use relievo::ops::animation::lod::Projection;
use relievo::ops::lod::LodCamera;
use relievo::ops::mesh::{Simplified, SimplifyOptions};
use relievo::ops::skinning::Extent;
use relievo::ops::surface::ReliefOptions;
use relievo::render::{Layer, OutputProgram, Renderer, SunShadow, TargetFormat};
use relievo::scene::kind::{Kind, KindProgram};
use relievo::scene::{
    Criterion, Culling, DistanceTo, DitherPattern, LevelChoice, LevelOfDetail, Pace, Quality, Scene, SizeOf,
    Transition, View, ViewStatistics,
};

#[rustfmt::skip]
fn items() {
    use relievo::scene::LevelOfDetail as _; // LevelOfDetail
    use relievo::scene::LevelStatistics as _; // LevelStatistics
    use relievo::asset::package::Package as _; // asset::package::Package
    use relievo::asset::package::PackageHeader as _; // PackageHeader
    use relievo::gpu::shaders::MODULES as _; // gpu::shaders::MODULES
    use relievo::ops::mesh::ProgressiveMesh as _; // ops::mesh::ProgressiveMesh
    use relievo_lab::reduce::Reducer as _; // reduce::Reducer
    use relievo::ops::mesh::Stopped as _; // ops::mesh::Stopped
    use relievo::ops::mesh::simplify as _; // ops::mesh::simplify
    use relievo::ops::mesh::simplify_within as _; // ops::mesh::simplify_within
    use relievo::scene::TerrainSource as _; // TerrainSource
    use relievo::ops::terrain::remainder as _; // ops::terrain::remainder
    use relievo::render::OutputProgram as _; // render::OutputProgram
    use relievo::scene::kind::Kind as _; // scene::kind::Kind
    use relievo::scene::kind::KindPart as _; // KindPart
    use relievo::ops::terrain::thermal as _; // ops::terrain::thermal
    use relievo::ops::skinning::Extent as _; // ops::skinning::Extent
    use relievo::ops::skinning::FadeRange as _; // ops::skinning::FadeRange
    use relievo::scene::add_levels as _; // scene::add_levels
    use relievo::scene::join_levels as _; // scene::join_levels
    use relievo::ops::skinning::collapse_bones as _; // ops::skinning::collapse_bones
    use relievo::ops::skinning::frame::SkinFrame as _; // ops::skinning::frame::SkinFrame
    use relievo::ops::skinning::paged::PagedSkin as _; // ops::skinning::paged::PagedSkin
    use relievo_lab::reduce::reduce_model as _; // reduce::reduce_model
    use relievo::ops::surface::SurfaceTextures as _; // ops::surface::SurfaceTextures
    use relievo::ops::surface::tangent as _; // ops::surface::tangent
    use relievo::ops::terrain::ground::Ground as _; // ops::terrain::ground::Ground
    use relievo_lab::measure::DisplacementMeter as _; // measure::DisplacementMeter
    use relievo_lab::measure::reduction::reduction as _; // measure::reduction::reduction
    use relievo::ops::animation::priority as _; // ops::animation::priority
    use relievo::ops::animation::frame::GatedFrame as _; // GatedFrame
    use relievo::render::SunShadow as _; // SunShadow
    use relievo_lab::measure::FrameSummary as _; // FrameSummary
    use relievo_lab::measure::ScenePlay as _; // ScenePlay
    use relievo_delivery::client::Fetcher as _; // client::Fetcher
    use relievo_delivery::client::HttpTransport as _; // HttpTransport
    use relievo_delivery::client::StreamedScene as _; // client::StreamedScene
}

#[rustfmt::skip]
fn members() {
    let _ = Alpha::Blended; // Alpha::Blended
    let _ = |frame: relievo::ops::animation::Frame| frame.ahead; // Frame::ahead
    let _ = |header: relievo::asset::package::PackageHeader| header.quantization; // PackageHeader::quantization
    let _ = |quality: relievo::scene::Quality| quality.pixels; // Quality::pixels
    let _ = Scene::record; // Scene::record
    let _ = Model::levels_from_file; // Model::levels_from_file
    let _ = Scene::lod_bias; // Scene::lod_bias
    let _ = Scene::morph_terrain; // Scene::morph_terrain
    let _ = relievo::scene::BoneGate::Bounded; // BoneGate::Bounded
    let _ = relievo::scene::BoneGate::Off; // BoneGate::Off
    let _ = relievo::scene::CharacterOptions::default(); // CharacterOptions
    let _ = |options: relievo::scene::CharacterOptions<'static>| options.priorities; // CharacterOptions::priorities
    let _ = |options: relievo::scene::CharacterOptions<'static>| options.tiers; // CharacterOptions::tiers
    let _ = relievo::scene::DistanceRange::validate; // DistanceRange
    let _ = |budget: relievo::scene::ErrorBudget| budget.bones; // ErrorBudget::bones
    let _ = |budget: relievo::scene::ErrorBudget| budget.influences; // ErrorBudget::influences
    let _ = relievo::scene::InfluenceLod::Bounded; // InfluenceLod::Bounded
    let _ = |counted: relievo::scene::ObjectStatistics| counted.pixels; // ObjectStatistics::pixels
    let _ = relievo::scene::Poses::of; // Poses::of
    let _ = relievo::scene::PriorityWeights::analyze; // PriorityWeights::analyze
    let _ = Scene::skeletons; // Scene::skeletons
    let _ = Scene::set_statistics; // Scene::set_statistics
    let _ = KindProgram::bind; // KindProgram::bind
    let _ = KindProgram::new; // KindProgram::new
    let _ = Layer::Measure; // Layer::Measure
    let _ = Layer::Own; // Layer::Own
    let _ = Layer::Surface; // Layer::Surface
    let _ = Layer::Transparent; // Layer::Transparent
    let _ = Layer::Velocity; // Layer::Velocity
    let _ = Model::blend; // Model::blend
    let _ = Model::from_file; // Model::from_file
    let _ = |mesh: relievo::asset::Mesh| mesh.error; // Mesh::error
    let _ = Model::to_glb; // Model::to_glb
    let _ = Model::to_obj; // Model::to_obj
    let _ = |options: SimplifyOptions| options.prune; // SimplifyOptions::prune
    let _ = OutputProgram::new; // OutputProgram::new
    let _ = Renderer::with_shading; // Renderer::with_shading
    let _ = |format: TargetFormat| format.color; // TargetFormat::color
    let _ = TargetFormat::of_output; // TargetFormat::of_output
    let _ = Scene::draws; // Scene::draws
    let _ = Scene::health; // Scene::health
    let _ = Scene::is_refining; // Scene::is_refining
    let _ = Scene::keep_motion_history; // Scene::keep_motion_history
    let _ = Scene::set_material; // Scene::set_material
    let _ = Scene::set_level_of_detail; // Scene::set_level_of_detail
    let _ = Simplified::hash; // Simplified::hash
    let _ = Layer::Color; // Layer::Color
    let _ = Layer::Depth; // Layer::Depth
    let _ = |renderer: &'static Renderer, pass: &mut wgpu::RenderPass<'static>, scene, view| Renderer::draw(renderer, pass, scene, view, Layer::Color); // Renderer::draw
    let _ = Scene::add_character; // Scene::add_character
    let _ = Scene::add_character_with; // Scene::add_character_with
    let _ = Scene::add_relief; // Scene::add_relief
    let _ = Scene::add_terrain; // Scene::add_terrain
    let _ = Scene::attach; // Scene::attach
    let _ = Scene::bounds; // Scene::bounds
    let _ = Scene::drive; // Scene::drive
    let _ = Scene::ground; // Scene::ground
    let _ = Scene::terrain_statistics; // Scene::terrain_statistics
    let _ = Scene::set_terrain_holes; // Scene::set_terrain_holes
    let _ = Scene::set_terrain_features; // Scene::set_terrain_features
    let _ = size_of::<relievo::scene::SampleMask>; // SampleMask
    let _ = relievo::scene::TerrainSource::with_holes; // TerrainSource::with_holes
    let _ = relievo::scene::TerrainSource::with_elevation; // TerrainSource::with_elevation
    let _ = relievo::scene::TerrainSource::with_relief; // TerrainSource::with_relief
    let _ = relievo::scene::TerrainSource::with_target; // TerrainSource::with_target
    let _ = |tiles: relievo::scene::ElevationTiles| tiles.write("".as_ref(), || ()); // ElevationTiles::write
    let _ = size_of::<relievo::scene::ElevationLoader>; // ElevationLoader
    let _ = size_of::<relievo::scene::ElevationMap>; // ElevationMap
    let _ = size_of::<relievo::scene::ElevationTiles>; // ElevationTiles
    let _ = size_of::<&dyn relievo::scene::ElevationSource>; // ElevationSource
    let _ = relievo::scene::ElevationLoader::from_folder; // ElevationLoader::from_folder
    let _ = relievo::scene::TerrainSource::endless; // TerrainSource::endless
    let _ = |limits: relievo::scene::EndlessLimits| limits.node_size; // EndlessLimits::node_size
    let _ = |limits: relievo::scene::EndlessLimits| limits.finer_normals; // EndlessLimits::finer_normals
    let _ = |limits: relievo::scene::EndlessLimits| limits.erosion_depth; // EndlessLimits::erosion_depth
    let _ = |limits: relievo::scene::EndlessLimits| limits.view_distance; // EndlessLimits::view_distance
    let _ = |limits: relievo::scene::EndlessLimits| limits.capacity; // EndlessLimits::capacity
    let _ = Scene::pick; // Scene::pick
    let _ = Scene::pose; // Scene::pose
    let _ = Scene::rebuild_all; // Scene::rebuild_all
    let _ = Scene::stage_times; // Scene::stage_times
    let _ = Scene::statistics; // Scene::statistics
    let _ = Scene::tight_bounds; // Scene::tight_bounds
    let _ = Scene::watched_bones; // Scene::watched_bones
    let _ = TargetFormat::measure; // TargetFormat::measure
    let _ = TargetFormat::new; // TargetFormat::new
    let _ = TargetFormat::surface; // TargetFormat::surface
    let _ = relievo::ops::terrain::config::TerrainConfig::from_json; // TerrainConfig::from_json
    let _ = |scene: &mut Scene, encoder: &mut wgpu::CommandEncoder| scene.record_with(encoder, &mut [], |_, _| Ok(())); // Scene::record_with
    let _ = TargetFormat::velocity; // TargetFormat::velocity
    let _ = Extent::fade_range; // Extent::fade_range
    let _ = |projection: &Projection, extent: &Extent| extent.level_ranges(projection, 1.0, [0.0]); // Extent::level_ranges
    let _ = |extent: Extent| extent.stray; // Extent::stray
    let _ = LodCamera::new; // LodCamera::new
    let _ = Projection::allowed; // Projection::allowed
    let _ = Transition::Geomorph; // Transition::Geomorph
    let _ = |options: ReliefOptions| options.shadow; // ReliefOptions::shadow
}

#[rustfmt::skip]
fn decided() {
    let _ = relievo::ops::animation::lod::Range::omega; // ops::animation::lod::Range::omega
    let _ = |gate| matches!(gate, relievo::ops::animation::Gate::SkipPeriod { .. }); // ops::animation::Gate::SkipPeriod
    let _ = relievo_lab::reduce::Reducer::ALL; // reduce::Reducer::ALL
    let _ = |cost| matches!(cost, relievo::ops::mesh::Cost::Melax { .. }); // ops::mesh::Cost::Melax
    let _ = relievo_lab::reduce::Normals::Recompute; // reduce::Normals::Recompute
    let _ = relievo::ops::surface::ReliefMethod::Parallax; // ops::surface::ReliefMethod::Parallax
    let _ = |march: relievo::ops::surface::March| march.steps; // ops::surface::March::steps
    let _ = |material: relievo::ops::surface::ReliefMaterial| material.plane; // ops::surface::ReliefMaterial::plane
    let _ = |config: relievo::ops::terrain::config::TerrainConfig| config.scale_factor; // ops::terrain::config::TerrainConfig::scale_factor
}

#[rustfmt::skip]
fn generic(scene: &mut Scene, kind: impl Kind) {
    let _ = Scene::add_kind(scene, kind, 1); // Scene::add_kind
    let _ = |from| Criterion::Distance { to: DistanceTo::Center, from }; // Criterion::Distance
    let _ = Criterion::Error; // Criterion::Error
    let _ = |below| Criterion::Magnification { below }; // Criterion::Magnification
    let _ = Criterion::Ratio { to: DistanceTo::Center, near: 0.0, far: 1.0 }; // Criterion::Ratio
    let _ = |below| Criterion::Size { of: SizeOf::Box, below }; // Criterion::Size
    let _ = Culling::Never; // Culling::Never
    let _ = DitherPattern::PerFrame; // DitherPattern::PerFrame
    let _ = Scene::set_character_model; // Scene::set_character_model
    let _ = Scene::set_model; // Scene::set_model
    let _ = Scene::wanted; // Scene::wanted
    let _ = |options: relievo_delivery::client::FetcherOptions| options.cache; // FetcherOptions::cache
    let _ = Layer::Levels; // Layer::Levels
    let _ = LevelChoice::Forced(0); // LevelChoice::Forced
    let _ = |of: LevelOfDetail| of.bias; // LevelOfDetail::bias
    let _ = |of: LevelOfDetail| of.hysteresis; // LevelOfDetail::hysteresis
    let _ = |of: LevelOfDetail| of.rank; // LevelOfDetail::rank
    let _ = Pace::Band(0.1); // Pace::Band
    let _ = Pace::Seconds(0.3); // Pace::Seconds
    let _ = |quality: Quality| quality.milliseconds; // Quality::milliseconds
    let _ = |quality: Quality| quality.triangles; // Quality::triangles
    let _ = Scene::can_morph; // Scene::can_morph
    let _ = Scene::share_budget; // Scene::share_budget
    let _ = SunShadow::fit; // SunShadow::fit
    let _ = TargetFormat::levels; // TargetFormat::levels
    let _ = Transition::Alpha { opaque: 600.0, gone: 800.0 }; // Transition::Alpha
    let _ = Transition::CrossFade(Pace::Band(0.1)); // Transition::CrossFade
    let _ = Transition::Dither(Pace::Band(0.1)); // Transition::Dither
    let _ = Transition::FadeIn(Pace::Band(0.1)); // Transition::FadeIn
    let _ = Transition::Hard; // Transition::Hard
    let _ = Transition::TwoPhase(Pace::Band(0.1)); // Transition::TwoPhase
    let _ = View::cut; // View::cut
    let _ = View::frame_took; // View::frame_took
    let _ = View::set_dither; // View::set_dither
    let _ = View::set_lod_cameras; // View::set_lod_cameras
    let _ = View::statistics; // View::statistics
    let _ = View::triangle_limit; // View::triangle_limit
    let _ = |view: ViewStatistics| view.budget; // ViewStatistics::budget
    let _ = |view: ViewStatistics| view.pixels; // ViewStatistics::pixels
}
