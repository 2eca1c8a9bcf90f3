//! The table of `docs/sources.md` of where a thesis contradicts itself, held against the code: every decision stands in the
//! documentation of its item and has a test, and the table lists every decision.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What a decision in the documentation begins with.
const DECIDED: &str = "**Decided**: ";

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The Rust files below these folders, each with its text.
fn sources(folders: &[&str]) -> BTreeMap<String, String> {
    fn walk(path: PathBuf, found: &mut BTreeMap<String, String>) {
        if path.is_dir() {
            for entry in std::fs::read_dir(path).expect("a folder") {
                walk(entry.expect("an entry").path(), found);
            }
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let name = path.strip_prefix(root()).expect("below it").display().to_string();
            found.insert(name, std::fs::read_to_string(path).expect("text"));
        }
    }
    let mut found = BTreeMap::new();
    folders.iter().for_each(|folder| walk(root().join(folder), &mut found));
    found
}

/// A row of the table: the file in which the item is, and the test's name.
struct Row {
    file: String,
    item: String,
    test: String,
}

fn table(text: &str) -> Vec<Row> {
    let rows = text.lines().skip_while(|line| !line.starts_with("| where the thesis contradicts itself |"));
    let rows = rows.skip(2).take_while(|line| line.starts_with('|'));
    rows.map(|line| {
        let cells: Vec<&str> = line.trim_matches('|').split(" | ").map(str::trim).collect();
        let [_, item, test] = cells.as_slice() else { panic!("three cells: {line}") };
        let (item, file) = item.split_once("](../").unwrap_or_else(|| panic!("a link: {line}"));
        Row {
            file: file.trim_end_matches(')').to_owned(),
            item: item.trim_matches(['[', '`']).to_owned(),
            test: test.trim_matches('`').to_owned(),
        }
    })
    .collect()
}

/// What is wrong with a table, given all sources with their tests.
fn mistakes(rows: &[Row], sources: &BTreeMap<String, String>) -> Vec<String> {
    let mut found = Vec::new();
    let mut listed: BTreeMap<&str, usize> = BTreeMap::new();
    for Row { file, item, test } in rows {
        *listed.entry(file).or_default() += 1;
        if !sources.values().any(|text| {
            text.contains(&format!("#[test]\nfn {test}()"))
                || text.contains(&format!("#[test]\n    fn {test}()"))
        }) {
            found.push(format!("{item}: there is no test {test}"));
        }
    }
    let is_doc = |line: &&str| {
        let line = line.trim_start();
        line.strip_prefix("///")
            .or_else(|| line.strip_prefix("//!"))
            .is_some_and(|text| text.trim().starts_with(DECIDED))
    };
    let is_source = |file: &str| file.starts_with("src/") || file.contains("/src/");
    for (file, text) in sources {
        let stated = text.lines().filter(is_doc).count();
        let mentioned = if is_source(file) { text.matches("Decided").count() } else { stated };
        if stated != mentioned {
            found.push(format!("{file}: \"{DECIDED}\" must begin a paragraph of documentation"));
        }
        let listed = listed.remove(file.as_str()).unwrap_or_default();
        if listed != stated && is_source(file) {
            found.push(format!(
                "{file}: docs/sources.md lists {listed} decisions, its documentation has {stated}"
            ));
        }
    }
    found.extend(listed.keys().map(|file| format!("{file}: there is no such file")));
    found
}

#[test]
fn every_contradiction_is_decided_in_the_code() {
    let rows = table(include_str!("../docs/sources.md"));
    assert!(rows.len() > 10, "{}", rows.len());
    let found = mistakes(&rows, &sources(&["src", "crates", "tests"]));
    assert!(found.is_empty(), "{found:#?}");
}

/// A decision that the table lacks, one that the code lacks, a test and a file that do not exist.
#[test]
fn planted_mistakes_in_the_table_are_found() {
    let row = |file: &str, test: &str| Row {
        file: file.to_owned(),
        item: "an item".to_owned(),
        test: test.to_owned(),
    };
    let text = |text: &str| text.to_owned();
    let sources = BTreeMap::from([
        (text("src/a.rs"), text("/// **Decided**: one.\n///\n/// **Decided**: two.\n")),
        (text("src/b.rs"), text("//! Nothing.\n")),
        (text("src/c.rs"), text("// Decided long ago.\n")),
        (text("tests/a.rs"), text("#[test]\nfn there() {}\n")),
    ]);
    let twice = || [row("src/a.rs", "there"), row("src/a.rs", "there")];
    let of = |more: Row| mistakes(&twice().into_iter().chain([more]).collect::<Vec<_>>(), &sources);
    let plain = mistakes(&twice(), &sources);
    assert!(plain.len() == 1 && plain[0].starts_with("src/c.rs"), "{plain:?}");
    assert_eq!(mistakes(&twice()[..1], &sources).len(), 2);
    assert_eq!(of(row("src/b.rs", "there")).len(), 2);
    assert_eq!(of(row("src/d.rs", "there")).len(), 2);
    assert_eq!(of(row("src/a.rs", "absent")).len(), 3);
}
