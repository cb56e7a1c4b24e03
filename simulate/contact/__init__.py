"""Contact of the tip with the liner: strips, gaps, rods, their forces."""
