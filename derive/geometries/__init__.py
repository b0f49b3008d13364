"""The library: one body a file, nothing but g(x)."""
