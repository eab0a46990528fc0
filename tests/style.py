#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The style checks: our own rules, arrows between parts (package_arrows.py), ruff, mypy, import-linter,
clang-format, shellcheck, codespell, clang-tidy, and noexcept functions that call what throws (nothrow.py).

Called by `./franka test --style`, by continuous integration and by the hooks of pre-commit. Each finding is
a line `file:line: what`. Exit status 1 if a check has findings or its tool is missing.
"""

import argparse
import collections
import json
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Set
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import nothrow
import package_arrows
import wall_clock

TOP = Path(__file__).resolve().parent.parent
VENV = TOP / ".venv" / "bin"
NOT_IN_DEBIAN = TOP / "out" / "not_in_debian"  # written by ./franka
TYPES = TOP / "catkin_ws" / "build" / "pyfranka" / "types"
COMPILE_COMMANDS = TOP / "compile_commands.json"

HEADER = "Copyright (c) 2026 the franka_ros for Debian authors"
NEEDS_HEADER = {".cpp", ".h", ".py", ".sh", ".cmake", ".launch", ".xacro", ".js", ".css"}

# Forbidden includes: a path pattern, the forbidden headers, and the reason.
INCLUDE_RULES = [
    (
        r"catkin_ws/src/(libfranka|franka_sim)/",
        r"<(ros|tf2?|tf2_ros|std_msgs|sensor_msgs|geometry_msgs)/",
        "libfranka and franka_sim build without ROS",
    ),
    (r"(?!.*/physics/)", r"<mujoco/", "MuJoCo headers stand in physics/ only"),
    (
        r"(?!catkin_ws/src/libfranka/src/|.*/fci/|.*/serve/|.*/test/|tests/)",
        r"<(sys/socket|netinet/in|arpa/inet)\.h>",
        "sockets stand in libfranka/src, fci/ and serve/ only",
    ),
]
READS_BY_LOCALE = (
    r"\b(strto(d|f|ld)|sto(d|f|ld)|atof|sscanf|Query(Double|Float)\w*|(Double|Float)(Text|Attribute|Value))\("
)
# They return the address of what another thread's call writes, too.
SHARED_TIME = re.compile(r"\b(localtime|gmtime|ctime|asctime)\(")
WRITES_BY_LOCALE = (
    r"\b(sn?printf|ROS_(DEBUG|INFO|WARN|ERROR|FATAL)\w*)"
    r"\((?:[^;\"]|\"[^\"]*\")*?\"[^\"]*%[-+#0-9.*]*[aefgAEFG]"
)
MARKERS = re.compile(r"\b(TODO|FIXME|XXX|HACK)\b")
# A word between two lines of a comment or of a documentation text.
GAP = r"(?:[ -]|\s*\n\s*(?:///?|#|\*)?\s*)"
# Every spelling of a note on threads or real-time safety, and the three that are allowed (CONTRIBUTING.md).
THREAD_NOTE = re.compile(
    rf"\b(?:not{GAP})?(?:(?:real-?{GAP}?time|rt){GAP}safe|thread{GAP}safe)\b"
    rf"|\bsafe{GAP}in{GAP}the{GAP}(?:1{GAP}kHz|control){GAP}loop\b"
    rf"|\bnot{GAP}for{GAP}the{GAP}(?:1{GAP}kHz|control){GAP}loop\b"
    rf"|[.;]{GAP}(?:any|one){GAP}thread[.,;]",
    re.IGNORECASE,
)
FIXED_NOTE = re.compile(
    r"(?:^|(?<=[.)/#] )|(?<=  )|(?<=\"\"\"))(?:Real-time safe|Not real-time safe|Thread-safe)\.(?=[\s\"])",
    re.MULTILINE,
)
# Words that docs/glossary.md replaces, and their replacements.
REPLACED_WORDS = [
    (
        re.compile(r"\bk(Most|Least|Longest|Shortest|Farthest|Fastest|Slowest|Strongest)([A-Z]\w*)?\b"),
        "kMax or kMin",
    ),
    (re.compile(r"(?<!here )\b(is|are|was|were) no (?!longer|more|other)[a-z]+"), "'is not a ...'"),
    (re.compile(r"\banew\b"), "'again'"),
    (re.compile(r"\bmet something\b"), "'hit an obstacle'"),
    (re.compile(r"\bis nothing that\b|\btakes nothing\b"), "'unknown argument', or what is expected"),
    (
        re.compile(
            r"(?i:colour|(?<![\"_])centre\b(?![\":])|metres?\b|behaviour|neighbour|initialis|normalis|serialis|factoris)"
        ),
        "the American spelling",
    ),
    (re.compile(r"\b(?i:whoever|whomever)\b"), "the caller, the client or the user"),
]
# Python that mypy does not read: tests, and the files that setuptools, pytest and Sphinx run.
UNTYPED = re.compile(r"(^|/)(setup|conftest|conf)\.py$|(^|/)tests?/")
MACHINE_PATH = re.compile(r"(?<![\w.$}/-])/(work|home|root|Users)/\w+")


class ToolMissing(Exception):
    """A check cannot run; the message says what to do."""


class NotInDebian(Exception):
    """A check cannot run on this release; the message says why."""


def git(*arguments: str) -> str:
    """Output of a git command; empty if it fails."""
    try:
        return subprocess.run(["git", *arguments], cwd=TOP, capture_output=True, text=True).stdout
    except FileNotFoundError:
        return ""


def tracked() -> list[Path]:
    """Existing tracked files; empty if this is not a clone, or git does not trust its owner."""
    return [TOP / name for name in git("ls-files", "-z").split("\0") if name and (TOP / name).is_file()]


def first_line(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.readline(80)


def sources(files: list[Path]) -> list[Path]:
    return [path for path in files if path.suffix in {".cpp", ".h"}]


# ---- tools -----------------------------------------------------------------------------------------------


def pinned_tool(name: str) -> str:
    """A program that requirements-test.txt pins: never another version in PATH."""
    for folder in (Path(sys.executable).parent, VENV):
        if (folder / name).is_file():
            return str(folder / name)
    raise ToolMissing(f"{name} is missing: run ./franka install test, which puts it into .venv.")


def debian_tool(name: str) -> str:
    found = shutil.which(name)
    if not found:
        package = name.replace("++", "")
        if NOT_IN_DEBIAN.exists() and package in NOT_IN_DEBIAN.read_text(encoding="utf-8").split():
            raise NotInDebian(f"{package} is not installed: this Debian does not have it")
        raise ToolMissing(f"{name} is missing: run ./franka install test, which installs the Debian package.")
    return found


def passes(command: list[str], files: list[Path]) -> bool:
    """Runs a tool on files, whose names it then prints relative to the root."""
    if not files:
        return True
    names = [str(path.relative_to(TOP)) for path in files]
    return subprocess.run([*command, *names], cwd=TOP).returncode == 0


# ---- our own rules ---------------------------------------------------------------------------------------


def include_findings(name: str, lines: list[str]) -> Iterator[str]:
    for pattern, header, reason in INCLUDE_RULES:
        if not re.match(pattern, name):
            continue
        for number, line in enumerate(lines, 1):
            if re.match(r"\s*#\s*include\s*" + header, line):
                yield f"{name}:{number}: {reason}: {line.strip()}"


def note_findings(name: str, text: str) -> Iterator[str]:
    """Notes on threads and real-time safety that a search for the fixed sentences does not find."""
    fixed = [match.span() for match in FIXED_NOTE.finditer(text)]
    for match in THREAD_NOTE.finditer(text):
        if not any(begin <= match.start() and match.end() <= end for begin, end in fixed):
            spelling = " ".join(re.sub(r"\n\s*(?:///?|#|\*)?", " ", match[0]).split())
            line = text.count("\n", 0, match.start()) + 1
            yield f"{name}:{line}: '{spelling}' is not one of the fixed notes (CONTRIBUTING.md, How we write)"


def word_findings(name: str, text: str) -> Iterator[str]:
    """Words that the glossary replaces."""
    for words, replacement in REPLACED_WORDS:
        for match in words.finditer(text):
            line = text.count("\n", 0, match.start()) + 1
            yield f"{name}:{line}: '{match[0]}': write {replacement} (docs/glossary.md)"


def locale_findings(name: str, text: str) -> Iterator[str]:
    """Calls that read or write a number with a decimal comma after setlocale()."""
    instead = "a stream" if "/ros_control/" in name else "franka_core/numbers.h or a stream"
    for match in re.finditer(rf"{READS_BY_LOCALE}|{WRITES_BY_LOCALE}", text):
        line = text.count("\n", 0, match.start()) + 1
        yield f"{name}:{line}: '{match[0].split('(')[0]}' depends on the locale: use {instead}"


def time_findings(name: str, text: str) -> Iterator[str]:
    """Calls whose result all threads share."""
    for match in SHARED_TIME.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        yield f"{name}:{line}: '{match[1]}' is not for several threads: use {match[1]}_r"


def text_findings(path: Path) -> Iterator[str]:
    name = str(path.relative_to(TOP))
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return
    lines = text.splitlines()
    if path.suffix in NEEDS_HEADER and lines and not any(HEADER in line for line in lines[:6]):
        yield f"{name}:1: the license header is missing"
    if path.suffix in {".cpp", ".h"}:
        yield from include_findings(name, lines)
        yield from time_findings(name, text)
        if not {"test", "tests", "bench"} & set(path.parts):
            yield from locale_findings(name, text)
        if path.suffix == ".h" and "#pragma once" not in lines:
            yield f"{name}:1: #pragma once is missing"
    if path.suffix in {".cpp", ".h", ".hpp", ".py"} and name not in {"tests/style.py", "tests/test_style.py"}:
        yield from note_findings(name, text)
        yield from wall_clock.findings(name, text)
    if name not in {"tests/style.py", "tests/test_style.py", "docs/glossary.md", ".codespellrc"}:
        yield from word_findings(name, text)
    for number, line in enumerate(lines, 1):
        if path.suffix not in {".md", ".py"} and MARKERS.search(line):  # ruff finds those of Python
            yield f"{name}:{number}: a left-over marker: {line.strip()}"
        if name != "tests/style.py" and MACHINE_PATH.search(line):
            yield f"{name}:{number}: names a machine's path: {line.strip()}"


def check_text(files: list[Path], long: bool) -> bool:
    findings = [finding for path in files for finding in text_findings(path)]
    if findings:
        print("\n".join(findings))
    return not findings


def check_arrows(files: list[Path], long: bool) -> bool:
    """Which part includes or imports which."""
    findings = package_arrows.findings()
    print("\n".join(findings), end="\n" if findings else "")
    return not findings


# ---- checks by tools -------------------------------------------------------------------------------------


def python_of(files: list[Path]) -> list[Path]:
    """Modules, and scripts without a suffix."""
    scripts = [path for path in files if not path.suffix and re.match(rb"#!.*python", first_line(path))]
    return [path for path in files if path.suffix == ".py"] + scripts


def check_ruff(files: list[Path], long: bool) -> bool:
    ruff = pinned_tool("ruff")
    python = python_of(files)
    tables = [path for path in files if path.suffix == ".cfg"]
    linted = passes([ruff, "check", "--quiet", "--output-format=concise"], python + tables)
    return passes([ruff, "format", "--check", "--quiet"], python) and linted


def module_of(path: Path) -> str:
    """The name by which others import it. A script that imports a package of its own name has none."""
    name, folder = path.stem, path.parent
    if not path.suffix and re.search(rf"^\s*(from|import) {name}\b", path.read_text(), re.MULTILINE):
        return "__main__"
    while (folder / "__init__.py").is_file():
        name, folder = folder.name if name == "__init__" else f"{folder.name}.{name}", folder.parent
    return name


def without_clashes(files: list[Path]) -> list[list[Path]]:
    """The files in groups; mypy reads one of each name, and imports the others of the group by theirs."""
    groups: list[dict[str, Path]] = []
    for path in files:
        name = module_of(path)
        # One of these is alone: its neighbors would be found in place of the package that it imports.
        if name == "__main__" or all(name in group or "__main__" in group for group in groups):
            groups.append({name: path})
        else:
            next(each for each in groups if name not in each and "__main__" not in each)[name] = path
    return [list(group.values()) for group in groups]


def check_mypy(files: list[Path], long: bool) -> bool:
    if not TYPES.is_dir():
        raise ToolMissing("mypy needs the types of pyfranka's module: run ./franka build, which makes them.")
    mypy = [pinned_tool("mypy"), "--no-error-summary"]
    stubs = [path for path in files if path.suffix == ".pyi"]  # which are imported in place of their modules
    typed = [path for path in python_of(files) if not UNTYPED.search(str(path.relative_to(TOP)))]
    clean = True
    for group in without_clashes([*stubs, *typed]):
        scripts = [] if module_of(group[0]) == "__main__" else ["--scripts-are-modules"]
        clean = passes([*mypy, *scripts], group) and clean
    return clean


def check_imports(files: list[Path], long: bool) -> bool:
    """The layers of Python's modules, in .importlinter."""
    command = [pinned_tool("lint-imports"), "--no-cache", "--no-logo"]
    environment = {**os.environ, "PYTHONPATH": str(TOP / "python" / "src")}
    result = subprocess.run(command, cwd=TOP, env=environment, capture_output=True, text=True)
    if result.returncode:
        print(result.stdout + result.stderr)
    return result.returncode == 0


