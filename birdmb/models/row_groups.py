"""Rows of a table that are alike, so that work for one of them serves all."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from birdmb._kernels import kernel
from birdmb._typing import FloatArray, IntArray


class Groups(NamedTuple):
    """Rows that are alike."""

    of: IntArray  # (K,) group of each row
    first: IntArray  # (G,) first row of each group
    members: IntArray  # (K,) rows, group by group
    start: IntArray  # (G + 1,) where the groups begin in `members`


@kernel
def groups_of(keys: IntArray, values: FloatArray) -> Groups:
    """Groups of rows with the same key (K,), from 0 on, and exactly the same values (K, m)."""
    count = keys.size
    of, first = np.empty(count, np.int64), np.empty(count, np.int64)
    latest = np.full(keys.max() + 1, -1)  # group with a key, and the one before it
    before = np.empty(count, np.int64)
    found = 0
    for k in range(count):
        g = latest[keys[k]]
        while g >= 0 and not _same(values[first[g]], values[k]):
            g = before[g]
        if g < 0:
            g = found
            first[g], before[g], latest[keys[k]] = k, latest[keys[k]], g
            found += 1
        of[k] = g
    start = np.zeros(found + 1, np.int64)
    for k in range(count):
        start[of[k] + 1] += 1
    start = np.cumsum(start)
    place, members = start[:-1].copy(), np.empty(count, np.int64)
    for k in range(count):
        members[place[of[k]]] = k
        place[of[k]] += 1
    return Groups(of, first[:found].copy(), members, start)


@kernel
def _same(a: FloatArray, b: FloatArray) -> bool:
    same = True
    for i in range(a.size):
        same = same and a[i] == b[i]
    return same
