//! Height map of thin tall posts. A whole post fits between two steps of a linear search, which therefore misses it (B figure
//! 3.6).

use super::noise::{Noise, cell, random};
use super::{Pattern, Sample, shade};

/// Number of posts along an edge of the tile.
const POSTS: usize = 8;

/// Number of posts in the tile.
#[cfg(test)]
pub const COUNT: usize = POSTS * POSTS;

/// Texels along an edge of the tile for which the posts' positions and widths are whole numbers of texels.
const TEXELS: f64 = 256.0;

const WOOD: [f64; 3] = [214.0, 178.0, 122.0];
const PAINT: [f64; 3] = [186.0, 46.0, 38.0];
const FLOOR: [f64; 3] = [104.0, 112.0, 108.0];

pub struct Posts {
    posts: Vec<Post>,
    floor: Noise,
    grain: Noise,
}

#[derive(Clone, Copy)]
struct Post {
    /// Left and upper edge of the post, in tiles, relative to the corner of the post's cell.
    start: [f64; 2],
    /// Width of the post in tiles.
    width: f64,
    height: f64,
    color: [f64; 3],
}

impl Posts {
    /// Places the posts for a tile of `size` × `size` texels, with no post thinner than one texel.
    pub fn new(size: u32) -> Self {
        let post = |index| post([index % POSTS, index / POSTS], 1.0 / f64::from(size));
        let posts = (0..POSTS * POSTS).map(post).collect();
        Self { posts, floor: Noise::new(31, 8, 3), grain: Noise::new(32, 64, 2) }
    }
}

fn post(id: [usize; 2], texel: f64) -> Post {
    let ([place_x, place_y], [width, height], [paint, tone]) =
        (random(33, id), random(34, id), random(35, id));
    let width = 2.0 + (3.0 * width).floor();
    let room = TEXELS / POSTS as f64 - 12.0;
    let start = [place_x, place_y].map(|along| (4.0 + (room * along).floor()) / TEXELS);
    let color = if paint < 0.25 { PAINT } else { WOOD };
    Post {
        start,
        width: (width / TEXELS).max(texel * 1.000_001),
        height: 0.76 + 0.24 * height,
        color: shade(color, 0.88 + 0.2 * tone),
    }
}

impl Pattern for Posts {
    fn at(&self, u: f64, v: f64) -> Sample {
        let ((x, s), (y, t)) = (cell(u * POSTS as f64, POSTS), cell(v * POSTS as f64, POSTS));
        let post = self.posts[y * POSTS + x];
        let grain = self.grain.signed(u, v);
        let within = |along: f64, axis: usize| {
            let offset = along / POSTS as f64 - post.start[axis];
            offset >= 0.0 && offset < post.width
        };
        if within(s, 0) && within(t, 1) {
            return Sample { height: post.height, color: shade(post.color, 1.0 + 0.08 * grain) };
        }
        let floor = self.floor.at(u, v);
        let height = 0.03 + 0.07 * floor + 0.012 * grain;
        Sample { height, color: shade(FLOOR, 0.72 + 0.45 * floor + 0.12 * grain) }
    }
}
