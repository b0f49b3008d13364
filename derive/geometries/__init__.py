"""The library: each file defines one body by its profile g(x)."""
