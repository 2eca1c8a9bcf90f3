//! Rows as a table for people.

use super::{Backend, Row};

/// The rows, with items a second, bytes a second, and how a kernel compares with its case's other rows.
pub fn table(rows: &[Row]) -> String {
    let mut text = format!(
        "{:<22} {:<34} {:<13} {:>11} {:>11} {:>11} {:>11} {:>8}\n",
        "name", "case", "backend", "median", "min", "M items/s", "GB/s", "gpu is"
    );
    for row in rows {
        let seconds = row.nanoseconds * 1e-9;
        let kernel = rows
            .iter()
            .find(|other| other.name == row.name && other.case == row.case && other.backend == Backend::Gpu);
        let ratio = (kernel.filter(|_| row.backend != Backend::Gpu))
            .map_or(String::new(), |kernel| format!("{:.2}×", row.nanoseconds / kernel.nanoseconds));
        text += &format!(
            "{:<22} {:<34} {:<13} {:>11} {:>11} {:>11.1} {:>11.2} {:>8}\n",
            row.name,
            row.case,
            row.backend.name(),
            duration(row.nanoseconds),
            duration(row.min),
            row.items as f64 / seconds / 1e6,
            row.bytes as f64 / seconds / 1e9,
            ratio,
        );
    }
    text
}

fn duration(nanoseconds: f64) -> String {
    match nanoseconds {
        n if n < 1e4 => format!("{n:.0} ns"),
        n if n < 1e7 => format!("{:.1} µs", n / 1e3),
        n if n < 1e10 => format!("{:.1} ms", n / 1e6),
        n => format!("{:.1} s", n / 1e9),
    }
}
