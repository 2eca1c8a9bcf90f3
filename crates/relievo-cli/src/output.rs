//! Prints lines on standard output.

use std::fmt::Display;
use std::io::{ErrorKind, Write as _};

use relievo::Error;

/// Prints a line. If the reader has closed the pipe, the line is dropped and the work goes on.
pub fn say(line: impl Display) -> Result<(), Error> {
    match writeln!(std::io::stdout(), "{line}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Error::output("standard output", error)),
        _ => Ok(()),
    }
}
