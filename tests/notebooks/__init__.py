"""The notebooks, run afresh."""
