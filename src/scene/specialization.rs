//! Specializations: all inputs from which the pipelines of a part are compiled.

use std::hash::{Hash, Hasher};
use std::sync::Arc;

use crate::gpu::bindings::render::{scene_mesh, scene_relief, scene_terrain};
use crate::gpu::shaders::{RENDER_SCENE_MESH, RENDER_SCENE_RELIEF, RENDER_SCENE_TERRAIN};
use crate::scene::options::TerrainStyle;
use crate::scene::program::{self, KindProgram};
use crate::scene::wgsl::entries::KindText;
use crate::shared::render::scene_fade::{FADE_BLEND, FADE_DITHER, FADE_HEAVIER, FADE_NONE, FADE_PUSHED};
use crate::surface::{Green, ReliefOptions, ReliefShadow};

/// The shader of a kind of object.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(crate) enum Program {
    Mesh,
    Relief,
    Terrain,
    /// The shader of a caller-defined kind.
    Own(KindProgram),
}

impl Program {
    pub fn name(&self) -> &str {
        match self {
            Self::Mesh => RENDER_SCENE_MESH.name,
            Self::Relief => RENDER_SCENE_RELIEF.name,
            Self::Terrain => RENDER_SCENE_TERRAIN.name,
            Self::Own(program) => program.name(),
        }
    }

    /// Facts about the shader from which its entry points are generated.
    pub fn kind(&self) -> KindText<'_> {
        let of = |name, blends, deep| KindText { name, blends, deep, moves: true };
        match self {
            Self::Mesh => of("mesh", true, false),
            Self::Relief => of("relief", false, true),
            Self::Terrain => of("terrain", false, false),
            Self::Own(program) => program.kind(),
        }
    }

    /// The shader with all facts from which entry points for a caller's output are generated.
    pub fn generated(&self) -> program::Program<'_> {
        program::Program { text: self.text(), kind: self.kind(), is_own: matches!(self, Self::Own(_)) }
    }

    /// Names that the caller's text declares. Empty for shaders of the crate.
    pub fn declared(&self) -> &[String] {
        if let Self::Own(program) = self { program.declared() } else { &[] }
    }

    /// The complete WGSL of the shader, which ends with the function `shade`.
    pub fn text(&self) -> &str {
        match self {
            Self::Mesh => RENDER_SCENE_MESH.source,
            Self::Relief => RENDER_SCENE_RELIEF.source,
            Self::Terrain => RENDER_SCENE_TERRAIN.source,
            Self::Own(program) => program.text(),
        }
    }
}

/// Pipeline state of a part, besides the shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(crate) struct PartState {
    /// Whether the part is masked or dithered, so that alpha decides which pixels are drawn.
    pub cut_out: bool,
    /// Whether the part is blended. Blended parts are drawn in a layer of their own.
    pub blended: bool,
    /// Whether both sides of triangles are visible.
    pub double_sided: bool,
    /// Layers in which the part writes the depth of its surface instead of the depth of its triangles.
    pub own_depth: OwnDepth,
}

/// Layers in which a part writes the depth of its surface instead of the depth of its triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(crate) enum OwnDepth {
    #[default]
    Never,
    /// Only in the depth layer; other layers get the depth of the triangles.
    Depth,
    Always,
}

/// Groups of layers. All layers of a group use the same override constants.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shown {
    /// Layers that show lit surfaces.
    Lit,
    /// Layers that show surfaces before lighting.
    Surface,
    /// Layers that need only positions and cut-outs.
    Place,
}