def check_clang_format(files: list[Path], long: bool) -> bool:
    return passes([pinned_tool("clang-format"), "--dry-run", "--Werror"], sources(files))


def check_shellcheck(files: list[Path], long: bool) -> bool:
    shell = re.compile(rb"#!.*\b(ba)?sh\b")
    named = [path for path in files if path.suffix in {".sh", ".bash", ""}]
    scripts = [path for path in named if shell.match(first_line(path))]
    return passes([pinned_tool("shellcheck"), "--format=gcc"], scripts)


def check_codespell(files: list[Path], long: bool) -> bool:
    return passes([pinned_tool("codespell")], files)


# ---- clang-tidy ------------------------------------------------------------------------------------------


def base_commit() -> str:
    """Base of changes: the merge base with the main branch, or the previous commit."""
    head = git("rev-parse", "HEAD").strip()
    for main in ("origin/HEAD", "origin/main"):
        base = git("merge-base", "HEAD", main).strip()
        if base and base != head:
            return base
    return git("rev-parse", "--verify", "--quiet", "HEAD~1").strip() or head


def changed(files: list[Path]) -> list[Path]:
    names = set(git("diff", "--name-only", "-z", base_commit()).split("\0"))
    return [path for path in files if str(path.relative_to(TOP)) in names]


