"""Figures of the paper, under its numbers."""
