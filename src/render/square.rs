//! Off-screen pictures of a square of relief, as the command line draws them.

use glam::{DVec3, Mat4, Vec4};

use crate::Error;
use crate::gpu::Gpu;
use crate::render::relief::{ReliefCamera, ReliefMaps, ReliefOptions, ReliefRenderer};
use crate::render::target::{LINEAR_FORMAT, Target};
use crate::surface::color::ColorTexture;
use crate::surface::linear_image::LinearImage;
use crate::surface::map::Address;
use crate::surface::mesh::SurfaceMesh;
use crate::surface::mips::Mips;
use crate::surface::relief::March;
use crate::surface::relief::textures::SurfaceTextures;
use crate::surface::view::SquareView;
use crate::surface::{Green, Material, Shadow};

/// How a square is drawn.
#[derive(Debug, Clone)]
pub struct SquarePicture<'a> {
    /// Heights and their acceleration map; they determine the method.
    pub textures: &'a SurfaceTextures,
    /// Base colours.
    pub albedo: &'a Mips,
    /// Tangent-space normals; if `None`, normals follow from the heights.
    pub normals: Option<&'a Mips>,
    /// The direction to which the green channel of the normals points.
    pub green: Green,
    /// Self-shadow.
    pub shadow: Shadow,
    /// Whether points beyond the square are cut away.
    pub silhouette: bool,
    /// Depth and light; the light is in the square's tangent space.
    pub material: Material,
    /// The parameters of the march.
    pub march: March,
    /// The view of the square.
    pub view: SquareView,
}

impl SquarePicture<'_> {
    /// Draws the square over a linear `background`, with one sample per pixel.
    ///
    /// # Errors
    /// [`crate::InputError`] for parameters that cannot be drawn; [`crate::gpu::GpuError`].
    pub fn draw(&self, gpu: &Gpu, background: [f32; 3]) -> Result<LinearImage, Error> {
        self.view.validate()?;
        let options = ReliefOptions {
            method: self.textures.method,
            shadow: self.shadow,
            normal_map: self.normals.map(|_| self.green),
            silhouette: self.silhouette,
            ..ReliefOptions::default()
        };
        let wraps = self.march.address == Address::Wrap;
        let albedo = ColorTexture::linear(gpu, self.albedo, wraps)?;
        let normals = self.normals.map(|normals| ColorTexture::linear(gpu, normals, wraps)).transpose()?;
        let maps = ReliefMaps { textures: self.textures, albedo: &albedo, normals: normals.as_ref() };
        // The mesh's v runs along −Y.
        let [x, y, z] = self.material.light;
        let material = Material { light: [x, -y, z], ..self.material };
        let tiles = self.view.tiles as f32;
        let renderer = ReliefRenderer::new(gpu, LINEAR_FORMAT, options)?;
        let mesh = SurfaceMesh::square(tiles);
        let mut scene = renderer.scene(gpu, &mesh, maps, &material, &self.march, 1.0 / tiles)?;
        scene.set_camera(gpu, camera(&self.view))?;
        let target = Target::linear(gpu, self.view.size)?;
        target.draw(gpu, background.map(f64::from), |pass| scene.draw(pass))?;
        Ok(LinearImage { size: self.view.size, pixels: target.read_linear(gpu)? })
    }
}

/// The camera of a parallel view of [`SurfaceMesh::square`].
pub(crate) fn camera(view: &SquareView) -> ReliefCamera {
    let world = |axis: [f64; 3]| DVec3::new(axis[0], -axis[1], axis[2]);
    let [right, up] = view.axes().map(world);
    let towards = world(view.towards());
    let [width, height] = view.size.map(|edge| 2.0 * view.zoom() / f64::from(edge));
    // The square lies within one unit of the origin, and its relief within two units behind it.
    let depth = -0.25 * towards;
    let (right, up) = (right * width, up * height);
    let row = |axis: DVec3, last: f32| axis.as_vec3().extend(last);
    let rows = [row(right, 0.0), row(up, 0.0), row(depth, 0.5), Vec4::W];
    let clip_from_world = Mat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose();
    ReliefCamera { clip_from_world, eye: towards.as_vec3().extend(0.0) }
}
