#!/usr/bin/env python3
"""Plants faults in shaders, and reports whether parity cases, goldens and tests see them.

    cargo test --no-run
    scripts/mutants.py [--count 40] [--seed 1] [--only STEM] [--target target/debug] [--json FILE]

A fault is an operator, a constant or a bound of a function that is changed to another of the same length. The flat
WGSL lies in the programs as text, so a fault is planted in copies of the programs, without compiling. A fault that
the shader compiler refuses is drawn again. Each fault goes through `relievo verify --only STEM` for the shaders that
have the function. Those that it does not see go through the test programs `golden`, `embed` and those of the shader's
domain, until one sees them.
Exit status 1 if any fault stays unseen: look at it, and show that it is equivalent or write the missing case.
"""

import argparse
import json
import os
import random
import re
import subprocess
import sys
import tempfile
from pathlib import Path

HEADER = re.compile(rb"// relievo ([a-z0-9_/]+): generated from [a-z0-9_/.]+\n")
FUNCTION = re.compile(rb"^(?:@[^\n]*\n)*fn (\w+)\(.*?^\}\n", re.MULTILINE | re.DOTALL)
# Where another text begins: a shader, a module for others' shaders, or what is no text.
END = re.compile(rb"// relievo [a-z0-9_/]+: generated from|// From relievo's|[^\x09\x0a\x20-\x7e\xc2-\xf4\x80-\xbf]")
# What a driver or naga says of text that is no shader.
REFUSED = re.compile(r"Validation|shader parsing|Shader validation|please report this", re.IGNORECASE)
# Seconds after which a program counts as hanging, which is a way to see a fault.
LONGEST = 900

# Each replacement has the length of what it replaces, since offsets in the programs must stay.
OPERATORS = {
    b" + ": [b" - "],
    b" - ": [b" + "],
    b" * ": [b" + "],
    b" / ": [b" * "],
    b" & ": [b" | "],
    b" | ": [b" & "],
    b" ^ ": [b" | "],
    b" << ": [b" >> "],
    b" >> ": [b" << "],
    b" && ": [b" || "],
    b" || ": [b" && "],
    b" == ": [b" != "],
    b" != ": [b" == "],
    b" < ": [b" <=", b" > "],
    b" > ": [b" >=", b" < "],
    b" <= ": [b" <  ", b" >= "],
    b" >= ": [b" >  ", b" <= "],
    b"min(": [b"max("],
    b"max(": [b"min("],
}
OPERATOR = re.compile(b"|".join(re.escape(text) for text in OPERATORS))
# A digit of a literal that stands alone: the last before a point or a suffix.
DIGIT = re.compile(rb"(?<![\w.])\d*(\d)(?=u\b|i\b|\.\d|\b)(?![\w]*\()")


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=40, help="number of faults (default: 40)")
    parser.add_argument("--seed", type=int, default=1, help="seed of the choice of faults (default: 1)")
    parser.add_argument("--only", default="", help="only shaders whose name begins so, as `terrain/thermal`")
    parser.add_argument("--target", type=Path, default=Path("target/debug"), help="folder with the programs")
    parser.add_argument("--json", type=Path, help="where to write what each fault was and what saw it")
    return parser.parse_args()


def reached(text: bytes) -> list[bytes]:
    """The functions of a shader that its entry points call. A fault in any other is equivalent."""
    functions = {match[1]: match[0] for match in FUNCTION.finditer(text)}
    calls = {name: set(re.findall(rb"\b(\w+)\(", body)) for name, body in functions.items()}
    left = [name for name, body in functions.items() if re.search(rb"@(?:compute|vertex|fragment)\b", body)]
    found = set()
    while left:
        name = left.pop()
        if name in functions and name not in found:
            found.add(name)
            left += calls[name] - {name}
    # A module for others' shaders has no entry point.
    return [body for name, body in functions.items() if name in found or not found]


def shaders(program: bytes) -> dict[str, bytes]:
    """The flat WGSL of each shader, by name: what follows its first line, function by function."""
    texts = {}
    for head in HEADER.finditer(program):
        end = END.search(program, head.end())
        text = program[head.start() : end.start() if end else len(program)]
        functions = list(FUNCTION.finditer(text))
        texts[head[1].decode()] = text[: functions[-1].end()] if functions else b""
    return texts


def faults_of(function: bytes) -> list[tuple[int, bytes, bytes]]:
    """All faults of a function: offset, text, replacement. Its head, with attributes and types, stays."""
    body = function.index(b"{\n")
    found = []
    for match in OPERATOR.finditer(function, body):
        found += [(match.start(), match[0], other) for other in OPERATORS[match[0]]]
    for match in DIGIT.finditer(function, body):
        digit = match[1]
        found.append((match.start(1), digit, b"%d" % ((int(digit) + 1) % 10)))
    return found


def programs(target: Path) -> dict[str, Path]:
    """The newest test programs, by name, and `relievo`, whose name the library's unit tests have too."""
    found = {}
    for path in sorted((target / "deps").glob("*-????????????????"), key=lambda path: path.stat().st_mtime):
        found[path.name.rsplit("-", 1)[0]] = path
    return found | {"relievo": target / "relievo"}


