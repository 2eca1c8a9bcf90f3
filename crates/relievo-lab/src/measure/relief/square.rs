//! A square of relief as a scene, seen by a parallel camera.

use glam::{DVec3, Mat4, Vec3, Vec4};
use relievo::Error;
use relievo::asset::Light;
use relievo::gpu::Gpu;
use relievo::ops::surface::{
    ColorTexture, ReliefMaps, ReliefMaterial, ReliefOptions, SurfaceMesh, SurfaceTextures,
};
use relievo::scene::{Camera, Depth, Placement, Relief, Scene};

use crate::measure::relief::{ReliefSquare, SquareView};

impl ReliefSquare {
    /// The square as a scene, with textures of a method. Colours and normals are linear half floats, so that drivers differ by
    /// rounding only.
    ///
    /// # Errors
    /// [`relievo::InputError`] for parameters out of range; [`relievo::gpu::GpuError`].
    pub(super) fn scene(&self, gpu: &Gpu, textures: &SurfaceTextures) -> Result<Scene, Error> {
        let address = self.march.address;
        let albedo = ColorTexture::linear(gpu, &self.albedo, address)?;
        let normals =
            self.normals.as_ref().map(|mips| ColorTexture::linear(gpu, mips, address)).transpose()?;
        let options = ReliefOptions {
            method: textures.method,
            shadow: self.shadow,
            normal_map: self.normals.as_ref().map(|_| self.green),
            silhouette: self.silhouette,
            ..ReliefOptions::default()
        };
        let maps = ReliefMaps { textures, albedo: &albedo, normals: normals.as_ref() };
        let made = Relief::of_maps(SurfaceMesh::square(self.view.tiles as f32), maps);
        let (material, march) = (self.material, self.march);
        // With one pipeline for both sides, mirrored instances need none of their own.
        let relief = Relief { options, material, march, double_sided: true, ..made };
        let mut scene = Scene::new(gpu)?;
        scene.set_light(light(&material))?;
        let square = scene.add_relief(&relief, 1)?;
        scene.spawn(square, Placement::default())?;
        Ok(scene)
    }
}

/// The light of a material in the square's tangent space, in the world: v runs along −Y.
fn light(material: &ReliefMaterial) -> Light {
    let [x, y, z] = material.light;
    Light { direction: Vec3::new(x, -y, z), color: Vec3::ONE, ambient: material.ambient }
}

/// The camera of a parallel view of [`SurfaceMesh::square`].
pub(crate) fn camera(view: &SquareView) -> Camera {
    let world = |axis: [f64; 3]| DVec3::new(axis[0], -axis[1], axis[2]).as_vec3().extend(0.0);
    let [right, up] = view.axes();
    let rows = [world(right), world(up), world(view.towards()), Vec4::W];
    let [width, height] = view.size.map(|edge| (2.0 * view.zoom() / f64::from(edge)) as f32);
    // The square lies within one unit of the origin, and its relief within two units behind it.
    let clip_from_view =
        Mat4::from_translation(Vec3::Z * 0.5) * Mat4::from_scale(Vec3::new(width, height, -0.25));
    Camera {
        cell: [0; 3],
        view_from_cell: Mat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose(),
        clip_from_view,
        viewport: view.size,
        depth: Depth::Forward,
    }
}
