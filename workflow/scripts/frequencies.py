"""Mesh -> first frequencies at rest, half and full speed, with either prestress."""

import numpy as np
from adapter import stage

from fem.assemble import STATES, assemble
from geometry.blade import Blade
from geometry.files import write_json
from geometry.settings import read_settings
from rom.modes import ShiftInvert

MODES = 8

with stage(snakemake):
    blade = read_settings(Blade, snakemake.params.blade)
    speeds = np.linspace(0, blade.max_speed_rad_s, 3)
    found = {"speeds_rad_s": speeds.tolist()}
    for prestress in STATES:
        variant = blade.changed(prestress=prestress)
        fom = assemble(variant, snakemake.wildcards.blade, snakemake.input.mesh, speeds)
        omega = [ShiftInvert(K, fom.M).modes(MODES).omega for K in fom.K]
        found[f"{prestress}_rad_s"] = [row.tolist() for row in omega]
    write_json(found, snakemake.output.json)
