"""What the rods under the tip do: strips, gaps, rods, their forces."""
