"""What the pictures hold: labels, and the values that the functions give."""
