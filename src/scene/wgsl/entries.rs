//! Generates WGSL entry points that draw a kind of object into render outputs. For the crate's own kinds, `relievo-shaders`
//! does so; for callers' kinds, the crate does at run time.
//!
//! A kind `mesh` exports the WGSL functions `mesh_place`, `mesh_surface` and, unless it moves as a rigid body,
//! `mesh_last_position` (`wgsl/render/scene_kind.wgsl`). The crate's own kinds declare their properties in a line such as `//
//! kind mesh: blends`. An output `surface` exports a struct of render targets, `SurfaceTargets`, and a function
//! `surface_write(Surface) -> SurfaceTargets`.

use std::fmt::Write as _;

/// A kind of object: its name, and which features its parts may use.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KindText<'a> {
    /// Name of the kind, which is the prefix of the WGSL functions that it exports.
    pub name: &'a str,
    /// Whether parts of such objects may be alpha-blended with the background.
    pub blends: bool,
    /// Whether parts of such objects may write their own depth, `Surface.depth`.
    pub deep: bool,
    /// Whether the kind exports `last_position`. If not, objects of this kind only move rigidly with their instances.
    pub moves: bool,
}

impl<'a> KindText<'a> {
    /// Reads the kind that a WGSL text declares with a line `// kind NAME: PROPERTIES`; `None` if there is no such line.
    ///
    /// # Errors
    /// A message for a line without a colon or with an unknown property.
    pub fn declared(text: &'a str) -> Result<Option<Self>, String> {
        let Some(line) = text.lines().find_map(|line| line.strip_prefix("// kind ")) else { return Ok(None) };
        let (name, properties) = line.split_once(':').ok_or("// kind NAME: needs a colon")?;
        let mut kind = Self { name, blends: false, deep: false, moves: true };
        for property in properties.split(',').map(str::trim).filter(|property| !property.is_empty()) {
            match property {
                "blends" => kind.blends = true,
                "deep" => kind.deep = true,
                other => return Err(format!("// kind {name}: `{other}` is not blends or deep")),
            }
        }
        Ok(Some(kind))
    }
}

/// An output: a set of render targets that receive the surfaces of fragments. The output `depth` is not among them. Its entry
/// points are generated separately, because depth alone needs no surface unless fragments are discarded.
#[derive(Debug, Clone)]
pub struct OutputText {
    /// Name of the output, which is the prefix of the WGSL items that it exports.
    pub name: String,
    /// Prefix of the names of the output's entry points.
    pub entry: String,
    /// Members of the output's struct of targets, in order; each text has attribute, name and type.
    pub members: Vec<String>,
    /// Whether the output needs the position in the last frame, `Surface.last_position`.
    pub moves: bool,
}

impl OutputText {
    /// Creates one of the crate's outputs. `text` is WGSL that declares the output's struct of targets.
    pub fn new(name: &str, text: &str, moves: bool) -> Self {
        let head = format!("struct {} {{", targets_of(name));
        let (_, rest) = text.split_once(&head).expect("an output declares its targets");
        let body = rest.split_once('}').map_or(rest, |(body, _)| body);
        let members = body.split(',').filter_map(|text| Some(text[text.find('@')?..].trim_end().to_owned()));
        Self { name: name.to_owned(), entry: name.to_owned(), members: members.collect(), moves }
    }

    /// Creates an output of the caller. Its entry points get the prefix `own_`, so that it may have the name of one of the
    /// crate's outputs.
    #[allow(dead_code)] // build.rs has none
    pub fn own(name: &str, members: Vec<String>, moves: bool) -> Self {
        Self { name: name.to_owned(), entry: format!("own_{name}"), members, moves }
    }

    /// Reads all outputs that a WGSL text declares with lines such as `// output velocity: moves`.
    ///
    /// # Errors
    /// A message for an unknown property of an output.
    pub fn declared(text: &str) -> Result<Vec<Self>, String> {
        let lines = text.lines().filter_map(|line| line.strip_prefix("// output "));
        let output = |line: &str| match line.split_once(": ") {
            None => Ok(Self::new(line, text, false)),
            Some((name, "moves")) => Ok(Self::new(name, text, true)),
            Some((name, other)) => Err(format!("// output {name}: `{other}` is not moves")),
        };
        lines.map(output).collect()
    }

    /// Name of the output's struct of targets.
    pub fn targets(&self) -> String {
        targets_of(&self.name)
    }

    /// Names of the members of the output's struct of targets.
    fn member_names(&self) -> impl Iterator<Item = &str> {
        self.members.iter().filter_map(|member| member.split(':').next()?.split_whitespace().last())
    }
}

/// Name of an output's struct of targets, such as `UvTargets` for the output `uv`.
pub fn targets_of(name: &str) -> String {
    let (first, rest) = name.split_at(1);
    format!("{}{rest}Targets", first.to_uppercase())
}

/// Name of an output's fragment entry point. `discards`: fragments may be discarded (cut-outs or dithering). `deep`: the part
/// writes its own depth.
pub fn fragment_entry(output: &str, discards: bool, deep: bool) -> String {
    format!("{output}{}{}", if discards { "_cut" } else { "" }, if deep { "_deep" } else { "" })
}

/// Names of the WGSL functions of a kind that the kind's entry points call.
pub fn exports(kind: &KindText<'_>) -> [String; 3] {
    ["place", "last_position", "surface"].map(|name| format!("{}_{name}", kind.name))
}

