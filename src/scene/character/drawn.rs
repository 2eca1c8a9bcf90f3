//! What is drawn of a character: its meshes from the pages of each chunk of instances.

use super::{Character, Runtime};
use crate::Error;
use crate::gpu::Gpu;
use crate::lod::SceneDraw;
use crate::scene::chunk::Chunk;
use crate::scene::drawable::Drawable;
use crate::scene::layouts::SceneLayouts;
use crate::scene::material::Looks;
use crate::scene::mesh;
use crate::skinning::paged::PagedSkin;

impl Character {
    /// Binds the pages of all chunks, after some were replaced.
    pub fn rebind(&self, gpu: &Gpu, layouts: &SceneLayouts, chunks: &mut [Chunk]) -> Result<(), Error> {
        for (chunk, runtime) in chunks.iter_mut().zip(&self.runtimes) {
            for (drawable, skin) in chunk.drawables.iter_mut().zip(&runtime.skins) {
                if let Drawable::Mesh(mesh) = drawable {
                    *mesh = mesh.with_pages(gpu, layouts, skin.pages())?;
                }
            }
        }
        Ok(())
    }

    /// The chunks of its instances. What is drawn of them differs in the pages; `first` has the meshes and materials.
    pub fn chunks(&self, gpu: &Gpu, layouts: &SceneLayouts, first: &[Drawable]) -> Result<Vec<Chunk>, Error> {
        Self::chunks_of((gpu, layouts), first, &self.runtimes)
    }

    /// As [`Character::chunks`], of these.
    pub fn chunks_of(
        (gpu, layouts): (&Gpu, &SceneLayouts),
        first: &[Drawable],
        runtimes: &[Runtime],
    ) -> Result<Vec<Chunk>, Error> {
        let chunk = |runtime: &Runtime| {
            let drawable = |(drawable, skin): (&Drawable, &PagedSkin)| match drawable {
                Drawable::Mesh(mesh) => Ok(Drawable::Mesh(mesh.beside(gpu, layouts, skin.pages())?)),
                Drawable::Terrain(_) | Drawable::Own(_) => Ok(drawable.clone()),
            };
            let drawables = first.iter().zip(&runtime.skins).map(drawable);
            Ok(Chunk::new(runtime.slots.clone(), drawables.collect::<Result<_, Error>>()?))
        };
        runtimes.iter().map(chunk).collect()
    }

    /// What is drawn of the first chunk: each mesh, from the vertices of each instance.
    pub fn drawables(
        &self,
        gpu: &Gpu,
        layouts: &SceneLayouts,
        looks: &Looks,
    ) -> Result<Vec<Drawable>, Error> {
        self.drawables_of((gpu, layouts), looks, &self.runtimes)
    }

    /// As [`Character::drawables`], of these chunks.
    pub fn drawables_of(
        &self,
        (gpu, layouts): (&Gpu, &SceneLayouts),
        looks: &Looks,
        runtimes: &[Runtime],
    ) -> Result<Vec<Drawable>, Error> {
        let drawable = |(index, skin): (usize, &PagedSkin)| {
            let mesh = (&skin.mesh, &*skin.clusters);
            mesh::drawable((gpu, layouts), (&self.merged, looks), index, mesh, Some(skin.pages()))
        };
        runtimes
            .first()
            .map_or(Ok(Vec::new()), |runtime| runtime.skins.iter().enumerate().map(drawable).collect())
    }

    /// The draws of all parts of a chunk.
    pub fn draws(&self) -> Vec<SceneDraw> {
        let skins = self.runtimes.first().into_iter().flat_map(|runtime| runtime.skins.iter().enumerate());
        skins.flat_map(|(index, skin)| mesh::part_draws(&self.merged, index, &skin.mesh)).collect()
    }
}
