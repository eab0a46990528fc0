# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The body of a request."""

from __future__ import annotations

import asyncio

from aiohttp import web

from pyfranka.desk.errors import DeskError, bad_request
from pyfranka.desk.settings import Limits


async def read_body(request: web.Request, limits: Limits) -> bytes:
    """The bytes of the body. Raises DeskError: 408 if it comes too slowly, 413 if it is too long, 400 if it
    cannot be read."""
    try:
        async with asyncio.timeout(limits.body_time):
            return await request.read()
    except TimeoutError:
        raise DeskError(408, "RequestTimeout", "The body has not come in time.") from None
    except web.HTTPRequestEntityTooLarge:
        raise DeskError(413, "TooLarge", f"The body has more than {limits.body} bytes.") from None
    except (web.HTTPException, ConnectionError):
        raise
    except Exception:
        raise bad_request("The body could not be read.") from None