/// WGSL text to which a caller's kind is added. It has `core`, the flat text of everything that entry points use, and the kind's
/// entry points for `outputs`, given as (name, needs motion). All names except the caller's get the crate's prefix.
pub fn composed(kind: &KindText<'_>, core: &str, outputs: &[(&str, bool)]) -> String {
    let output = |(name, moves): &(&str, bool)| OutputText::new(name, core, *moves);
    let outputs: Vec<_> = outputs.iter().map(output).collect();
    super::prefix::prefixed_with(&super::prefix::prefixed(core), &entries(kind, &outputs), &exports(kind))
}

/// WGSL text of all entry points of a kind. Vertex entries are `vertex`, `vertex_moving` (adds the position in the last frame)
/// and `vertex_depth` (position only). Fragment entries are those of `depth` and of each output.
pub fn entries(kind: &KindText<'_>, outputs: &[OutputText]) -> String {
    let name = kind.name;
    let mut text = String::new();
    for (varyings, entry, moves) in [("Varyings", "vertex", false), ("MovingVaryings", "vertex_moving", true)]
    {
        let (more, last) = match (moves, kind.moves) {
            (false, _) => ("", String::new()),
            (true, true) => (MOVING, format!(", {name}_last_position(entry, vertex)")),
            (true, false) => (MOVING, ", scene_last_rigid(entry, placed.position)".to_owned()),
        };
        write!(
            text,
            "struct {varyings} {{{VARYINGS}{more}
}}

@vertex
fn {entry}(@builtin(vertex_index) vertex: u32, @location(0) entry: u32) -> {varyings} {{
    let placed = {name}_place(entry, vertex);
    return {varyings}(
        scene_clip(entry, placed.position), placed.position, placed.normal, placed.tangent, placed.uv,
        placed.values, scene_words(placed, entry){last});
}}

"
        )
        .expect("a string");
    }
    write!(
        text,
        "struct Position {{
    @invariant @builtin(position) clip: vec4<f32>,
}}

@vertex
fn vertex_depth(@builtin(vertex_index) vertex: u32, @location(0) entry: u32) -> Position {{
    return Position(scene_clip(entry, {name}_place(entry, vertex).position));
}}

@fragment
fn depth() {{}}

"
    )
    .expect("a string");
    let seen_whole = seen(name, false);
    write!(text, "@fragment\nfn depth_cut({ARGUMENTS}) {{\n{seen_whole}{DISCARD}}}\n\n").expect("a string");
    if kind.deep {
        for discards in [false, true] {
            let entry = fragment_entry("depth", discards, true);
            let (seen, discard) = (seen(name, false), if discards { DISCARD } else { "" });
            write!(
                text,
                "@fragment\nfn {entry}({ARGUMENTS}) -> @builtin(frag_depth) f32 {{\n    let slope = fwidth(in.clip.z);\n\
                 {seen}{discard}    return depth_behind(surface.depth, in.clip.z, slope);\n}}\n\n"
            )
            .expect("a string");
        }
    }
    for output in outputs {
        text += &fragments(kind, output);
    }
    text
}

/// WGSL text of all fragment entry points of an output, one for each combination of features that parts of the kind may use.
pub fn fragments(kind: &KindText<'_>, output: &OutputText) -> String {
    let mut text = String::new();
    for deep in [false, true].into_iter().filter(|deep| kind.deep || !deep) {
        text += &fragment(kind, output, false, deep);
        text += &fragment(kind, output, true, deep);
    }
    text
}

/// WGSL text of one fragment entry point of an output.
fn fragment(kind: &KindText<'_>, output: &OutputText, discards: bool, deep: bool) -> String {
    let entry = fragment_entry(&output.entry, discards, deep);
    let (seen, discard) = (seen(kind.name, output.moves), if discards { DISCARD } else { "" });
    let (targets, varyings) = (output.targets(), if output.moves { "MovingVaryings" } else { "Varyings" });
    let write = format!("{}_write(surface)", output.name);
    let arguments = ARGUMENTS.replace("Varyings", varyings);
    if !deep {
        return format!(
            "@fragment\nfn {entry}({arguments}) -> {targets} {{\n{seen}    let targets = {write};\n{discard}    return targets;\n}}\n\n"
        );
    }
    let declared: String = output.members.iter().map(|member| format!("    {member},\n")).collect();
    let values: String = output.member_names().map(|member| format!("targets.{member}, ")).collect();
    format!(
        "struct {entry}_targets {{\n{declared}    @builtin(frag_depth) depth: f32,\n}}\n\n\
         @fragment\nfn {entry}({arguments}) -> {entry}_targets {{\n{seen}    let targets = {write};\n{discard}    \
         return {entry}_targets({values}surface.depth);\n}}\n\n"
    )
}

/// WGSL statement that evaluates the kind's surface function for a fragment.
fn seen(kind: &str, moves: bool) -> String {
    let last = if moves { "in.last" } else { "in.position" };
    format!(
        "    let surface = {kind}_surface(SceneFragment(
        in.position, in.normal, in.tangent, in.uv, in.values, in.words.xyz, words_instance(in.words), {last}, in.clip,
        words_outside(in.words, is_front), words_level(in.words), words_fade(in.words)));
"
    )
}

const ARGUMENTS: &str = "in: Varyings, @builtin(front_facing) is_front: bool";

/// WGSL that discards a fragment. It must come after everything that needs derivatives.
const DISCARD: &str = "    if surface.alpha < surface.cutoff || is_left_out(in.words.w, in.clip.xy) {\n        discard;\n    }\n";

/// Members that every vertex entry outputs. `@invariant` makes all pipelines of a view compute the same bits of the position.
const VARYINGS: &str = "
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec4<f32>,
    @location(3) uv: vec4<f32>,
    @location(4) values: vec4<f32>,
    @location(5) @interpolate(flat) words: vec4<u32>,";

/// Additional member that vertex entries output if the render output needs motion.
const MOVING: &str = "
    @location(6) last: vec3<f32>,";
