"""Blade geometry: a second-order tetrahedral mesh from parameters, section table, CAD or mesh.

Frame, everywhere in Tiprub: attached to the blade, z the engine axis (downstream), x the radial
line through the section centroids, y tangential; theta is measured about z from x towards y, in the
sense of rotation. The leading edge is upstream (smaller z) and ahead in rotation (larger y).
"""
