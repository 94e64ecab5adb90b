"""Threads of the exact search: what comes of a node depends on the node alone."""

from __future__ import annotations

import os
import threading
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import Self

import numpy as np

from grasp_xl.search.exact_kernel import expand, make_nodes
from grasp_xl.search.exact_leaf import ENTRIES
from grasp_xl.search.exact_model import Model
from grasp_xl.search.exact_prices import Room, make_room
from grasp_xl.search.exchange import STREAMS, Exchange
from grasp_xl.search.stop import Stop

BATCH = 64
"""Nodes that are expanded at once; the same on every machine, so that results are."""

PART = 4
"""Nodes that a worker takes at a time."""

POLL_SECONDS = 0.05
"""How often somebody's wish to stop is looked for while nodes are expanded."""


class Workers:
    """Threads that expand a batch of nodes.

    Parameters
    ----------
    model : Model
    elements : int
        Most elements of a grasp.
    top : int
        Grasps that a node may give.
    """

    def __init__(self, model: Model, elements: int, top: int) -> None:
        self._model = model
        places = len(model.locations.xyz)
        cores = os.cpu_count() or 1
        self.halt = np.zeros(1, dtype=np.int64)
        self.rooms = [make_room(places, elements, ENTRIES) for _ in range(cores)]
        self.batch = make_nodes(BATCH, elements)
        self.children = make_nodes((BATCH, elements + 1), elements)
        self.born = np.zeros(BATCH, dtype=np.int64)
        self.found = np.zeros((BATCH, top))
        self.genes = np.zeros((BATCH, top, elements, 2), dtype=np.int64)
        self._threads = ThreadPoolExecutor(cores)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._threads.shutdown()

    def expand(self, taken: int, upper: float, slack: float, asked_to_stop: Stop) -> None:
        """Expand the first nodes of the batch; those not done when asked to stop stay as they are.

        An error in a thread is raised here: it voids the proof.
        """
        parts = _Shared(range(0, taken, PART))

        def work(room: Room) -> None:
            for first in parts:
                expand(
                    *self._model,
                    self.batch,
                    first,
                    min(first + PART, taken),
                    upper,
                    slack,
                    self.children,
                    self.born,
                    self.found,
                    self.genes,
                    room,
                    self.halt,
                )

        self._wait([self._threads.submit(work, room) for room in self.rooms], asked_to_stop)

    def exchange(self, exchange: Exchange, judged: int, asked_to_stop: Stop) -> None:
        """Let all streams of an exchange go on."""
        streams = range(STREAMS)
        running = [
            self._threads.submit(exchange.search, stream, judged, self.halt) for stream in streams
        ]
        self._wait(running, asked_to_stop)

    def _wait(self, running: Sequence[Future[None]], asked_to_stop: Stop) -> None:
        while wait(running, POLL_SECONDS).not_done:
            self.halt[0] = self.halt[0] or asked_to_stop()
        for thread in running:
            thread.result()


class _Shared:
    """An iterator that threads share: each value goes to one of them."""

    def __init__(self, values: Iterable[int]) -> None:
        self._values = iter(values)
        self._lock = threading.Lock()

    def __iter__(self) -> Iterator[int]:
        return self

    def __next__(self) -> int:
        with self._lock:
            return next(self._values)
