"""The proof: right formulas hold, and no broken one does."""
