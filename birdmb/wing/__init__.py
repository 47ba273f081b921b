"""The wing: joint chain, feathers, edges and the lifting line (compiled kernels)."""
