//! A report of parity cases as text.

use crate::harness::CaseResult;
use crate::harness::compare::{LeftOut, Spread};
use crate::verify::Report;

impl Report {
    /// As text: a line a kernel and kind of comparison, what is left out, and every fault.
    pub fn summary(&self) -> String {
        let mut groups: Vec<(&str, &str, Vec<&CaseResult>)> = Vec::new();
        for case in &self.cases {
            let unit = case.comparison.unit;
            match groups.iter_mut().find(|(stem, group, _)| *stem == case.stem && *group == unit) {
                Some((_, _, cases)) => cases.push(case),
                None => groups.push((case.stem, unit, vec![case])),
            }
        }
        let mut text = format!(
            "{:<18} {:>6} {:>12} {:>11} {:>11}  {}\n",
            "kernel", "cases", "values", "error", "bound", ""
        );
        for (stem, unit, cases) in &groups {
            let values: usize = cases.iter().map(|case| case.comparison.values).sum();
            let error = cases.iter().map(|case| case.comparison.error).fold(0.0, f64::max);
            let bound = cases.iter().map(|case| case.comparison.bound).fold(0.0, f64::max);
            let holds = if cases.iter().all(|case| case.comparison.holds) { "holds" } else { "FAILS" };
            text += &format!(
                "{stem:<18} {:>6} {values:>12} {:>11} {:>11}  {unit}: {holds}\n",
                cases.len(),
                number(error),
                number(bound)
            );
            text += &spread(cases);
        }
        text += &left_out(self);
        for case in self.cases.iter().filter(|case| !case.comparison.holds) {
            text += &format!(
                "FAILS {} {}: {}\n",
                case.stem,
                case.case,
                case.comparison.fault.as_deref().unwrap_or("")
            );
        }
        let failed = self.cases.iter().filter(|case| !case.comparison.holds).count();
        text += &match failed {
            0 => format!("all {} cases hold\n", self.cases.len()),
            _ => format!(
                "{failed} of {} cases fail: do not trust this driver with these kernels\n",
                self.cases.len()
            ),
        };
        text
    }
}

/// A line on the errors of values that have a bound each.
fn spread(cases: &[&CaseResult]) -> String {
    let spreads = || cases.iter().filter_map(|case| case.comparison.spread);
    let Some(first) = spreads().next() else { return String::new() };
    let most = |of: fn(Spread) -> f64| spreads().map(of).fold(0.0, f64::max);
    let sum = |of: fn(Spread) -> usize| spreads().map(of).sum::<usize>();
    format!(
        "{:<18} 99 of 100 within {} {unit} in every case, largest {} {unit}; {} touch (at most {})\n",
        "",
        number(most(|spread| spread.p99)),
        number(most(|spread| spread.largest)),
        sum(|spread| spread.touching),
        sum(|spread| spread.may_touch),
        unit = first.unit,
    )
}

/// A line for each kernel of which something is left out, and for each of which cases cannot run.
fn left_out(report: &Report) -> String {
    let mut text = String::new();
    let mut kernels: Vec<&str> = report.cases.iter().map(|case| case.stem).collect();
    kernels.dedup();
    for stem in kernels {
        let own = report.cases.iter().filter(|case| case.stem == stem);
        let all: Vec<_> = own.filter_map(|case| case.comparison.left_out).collect();
        let sum = |of: fn(&LeftOut) -> usize| all.iter().map(of).sum::<usize>();
        let [count, of] = [sum(|left_out| left_out.count), sum(|left_out| left_out.of)];
        if count > 0 {
            text += &format!("{stem}: {count} of {of} left out, as rounding may decide them either way\n");
        }
    }
    text
}

fn number(value: f64) -> String {
    if value == 0.0 || value >= 1.0 { format!("{value}") } else { format!("{value:.2e}") }
}
