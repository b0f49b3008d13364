"""What generated modules need besides NumPy; copied beside them, never imported from here."""
