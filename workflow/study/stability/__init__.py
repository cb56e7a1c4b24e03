"""The study of stability: cases at the extremes, and the map over step and stiffness."""
