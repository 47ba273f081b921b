"""The wing: joint chain, skeleton, feathers, edges and the lifting line (compiled kernels)."""
