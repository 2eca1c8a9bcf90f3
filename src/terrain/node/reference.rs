//! Tiles and facts of nodes: the CPU reference of `kernels/terrain/node.wgsl`.

use super::{NODE_MARGIN, NodeFacts, NodeShape};

/// The tile of a node, row by row, and its facts, from a region of [`NodeShape::region_width`]² finer heights.
pub fn node(shape: NodeShape, region: &[i32]) -> (Vec<i32>, NodeFacts) {
    let (width, step, margin) = (shape.region_width() as usize, 1_usize << shape.finer, NODE_MARGIN as usize);
    let at = |x: usize, y: usize| region[y * width + x];
    let every = || (0..width).step_by(step);
    let tile = every().flat_map(|y| every().map(move |x| at(x, y))).collect();
    let first = margin * step;
    let inner = || (0..=(shape.size as usize - 1) * step).map(|at| at + first);
    let own = || inner().flat_map(|y| inner().map(move |x| (x, y)));
    let mut facts = NodeFacts {
        lowest: own().map(|(x, y)| at(x, y)).min().unwrap_or(0),
        highest: own().map(|(x, y)| at(x, y)).max().unwrap_or(0),
        deviation: 0,
        stitched: 0,
        second_difference: 0,
    };
    for (x, y) in own() {
        facts.stitched =
            facts.stitched.max(stitched(shape, [x - first, y - first], &|x, y| at(x + first, y + first)));
        let [cell_x, cell_y] =
            [x, y].map(|at| ((at - first) / step).min(shape.size as usize - 2) * step + first);
        let [part_x, part_y] = [x - cell_x, y - cell_y];
        if part_x == 0 && part_y == 0 {
            continue;
        }
        let corner = |dx: usize, dy: usize| i64::from(at(cell_x + dx * step, cell_y + dy * step));
        let (start, part_x, part_y) = match part_x + part_y <= step {
            true => (corner(0, 0), part_x as i64, part_y as i64),
            false => (corner(1, 1), (step - part_y) as i64, (step - part_x) as i64),
        };
        let towards = |end: i64, part: i64| ((end - start) * part) >> shape.finer;
        let surface = start + towards(corner(1, 0), part_x) + towards(corner(0, 1), part_y);
        facts.deviation = facts.deviation.max(apart(at(x, y), surface));
    }
    let half = |a: i32, b: i32| ((a >> 1) + (b >> 1)).unsigned_abs() + 1;
    for (x, y) in (1..width - 1).flat_map(|y| (1..width - 1).map(move |x| (x, y))) {
        let (own, east, south) = (at(x, y), at(x + 1, y), at(x, y + 1));
        let along = [half(at(x - 1, y) - own, east - own), half(at(x, y - 1) - own, south - own)];
        let twist = half(own - east, at(x + 1, y + 1) - south);
        facts.second_difference = facts.second_difference.max(twist.max(along[0]).max(along[1]));
    }
    (tile, facts)
}

/// The distance of a height from a surface whose two terms are rounded down.
fn apart(height: i32, surface: i64) -> u32 {
    (i64::from(height) - surface).unsigned_abs() as u32 + 2
}

/// The largest deviation of a finer sample from the triangles of the node's stitched borders, 0 for samples that are not beside one.
fn stitched(shape: NodeShape, [x, y]: [usize; 2], height: &dyn Fn(usize, usize) -> i32) -> u32 {
    let (step, last) = (1_usize << shape.finer, (shape.size as usize - 1) << shape.finer);
    // The height `along` a side and `depth` samples inside. Sides: west, east, north, south.
    let height_at = |side: usize, along: usize, depth: usize| match side {
        0 => height(depth, along),
        1 => height(last - depth, along),
        2 => height(along, depth),
        _ => height(along, last - depth),
    };
    let sides = [(y, x), (y, last - x), (x, y), (x, last - y)];
    let mut largest = 0;
    for (side, (along, depth)) in sides.into_iter().enumerate().filter(|(_, (_, depth))| *depth < step) {
        let height = |along: usize, depth: usize| height_at(side, along, depth);
        let first = (along / (2 * step)).min((shape.size as usize - 3) / 2) * 2 * step;
        let [a, b] = [0, 2 * step].map(|at| i64::from(height(first + at, 0)));
        let [i, j, k] = [0, step, 2 * step].map(|at| i64::from(height(first + at, step)));
        let (at, depth) = ((along - first) as i64, depth as i64);
        let towards = |start: i64, end: i64, part: i64, shift: u32| ((end - start) * part) >> shift;
        let (finer, rest) = (shape.finer, 2 * step as i64 - at);
        let surface = if rest < depth {
            b + towards(b, k, depth - rest, finer) + towards(b, j, rest, finer)
        } else if at < depth {
            a + towards(a, i, depth - at, finer) + towards(a, j, at, finer)
        } else {
            a + towards(a, j, depth, finer) + towards(a, b, at - depth, finer + 1)
        };
        largest = largest.max(apart(height(along, depth as usize), surface));
        // The edge to J that crosses the diagonals of the finer cells.
        let (start, from, next) =
            if side % 2 == 0 { (a, at, along + 1) } else { (b, rest, along.wrapping_sub(1)) };
        if from == depth {
            let [inside, beside] = [height(along, depth as usize + 1), height(next, depth as usize)];
            let own = (i64::from(inside) + i64::from(beside)) >> 1;
            largest = largest.max(apart(own as i32, start + towards(start, j, 2 * depth + 1, finer + 1)) + 1);
        }
    }
    largest
}
