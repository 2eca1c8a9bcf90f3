// The outputs `color` and `transparent`: the lit colour of a surface. All lighting of a scene happens here.
// output color
// output transparent
import package::wgsl::render::scene_shade::{Surface, shade};
import package::wgsl::render::scene_shadow::{SHADOWED, scene_sunlit};
import package::wgsl::render::scene_view::scene_seen_by;

// Targets of the output `color`.
struct ColorTargets {
    // Linear lit colour and alpha.
    @location(0) color: vec4<f32>,
}

// Targets of the output `transparent`.
struct TransparentTargets {
    // Linear lit colour and alpha.
    @location(0) color: vec4<f32>,
}

// Linear lit colour and alpha of a surface, including the shadow from the shadow map.
fn lit(given: Surface) -> vec4<f32> {
    var surface = given;
    if SHADOWED {
        surface.sunlit *= scene_sunlit(surface.light_position, surface.geometric_normal);
    }
    return mix(shade(surface, scene_seen_by()), vec4<f32>(surface.unlit.rgb, 1.0), surface.unlit.w);
}

// Target values of an opaque surface. Its alpha is 1, or less while a fade is blended. The material's alpha only decides which
// pixels are discarded.
fn color_write(given: Surface) -> ColorTargets {
    var surface = given;
    surface.alpha = surface.fade;
    return ColorTargets(lit(surface));
}

// Target values of a transparent surface: alpha is the material's alpha, reduced while a fade is blended.
fn transparent_write(given: Surface) -> TransparentTargets {
    var surface = given;
    surface.alpha *= surface.fade;
    return TransparentTargets(lit(surface));
}
