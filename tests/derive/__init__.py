"""The symbolic half: from g(x) to a proven sheet; the folders are those of derive/."""
