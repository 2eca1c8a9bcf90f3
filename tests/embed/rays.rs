//! What a camera sees in each pixel, computed on the host in f64 from triangles.

use glam::{DMat4, DVec3, DVec4, Mat4};
use relievo::asset::influences::{Influence, Influences};
use relievo::asset::material::Alpha;
use relievo::asset::{Bone, Material, Mesh, Model, Skeleton, Skin, Transform};
use relievo::scene::{Camera, Placement};

use crate::harness::is_coarse;

/// A triangle in the world, relative to cell (0, 0, 0).
#[derive(Clone, Copy)]
pub struct Triangle {
    pub corners: [DVec3; 3],
    /// What it belongs to: anything that the test wants to know.
    pub tag: usize,
    /// Whether it is seen from behind too.
    pub double_sided: bool,
}

/// What a ray meets first.
#[derive(Clone, Copy)]
pub struct Hit {
    pub triangle: usize,
    pub position: DVec3,
    /// Places of the triangle's plane, around what a pixel may show in place of `position`.
    around: [DVec3; 4],
}

impl Hit {
    /// By how much a value that depends on the place may differ from that at `position`.
    pub fn slack(&self, value: impl Fn(DVec3) -> f64) -> f64 {
        let wanted = value(self.position);
        // Values hardly bend within a part of a pixel.
        1.05 * self.around.iter().map(|place| (value(*place) - wanted).abs()).fold(0.0, f64::max)
    }
}

/// By how many pixels what a pixel shows may lie beside its middle: an adapter that rounds vertices to a sixteenth of a pixel
/// moves each place of a triangle by half of that at most.
pub fn pixels_beside() -> f64 {
    if is_coarse() { 1.0 / 32.0 } else { 0.0 }
}

fn clip_from_world(camera: &Camera) -> DMat4 {
    camera.clip_from_view.as_dmat4() * camera.view_from_cell.as_dmat4()
}

/// Where a camera shows a place, as a fraction of the picture, from its upper left.
pub fn shown(camera: &Camera, place: DVec3) -> [f64; 2] {
    let clip = clip_from_world(camera) * place.extend(1.0);
    [0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w]
}

/// The ray through a place of the picture in pixels: where it begins, on the near plane, and its direction.
fn ray(world_from_clip: DMat4, viewport: [u32; 2], pixel: [f64; 2]) -> [DVec3; 2] {
    let [x, y] = [0, 1].map(|axis| 2.0 * pixel[axis] / f64::from(viewport[axis]) - 1.0);
    let place = |depth: f64| {
        let point = world_from_clip * DVec4::new(x, -y, depth, 1.0);
        point.truncate() / point.w
    };
    [place(0.0), (place(0.5) - place(0.0)).normalize()]
}

/// The first triangle that a ray meets.
pub fn first(triangles: &[Triangle], ray: [DVec3; 2]) -> Option<Hit> {
    first_of(triangles, 0..triangles.len(), ray)
}

/// The first of some triangles that a ray meets.
fn first_of(
    triangles: &[Triangle],
    some: impl IntoIterator<Item = usize>,
    [from, along]: [DVec3; 2],
) -> Option<Hit> {
    let mut nearest: Option<(f64, Hit)> = None;
    for at in some {
        let triangle = &triangles[at];
        let [a, b, c] = triangle.corners;
        let (u, v) = (b - a, c - a);
        let normal = u.cross(v);
        let facing = -normal.dot(along);
        if facing.abs() < 1e-12 || facing < 0.0 && !triangle.double_sided {
            continue;
        }
        let (distance, position) = on_plane(triangle, [from, along]);
        let inside = position - a;
        let area = normal.length_squared();
        let weights = [inside.cross(v).dot(normal) / area, u.cross(inside).dot(normal) / area];
        let is_inside = weights[0] >= 0.0 && weights[1] >= 0.0 && weights[0] + weights[1] <= 1.0;
        if distance > 0.0 && is_inside && nearest.as_ref().is_none_or(|(before, _)| distance < *before) {
            nearest = Some((distance, Hit { triangle: at, position, around: [position; 4] }));
        }
    }
    nearest.map(|(_, hit)| hit)
}

/// Where a ray meets the plane of a triangle: how far along, and the place.
fn on_plane(triangle: &Triangle, [from, along]: [DVec3; 2]) -> (f64, DVec3) {
    let [a, b, c] = triangle.corners;
    let normal = (b - a).cross(c - a);
    let distance = (a - from).dot(normal) / normal.dot(along);
    (distance, from + distance * along)
}

/// For each pixel what its middle sees, or an error where rounding may decide: where places a hundredth of a pixel beside
/// it, or twice [`pixels_beside`] farther, see something else.
pub fn picture(triangles: &[Triangle], camera: &Camera) -> Vec<Result<Option<Hit>, ()>> {
    let [width, height] = camera.viewport;
    let pixels = (0..width * height).map(|at| [at % width, at / width].map(|edge| f64::from(edge) + 0.5));
    let tag = |hit: &Option<Hit>| hit.as_ref().map(|hit| triangles[hit.triangle].tag);
    let balls: Vec<Ball> = triangles.iter().map(Ball::around).collect();
    let (world_from_clip, off) = (clip_from_world(camera).inverse(), pixels_beside());
    pixels
        .map(|[x, y]| {
            let through = |[dx, dy]: [f64; 2]| ray(world_from_clip, camera.viewport, [x + dx, y + dy]);
            let middle = through([0.0; 2]);
            let edge = 0.01 + 2.0 * off;
            let beside = [[-edge, 0.0], [edge, 0.0], [0.0, -edge], [0.0, edge]].map(through);
            let apart = [0, 1]
                .map(|part| beside.iter().map(|ray| (ray[part] - middle[part]).length()).fold(0.0, f64::max));
            let is_near = |at: &usize| balls[*at].may_meet(middle, apart);
            let some: Vec<usize> = (0..triangles.len()).filter(is_near).collect();
            let first = |ray| first_of(triangles, some.iter().copied(), ray);
            let seen = first(middle);
            let is_sure = beside.iter().all(|ray| tag(&first(*ray)) == tag(&seen));
            let with_corners = |hit: Hit| {
                let corners = [[-off, -off], [off, -off], [-off, off], [off, off]].map(through);
                Hit { around: corners.map(|ray| on_plane(&triangles[hit.triangle], ray).1), ..hit }
            };
            let seen = if off > 0.0 { seen.map(with_corners) } else { seen };
            if is_sure { Ok(seen) } else { Err(()) }
        })
        .collect()
}

