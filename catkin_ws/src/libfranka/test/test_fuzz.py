# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every decoder of the codec under libFuzzer, AddressSanitizer and UndefinedBehaviorSanitizer.

A hundred thousand inputs each, always the same; an hour of others each with FRANKA_TEST_LONG=1
(decision 39). Each starts with the inputs of corpus/<target>.zip. Needs clang-22 and libclang-rt-22-dev.
"""

import os
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
PACKAGE = HERE.parent
FUZZERS = HERE / "fuzz"
TARGETS = sorted(path.name.removesuffix("_fuzzer.cpp") for path in FUZZERS.glob("*_fuzzer.cpp"))
LONG = os.environ.get("FRANKA_TEST_LONG") == "1"
LENGTH = ["-max_total_time=3600"] if LONG else ["-runs=100000", "-seed=1"]
FLAGS = [
    "-std=c++17",
    "-O1",
    "-g",
    "-fsanitize=address,undefined",
    "-fno-sanitize-recover=all",
    f"-I{PACKAGE / 'include'}",
]


def run(command, **arguments):
    return subprocess.run(
        [str(word) for word in command],
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        **arguments,
    )


def compile_object(compiler, source, build):
    result = build / (source.stem + ".o")
    cache = ["ccache"] if shutil.which("ccache") else []
    done = run(
        [*cache, compiler, *FLAGS, "-fsanitize=fuzzer-no-link", "-c", source, "-o", result], timeout=300
    )
    assert done.returncode == 0, done.stdout
    return result


@pytest.fixture(scope="module")
def codec(tmp_path_factory):
    """The codec's objects and the compiler, built once for all targets."""
    compiler = shutil.which("clang++-22") or shutil.which("clang++")
    assert compiler, "No clang++-22: install the Debian packages clang-22 and libclang-rt-22-dev."
    build = tmp_path_factory.mktemp("fuzz")
    core = [PACKAGE / "src" / "core" / name for name in ("numbers.cpp", "payload.cpp")]
    sources = [*sorted((PACKAGE / "src" / "fci").glob("*.cpp")), *core]
    with ThreadPoolExecutor(2) as pool:
        objects = list(pool.map(lambda source: compile_object(compiler, source, build), sources))
    return compiler, objects, build


@pytest.mark.parametrize("target", TARGETS)
def test_decoder(codec, target):
    compiler, objects, build = codec
    program = build / f"{target}_fuzzer"
    fuzzer = compile_object(compiler, FUZZERS / f"{target}_fuzzer.cpp", build)
    built = run([compiler, *FLAGS, "-fsanitize=fuzzer", fuzzer, *objects, "-o", program], timeout=300)
    assert built.returncode == 0, built.stdout
    corpus = build / f"{target}_corpus"
    shutil.unpack_archive(FUZZERS / "corpus" / f"{target}.zip", corpus)
    inputs = len(list(corpus.iterdir()))
    fuzzed = run(
        [
            program,
            *LENGTH,
            "-timeout=60",
            "-max_len=4096",
            f"-artifact_prefix={build}/",
            corpus,
        ],
        timeout=4000,
    )
    assert fuzzed.returncode == 0, fuzzed.stdout[:1000] + fuzzed.stdout[-6000:]  # the seed, and the error
    assert "DONE" in fuzzed.stdout and inputs > 0, fuzzed.stdout[-2000:]
