//! Parallel iterators: rayon's, and in browsers, where there are no threads, the same calls on one thread.

#[cfg(not(target_arch = "wasm32"))]
pub use rayon::prelude;

#[cfg(target_arch = "wasm32")]
pub mod prelude {
    use std::iter::{Enumerate, FlatMap, Map, Zip};
    use std::slice::{Iter, IterMut};

    /// An iterator with the methods of rayon's.
    pub struct Serial<I>(I);

    impl<I: Iterator> Serial<I> {
        pub fn map<T, F: FnMut(I::Item) -> T>(self, of: F) -> Serial<Map<I, F>> {
            Serial(self.0.map(of))
        }

        pub fn flat_map<T: IntoIterator, F: FnMut(I::Item) -> T>(self, of: F) -> Serial<FlatMap<I, T, F>> {
            Serial(self.0.flat_map(of))
        }

        pub fn enumerate(self) -> Serial<Enumerate<I>> {
            Serial(self.0.enumerate())
        }

        pub fn zip<J: IntoIterator>(self, other: J) -> Serial<Zip<I, J::IntoIter>> {
            Serial(self.0.zip(other))
        }

        pub fn for_each(self, of: impl FnMut(I::Item)) {
            self.0.for_each(of);
        }

        pub fn collect<C: FromIterator<I::Item>>(self) -> C {
            self.0.collect()
        }

        pub fn reduce(
            self,
            start: impl Fn() -> I::Item,
            both: impl FnMut(I::Item, I::Item) -> I::Item,
        ) -> I::Item {
            self.0.fold(start(), both)
        }
    }

    impl<I: Iterator> IntoIterator for Serial<I> {
        type Item = I::Item;
        type IntoIter = I;

        fn into_iter(self) -> I {
            self.0
        }
    }

    pub trait IntoParallelIterator: IntoIterator + Sized {
        fn into_par_iter(self) -> Serial<Self::IntoIter> {
            Serial(self.into_iter())
        }
    }

    impl<T: IntoIterator> IntoParallelIterator for T {}

    pub trait ParallelSlice<T> {
        fn par_iter(&self) -> Serial<Iter<'_, T>>;

        fn par_iter_mut(&mut self) -> Serial<IterMut<'_, T>>;
    }

    impl<T> ParallelSlice<T> for [T] {
        fn par_iter(&self) -> Serial<Iter<'_, T>> {
            Serial(self.iter())
        }

        fn par_iter_mut(&mut self) -> Serial<IterMut<'_, T>> {
            Serial(self.iter_mut())
        }
    }
}
