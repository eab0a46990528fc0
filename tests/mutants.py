#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that tests find each mutant of tests/data/mutants, by the proof that proofs.tsv names.

A mutant is found if its proof fails with it and passes without it. Works in out/mutants, a worktree of the
last commit, which is built once and stays. Prints `NN found|MISSED|does not build SECONDS` for each mutant,
with the reason, and ends with status 1 if any was not found. The output of all proofs is in out/mutants.log.
Needs the .venv of `./franka test`.
"""

import argparse
import os
import re
import subprocess
import sys
import time
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
sys.path.append(str(TOP / "tests" / "support"))
import own_network  # noqa: E402

MUTANTS = TOP / "tests" / "data" / "mutants"
COPY, LOG = TOP / "out" / "mutants", TOP / "out" / "mutants.log"
TESTS = (":(glob)**/test/**", ":(glob)**/tests.cmake", "tests", "conftest.py")
REASON = re.compile(r"^E  .*|.*Falsifiable after.*|\S+:\d+: Failure\n(?:.+\n){1,4}", re.MULTILINE)
LIMIT = "900"  # [s] of a proof: the longest of today, which waits for its deadline, takes 186 s


def run(*command: str, needed: bool = True) -> subprocess.CompletedProcess:
    """In the copy; adds the output to the log. needed: a failure ends this program."""
    with open(LOG, "a", encoding="utf-8") as log:
        print("$", *command, file=log, flush=True)
        begin = log.tell()
        result = subprocess.run(command, cwd=COPY, stdout=log, stderr=subprocess.STDOUT)
    result.stdout = LOG.read_bytes()[begin:].decode(errors="replace")
    if needed and result.returncode:
        sys.exit(f"{' '.join(command)}:\n{result.stdout[-3000:]}")
    return result


def prepare(tests_of: str) -> None:
    """Updates and builds the copy. tests_of: a commit whose tests it gets."""
    COPY.mkdir(parents=True, exist_ok=True)
    if not (COPY / ".git").exists():
        run("git", "-C", str(TOP), "worktree", "add", "--force", "--detach", str(COPY))
    commit = run("git", "-C", str(TOP), "rev-parse", "HEAD").stdout.strip()
    run("git", "checkout", "--quiet", "--force", "--detach", commit)
    if tests_of:
        run("git", "restore", "--staged", "--worktree", "--source", tests_of, "--", *TESTS)
    settings = COPY / "catkin_ws" / "build" / "CMakeCache.txt"
    if not settings.exists():
        settings.parent.mkdir(parents=True)
        settings.write_text("CATKIN_ENABLE_TESTING:BOOL=ON\n", encoding="utf-8")
    run("./franka", "build")


def passes(command: list[str]) -> tuple[bool, str]:
    """Whether all cases pass, or there are none; and why. Has a ROS master without old parameters."""
    of_master = ["./franka", "shell", "rosmaster", "--core"]
    master = subprocess.Popen(of_master, cwd=COPY, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    result = run("./franka", "shell", "timeout", LIMIT, *command, needed=False)
    master.kill()
    master.wait()
    if "Running 0 tests" in result.stdout or ("pytest" in command and result.returncode not in (0, 1)):
        return True, f"ran no test, status {result.returncode}"
    reason = REASON.search(result.stdout)
    return result.returncode == 0, " ".join(reason[0].split()) if reason else f"status {result.returncode}"


def check(patch: Path, package: str, proof: str, whole: bool) -> tuple[str, str]:
    """What becomes of a mutant. whole: all cases of the proof's program or file run."""
    target, *options = proof.split()
    command = [f"catkin_ws/devel/lib/{package}/{target}", *([] if whole else options)]
    if ".py" in proof:
        changes_programs = re.search(r"^\+\+\+ .*\.(cpp|h)$", patch.read_text(encoding="utf-8"), re.MULTILINE)
        target = "all" if changes_programs else ""
        pytest = [str(TOP / ".venv/bin/python3"), "-m", "pytest", "-q", "-p", "no:cacheprovider"]
        command = [*pytest, proof.split("::")[0] if whole else proof]
    build = ["./franka", "shell", "ninja", "-C", "catkin_ws/build", target] if target else ["true"]
    run("patch", "-p1", "-i", str(patch))
    try:
        if run(*build, needed=False).returncode:
            return "does not build", ""
        missed, reason = passes(command)
    finally:
        run("patch", "-R", "-p1", "-i", str(patch))
        run(*build)
    if missed:
        return "MISSED", reason
    return ("found", reason) if passes(command)[0] else ("MISSED", "its proof fails without it, too")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("numbers", nargs="*", help="of mutants, as 07; all if none is given")
    parser.add_argument("--tests-of", default="", metavar="COMMIT", help="runs whole files of that commit")
    arguments = parser.parse_args()
    if own_network.ENTERED not in os.environ:
        prepare(arguments.tests_of)
    if reason := own_network.enter():
        sys.exit(f"No network of its own: {reason}")
    os.environ |= {"ROS_MASTER_URI": "http://localhost:11311", "ROS_HOSTNAME": "localhost"}
    os.environ |= {"CCACHE_BASEDIR": str(COPY), "CCACHE_NOHASHDIR": "1"}  # as ./franka builds
    outcomes = []
    for row in (MUTANTS / "proofs.tsv").read_text(encoding="utf-8").splitlines():
        number, package, proof = row.split("\t")
        if number in arguments.numbers or not arguments.numbers:
            begin, (patch,) = time.monotonic(), MUTANTS.glob(f"{number}_*.patch")
            outcome, why = check(patch, package, proof, bool(arguments.tests_of))
            outcomes.append(outcome)
            print(f"{number} {outcome} {time.monotonic() - begin:.0f}  {why[:200]}".rstrip(), flush=True)
    print(f"{outcomes.count('found')} of {len(outcomes)} found")
    return 0 if outcomes.count("found") == len(outcomes) > 0 else 1


if __name__ == "__main__":
    sys.exit(main())
