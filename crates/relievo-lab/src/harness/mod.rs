//! Tools that verify and measure operations, independent of any operation: comparators, poisoned buffers and
//! parity cases; repetition, clocks and tables.

pub use cases::{CaseResult, Cases};
pub use measure::{Bench, Contender};
pub use row::{Backend, Row};
pub use table::table;
pub use timer::{Measurement, TimedBy, Timer};

mod cases;
pub mod compare;
mod measure;
pub mod poison;
mod row;
mod table;
mod timer;
