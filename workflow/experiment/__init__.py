"""Experiments: scenes with some values changed, what their runs show, and its picture.

Rows are planned without compiled code (``plan``) and marched in blocks (``engine``).
"""
