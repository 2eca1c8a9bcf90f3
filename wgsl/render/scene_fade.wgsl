// Drawing of instances that fade from one level of detail to the next, or fade out.
import package::wgsl::lod::object::{FADE_STEPS, fade_rest, fade_weight, list_entry_instance, list_entry_level, list_entry_steps};
import package::wgsl::render::scene_view::view;

// Method by which list entries with fade words are drawn: one of the constants below. The renderer sets it for lists of
// instances that fade.
override FADE: u32 = 0u;
// Fade method of lists in which no instance fades.
const FADE_NONE = 0u;
// Fade method: an instance is drawn in a pattern of pixels.
const FADE_DITHER = 1u;
// Fade method: an instance is blended, with its weight as alpha.
const FADE_BLEND = 2u;
// Fade method: an instance is drawn if its weight is more than half of `FADE_STEPS`.
const FADE_HEAVIER = 3u;
// Fade method for depth: surfaces are pushed away from the eye. The pushed depth hides the interior of both levels of a
// cross-fade, but does not hide their outer surfaces.
const FADE_PUSHED = 4u;

// Word that the vertex shader passes on after the kind's own words. It holds the instance, its fade word, its level, and
// whether triangles seen from outside run counter-clockwise on screen.
// packed SceneWord: instance 20, fade 8, level 3, counter_clockwise 1

// Position in clip space of a point that is relative to the corner of the view's cell. If the instance is not drawn, the
// position is outside clip space.
fn scene_clip(entry: u32, position: vec3<f32>) -> vec4<f32> {
    let clip = view.clip_from_world * vec4<f32>(position, 1.0);
    if FADE == FADE_HEAVIER && 2u * fade_weight(list_entry_steps(entry)) <= FADE_STEPS {
        return vec4<f32>(2.0, 2.0, 2.0, 1.0);
    }
    return clip;
}

// Word that describes a list entry to the fragment shader (`scene_word_word`).
fn entry_word(entry: u32, is_counter_clockwise: bool) -> u32 {
    let fade = select(0u, list_entry_steps(entry) & 0xffu, FADE == FADE_DITHER || FADE == FADE_BLEND);
    return scene_word_word(list_entry_instance(entry), fade, list_entry_level(entry), u32(is_counter_clockwise));
}

// Alpha of an instance that is blended while it fades, 0 to 1; 1 for other fade methods.
fn faded_alpha(word: u32) -> f32 {
    return select(1.0, f32(fade_weight(scene_word_fade(word))) / f32(FADE_STEPS), FADE == FADE_BLEND);
}

// Whether the pattern of a fade leaves a pixel to the other level. `pixel` is the pixel's position in the target, from the
// upper left corner.
fn is_left_out(word: u32, pixel: vec2<f32>) -> bool {
    let fade = scene_word_fade(word);
    let is_covered = 2u * pattern_rank(vec2<u32>(pixel) + view.dither_offset) < fade_weight(fade);
    return FADE == FADE_DITHER && is_covered == (fade_rest(fade) != 0u);
}

// Rank of a pixel, 0 to 63, in an 8 × 8 ordered-dither matrix (Bayer 1973). The bits of the rank are the bits of x ^ y and y,
// interleaved and reversed.
fn pattern_rank(pixel: vec2<u32>) -> u32 {
    let x = pixel.x ^ pixel.y;
    var rank = 0u;
    for (var bit = 0u; bit < 3u; bit++) {
        rank = (rank << 2u) | (((x >> bit) & 1u) << 1u) | ((pixel.y >> bit) & 1u);
    }
    return rank;
}