def package_of(path: Path) -> Path:
    """The nearest folder with a package.xml, or the root."""
    for folder in path.parents:
        if folder == TOP or (folder / "package.xml").is_file():
            return folder
    return TOP


def includers(files: list[Path]) -> dict[str, set[Path]]:
    """The sources and headers that include a header of this name."""
    found = collections.defaultdict(set)
    for path in sources(files):
        for name in re.findall(r'#include ["<](?:.*/)?(\w+\.h)[">]', path.read_text(encoding="utf-8")):
            found[name].add(path)
    return found


def units_of(path: Path, compiled: Set[Path], including: dict[str, set[Path]]) -> set[Path]:
    """Sources that show what a file has: itself; those of a header's name, or the next that includes it."""
    of_name = {unit for unit in compiled if unit.stem == path.stem and package_of(unit) == package_of(path)}
    units, seen = of_name if path.suffix == ".h" else compiled & {path}, {path}
    new = seen if path.suffix == ".h" else set()
    while new and not units:
        new = set().union(*(including[header.name] for header in new)) - seen
        seen |= new
        units = set(sorted(new & compiled)[:1])
    return units


def tidy(program: str, path: Path) -> str:
    """clang-tidy's findings in a source; empty if it is clean."""
    # The build uses g++; clang does not know some of its options.
    command = [program, "--quiet", f"-p={TOP}", "--extra-arg=-Wno-unknown-warning-option", str(path)]
    result = subprocess.run(command, cwd=TOP, capture_output=True, text=True)
    if result.returncode == 0:
        return ""
    # The error stream counts suppressed warnings, or holds the error if the program itself fails.
    return (result.stdout or result.stderr).replace(f"{TOP}/", "")


