"""Many runs: rows of designs (``design``) and of experiments (``plan``), each a scene.

Rows are planned without compiled code. ``engine`` computes them in blocks and keeps them in a
``store`` under a hash; ``table`` and ``design_rows`` make tables of their numbers.
"""
