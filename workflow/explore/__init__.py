"""The page to explore a sweep: one HTML file that needs no network."""