/// A ball around a triangle.
struct Ball {
    middle: DVec3,
    radius: f64,
}

impl Ball {
    fn around(triangle: &Triangle) -> Self {
        let corners = triangle.corners;
        let middle = corners.into_iter().sum::<DVec3>() / 3.0;
        let radius = corners.iter().map(|corner| (corner - middle).length()).fold(0.0, f64::max);
        Self { middle, radius }
    }

    /// Whether a ray may meet the ball, or a ray whose start and direction are at most `apart` from it.
    fn may_meet(&self, [from, along]: [DVec3; 2], apart: [f64; 2]) -> bool {
        let offset = self.middle - from;
        let farthest = offset.length() + self.radius + apart[0];
        let reach = self.radius + apart[0] + farthest * apart[1] + 1e-9 * farthest;
        (offset - offset.dot(along) * along).length_squared() <= reach * reach
    }
}

/// The matrix of a placement, relative to cell (0, 0, 0).
pub fn matrix(placement: &Placement) -> DMat4 {
    let turn = placement.turn.as_dquat().normalize();
    DMat4::from_scale_rotation_translation(placement.scale.as_dvec3(), turn, placement.world())
}

/// A model of given triangles, three corners each, at one bone that rests at the origin, with a normal for each triangle
/// and texture coordinates from its first two axes.
pub fn model(corners: &[[[f32; 3]; 3]], material: Material, double_sided: bool) -> Model {
    let bone = Bone { name: "bone".to_owned(), parent: None, rest: Transform::IDENTITY };
    let positions = corners.as_flattened().to_vec();
    let follows = (0..positions.len()).map(|_| vec![Influence { bone: 0, weight: 1.0 }]);
    let mesh = Mesh {
        name: "mesh".to_owned(),
        skin: 0,
        normals: corners.iter().flat_map(|corners| [normal(corners); 3]).collect(),
        tangents: corners.iter().flat_map(|corners| [tangent(corners); 3]).collect(),
        uv: positions.iter().map(|[x, y, _]| [*x, *y]).collect(),
        indices: (0..positions.len() as u32).collect(),
        double_sided,
        material: Some(0),
        influences: Influences::new("w", 1, follows).expect("one"),
        targets: Vec::new(),
        weights: Vec::new(),
        weight_keys: Vec::new(),
        positions,
        ..Mesh::default()
    };
    Model {
        skeleton: Skeleton::of_joints(vec![bone]).expect("a bone"),
        skins: vec![Skin {
            name: "skin".to_owned(),
            bones: vec![0],
            inverse_binds: vec![Mat4::IDENTITY.to_cols_array()],
        }],
        clips: Vec::new(),
        motion: None,
        meshes: vec![mesh],
        skinned: 1,
        materials: vec![material],
        images: Vec::new(),
    }
}

fn normal(corners: &[[f32; 3]; 3]) -> [f32; 3] {
    let [a, b, c] = corners.map(glam::Vec3::from);
    (b - a).cross(c - a).normalize().into()
}

fn tangent(corners: &[[f32; 3]; 3]) -> [f32; 4] {
    let [a, b, _] = corners.map(glam::Vec3::from);
    (b - a).normalize().extend(1.0).into()
}

/// A material of one colour.
pub fn plain(color: [f32; 4], alpha: Alpha) -> Material {
    Material {
        name: "plain".to_owned(),
        color,
        texture: None,
        normal: None,
        normal_scale: 1.0,
        alpha,
        pbr: Default::default(),
    }
}

/// The twelve triangles of a cube with edges of two units around the origin, two for each side.
pub fn cube() -> Vec<[[f32; 3]; 3]> {
    let mut all = Vec::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let corner = |u: f32, v: f32| {
                let mut corner = [0.0; 3];
                corner[axis] = side;
                corner[(axis + 1) % 3] = if side > 0.0 { u } else { v };
                corner[(axis + 2) % 3] = if side > 0.0 { v } else { u };
                corner
            };
            let [a, b, c, d] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            all.extend([[a, b, c], [a, c, d]]);
        }
    }
    all
}

/// Triangles where a placement has them; `tag` from their number.
pub fn placed(
    corners: &[[[f32; 3]; 3]],
    placement: &Placement,
    double_sided: bool,
    tag: impl Fn(usize) -> usize,
) -> Vec<Triangle> {
    let into = matrix(placement);
    let is_mirrored = into.determinant() < 0.0;
    let triangle = |(at, corners): (usize, &[[f32; 3]; 3])| {
        let [a, b, c] = corners.map(|corner| into.transform_point3(glam::Vec3::from(corner).as_dvec3()));
        Triangle { corners: if is_mirrored { [a, c, b] } else { [a, b, c] }, tag: tag(at), double_sided }
    };
    corners.iter().enumerate().map(triangle).collect()
}
