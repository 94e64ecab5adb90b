"""The open nodes of the exact search, best first."""

from __future__ import annotations

import math

import numpy as np

from grasp_xl.search.exact_kernel import Nodes, make_nodes, put_children, take_batch
from grasp_xl.space import IntArray


class Frontier:
    """Open nodes, best first."""

    def __init__(self, elements: int) -> None:
        self._nodes = make_nodes(0, elements)
        self._order = np.zeros(0, dtype=np.int64)
        self._key = np.zeros(0)
        self._age = np.zeros(0, dtype=np.int64)
        self._size = 0
        self._born = 0

    def __len__(self) -> int:
        return self._size

    @property
    def bound(self) -> float:
        """Least bound, infinity where no node is open."""
        return float(self._nodes.bound[self._order[: self._size]].min(initial=math.inf))

    @property
    def key(self) -> float:
        """Key of the node that comes first, infinity where none is open."""
        return float(self._key[self._order[0]]) if self._size else math.inf

    def take(self, batch: Nodes, below: float) -> int:
        """Move the first nodes below a bound into a batch; return how many."""
        taken, self._size = take_batch(
            self._nodes, self._order, self._key, self._age, self._size, batch, below
        )
        return taken

    def put(self, children: Nodes, born: IntArray, below: float) -> None:
        """Take in all children with a bound below a limit."""
        self._make_room(int(born.sum()))
        size = put_children(
            *(self._nodes, self._order, self._key, self._age, self._size, self._born),
            *(children, born, below),
        )
        self._born += size - self._size
        self._size = size

    def _make_room(self, more: int) -> None:
        capacity = len(self._order)
        if self._size + more <= capacity:
            return
        new = max(1024, capacity, more)
        old = self._nodes
        self._nodes = make_nodes(capacity + new, old.boxes.shape[1])
        for kept, field in zip(self._nodes, old, strict=True):
            kept[:capacity] = field
        self._key = np.concatenate([self._key, np.zeros(new)])
        self._age = np.concatenate([self._age, np.zeros(new, dtype=np.int64)])
        self._order = np.concatenate([self._order, np.arange(capacity, capacity + new)])
