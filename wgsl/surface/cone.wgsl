// Cone stepping over `cone_map`. Each cell stores the height of its highest corner, and the radius of a cone on that corner.
// Inside the cone, a ray crosses the surface at most once, so no step can pass the first crossing unnoticed. A binary search
// finds the crossing between the last two points (thesis B section 2.3.3; Policarpo and Oliveira 2007, made safe under bilinear
// filtering).
import package::wgsl::surface::ray::{SURFACE_EXHAUSTED, SURFACE_HIT, SurfaceHit, SurfaceMarch, SurfaceRay, surface_missed, surface_point};
import package::wgsl::surface::grid::{SurfaceGrid, SurfaceNode, surface_beyond, surface_bound, surface_cell, surface_corner, surface_corners, surface_exits, surface_grid, surface_node, surface_patch};
import package::wgsl::surface::linear::surface_narrowed;

// Traces a ray by cone stepping. `cones` is the cone map of `heights`, computed by surface/cone_map. Only the address mode and
// the number of binary steps of `march` are used.
fn surface_cone(
    heights: texture_2d<f32>, cones: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch,
) -> SurfaceHit {
    if !(ray.cosine > 0.0) {
        return surface_missed(ray);
    }
    let grid = surface_grid(textureDimensions(heights), ray, march.address);
    let distance = length(grid.travel);
    let bound = surface_bound(grid, 0u);
    var cell = vec2<i32>(0);
    var parameter = 0.0;
    // The last parameter at which the ray is known to be above the surface.
    var above = 0.0;
    var samples = 0u;
    var step = 0u;
    while step < bound {
        // Steps above the surface have a loop of their own. In this loop, a ray waits only for the steps of the other rays in
        // its workgroup, not for their intersections with patches.
        var node: SurfaceNode;
        var exits: vec2<f32>;
        var leave: f32;
        var is_near = false;
        while step < bound {
            step += 1u;
            node = surface_node(grid, cell, 0u);
            exits = surface_exits(grid, node);
            leave = clamp(min(exits.x, exits.y), parameter, 1.0);
            // Height of the cell's highest corner (r), and radius of the cone in cells at height 1 above the corner (g).
            let cone = textureLoad(cones, node.index, 0).rg;
            samples += 1u;
            if 1.0 - leave <= cone.r {
                is_near = true;
                break;
            }
            above = parameter;
            let reach = parameter + cone.g * (1.0 - parameter - cone.r) / (distance + cone.g);
            if reach > leave {
                parameter = min(reach, 1.0);
                cell = vec2<i32>(floor(grid.start + parameter * grid.travel));
            } else {
                cell = surface_beyond(grid, node, exits, leave);
                parameter = leave;
            }
        }
        if !is_near {
            break;
        }
        let corners = surface_corners(heights, grid, node.index);
        samples += 4u;
        let found = surface_patch(grid, corners, surface_corner(node), parameter, leave);
        if found > parameter || (found == parameter && above == parameter) {
            return surface_point(ray, found, samples, SURFACE_HIT);
        }
        if found >= 0.0 {
            // Cones belong to mip level 0 of the heights.
            var level = march;
            level.mip = 0u;
            return surface_narrowed(heights, ray, level, above, parameter, samples);
        }
        above = parameter;
        if leave >= 1.0 {
            parameter = 1.0;
            break;
        }
        cell = surface_beyond(grid, node, exits, leave);
        parameter = leave;
    }
    // A ray that reaches the bottom of the volume has hit, because no surface lies below the bottom.
    let outcome = select(SURFACE_EXHAUSTED, SURFACE_HIT, parameter >= 1.0);
    return surface_point(ray, parameter, samples, outcome);
}
