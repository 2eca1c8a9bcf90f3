//! Building blocks of the generated bindings; see `gpu::bindings`.

use std::marker::PhantomData;

use super::Buffer;

/// The names that generated code uses.
pub(crate) mod prelude {
    pub(crate) use super::Slice;
    pub(crate) use crate::gpu::{
        Buffer, Gpu, GpuError, Group as BindGroup, Kernel, Layouts, Uniform, shaders,
    };
}

/// A storage buffer as a resource to bind, typed by its elements.
#[derive(Debug)]
pub struct Slice<'a, T> {
    raw: &'a wgpu::Buffer,
    element: PhantomData<T>,
}

impl<T> Clone for Slice<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Slice<'_, T> {}

impl<'a, T> Slice<'a, T> {
    /// The whole buffer.
    pub fn resource(&self) -> wgpu::BindingResource<'a> {
        self.raw.as_entire_binding()
    }

    /// The same bytes as elements of another type, as a shader declares them. One type's size must be a multiple of the
    /// other's.
    pub fn cast<U>(self) -> Slice<'a, U>
    where
        T: SeenAs<U>,
    {
        const {
            let (from, to) = (size_of::<T>(), size_of::<U>());
            assert!(from.is_multiple_of(to) || to.is_multiple_of(from), "elements do not fit each other");
        }
        Slice { raw: self.raw, element: PhantomData }
    }
}

/// A type that a shader may read as elements of `U` with the same bytes, such as a matrix as its rows.
pub trait SeenAs<U> {}

// A matrix as its rows.
impl<const N: usize> SeenAs<[f32; 4]> for [[f32; 4]; N] {}
// A vector as its components.
impl<const N: usize> SeenAs<f32> for [f32; N] {}
// Consecutive scalars as vectors.
impl SeenAs<[u32; 4]> for u32 {}
impl SeenAs<[f32; 4]> for f32 {}
impl SeenAs<[i32; 4]> for i32 {}
impl SeenAs<[i32; 4]> for [i32; 2] {}
// Floats as their bits.
impl SeenAs<[u32; 4]> for [f32; 4] {}
impl<const N: usize> SeenAs<[u32; 4]> for [[f32; 4]; N] {}
impl SeenAs<u32> for f32 {}
impl SeenAs<i32> for u32 {}
impl<const N: usize> SeenAs<u32> for [f32; N] {}

impl<T> Buffer<T> {
    /// The buffer as a resource to bind.
    pub fn slice(&self) -> Slice<'_, T> {
        Slice { raw: &self.raw, element: PhantomData }
    }
}

impl<T: bytemuck::Pod> Buffer<T> {
    /// The same buffer with elements of another type, as [`Slice::cast`].
    pub fn cast<U>(&self) -> Buffer<U>
    where
        T: SeenAs<U>,
    {
        self.slice().cast::<U>();
        self.of_elements()
    }
}
