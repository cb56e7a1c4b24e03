"""Experiments: scenes with some values changed, their results and picture.

Rows are planned without compiled code (``plan``) and computed in blocks (``engine``).
"""
