"""Identification of parameters that the paper leaves open, from the critical speeds it gives."""
