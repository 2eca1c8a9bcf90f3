//! What an object has on a device: made larger, made afresh, or made on another one.

use super::{Kind, MeshOnHost, Object};
use crate::Error;
use crate::gpu::Gpu;
use crate::scene::character::Runtime;
use crate::scene::drawable::Drawable;
use crate::scene::layouts::SceneLayouts;
use crate::scene::{mesh, relief, terrain};

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
