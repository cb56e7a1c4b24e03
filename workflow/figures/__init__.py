"""Figures: each module reads its files (``load``) and draws them (``draw``)."""
