"""Uncertainty of numbers: observables of a run, and its second runs."""
