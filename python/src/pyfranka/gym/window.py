# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The window of an environment with render_mode="human"."""

from __future__ import annotations

from typing import Any

import numpy
from numpy.typing import NDArray

__all__ = ["Window"]


class Window:
    """Shows pictures one after the other, not faster than at a rate. Needs pygame, as the windows of
    Gymnasium's own environments do. Called by one thread."""

    def __init__(self, title: str, size: tuple[int, int], rate: float):
        """title: of the window. size: width and height [pixel]. rate: of pictures [Hz]. Raises ImportError
        without pygame."""
        try:
            import pygame
        except ImportError:
            raise ImportError(
                'The window of render_mode="human" needs pygame: pip install pygame. "rgb_array" needs none.'
            ) from None
        self._pygame, self._rate = pygame, rate
        self._title, self._size = title, size
        self._surface: Any = None

    def show(self, picture: NDArray[numpy.uint8]) -> None:
        """Shows a picture, height x width x 3. The first one opens the window."""
        pygame = self._pygame
        if self._surface is None:
            pygame.display.init()
            pygame.display.set_caption(self._title)
            self._surface = pygame.display.set_mode(self._size)
            self._clock = pygame.time.Clock()
        pygame.event.pump()
        self._surface.blit(pygame.surfarray.make_surface(picture.swapaxes(0, 1)), (0, 0))
        pygame.display.flip()
        self._clock.tick(self._rate)

    def close(self) -> None:
        """Closes the window."""
        if self._surface is not None:
            self._pygame.display.quit()
            self._surface = None
