//! The encoders that a renderer records into: a render pass or a render bundle.

/// A render pass, or the encoder of a render bundle. A render pass does not borrow the drawn resources, so it may be
/// a pass without a lifetime ([`wgpu::RenderPass::forget_lifetime`]).
pub trait ScenePass<'a>: sealed::Sealed {
    /// Sets the pipeline of the next draws.
    fn set_pipeline(&mut self, pipeline: &'a wgpu::RenderPipeline);
    /// Sets a bind group of the next draws.
    fn set_bind_group(&mut self, index: u32, group: &'a wgpu::BindGroup);
    /// Sets a vertex buffer of the next draws.
    fn set_vertex_buffer(&mut self, slot: u32, buffer: wgpu::BufferSlice<'a>);
    /// Sets the index buffer of the next draws, with `u32` indices.
    fn set_index_buffer(&mut self, buffer: wgpu::BufferSlice<'a>);
    /// Draws indexed triangles, with arguments at `offset` bytes in a buffer.
    fn draw_indexed_indirect(&mut self, arguments: &'a wgpu::Buffer, offset: u64);
}

mod sealed {
    /// Keeps other crates from implementing [`ScenePass`](super::ScenePass).
    pub trait Sealed {}
    impl Sealed for wgpu::RenderPass<'_> {}
    impl Sealed for wgpu::RenderBundleEncoder<'_> {}
}

macro_rules! recorded_by {
    ($encoder:ty) => {
        impl<'a> ScenePass<'a> for $encoder {
            fn set_pipeline(&mut self, pipeline: &'a wgpu::RenderPipeline) {
                Self::set_pipeline(self, pipeline);
            }

            fn set_bind_group(&mut self, index: u32, group: &'a wgpu::BindGroup) {
                Self::set_bind_group(self, index, group, &[]);
            }

            fn set_vertex_buffer(&mut self, slot: u32, buffer: wgpu::BufferSlice<'a>) {
                Self::set_vertex_buffer(self, slot, buffer);
            }

            fn set_index_buffer(&mut self, buffer: wgpu::BufferSlice<'a>) {
                Self::set_index_buffer(self, buffer, wgpu::IndexFormat::Uint32);
            }

            fn draw_indexed_indirect(&mut self, arguments: &'a wgpu::Buffer, offset: u64) {
                Self::draw_indexed_indirect(self, arguments, offset);
            }
        }
    };
}

recorded_by!(wgpu::RenderPass<'_>);
recorded_by!(wgpu::RenderBundleEncoder<'a>);
