"""The coatings that the paper compares, in its numbers: E and K, as of Table 1."""

# Table 1, of ``workflow/experiments/grid.yaml``
E = (1.0, 1.82, 4.55, 10.0, 13.64, 18.18, 45.45, 100.0, 181.82)
K = (0.45, 0.91, 4.55, 9.09, 45.45)
WORST = (10.0, 4.55)  # the paper's worst case
K_OF_E1 = 4.55  # of the coating with E = 1 in Figs. 10 to 12
