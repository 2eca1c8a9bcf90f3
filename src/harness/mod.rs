//! Tools that verify and measure operations, independent of any operation: comparators, poisoned buffers and
//! parity cases; repetition, clocks and tables.

mod cases;
pub mod compare;
mod measure;
pub mod poison;
mod row;
mod table;

pub use cases::{CaseResult, Cases, Skipped, selected};
pub use measure::{Bench, Contender};
pub use row::{Backend, Row};
pub use table::table;
