//! Formats rows as a text table.

use crate::harness::{Row, TimedBy};

/// The rows as a table: nanoseconds per item, items and bytes per second, the ratio of each row to its case's
/// kernel, and the clock. The device's clock measures the work alone; the host's clock includes submission and
/// waiting.
pub fn table(rows: &[Row]) -> String {
    let mut text = format!(
        "{:<22} {:<34} {:<13} {:>11} {:>11} {:>9} {:>11} {:>11} {:>8}  {}\n",
        "name", "case", "backend", "median", "min", "ns/item", "M items/s", "GB/s", "gpu is", "clock"
    );
    for row in rows {
        let seconds = row.nanoseconds * 1e-9;
        let ratio = row.beside_kernel.map_or(String::new(), |ratio| format!("{ratio:.2}×"));
        text += &format!(
            "{:<22} {:<34} {:<13} {:>11} {:>11} {:>9.2} {:>11.1} {:>11.2} {:>8}  {}\n",
            row.name,
            row.case,
            row.backend.name(),
            duration(row.nanoseconds),
            duration(row.min),
            row.nanoseconds / row.items as f64,
            row.items as f64 / seconds / 1e6,
            row.bytes as f64 / seconds / 1e9,
            ratio,
            match row.timed_by {
                TimedBy::Timestamp => "device",
                TimedBy::Wall => "wall",
            },
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::harness::Backend;

    #[test]
    fn rows_say_which_clock_timed_them() {
        let row = |backend, timed_by| Row {
            name: "terrain/height",
            case: "33x33".to_owned(),
            backend,
            nanoseconds: 2e6,
            min: 1e6,
            max: 3e6,
            beside_kernel: (backend != Backend::Gpu).then_some(0.5),
            items: 1089,
            item: "point",
            bytes: 4356,
            timed_by,
        };
        let rows = [row(Backend::Gpu, TimedBy::Timestamp), row(Backend::Copy, TimedBy::Wall)];
        let text = table(&rows);
        let ends: Vec<_> = text.lines().filter_map(|line| line.split_whitespace().last()).collect();
        assert_eq!(ends, ["clock", "device", "wall"], "{text}");
        // 2 ms of 1,089 points.
        let items: Vec<_> = text.lines().skip(1).filter_map(|line| line.split_whitespace().nth(7)).collect();
        assert_eq!(items, ["1836.55"; 2], "{text}");
        assert_eq!(text.matches("0.50×").count(), 1, "{text}");
    }
}
