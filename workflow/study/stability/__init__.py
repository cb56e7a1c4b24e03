"""Study of stability: cases with extreme parameters, and a map over step and stiffness."""
