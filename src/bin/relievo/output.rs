//! Lines on standard output.

use std::fmt::Display;
use std::io::{ErrorKind, Write as _};

use relievo::Error;

/// Prints a line. Whoever closed the pipe has read enough: the work goes on without a word.
pub fn say(line: impl Display) -> Result<(), Error> {
    match writeln!(std::io::stdout(), "{line}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Error::output("standard output", error)),
        _ => Ok(()),
    }
}
