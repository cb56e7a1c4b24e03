"""Figures: each module has a ``draw``; ``jobs.figure`` reads the files that it takes."""
