"""All that draws.

Nothing that computes imports it: results draw themselves by a call that their `plot` imports when
it is called. A function `plot_...` returns a `matplotlib.figure.Figure`, which `savefig` writes to
a file, a notebook shows as a cell's last line, and `pyplot.show` shows where pyplot was imported
and has a screen. Within `paper(width="90mm")` figures fit a paper's column. A function `draw_...`
draws into axes that it is given.
"""

import lazy_loader

# The names are listed in __init__.pyi and imported at their first use: the picture of an orbit
# must not wait for all that draws birds.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
