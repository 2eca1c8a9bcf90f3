//! The shaders, entry points and constants of pipelines.

use super::pipelines::Kind;
use crate::gpu::bindings::render::{scene_mesh, scene_relief, scene_terrain};
use crate::gpu::shaders::{RENDER_SCENE_MESH, RENDER_SCENE_RELIEF, RENDER_SCENE_TERRAIN, Shader};
use crate::render::format::TargetFormat;
use crate::render::layer::Layer;
use crate::scene::TerrainStyle;
use crate::scene::drawable::SurfaceKind;
use crate::surface::{Green, ReliefOptions};

/// The shader of a pipeline with its entry points, without the prefix of their names, and constants.
pub(super) struct Program {
    pub shader: &'static Shader,
    pub vertex: &'static str,
    /// None where depth alone is written and nothing is left out.
    pub fragment: Option<&'static str>,
    pub constants: Vec<(&'static str, f64)>,
}

impl Program {
    /// The program of a layer of a kind of surface. With `is_shaded` the caller shades, and with `shadowed` surfaces lie in
    /// the shadow of a sun.
    pub fn new(layer: Layer, kind: Kind, format: &TargetFormat, [is_shaded, shadowed]: [bool; 2]) -> Self {
        let is_whole = is_shaded || shadowed;
        // A pipeline without a fragment stage fits no pass with colours.
        let depth_opaque = (!format.color.is_empty()).then_some("depth_opaque");
        match kind {
            Kind::Mesh { surface, normal_mapped, alike } => {
                let (vertex, fragment) = match layer {
                    Layer::Depth if surface.cut_out => ("vertex", Some("depth_cut_out")),
                    Layer::Depth => ("vertex", depth_opaque),
                    Layer::Color if !is_whole && alike.is_some() => ("vertex_plain", Some("opaque_plain")),
                    Layer::Color | Layer::Transparent if !is_whole => own_color(surface, normal_mapped),
                    layer => whole(layer),
                };
                let SurfaceKind { double_sided, cut_out, blended, morphed } = surface;
                let textured = alike.is_some_and(|alike| alike.textured);
                let several = alike.is_some_and(|alike| alike.several);
                let constants = scene_mesh::Constants {
                    double_sided,
                    textured,
                    several,
                    cut_out,
                    blended,
                    normal_mapped,
                    shadowed,
                    morphed,
                };
                Self { shader: &RENDER_SCENE_MESH, vertex, fragment, constants: constants.list() }
            }
            Kind::Relief { options, .. } => Self {
                shader: &RENDER_SCENE_RELIEF,
                vertex: if layer == Layer::Velocity { "vertex_moving" } else { "vertex" },
                fragment: Some(match layer {
                    Layer::Depth => "depth_relief",
                    // Without a depth attachment no shader may write depth.
                    Layer::Color if options.depth && format.depth.is_some() => "fragment_deep",
                    Layer::Color | Layer::Transparent => "fragment",
                    Layer::Surface => "surface",
                    Layer::Measure => "measure",
                    Layer::Velocity => "velocity_moving",
                }),
                constants: relief_constants(&options, [format.is_reversed(), shadowed]).list(),
            },
            Kind::Terrain { style } => {
                let (vertex, fragment) = match layer {
                    Layer::Depth => ("vertex", depth_opaque),
                    Layer::Color if style == TerrainStyle::Wireframe => {
                        ("vertex_wired", Some("shaded_wired"))
                    }
                    Layer::Color | Layer::Transparent if !is_whole => ("vertex", Some("fragment")),
                    layer => whole(layer),
                };
                let constants = scene_terrain::Constants { shadowed }.list();
                Self { shader: &RENDER_SCENE_TERRAIN, vertex, fragment, constants }
            }
        }
    }
}

/// The entries of meshes and terrain that know everything of a surface, and those that know its motion.
fn whole(layer: Layer) -> (&'static str, Option<&'static str>) {
    match layer {
        Layer::Surface => ("vertex_whole", Some("surface_whole")),
        Layer::Measure => ("vertex_whole", Some("measure_whole")),
        Layer::Velocity => ("vertex_moving", Some("velocity_moving")),
        Layer::Color | Layer::Transparent | Layer::Depth => ("vertex_whole", Some("shaded_whole")),
    }
}

/// The entries of a mesh in the crate's own shading, which hand over no more than that needs.
fn own_color(surface: SurfaceKind, normal_mapped: bool) -> (&'static str, Option<&'static str>) {
    match (surface.cut_out, normal_mapped) {
        (false, false) => ("vertex", Some("opaque")),
        (false, true) => ("vertex_bumpy", Some("opaque_bumpy")),
        (true, false) => ("vertex", Some("cut_out")),
        (true, true) => ("vertex_bumpy", Some("cut_out_bumpy")),
    }
}

fn relief_constants(options: &ReliefOptions, [reversed, shadowed]: [bool; 2]) -> scene_relief::Constants {
    scene_relief::Constants {
        method: options.method.code(),
        shadow: options.shadow as u32,
        normal_map: options.normal_map.is_some(),
        green_up: options.normal_map == Some(Green::Up),
        silhouette: options.silhouette,
        choose_mip: options.chooses_mip(),
        own_depth: options.depth,
        reversed,
        shadowed,
        // Reliefs have one level of detail.
        morphed: false,
    }
}
