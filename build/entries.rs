//! Generates the entry points with which a kind of object is drawn into outputs, as WGSL: at build time for the crate's own
//! kinds, and at run time for those of callers.
//!
//! A kind exports `mesh_place`, `mesh_surface` and, unless it moves as a rigid body, `mesh_last_position`
//! (`wgsl/render/scene_kind.wgsl`). The crate's own say with a line such as `// kind mesh: blends` what their parts
//! may need. An output exports a struct of its targets and a function: `SurfaceTargets` and
//! `surface_write(Surface) -> SurfaceTargets`.

use std::fmt::Write as _;

/// What the parts of a kind may need.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KindText<'a> {
    /// What the names of its exports begin with.
    pub name: &'a str,
    /// Whether parts may be blended with what is behind them.
    pub blends: bool,
    /// Whether parts may write `Surface.depth`.
    pub deep: bool,
    /// Whether it exports `last_position`; else it moves with its instances alone.
    pub moves: bool,
}

impl<'a> KindText<'a> {
    /// The kind that a text declares, if it declares one.
    ///
    /// # Errors
    /// The word that is no property of a kind.
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

/// An output of surfaces. `depth`, which needs no surface of parts that are drawn whole, is generated beside these.
#[derive(Debug, Clone)]
pub struct OutputText {
    /// What the names of its exports begin with.
    pub name: String,
    /// What the names of its entry points begin with.
    pub entry: String,
    /// The declarations of the colours in the struct of its targets, in order: attribute, name and type.
    pub members: Vec<String>,
    /// Whether it needs `Surface.last_position`.
    pub moves: bool,
}

impl OutputText {
    /// An output of the crate's, whose targets a text declares.
    pub fn new(name: &str, text: &str, moves: bool) -> Self {
        let head = format!("struct {} {{", targets_of(name));
        let (_, rest) = text.split_once(&head).expect("an output declares its targets");
        let body = rest.split_once('}').map_or(rest, |(body, _)| body);
        let members = body.split(',').filter_map(|text| Some(text[text.find('@')?..].trim_end().to_owned()));
        Self { name: name.to_owned(), entry: name.to_owned(), members: members.collect(), moves }
    }

    /// An output of the caller's. Its entry points have names of their own, so that it may be called as one of the crate's.
    #[allow(dead_code)] // build.rs has none
    pub fn own(name: &str, members: Vec<String>, moves: bool) -> Self {
        Self { name: name.to_owned(), entry: format!("own_{name}"), members, moves }
    }

    /// The outputs that a text declares, with lines such as `// output velocity: moves`.
    ///
    /// # Errors
    /// The word that is no property of an output.
    pub fn declared(text: &str) -> Result<Vec<Self>, String> {
        let lines = text.lines().filter_map(|line| line.strip_prefix("// output "));
        let output = |line: &str| match line.split_once(": ") {
            None => Ok(Self::new(line, text, false)),
            Some((name, "moves")) => Ok(Self::new(name, text, true)),
            Some((name, other)) => Err(format!("// output {name}: `{other}` is not moves")),
        };
        lines.map(output).collect()
    }

    /// The struct of its targets.
    pub fn targets(&self) -> String {
        targets_of(&self.name)
    }

    /// The names of the members of that struct.
    fn member_names(&self) -> impl Iterator<Item = &str> {
        self.members.iter().filter_map(|member| member.split(':').next()?.split_whitespace().last())
    }
}

/// The struct of an output's targets: `UvTargets` of `uv`.
pub fn targets_of(name: &str) -> String {
    let (first, rest) = name.split_at(1);
    format!("{}{rest}Targets", first.to_uppercase())
}

/// The name of the fragment entry of an output: for parts that discard (cut out, or dithered), and for those that write their
/// own depth.
pub fn fragment_entry(output: &str, discards: bool, deep: bool) -> String {
    format!("{output}{}{}", if discards { "_cut" } else { "" }, if deep { "_deep" } else { "" })
}

/// The names that the entries of a kind use of its own text.
pub fn exports(kind: &KindText<'_>) -> [String; 3] {
    ["place", "last_position", "surface"].map(|name| format!("{}_{name}", kind.name))
}

/// What a caller's kind stands beside: `core`, the flat text of everything that entry points use, with the entry points of the
/// outputs that it has. All names but the caller's have the prefix of the crate.
pub fn composed(kind: &KindText<'_>, core: &str, outputs: &[(&str, bool)]) -> String {
    let output = |(name, moves): &(&str, bool)| OutputText::new(name, core, *moves);
    let outputs: Vec<_> = outputs.iter().map(output).collect();
    super::prefix::prefixed_with(&super::prefix::prefixed(core), &entries(kind, &outputs), &exports(kind))
}

/// The entry points of a kind: `vertex`, `vertex_moving` with the last position, `vertex_depth` with the position alone, and
/// the fragment entries of `depth` and of each output.
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

/// The fragment entries of an output, for every part that a kind may have.
pub fn fragments(kind: &KindText<'_>, output: &OutputText) -> String {
    let mut text = String::new();
    for deep in [false, true].into_iter().filter(|deep| kind.deep || !deep) {
        text += &fragment(kind, output, false, deep);
        text += &fragment(kind, output, true, deep);
    }
    text
}

/// A fragment entry of an output.
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

/// The line that gets the surface of a fragment.
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

/// After everything that needs derivatives.
const DISCARD: &str = "    if surface.alpha < surface.cutoff || is_left_out(in.words.w, in.clip.xy) {\n        discard;\n    }\n";

/// What every vertex hands over. Pipelines of one view give equal bits.
const VARYINGS: &str = "
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) tangent: vec4<f32>,
    @location(3) uv: vec4<f32>,
    @location(4) values: vec4<f32>,
    @location(5) @interpolate(flat) words: vec4<u32>,";

/// What vertices of outputs with motion hand over besides.
const MOVING: &str = "
    @location(6) last: vec3<f32>,";
