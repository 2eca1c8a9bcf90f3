//! Relief-mapped meshes in a scene: walls, cobbles, and other surfaces whose depth is given by a height map.

use glam::{Vec2, Vec3};

use crate::gpu::{Buffer, Gpu, Uniform};
use crate::scene::chunk::Chunk;
use crate::scene::drawable::NO_OBJECT;
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::{ReliefBindings, ReliefLook, check_image};
use crate::scene::mesh::{
    Drawn, Faces, MeshDrawable, MeshGeometry, MeshMaterials, MeshPart, NOTHING, within_binding,
};
use crate::scene::object_kind::{MakeOn, Making, ObjectKind, OnDevice};
use crate::scene::ray::Surface;
use crate::shared::lod::object::{OBJECT_LEVELS, SceneDraw};
use crate::shared::render::scene_vertex::MeshParams;
use crate::skinning::bounding_sphere::BoundingSphere;
use crate::skinning::vertex::Vertex;
use crate::surface::color::ColorTexture;
use crate::surface::map::HeightMap;
use crate::surface::mesh::{SurfaceMesh, SurfaceVertex};
use crate::surface::mips::Mips;
use crate::surface::relief::March;
use crate::surface::relief::textures::SurfaceTextures;
use crate::surface::{Green, ReliefMaps, ReliefMaterial, ReliefOptions};
use crate::{Error, InputError};

/// A relief-mapped mesh, for [`Scene::add_relief`](crate::scene::Scene::add_relief).
///
/// A relief has no levels of detail, so its mesh is drawn in full at any distance. The error of a level would bound
/// only the displacement of the surface, but not the texture coordinates along which rays march through the relief. Use
/// a mesh with few triangles, because the maps contain the detail.
#[derive(Debug, Clone)]
pub struct Relief {
    /// The mesh, in model space.
    pub mesh: SurfaceMesh,
    /// Heights, colours and normals.
    pub maps: ReliefSource,
    /// Method, shadows and silhouette. With [`ReliefSource::Textures`], the method must be the one that the textures
    /// were made for.
    pub options: ReliefOptions,
    /// Depth and plane of the relief, and softness of its shadows. The material's light is ignored, because a scene has
    /// one light.
    pub material: ReliefMaterial,
    /// Settings of the ray march, and the address mode beyond the edges of the maps.
    pub march: March,
    /// Whether both sides of the mesh are visible.
    pub double_sided: bool,
}

/// The maps of a [`Relief`].
#[derive(Debug, Clone)]
pub enum ReliefSource {
    /// Images on the host. When the relief is added, they are uploaded, and the acceleration map of the method is
    /// computed.
    Images {
        /// The heights.
        heights: HeightMap,
        /// The colours in sRGB.
        albedo: image::RgbaImage,
        /// Normals in tangent space, if [`ReliefOptions::normal_map`] asks for them.
        normals: Option<image::RgbaImage>,
    },
    /// Textures on the device, which several objects and the caller may share. Use them for heights that are computed
    /// on the device, or for colours in linear half floats ([`ColorTexture::linear`]). Such colours do not depend
    /// on the driver's sRGB decoding.
    Textures {
        /// The heights, and the acceleration map of a method.
        textures: Box<SurfaceTextures>,
        /// The colours.
        albedo: Box<ColorTexture>,
        /// Normals in tangent space, if [`ReliefOptions::normal_map`] asks for them.
        normals: Option<Box<ColorTexture>>,
    },
}

impl Relief {
    /// An upright square wall that faces +Z and is centred at the model's origin. Its edge is one unit of the model.
    /// The maps repeat `tiles` times along each edge, with their top edge upwards. The back of the wall is drawn only
    /// if `double_sided` is set. All other fields are as in [`Relief::new`].
    pub fn wall(tiles: f32, heights: HeightMap, albedo: image::RgbaImage) -> Self {
        Self::new(SurfaceMesh::square(tiles), heights, albedo)
    }

    /// A relief on a mesh, with repeating heights and colours. It is drawn by the exact quadtree method, and writes the
    /// depth of the relief. The relief touches the mesh where heights are largest, and lies behind the mesh elsewhere.
    pub fn new(mesh: SurfaceMesh, heights: HeightMap, albedo: image::RgbaImage) -> Self {
        Self::of(mesh, ReliefSource::Images { heights, albedo, normals: None })
    }

