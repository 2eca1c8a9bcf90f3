//! What an object has on a device: made larger, made afresh, or made on another one.

use super::{MAX_CAPACITY, MeshOnHost, Object, ObjectKind, whole};
use crate::gpu::Gpu;
use crate::scene::character::{Character, Runtime, Shared};
use crate::scene::chunk::Chunk;
use crate::scene::instances;
use crate::scene::kind::OwnKind;
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::Looks;
use crate::scene::terrain::Morphing;
use crate::scene::{mesh, relief, terrain};
use crate::shared::lod::instance::INSTANCE_CARRIES;
use crate::{Error, InputError};

/// What an object has on a device.
#[derive(Debug)]
pub(in crate::scene) struct OnDevice {
    chunks: Vec<Chunk>,
    character: Option<(Shared, Vec<Runtime>)>,
    morphing: Option<Morphing>,
    own: Option<OwnKind>,
}

impl Object {
    /// Makes room for twice as many instances. If it fails, nothing has changed.
    pub(in crate::scene) fn grow(&mut self, gpu: &Gpu, layouts: &SceneLayouts) -> Result<(), Error> {
        let capacity = self.instances.capacity();
        if capacity >= MAX_CAPACITY {
            let bound = format!("must be at most {MAX_CAPACITY}: add another object");
            return Err(InputError::new("object.capacity", 2 * capacity, bound).into());
        }
        let capacity = (2 * capacity).min(MAX_CAPACITY);
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
        match &mut self.kind {
            ObjectKind::Character(character) => {
                character.grow(gpu, capacity)?;
                let first = self.chunks.first().map_or(&[][..], |chunk| &chunk.drawables);
                self.chunks = character.chunks(gpu, layouts, first)?;
            }
            ObjectKind::Mesh(_) => self.chunks.iter_mut().for_each(|chunk| chunk.slots = 0..capacity),
            ObjectKind::Own(own) => {
                own.is_fresh = true;
                self.chunks.iter_mut().for_each(|chunk| chunk.slots = 0..capacity);
            }
            // It does not grow.
            ObjectKind::Terrain(terrain) => terrain.morphing.iter_mut().for_each(Morphing::refresh),
        }
        Ok(())
    }

    /// Everything on another device.
    pub(in crate::scene) async fn on(&self, gpu: &Gpu, layouts: &SceneLayouts) -> Result<OnDevice, Error> {
        let none = Looks { materials: Vec::new(), images: Vec::new() };
        let looks = self.looks.as_ref().unwrap_or(&none);
        let drawn = match &self.kind {
            ObjectKind::Terrain(terrain) => {
                terrain.check_can_be_rebuilt()?;
                let (terrain, _, (chunks, _)) = terrain::made(gpu, layouts, &terrain.source).await?;
                return Ok(OnDevice { chunks, character: None, morphing: terrain.morphing, own: None });
            }
            ObjectKind::Mesh(MeshOnHost::Model(merged)) => mesh::drawn(gpu, layouts, (merged, looks))?,
            ObjectKind::Mesh(MeshOnHost::Relief(relief)) => {
                relief.check_can_be_rebuilt()?;
                relief::drawn(gpu, layouts, relief)?.1
            }
            ObjectKind::Character(character) => {
                let (shared, runtimes) = character.on(gpu)?;
                let first = character.drawables_of((gpu, layouts), looks, &runtimes)?;
                let chunks = Character::chunks_of((gpu, layouts), &first, &runtimes)?;
                return Ok(OnDevice {
                    chunks,
                    character: Some((shared, runtimes)),
                    morphing: None,
                    own: None,
                });
            }
            ObjectKind::Own(own) => {
                let own = own.rebuilt(gpu)?;
                let chunks = whole(&self.instances, own.drawn(gpu, layouts)?).0;
                return Ok(OnDevice { chunks, character: None, morphing: None, own: Some(own) });
            }
        };
        Ok(OnDevice { chunks: whole(&self.instances, drawn).0, character: None, morphing: None, own: None })
    }

    /// Takes everything on another device. Everything starts afresh.
    pub(in crate::scene) fn adopt(&mut self, on_device: OnDevice) {
        let OnDevice { chunks, character: on_device, morphing, own: on_new } = on_device;
        if let (ObjectKind::Own(own), Some(on_new)) = (&mut self.kind, on_new) {
            **own = on_new;
        }
        if let ObjectKind::Terrain(terrain) = &mut self.kind {
            terrain.morphing = morphing;
        }
        if let (Some(character), Some(on_device)) = (self.kind.character_mut(), on_device) {
            character.adopt(on_device);
        }
        self.chunks = chunks;
        self.mark_transition();
        self.coarsening = 1.0;
        self.pending = None;
        (self.is_retuned, self.is_rebound, self.fitted) = (false, false, 0);
        self.instances.change_all();
    }

    /// Sets the sphere of an instance that plays something else.
    pub(in crate::scene) fn bound_again(&mut self, index: u32) {
        if let Some(character) = self.kind.character() {
            let sphere = character.sphere_of(index);
            self.instances.change(index, |instance| instances::bound(instance, &sphere));
        }
    }

    /// Ends fades that have reached their weight.
    pub(in crate::scene) fn settle(&mut self, now: f64) {
        let Some(character) = self.kind.character_mut() else { return };
        let settled = character.settle(now);
        for index in settled {
            // What carries a mesh keeps the larger sphere until it plays something else.
            if self.instances.all()[index as usize].flags & INSTANCE_CARRIES == 0 {
                self.bound_again(index);
            }
        }
    }
}
