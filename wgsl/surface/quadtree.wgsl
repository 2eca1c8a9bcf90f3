// Max-mip traversal (thesis B section 2.3.4; Tevs, Ihrke and Seidel 2008). If the ray passes above a node, the whole node is
// skipped. In a leaf, the ray is intersected exactly with the bilinear patch.
import package::wgsl::surface::ray::{SURFACE_EXHAUSTED, SURFACE_HIT, SurfaceHit, SurfaceMarch, SurfaceRay, surface_missed, surface_point};
import package::wgsl::surface::grid::{SurfaceGrid, SurfaceNode, surface_beyond, surface_bound, surface_cell, surface_corner, surface_corners, surface_exits, surface_grid, surface_node, surface_patch};
import package::wgsl::surface::atlas::{surface_atlas_at, surface_levels};

// Traces a ray by max-mip traversal. `pyramid` is the max-mip pyramid of `heights`, computed by surface/height_pyramid. Only
// the address mode of `march` is used.
fn surface_quadtree(
    heights: texture_2d<f32>, pyramid: texture_2d<f32>, ray: SurfaceRay, march: SurfaceMarch,
) -> SurfaceHit {
    if !(ray.cosine > 0.0) {
        return surface_missed(ray);
    }
    let grid = surface_grid(textureDimensions(heights), ray, march.address);
    let top = surface_levels(vec2<u32>(grid.cells)) - 1u;
    let bound = surface_bound(grid, top);
    // The traversal starts with nodes of half the ray's length, because larger nodes can rarely be skipped.
    let longest = u32(max(abs(grid.travel.x), abs(grid.travel.y)));
    var level = min(firstLeadingBit(max(longest / 2u, 1u)), top);
    var cell = vec2<i32>(0);
    var parameter = 0.0;
    var samples = 0u;
    var step = 0u;
    while step < bound {
        // Visits of nodes have a loop of their own. In this loop, a ray waits only for the visits of the other rays in its
        // workgroup, not for their intersections with patches.
        var node: SurfaceNode;
        var exits: vec2<f32>;
        var leave: f32;
        var is_leaf = false;
        while step < bound {
            step += 1u;
            node = surface_node(grid, cell, level);
            exits = surface_exits(grid, node);
            leave = clamp(min(exits.x, exits.y), parameter, 1.0);
            let at = surface_atlas_at(vec2<u32>(grid.cells), level, node.index);
            let highest = textureLoad(pyramid, at, 0).r;
            samples += 1u;
            if 1.0 - leave > highest {
                cell = surface_beyond(grid, node, exits, leave);
                parameter = leave;
                level = min(level + select(0u, 1u, surface_leaves_parent(grid, node, exits, level)), top);
                continue;
            }
            parameter = max(parameter, 1.0 - highest);
            if level == 0u {
                is_leaf = true;
                break;
            }
            level -= 1u;
            cell = surface_cell(grid, node, parameter);
        }
        if !is_leaf {
            break;
        }
        let corners = surface_corners(heights, grid, node.index);
        samples += 4u;
        let found = surface_patch(grid, corners, surface_corner(node), parameter, leave);
        if found >= 0.0 {
            return surface_point(ray, found, samples, SURFACE_HIT);
        }
        if leave >= 1.0 {
            parameter = 1.0;
            break;
        }
        cell = surface_beyond(grid, node, exits, leave);
        parameter = leave;
        level = min(select(0u, 1u, surface_leaves_parent(grid, node, exits, 0u)), top);
    }
    // A ray that reaches the bottom of the volume has hit, because no surface lies below the bottom.
    let outcome = select(SURFACE_EXHAUSTED, SURFACE_HIT, parameter >= 1.0);
    return surface_point(ray, parameter, samples, outcome);
}

// Whether the ray leaves a node and the node's parent through the same edge.
fn surface_leaves_parent(grid: SurfaceGrid, node: SurfaceNode, exits: vec2<f32>, level: u32) -> bool {
    let along_x = exits.x <= exits.y;
    let index = select(node.index.y, node.index.x, along_x);
    let cells = select(grid.cells.y, grid.cells.x, along_x);
    let forward = select(grid.travel.y, grid.travel.x, along_x) >= 0.0;
    let is_odd = (index & 1) == 1;
    let is_last = ((index + 1) << level) >= cells;
    return select(!is_odd, is_odd || is_last, forward);
}
