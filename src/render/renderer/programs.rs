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
    pub fragment: Option<String>,
    pub constants: Vec<(&'static str, f64)>,
}

impl Program {
    /// The program of a layer of a kind of surface, in the shadow of a sun or without.
    pub fn new(layer: Layer, kind: Kind, format: &TargetFormat, shadowed: bool) -> Self {
        // Without a depth attachment no shader may write depth.
        let deep = format.depth.is_some() && kind.is_deep(layer);
        let discards = kind.discards();
        let is_plain_depth = layer == Layer::Depth && !discards && !deep;
        let (shader, constants) = match kind {
            Kind::Mesh { surface, normal_mapped, textured } => {
                let SurfaceKind { double_sided, morphed, .. } = surface;
                let constants =
                    scene_mesh::Constants { double_sided, textured, normal_mapped, shadowed, morphed };
                (&RENDER_SCENE_MESH, constants.list())
            }
            Kind::Relief { options, .. } => {
                (&RENDER_SCENE_RELIEF, relief_constants(&options, format.is_reversed(), shadowed).list())
            }
            Kind::Terrain { style } => {
                let wireframe = style == TerrainStyle::Wireframe;
                (&RENDER_SCENE_TERRAIN, scene_terrain::Constants { shadowed, wireframe }.list())
            }
        };
        Self {
            shader,
            vertex: match layer {
                _ if is_plain_depth => "vertex_depth",
                Layer::Velocity => "vertex_moving",
                _ => "vertex",
            },
            // A pipeline without a fragment stage fits no pass with colours.
            fragment: (!is_plain_depth || !format.color.is_empty()).then(|| {
                let [cut, deep] =
                    [(discards, "_cut"), (deep, "_deep")].map(|(is, end)| if is { end } else { "" });
                format!("{}{cut}{deep}", layer.entry())
            }),
            constants,
        }
    }
}

fn relief_constants(options: &ReliefOptions, reversed: bool, shadowed: bool) -> scene_relief::Constants {
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