def units_to_check(name: str, files: list[Path], long: bool) -> dict[Path, dict]:
    """The sources that a check by a compiler reads, and how the present build compiles them."""
    candidates = sources(files) if long else sources(changed(files))
    if not candidates:
        return {}
    if not COMPILE_COMMANDS.exists():
        raise ToolMissing(f"{name} needs compile_commands.json: run ./franka build, which makes it.")
    entries = json.loads(COMPILE_COMMANDS.read_text(encoding="utf-8"))
    # A package that is linked into the workspace is compiled under the link's name.
    built = {Path(entry["directory"], entry["file"]).resolve(): entry for entry in entries}
    compiled = built.keys() & set(files)
    including = includers(files)
    units = {path: units_of(path, compiled, including) for path in candidates}
    left_out = [path for path in candidates if not units[path]]
    if left_out:
        names = ", ".join(str(path.relative_to(TOP)) for path in left_out[:3])
        print(f"{name}: {len(left_out)} files are not part of the present build ({names} ...)")
    return {path: built[path] for path in sorted(set().union(*units.values()))}


def print_findings(name: str, units: dict[Path, dict], find: Callable[[dict], list[str]]) -> bool:
    """Prints what is found in each source. @returns whether that is nothing"""
    with ThreadPoolExecutor(int(os.environ.get("FRANKA_JOBS") or os.cpu_count() or 2)) as pool:
        found = list(pool.map(find, units.values()))
    # Each source that includes a header repeats its findings.
    lines = dict.fromkeys(line for part in found for line in part)
    print("\n".join(lines), end="\n" if lines else "")
    print(f"{name}: {len(units)} sources")
    return not lines


