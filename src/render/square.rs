//! A whole picture of a square of relief, off screen: what the command line draws.

use glam::{DVec3, Mat4, Vec4};

use crate::Error;
use crate::gpu::Gpu;
use crate::render::color::ColorTexture;
use crate::render::relief::{ReliefCamera, ReliefMaps, ReliefOptions, ReliefRenderer};
use crate::render::target::{LINEAR_FORMAT, Target};
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
    /// Heights and their acceleration; the method is theirs.
    pub textures: &'a SurfaceTextures,
    /// Colours.
    pub albedo: &'a Mips,
    /// Tangent-space normals; else those of the heights.
    pub normals: Option<&'a Mips>,
    /// Where green of the normals points.
    pub green: Green,
    /// Self-shadow.
    pub shadow: Shadow,
    /// Cuts away what leaves the square.
    pub silhouette: bool,
    /// Depth and light; the light in the square's tangent space.
    pub material: Material,
    /// How rays are marched.
    pub march: March,
    /// Where it is seen from.
    pub view: SquareView,
}

impl SquarePicture<'_> {
    /// Draws it over a linear `background`, one sample a pixel.
    ///
    /// # Errors
    /// [`crate::InputError`] for what cannot be drawn; [`crate::gpu::GpuError`].
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

/// The parallel projection of a view of [`SurfaceMesh::square`].
pub(crate) fn camera(view: &SquareView) -> ReliefCamera {
    let world = |axis: [f64; 3]| DVec3::new(axis[0], -axis[1], axis[2]);
    let [right, up] = view.axes().map(world);
    let towards = world(view.towards());
    let [width, height] = view.size.map(|edge| 2.0 * view.zoom() / f64::from(edge));
    // The square lies within one unit of the origin, its relief within two behind it.
    let depth = -0.25 * towards;
    let (right, up) = (right * width, up * height);
    let row = |axis: DVec3, last: f32| axis.as_vec3().extend(last);
    let rows = [row(right, 0.0), row(up, 0.0), row(depth, 0.5), Vec4::W];
    let clip_from_world = Mat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose();
    ReliefCamera { clip_from_world, eye: towards.as_vec3().extend(0.0) }
}