    /// A relief on a mesh that shares the caller's textures. It is drawn by the method for which the textures were
    /// made, with normals from the heights, and writes the depth of the relief. The textures also
    /// decide the address mode.
    pub fn of_maps(mesh: SurfaceMesh, maps: ReliefMaps<'_>) -> Self {
        let ReliefMaps { textures, albedo, normals } = maps;
        let (method, address) = (textures.method, textures.address);
        let source = ReliefSource::Textures {
            textures: Box::new(textures.clone()),
            albedo: Box::new(albedo.clone()),
            normals: normals.cloned().map(Box::new),
        };
        let made = Self::of(mesh, source);
        let options = ReliefOptions { method, ..made.options };
        Self { options, march: March { address, ..made.march }, ..made }
    }

    fn of(mesh: SurfaceMesh, maps: ReliefSource) -> Self {
        Self {
            mesh,
            maps,
            options: ReliefOptions { depth: true, ..ReliefOptions::default() },
            material: ReliefMaterial::default(),
            march: March::default(),
            double_sided: false,
        }
    }

    /// The same relief with normals from an image instead of from the heights. `green` is the direction of the image's
    /// green channel. A relief with [`ReliefSource::Textures`] stays unchanged.
    #[must_use]
    pub fn with_normals(mut self, image: image::RgbaImage, green: Green) -> Self {
        if let ReliefSource::Images { normals, .. } = &mut self.maps {
            *normals = Some(image);
            self.options.normal_map = Some(green);
        }
        self
    }

    /// Checks that the relief can be made again on another device.
    ///
    /// # Errors
    /// [`InputError`] for a relief made from textures, because the textures were on the lost device.
    fn check_can_be_rebuilt(&self) -> Result<(), InputError> {
        match &self.maps {
            ReliefSource::Images { .. } => Ok(()),
            ReliefSource::Textures { .. } => {
                let bound = "must be removed before, and added again with textures on the new device";
                Err(InputError::new("relief.maps", "textures on the lost device", bound))
            }
        }
    }
}

impl ObjectKind for Relief {
    fn name(&self) -> &'static str {
        "a relief"
    }

    fn is_attachable(&self) -> bool {
        true
    }

    fn made_on<'a>(&'a self, target: MakeOn<'a>) -> Making<'a> {
        let MakeOn { gpu, layouts, capacity, .. } = target;
        Box::pin(async move {
            self.check_can_be_rebuilt()?;
            let (_, (drawables, _)) = drawn(gpu, layouts, self)?;
            Ok(OnDevice::chunks(vec![Chunk::new(0..capacity, drawables)]))
        })
    }

    fn surfaces(&self, _: u32, _: f64) -> Result<Vec<Surface<'_>>, InputError> {
        let positions = self.mesh.vertices.iter().map(|vertex| vertex.position).collect::<Vec<_>>();
        Ok(vec![Surface::new(positions, &self.mesh.indices, self.double_sided)])
    }
}

/// Uploads a relief-mapped mesh. Returns a sphere around it, its drawables and its draws.
pub(super) fn drawn(
    gpu: &Gpu,
    layouts: &SceneLayouts,
    relief: &Relief,
) -> Result<(BoundingSphere, Drawn), Error> {
    check(gpu, relief).map_err(|error| error.below("relief"))?;
    let [vertices, indices] = [relief.mesh.vertices.len(), relief.mesh.indices.len()];
    within_binding(gpu, "relief.mesh.vertices.len", vertices, size_of::<Vertex>())?;
    within_binding(gpu, "relief.mesh.indices.len", indices, size_of::<u32>())?;
    let vertices: Vec<Vertex> = (relief.mesh.vertices.iter())
        .map(|vertex| Vertex { position: vertex.position, normal: vertex.normal, tangent: vertex.tangent })
        .collect();
    let uv: Vec<[f32; 2]> = relief.mesh.vertices.iter().map(|vertex| vertex.uv).collect();
    let material_of = Buffer::new(gpu, "materials of vertices", vertices.len())?;
    let geometry = MeshGeometry {
        object: Uniform::new(gpu, "object", &NO_OBJECT)?,
        params: Uniform::new(gpu, "mesh", &MeshParams { clusters: 0, last: 0, partners: 0 })?,
        vertices: Buffer::constant(gpu, "mesh vertices", &vertices)?,
        last: 0,
        page_table: material_of.clone(),
        uv: Buffer::constant(gpu, "mesh uv", &uv)?,
        material_of,
        partners: 0,
        indices: Buffer::constant(gpu, "mesh indices", &relief.mesh.indices)?,
    };
    let faces = Faces { blended: false, double_sided: relief.double_sided };
    let material = material(gpu, layouts, relief).map_err(|error| match error {
        Error::Input(error) => error.below("relief").into(),
        error => error,
    })?;
    let parts = vec![MeshPart::new(faces, MeshMaterials::Relief(material))];
    let drawable = MeshDrawable::new(gpu, layouts, geometry, 0, parts)?;
    let draw = SceneDraw { index_count: relief.mesh.indices.len() as u32, ..NOTHING };
    let mut draws = vec![NOTHING; OBJECT_LEVELS as usize];
    draws[0] = draw;
    let sphere = BoundingSphere::around(vertices.iter().map(|vertex| vertex.position.into()));
    Ok((sphere, (vec![Box::new(drawable)], draws)))
}

