"""Moving pictures of flights: a page of HTML, MP4, GIF, and files for ParaView.

`birdmb.animation.scene` computes what there is to see, in world axes; the others show it.
"""
