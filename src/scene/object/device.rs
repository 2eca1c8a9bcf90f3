//! What an object has on a device: made larger, made afresh, or made on another one.

use super::{Kind, MeshOnHost, Object};
use crate::Error;
use crate::gpu::{Gpu, Staged, Upload as _};
use crate::scene::character::{Character, Runtime};
use crate::scene::drawable::{Drawable, MeshDrawable};
use crate::scene::layouts::SceneLayouts;
use crate::scene::{mesh, relief, terrain};
use crate::shared::render::scene_vertex::MeshParams;
use crate::skinning::pages::PageBuffers;

/// What an object has on a device.
#[derive(Debug)]
pub(in crate::scene) struct OnDevice {
    drawables: Vec<Drawable>,
    runtime: Option<Runtime>,
}

impl Object {
    /// Makes room for twice as many instances. If it fails, nothing has changed.
    pub(in crate::scene) fn grow(&mut self, gpu: &Gpu, layouts: &SceneLayouts) -> Result<(), Error> {
        let capacity = 2 * self.instances.capacity();
        self.renew(gpu, layouts, capacity)?;
        self.instances.grow(capacity);
        Ok(())
    }

    /// Lets everything start afresh.
    pub(in crate::scene) fn refresh(&mut self, gpu: &Gpu, layouts: &SceneLayouts) -> Result<(), Error> {
        self.renew(gpu, layouts, self.instances.capacity())?;
        self.instances.change_all();
        Ok(())
    }

    fn renew(&mut self, gpu: &Gpu, layouts: &SceneLayouts, capacity: usize) -> Result<(), Error> {
        if let Kind::Character(character) = &mut self.kind {
            let (runtime, drawables) = character.on(gpu, layouts, capacity)?;
            character.adopt(runtime);
            self.drawables = drawables;
        }
        Ok(())
    }

    /// Everything on another device.
    pub(in crate::scene) async fn on(&self, gpu: &Gpu, layouts: &SceneLayouts) -> Result<OnDevice, Error> {
        let drawables = match &self.kind {
            Kind::Terrain(terrain) => terrain::generated(gpu, layouts, &terrain.source).await?.2.0,
            Kind::Mesh(MeshOnHost::Model(merged)) => mesh::drawn(gpu, layouts, merged)?.0,
            Kind::Mesh(MeshOnHost::Relief(relief)) => relief::drawn(gpu, layouts, relief)?.1.0,
            Kind::Character(character) => {
                let (runtime, drawables) = character.on(gpu, layouts, self.instances.capacity())?;
                return Ok(OnDevice { drawables, runtime: Some(runtime) });
            }
        };
        Ok(OnDevice { drawables, runtime: None })
    }

    /// Takes everything on another device. Everything starts afresh.
    pub(in crate::scene) fn adopt(&mut self, OnDevice { drawables, runtime }: OnDevice) {
        if let (Kind::Character(character), Some(runtime)) = (&mut self.kind, runtime) {
            character.adopt(runtime);
        }
        self.drawables = drawables;
        self.instances.change_all();
        self.fitted = 0;
    }
}

/// Stages where the instances and vertices of drawables lie.
pub(super) fn stage_params(
    staged: &mut Staged,
    drawables: &[Drawable],
    first_instance: u32,
    object: u32,
) -> Result<(), Error> {
    for drawable in drawables {
        if let Drawable::Mesh(MeshDrawable { geometry, clusters, .. }) = drawable {
            let params = MeshParams { first_instance, clusters: *clusters, object, last: geometry.last };
            staged.uniform(&geometry.params, &params)?;
        }
    }
    Ok(())
}

/// The same drawables over a character's pages, after these were replaced.
pub(super) fn rebound(
    drawables: &[Drawable],
    gpu: &Gpu,
    layouts: &SceneLayouts,
    character: &Character,
) -> Result<Vec<Drawable>, Error> {
    let with_pages = |(drawable, pages): (&Drawable, &PageBuffers)| match drawable {
        Drawable::Mesh(mesh) => Ok(Drawable::Mesh(mesh.with_pages(gpu, layouts, pages)?)),
        Drawable::Terrain(_) => Ok(drawable.clone()),
    };
    drawables.iter().zip(character.pages()).map(with_pages).collect()
}