/// Checks the relief's mesh and images.
fn check(gpu: &Gpu, Relief { mesh, maps, .. }: &Relief) -> Result<(), InputError> {
    mesh.validate().map_err(|error| error.below("mesh"))?;
    InputError::check(!mesh.indices.is_empty(), "mesh.indices.len", 0, || "must be at least 3")?;
    for (at, SurfaceVertex { position, normal, tangent, uv }) in mesh.vertices.iter().enumerate() {
        let fields: [(&str, &[f32]); 4] =
            [("position", position), ("normal", normal), ("tangent", tangent), ("uv", uv)];
        let is_wrong = |(_, values): &(&str, &[f32])| values.iter().any(|value| !value.is_finite());
        if let Some((field, values)) = fields.into_iter().find(is_wrong) {
            let path = format!("mesh.vertices[{at}].{field}");
            return Err(InputError::new(path, format!("{values:?}"), "must be finite"));
        }
    }
    if let ReliefSource::Images { albedo, normals, .. } = maps {
        let all = [("maps.albedo", Some(albedo)), ("maps.normals", normals.as_ref())];
        for (path, image) in all.into_iter().filter_map(|(path, image)| Some((path, image?))) {
            check_image(gpu, path, image)?;
        }
    }
    Ok(())
}

fn material(gpu: &Gpu, layouts: &SceneLayouts, relief: &Relief) -> Result<ReliefBindings, Error> {
    let corners = || relief.mesh.vertices.iter().map(|vertex| Vec2::from(vertex.uv));
    let low = corners().fold(Vec2::MAX, Vec2::min);
    let high = corners().fold(Vec2::MIN, Vec2::max);
    let look = ReliefLook {
        material: relief.material,
        march: relief.march,
        range: [low.into(), high.into()],
        world: length_of_uv(&relief.mesh)?,
        color: [1.0; 3],
    };
    let bound = |textures: &SurfaceTextures, albedo: &ColorTexture, normals: Option<&ColorTexture>| {
        let maps = ReliefMaps { textures, albedo, normals };
        ReliefBindings::new(gpu, layouts, maps, relief.options, &look)
    };
    match &relief.maps {
        ReliefSource::Textures { textures, albedo, normals } => bound(textures, albedo, normals.as_deref()),
        ReliefSource::Images { heights, albedo, normals } => {
            let (address, method) = (relief.march.address, relief.options.method);
            let texture = |mips: Mips| ColorTexture::new(gpu, &mips, address);
            let textures = SurfaceTextures::new(gpu, heights, method, address)?;
            let albedo = texture(Mips::of_color(albedo.clone()))?;
            let normals = normals.clone().map(|normals| texture(Mips::of_data(normals))).transpose()?;
            bound(&textures, &albedo, normals.as_ref())
        }
    }
}

/// Length of one uv unit in model units: the square root of the mesh's total area over its total area in uv.
fn length_of_uv(mesh: &SurfaceMesh) -> Result<f32, InputError> {
    let (mut in_space, mut in_uv) = (0.0, 0.0);
    for triangle in mesh.indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|corner| &mesh.vertices[triangle[corner] as usize]);
        let [pa, pb, pc] = [a, b, c].map(|vertex| Vec3::from(vertex.position).as_dvec3());
        let [ta, tb, tc] = [a, b, c].map(|vertex| Vec2::from(vertex.uv).as_dvec2());
        in_space += (pb - pa).cross(pc - pa).length();
        in_uv += (tb - ta).perp_dot(tc - ta).abs();
    }
    if in_uv > 0.0 && in_space > 0.0 {
        return Ok((in_space / in_uv).sqrt() as f32);
    }
    Err(InputError::new("mesh", "no area", "must have an area, in space and in texture coordinates"))
}