class Fault:
    def __init__(self, name: str, function: bytes, at: int, old: bytes, new: bytes):
        self.shader, self.function, self.old, self.new = name, function, old, new
        self.planted = function[:at] + new + function[at + len(old) :]
        self.line = function.count(b"\n", 0, at)
        self.text = self.planted.split(b"\n")[self.line].decode().strip()

    def __str__(self) -> str:
        name = FUNCTION.match(self.function)[1].decode()
        return f"{self.shader} {name}: `{self.old.decode()}` to `{self.new.decode()}`: {self.text}"

    def plant(self, program: Path, folder: Path) -> Path | None:
        """A copy of a program with the fault, or none if the program lacks the function."""
        content = program.read_bytes()
        if self.function not in content:
            return None
        copy = folder / program.name
        copy.write_bytes(content.replace(self.function, self.planted))
        copy.chmod(0o755)
        return copy


def run(program: Path, *arguments: str) -> tuple[int, str]:
    """Exit status and output; hanging is status 124."""
    environment = {**os.environ, "XDG_RUNTIME_DIR": os.environ.get("XDG_RUNTIME_DIR", "/tmp")}
    try:
        done = subprocess.run(
            [program, *arguments], capture_output=True, text=True, errors="replace", timeout=LONGEST, env=environment
        )
        return done.returncode, done.stdout + done.stderr
    except subprocess.TimeoutExpired:
        return 124, ""


def stems(texts: dict[str, bytes], function: bytes) -> list[str]:
    return [name for name, text in texts.items() if function in text]


def attempts(fault: Fault, texts: dict[str, bytes], known: dict[str, Path]) -> tuple[list, list]:
    """The programs with arguments that may see a fault: `relievo verify`, and the test programs, which take longer."""
    kernels = [name for name in stems(texts, fault.function) if not name.startswith("render/")]
    domains = [name.split("/")[0] for name in kernels]
    tests = [name for name in ["golden", "embed", *dict.fromkeys(domains)] if name in known]
    return [("relievo", ["verify", "--only", stem]) for stem in kernels], [(name, []) for name in tests]


def seen_by(fault: Fault, tried: list, all_programs: dict[str, Path]) -> str | None:
    """Which of the programs sees a fault: empty if none does, none if the fault is no shader."""
    copies: dict[str, Path | None] = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, rest in tried:
            if name not in copies:
                copies[name] = fault.plant(all_programs[name], Path(folder))
            copy = copies[name]
            if copy is None:
                continue
            status, output = run(copy, *rest)
            if status == 0 or (rest and status == 2 and "no case" in output):
                continue
            if status != 124 and REFUSED.search(output):
                return None
            return " ".join([name, *rest]) + (" (hangs)" if status == 124 else "")
    return ""


def main() -> None:
    chosen = arguments()
    all_programs = programs(chosen.target)
    texts = shaders(all_programs["relievo"].read_bytes())
    texts = {name: text for name, text in texts.items() if text}
    names = [name for name in sorted(texts) if name.startswith(chosen.only) and not name.startswith("baseline/")]
    if not names:
        sys.exit(f"--only {chosen.only}: must begin the name of a shader")
    status, output = run(all_programs["relievo"], "verify", "--only", "baseline/copy")
    if status != 0:
        sys.exit(f"`relievo verify` fails without a fault: {output}")
    draw = random.Random(chosen.seed)
    tried: set[bytes] = set()
    found: list[dict[str, str]] = []
    refused = 0

    def drawn() -> Fault:
        while True:
            name = names[len(tried) % len(names)] if chosen.only else draw.choice(names)
            faults = faults_of(function := draw.choice(reached(texts[name])))
            if faults and (fault := Fault(name, function, *draw.choice(faults))).planted not in tried:
                tried.add(fault.planted)
                return fault

    def tell(fault: Fault, by: str) -> None:
        found.append({"fault": str(fault), "seen_by": by})
        print(f"{len(found):3} {'seen by ' + by if by else 'NOT SEEN'}: {fault}", flush=True)

    while len(found) < chosen.count:
        unseen = []
        while len(found) + len(unseen) < chosen.count:
            fault = drawn()
            verify, tests = attempts(fault, texts, all_programs)
            by = seen_by(fault, verify, all_programs)
            if by:
                tell(fault, by)
            elif by is None:
                refused += 1
            else:
                unseen.append((fault, tests))
        print(f"{len(unseen)} faults are left to the test programs:", *(fault for fault, _ in unseen), sep="\n    ", flush=True)
        for fault, tests in unseen:
            by = seen_by(fault, tests, all_programs)
            if by is None:
                refused += 1
            else:
                tell(fault, by)
    seen = sum(bool(entry["seen_by"]) for entry in found)
    print(f"{seen} of {len(found)} faults seen; {refused} more were no shaders")
    if chosen.json:
        chosen.json.write_text(json.dumps({"seed": chosen.seed, "seen": seen, "faults": found}, indent=1) + "\n")
    sys.exit(seen < len(found))


main()
