# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A client in a torque motion that judges its states: steady_client.py ADDRESS VERSION.

Prints a line when it moves, and ends its motion when its standard input is closed. Its last line is JSON: how
many states have come, the largest step of their numbers [ms], and the longest time between two [s].
"""

import json
import select
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from fci_session import go_first
from fci_wire import EXTERNAL, IDLE, MOVE, NO_GENERATOR, Client, command

WARM_UP = 200  # states before the judgement begins


def main(address: str, version: int) -> None:
    go_first()
    with Client(address, version) as client:
        assert client.connect() == (0, version)
        if client.newest_state().mode != IDLE:
            client.recover()
        state = client.start(EXTERNAL, NO_GENERATOR)
        states = step = 0
        longest, last = 0.0, time.monotonic()
        ends = False
        while state.mode == MOVE:
            if states % 100 == 0:
                ends = bool(select.select([sys.stdin], [], [], 0)[0])
            client.send(command(version, state.message_id, finished=ends))
            before, state = state.message_id, client.state()
            now = time.monotonic()
            states += 1
            if states == WARM_UP:
                print("moves", flush=True)
            elif states > WARM_UP and not ends:
                step = max(step, state.message_id - before)
                longest = max(longest, now - last)
            last = now
        status = client.reply()[1][0]
        seen = {"states": states, "step": step, "longest_gap": longest, "status": status}
        print(json.dumps(seen), flush=True)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
