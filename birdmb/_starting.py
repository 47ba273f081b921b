"""What who ends this process must not find half done: that it starts others."""

from __future__ import annotations

import threading

starting_processes = threading.RLock()
"""Held while processes, or what they share, come into being; by who ends this one, for ever."""
