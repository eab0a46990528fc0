# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.sweep on clusters of Dask over SSH, and by the scripts of a job queue. Long form."""

import getpass
import os
import shutil
import socket
import subprocess
import sys
from contextlib import contextmanager, suppress

import cloudpickle
import numpy
import pyfranka
import pytest
from pyfranka.sim import KINDS, Simulation
from waiting import wait_for

cloudpickle.register_pickle_by_value(sys.modules[__name__])  # workers cannot import the tests
SSHD = shutil.which("sshd", path=f"{os.environ['PATH']}:/usr/sbin")
STARTS = 60.0  # [s]
pytestmark = pytest.mark.long_form("starts clusters")
# What a worker needs of this process's environment: a login gives its own.
PASSED_ON = ("PATH", "PYTHONPATH", "LD_LIBRARY_PATH", "ROS_PACKAGE_PATH", "CMAKE_PREFIX_PATH")


def motion(case, seed):
    """The robot's hash of a short motion at random stiffness, and where it ran."""
    robots = [KINDS[case](base=(-0.5, 0, 0), realism="recorded")]
    with Simulation("stone.xml", robots, seed=seed % 1000) as sim:
        robot = sim[case]
        robot.joint_impedance(robot.state.q + 0.1, 0.2, numpy.random.default_rng(seed).uniform(100, 300, 7))
        sim.step(500)
        return {"hash": f"{robot.state_hash():016x}", "process": os.getpid()}


def check(cluster):
    """A sweep there gives what each case gives here, once and in order, in other processes."""
    cluster.wait_for_workers(2, timeout=STARTS)
    cases = ["panda", "fr3"] * 6
    done = pyfranka.sweep(motion, cases, cluster)
    assert not done.failed, done.failed[0].error
    assert [outcome.index for outcome in done] == list(range(len(cases)))
    for outcome in done:
        assert outcome.result["hash"] == motion(outcome.case, outcome.seed)["hash"]
    processes = {outcome.result["process"] for outcome in done}
    assert len(processes) == 2 and os.getpid() not in processes


def free_port():
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        return listening.getsockname()[1]


@contextmanager
def ssh_server(folder):
    """An sshd of its own on this machine: its port, and the key that it accepts."""
    for name in ("host", "client"):
        subprocess.run(["ssh-keygen", "-q", "-t", "ed25519", "-N", "", "-f", folder / name], check=True)
    shutil.copy(folder / "client.pub", folder / "authorized")
    passed_on = " ".join(f'"{name}={os.environ[name]}"' for name in PASSED_ON if name in os.environ)
    port, configuration = free_port(), folder / "sshd_config"
    configuration.write_text(
        f"Port {port}\nListenAddress 127.0.0.1\nHostKey {folder / 'host'}\nPidFile none\nUsePAM no\n"
        f"AuthorizedKeysFile {folder / 'authorized'}\nStrictModes no\nPermitRootLogin prohibit-password\n"
        f"PasswordAuthentication no\nSetEnv {passed_on}\n"
    )
    if os.geteuid() == 0:  # another user's sshd lets that user log in, and needs no folder
        os.makedirs("/run/sshd", exist_ok=True)  # its package makes it at the start of the system
    with (folder / "log").open("w") as log:
        server = subprocess.Popen([SSHD, "-D", "-e", "-f", configuration], stderr=log)

        def accepts():
            assert server.poll() is None, (folder / "log").read_text()
            with suppress(OSError):
                socket.create_connection(("127.0.0.1", port), timeout=STARTS).close()
                return True

        try:
            wait_for(accepts, "The server", STARTS)
            yield port, folder / "client"
        finally:
            server.terminate()
            server.wait(STARTS)


def test_over_ssh(tmp_path):
    pytest.importorskip("asyncssh", reason="asyncssh is not installed")
    if SSHD is None:
        pytest.skip("openssh-server is not installed")
    from distributed import SSHCluster

    with ssh_server(tmp_path) as (port, key):
        connect = {"port": port, "client_keys": [str(key)], "known_hosts": None}
        connect["username"] = getpass.getuser()
        with SSHCluster(
            ["127.0.0.1"] * 3,  # the scheduler's, and two workers'
            connect_options=connect,
            worker_options={"nthreads": 1},
            scheduler_options={"port": 0, "dashboard": False},
            remote_python=sys.executable,
        ) as cluster:
            check(cluster)


def test_by_the_scripts_of_a_job_queue(tmp_path):
    """dask-jobqueue's LocalCluster: what SLURM and the like are given, started as a program here."""
    jobqueue = pytest.importorskip("dask_jobqueue.local", reason="dask-jobqueue is not installed")
    with jobqueue.LocalCluster(
        cores=1,
        processes=1,
        memory="2 GiB",
        python=sys.executable,
        local_directory=str(tmp_path),
        log_directory=str(tmp_path),
        scheduler_options={"host": "127.0.0.1", "dashboard": False, "dashboard_address": "127.0.0.1:0"},
    ) as cluster:
        assert "distributed.cli.dask_worker tcp://127.0.0.1:" in cluster.job_script(), cluster.job_script()
        cluster.scale(2)
        check(cluster)