/// Names and values of override constants.
type Constants = Vec<(&'static str, f64)>;

/// Inputs of a part's pipelines. Equal specializations share pipelines.
#[derive(Debug, Clone)]
pub(crate) struct Specialization(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    program: Program,
    state: PartState,
    /// Override constants for each group of layers, indexed by [`Shown`].
    constants: [Constants; 3],
    hash: u64,
}

impl Inner {
    fn bits(&self) -> impl Iterator<Item = (&'static str, u64)> {
        self.constants.iter().flatten().map(|(name, value)| (*name, value.to_bits()))
    }
}

impl PartialEq for Specialization {
    fn eq(&self, other: &Self) -> bool {
        let (a, b) = (&*self.0, &*other.0);
        std::ptr::eq(a, b)
            || (a.hash == b.hash && a.program == b.program && a.state == b.state && a.bits().eq(b.bits()))
    }
}

impl Eq for Specialization {}

impl Hash for Specialization {
    fn hash<H: Hasher>(&self, state: &mut H) {
        state.write_u64(self.0.hash);
    }
}

impl Specialization {
    fn new(program: Program, state: PartState, constants: [Constants; 3]) -> Self {
        let mut inner = Inner { program, state, constants, hash: 0 };
        let mut hasher = std::hash::DefaultHasher::new();
        (&inner.program, inner.state).hash(&mut hasher);
        inner.bits().for_each(|bits| bits.hash(&mut hasher));
        inner.hash = hasher.finish();
        Self(Arc::new(inner))
    }

    /// The specialization of a mesh with materials. `textured` tells whether any material has a texture, and
    /// `normal_mapped` whether any has a normal map. `morphed` tells whether levels of detail geomorph.
    pub fn mesh(state: PartState, textured: bool, normal_mapped: bool, morphed: bool) -> Self {
        let PartState { double_sided, cut_out, .. } = state;
        let full = scene_mesh::Constants {
            double_sided,
            textured,
            normal_mapped,
            morphed,
            shadowed: false,
            fade: 0,
        };
        let place = scene_mesh::Constants { textured: textured && cut_out, normal_mapped: false, ..full };
        Self::new(Program::Mesh, state, [full, full, place].map(|constants| constants.list()))
    }

    /// The specialization of a relief-mapped mesh.
    pub fn relief(options: &ReliefOptions, double_sided: bool) -> Self {
        let own_depth = if options.depth { OwnDepth::Always } else { OwnDepth::Depth };
        let state = PartState { cut_out: options.silhouette, blended: false, double_sided, own_depth };
        let full = scene_relief::Constants {
            method: options.method.code(),
            shadow: options.shadow as u32,
            normal_map: options.normal_map.is_some(),
            green_up: options.normal_map == Some(Green::Up),
            silhouette: options.silhouette,
            choose_mip: options.chooses_mip(),
            // The renderer sets the values of these constants later.
            own_depth: false,
            reversed: false,
            shadowed: false,
            fade: 0,
            // Reliefs have a single level of detail.
            morphed: false,
        };
        let surface = scene_relief::Constants { shadow: ReliefShadow::None as u32, ..full };
        let place = scene_relief::Constants { normal_map: false, green_up: false, ..surface };
        Self::new(Program::Relief, state, [full, surface, place].map(|constants| constants.list()))
    }

    /// The specialization of terrain patches, which are double-sided. `cut_out` tells whether they may have holes.
    pub fn terrain(style: TerrainStyle, cut_out: bool) -> Self {
        let wireframe = |wireframe| scene_terrain::Constants { wireframe, shadowed: false, fade: 0 }.list();
        let state = PartState { double_sided: true, cut_out, ..PartState::default() };
        let full = wireframe(style == TerrainStyle::Wireframe);
        Self::new(Program::Terrain, state, [full, wireframe(false), wireframe(false)])
    }

    /// The specialization of a part of a caller-defined kind.
    pub fn own(program: &KindProgram, state: PartState) -> Self {
        // The shader of every caller-defined kind declares these constants.
        let constants = [SHADOWED, OWN_DEPTH, REVERSED, FADE].map(|name| (name, 0.0)).to_vec();
        Self::new(Program::Own(program.clone()), state, std::array::from_fn(|_| constants.clone()))
    }

    pub fn program(&self) -> &Program {
        &self.0.program
    }

    pub fn state(&self) -> PartState {
        self.0.state
    }

    /// The override constants for a group of layers. The renderer sets some of them by these arguments: whether shading
    /// samples a sun's shadow map, whether depth falls with distance, and how fading instances are drawn.
    pub fn constants(&self, shown: Shown, shadowed: bool, reversed: bool, fade: Fade) -> Constants {
        let flag = |value: bool| f64::from(u8::from(value));
        let set = [
            (SHADOWED, flag(shadowed)),
            (OWN_DEPTH, flag(self.0.state.own_depth == OwnDepth::Always)),
            (REVERSED, flag(reversed)),
            (FADE, f64::from(fade as u32)),
        ];
        let value = |(name, value): &(&'static str, f64)| {
            let set = set.iter().find(|(known, _)| known == name);
            (*name, set.map_or(*value, |(_, set)| *set))
        };
        self.0.constants[shown as usize].iter().map(value).collect()
    }
}

/// How fading instances are drawn. Each pipeline is compiled for one of these ways.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(crate) enum Fade {
    /// The pipeline draws only instances that do not fade.
    #[default]
    None = FADE_NONE as isize,
    Dither = FADE_DITHER as isize,
    Blend = FADE_BLEND as isize,
    /// Only the level with the larger weight is drawn.
    Heavier = FADE_HEAVIER as isize,
    /// The surface is pushed away from the eye, to write depth that hides the inside of both levels of a cross-fade.
    Pushed = FADE_PUSHED as isize,
}

/// Names of the override constants that the renderer sets.
const SHADOWED: &str = "relievo_SHADOWED";
const OWN_DEPTH: &str = "relievo_OWN_DEPTH";
const REVERSED: &str = "relievo_REVERSED";
const FADE: &str = "relievo_FADE";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_ones_are_equal_and_others_differ() {
        let mesh = |double_sided, textured| {
            Specialization::mesh(PartState { double_sided, ..PartState::default() }, textured, false, false)
        };
        assert_eq!(mesh(true, true), mesh(true, true));
        assert_ne!(mesh(true, true), mesh(true, false));
        assert_ne!(mesh(true, true), mesh(false, true));
        assert_ne!(mesh(true, false), Specialization::terrain(TerrainStyle::Textured, false));
    }

    #[test]
    fn the_renderers_constants_are_set_where_the_shader_has_them() {
        let relief =
            Specialization::relief(&ReliefOptions { depth: true, ..ReliefOptions::default() }, false);
        let found = relief.constants(Shown::Lit, true, true, Fade::Blend);
        for name in [SHADOWED, OWN_DEPTH, REVERSED] {
            assert!(found.contains(&(name, 1.0)), "{name} in {found:?}");
        }
        let mut terrain = Specialization::terrain(TerrainStyle::Wireframe, false).constants(
            Shown::Place,
            false,
            true,
            Fade::None,
        );
        terrain.sort_by_key(|(name, _)| *name);
        assert_eq!(terrain, [(FADE, 0.0), (SHADOWED, 0.0), ("relievo_WIREFRAME", 0.0)]);
    }
}
