#!/usr/bin/env python3
"""Counts lines of code by crate: without comments, blank lines and tests.

    scripts/lines.py [FOLDER]

Tests are modules behind `#[cfg(test)]`, in their file or in files of their own, and the folders `tests/`, `benches/` and
`examples/`. Rust is counted in `src/` and `build*`, WGSL in `kernels/` and `wgsl/`. FOLDER is a checkout; default: this one.
"""

import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

# A module of tests that begins in a file, and one that is a file.
BEGINS = re.compile(r"^\s*#\[cfg\((?:test|all\(test\b.*)\)\]$")
MODULE = re.compile(r"^\s*(?:pub(?:\(.*?\))? )?mod (\w+)\s*([;{])")


def without_comments(text: str) -> str:
    """The text without comments; strings, in which `//` may stand, are kept."""
    token = re.compile(
        r'r(#*)".*?"\1|"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])\'|//[^\n]*|/\*.*?\*/', re.DOTALL
    )
    return token.sub(lambda m: "" if m[0].startswith(("//", "/*")) else m[0], text)


def rust(path: Path, tests: set[Path]) -> int:
    """Lines of a Rust file; files and folders of its test modules go to `tests`."""
    lines = without_comments(path.read_text()).split("\n")
    count, at = 0, 0
    folder = path.parent if path.name in ("mod.rs", "lib.rs", "main.rs") else path.with_suffix("")
    while at < len(lines):
        if BEGINS.match(lines[at]):
            head = at + 1
            while lines[head].strip().startswith("#["):
                head += 1
            module = MODULE.match(lines[head])
            if module and module[2] == ";":
                tests.update([folder / f"{module[1]}.rs", folder / module[1]])
                at = head + 1
                continue
            if module:
                indent = len(lines[head]) - len(lines[head].lstrip())
                while lines[head].rstrip() != " " * indent + "}":
                    head += 1
                at = head + 1
                continue
        count += bool(lines[at].strip())
        at += 1
    return count


def crate_of(path: Path) -> str:
    if path.parts[0] == "crates":
        return path.parts[1]
    if path.parts[:2] == ("src", "bin"):
        return "relievo (src/bin)"
    return "relievo"


def main() -> None:
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent.parent)
    files = subprocess.run(
        ["git", "-C", root, "ls-files"], check=True, capture_output=True, text=True
    ).stdout.split()
    sources = [Path(file) for file in files if (root / file).is_file()]
    outside = {"tests", "benches", "examples", "generated"}
    sources = [file for file in sources if not outside & set(file.parts)]
    tests: set[Path] = set()
    counts = {
        file: rust(root / file, tests)
        for file in sources
        if file.suffix == ".rs" and ("src" in file.parts or file.parts[0].startswith("build"))
    }
    code: Counter[tuple[str, str]] = Counter()
    for file, count in counts.items():
        path = root / file
        if tests.isdisjoint([path, *path.parents]):
            code[crate_of(file), "Rust"] += count
    for file in sources:
        if file.suffix == ".wgsl":
            lines = without_comments((root / file).read_text()).split("\n")
            code[crate_of(file), "WGSL"] += sum(bool(line.strip()) for line in lines)
    for (crate, language), count in sorted(code.items()):
        print(f"{crate:20} {language} {count:7}")
    print(f"{'all':25} {sum(code.values()):7}")


main()