def check_clang_tidy(files: list[Path], long: bool) -> bool:
    program = debian_tool("clang-tidy-22")
    units = units_to_check("clang-tidy", files, long)

    def find(entry: dict) -> list[str]:
        return tidy(program, Path(entry["directory"], entry["file"])).splitlines()

    return not units or print_findings("clang-tidy", units, find)


# ---- functions that must not throw -----------------------------------------------------------------------


def is_program(path: Path) -> bool:
    """Whether a source is part of what users run, not of tests and benchmarks."""
    return not {"test", "tests", "bench"}.intersection(path.relative_to(TOP).parts)


def check_nothrow(files: list[Path], long: bool) -> bool:
    debian_tool(nothrow.COMPILER)
    units = units_to_check("nothrow", [path for path in files if is_program(path)], long)
    own = nothrow.own_namespaces(sources(files))
    return not units or print_findings("nothrow", units, lambda entry: nothrow.findings(entry, own, TOP))


CHECKS: dict[str, Callable[[list[Path], bool], bool]] = {
    "text": check_text,
    "arrows": check_arrows,
    "ruff": check_ruff,
    "mypy": check_mypy,
    "imports": check_imports,
    "clang-format": check_clang_format,
    "shellcheck": check_shellcheck,
    "codespell": check_codespell,
    "clang-tidy": check_clang_tidy,
    "nothrow": check_nothrow,
}


def main() -> int:
    parser = argparse.ArgumentParser(prog="./franka test --style")
    parser.add_argument("checks", nargs="*", metavar="CHECK", help=f"only these of {', '.join(CHECKS)}")
    parser.add_argument(
        "--long", action="store_true", help="clang-tidy and nothrow on all sources, not only the changed"
    )
    parser.add_argument("--skips", type=Path, help="a file for the checks that cannot run")
    arguments = parser.parse_args()
    unknown = [name for name in arguments.checks if name not in CHECKS]
    if unknown:
        parser.error(f"there is no check {', '.join(unknown)}; there are: {', '.join(CHECKS)}")
    files = tracked()
    if not files:
        print("style: git lists no files here; `git status` shows the reason.", file=sys.stderr)
        return 1
    failed = []
    for name in arguments.checks or CHECKS:
        begin = time.monotonic()
        try:
            clean = CHECKS[name](files, arguments.long)
        except ToolMissing as missing:
            print(f"style: {missing}", file=sys.stderr)
            clean = False
        except NotInDebian as lacking:
            print(f"style: {lacking}", file=sys.stderr)
            if arguments.long or os.environ.get("CI") == "true":
                failed.append(name)
            elif arguments.skips:
                with arguments.skips.open("a", encoding="utf-8") as file:
                    file.write(f"{name}\t{lacking}\n")
            continue
        print(f"{name}: {'clean' if clean else 'FAILED'} ({time.monotonic() - begin:.1f} s)", flush=True)
        if not clean:
            failed.append(name)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
