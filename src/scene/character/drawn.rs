//! Drawables of a character: one per mesh and chunk (group of instances). Each draws the skinned vertices in the chunk's
//! pages (blocks of 64 vertices).

use super::{Character, Runtime};
use crate::Error;
use crate::gpu::Gpu;
use crate::lod::SceneDraw;
use crate::scene::chunk::Chunk;
use crate::scene::drawable::Drawable;
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::Looks;
use crate::scene::mesh::{self, MergedMesh, MeshDrawable};

impl Character {
    /// Binds the page buffers of all chunks again, after some page buffers were replaced.
    pub(super) fn rebind(
        &self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        chunks: &mut [Chunk],
    ) -> Result<(), Error> {
        for (chunk, runtime) in chunks.iter_mut().zip(&self.runtimes) {
            for (drawable, skin) in chunk.drawables.iter_mut().zip(&runtime.skins) {
                if let Some(mesh) = drawable.downcast_mut::<MeshDrawable>() {
                    *mesh = mesh.with_pages(gpu, layouts, skin.pages())?;
                }
            }
        }
        Ok(())
    }

    /// The chunks of the character, one per element of `runtimes`. Meshes and materials come from the first chunk of
    /// `known`. The drawables of two chunks differ only in their page buffers.
    pub(super) fn chunks(
        gpu: &Gpu,
        layouts: &SceneLayouts,
        known: &[Chunk],
        runtimes: &[Runtime],
    ) -> Result<Vec<Chunk>, Error> {
        let first = known.first().map_or(&[][..], |chunk| &chunk.drawables);
        let chunk = |runtime: &Runtime| {
            let meshes = first.iter().filter_map(|drawable| drawable.downcast::<MeshDrawable>());
            let drawables = meshes.zip(&runtime.skins).map(|(mesh, skin)| {
                let drawable: Box<dyn Drawable> = Box::new(mesh.beside(gpu, layouts, skin.pages())?);
                Ok(drawable)
            });
            Ok(Chunk::new(runtime.slots.clone(), drawables.collect::<Result<_, Error>>()?))
        };
        runtimes.iter().map(chunk).collect()
    }

    /// All chunks of the character, with the materials of `looks`.
    pub fn chunks_of_looks(
        &self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        looks: &Looks,
    ) -> Result<Vec<Chunk>, Error> {
        let first = self.first_chunk(gpu, layouts, looks, &self.runtimes)?;
        Self::chunks(gpu, layouts, &[first], &self.runtimes)
    }

    /// The first chunk of the character, with an empty range of instances. It has one drawable per mesh, which reads the
    /// skinned vertices of each instance.
    pub(super) fn first_chunk(
        &self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        looks: &Looks,
        runtimes: &[Runtime],
    ) -> Result<Chunk, Error> {
        let mut drawables: Vec<Box<dyn Drawable>> = Vec::new();
        let skins = runtimes.first().into_iter().flat_map(|runtime| &runtime.skins);
        for (index, skin) in skins.enumerate() {
            let (of, pages) = (MergedMesh { merged: &self.merged, looks, index }, Some(skin.pages()));
            drawables.push(Box::new(mesh::drawable(gpu, layouts, &of, &skin.mesh, &skin.clusters, pages)?));
        }
        Ok(Chunk::new(0..0, drawables))
    }

    /// The draw arguments of one chunk: a draw per part and level of detail, mesh by mesh.
    pub fn draws(&self) -> Vec<SceneDraw> {
        let skins = self.runtimes.first().into_iter().flat_map(|runtime| runtime.skins.iter().enumerate());
        skins.flat_map(|(index, skin)| mesh::part_draws(&self.merged, index, &skin.mesh)).collect()
    }
}
