"""The thesis that this program implements, chapter by chapter; nothing but the command line
imports it.

G. Ducci, *Stability of Flapping Flight Dynamics of Large Birds*, PhD thesis, UCLouvain, 2022.
`cases` are its printed numbers with how to compute them, `figures` its numbered figures and tables;
`python -m birdmb.reproduction` draws the latter and `birdmb validate` compares the former.
"""

from __future__ import annotations
