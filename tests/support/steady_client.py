# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A client in a torque motion: steady_client.py ADDRESS VERSION.

Prints a line when it moves, and ends its motion when its standard input is closed. Its last line is JSON: how
many states have come, the largest step of their numbers, and the status of the motion.
"""

import json
import select
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from fci_wire import EXTERNAL, IDLE, MOVE, NO_GENERATOR, Client, command

WARM_UP = 200  # states before it prints


def main(address: str, version: int) -> None:
    with Client(address, version) as client:
        assert client.connect() == (0, version)
        if client.newest_state().mode != IDLE:
            client.recover()
        state = client.start(EXTERNAL, NO_GENERATOR)
        states = step = 0
        ends = False
        while state.mode == MOVE:
            if states % 100 == 0:
                ends = bool(select.select([sys.stdin], [], [], 0)[0])
            client.send(command(version, state.message_id, finished=ends))
            before, state = state.message_id, client.state()
            states += 1
            if states == WARM_UP:
                print("moves", flush=True)
            elif states > WARM_UP and not ends:
                step = max(step, state.message_id - before)
        status = client.reply()[1][0]
        print(json.dumps({"states": states, "step": step, "status": status}), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
