//! What proves and measures operations, and knows none of them: comparators, poisoned buffers, parity cases; repetition,
//! clocks, tables.

mod cases;
pub mod compare;
mod measure;
pub mod poison;
mod row;
mod table;

pub(crate) use cases::selected;
pub use cases::{CaseResult, Cases, Skipped};
pub use measure::{Bench, Contender};
pub use row::{Backend, Row};
pub use table::table;
