//! All reducers behind one interface.

mod interface;
