# What all rules share: the project, and messages in which users find their own files.
import logging
import re
import sys
import warnings
from functools import partial
from pathlib import Path

from snakemake.exceptions import WorkflowError

from geometry.base import WARNING, SettingsError, memory_of_machine
from geometry.blade import SOURCES
from workflow.at_work import ANOTHER, hold
from workflow.figures import table
from workflow.targets import paper
from workflow.targets.experiments import Experiments
from workflow.targets.inputs import code_of, one_of, own_files
from workflow.targets.messages import (
    Stop,
    closing_words,
    in_one_line,
    without_sources,
    without_traceback,
)
from workflow.targets.project import Project, pictures
from workflow.targets.told import told

LONGEST = 1  # priority of the jobs that others wait for most: figures take the cores that are left

for of_messages in (without_sources, without_traceback, Stop()):
    logging.getLogger("snakemake.logging").addFilter(of_messages)

warnings.showwarning = partial(in_one_line, shown=workflow.is_main_process)
# Not by `configfile:`, which takes the last of equal keys. `config`: what --config gives.
try:
    project = Project.read(config)
    FIGURES = project.figures
except SettingsError as error:
    raise WorkflowError(str(error)) from None
# Jobs beside one another on this machine do not need more than it has, or --resources mem_mb=... allows.
if workflow.resource_settings.nodes is None and "mem_mb" not in workflow.global_resources:
    workflow.register_resource("mem_mb", int(memory_of_machine() / 1e6))
blades, scenes = project.blades, project.scenes
experiments = Experiments(blades, scenes.most_blocks)


wildcard_constraints:
    blade=one_of(blades.settings),
    scene=one_of(scenes),
    block=r"\d+",
    row=r"\d+",
    directions="r|rt|rtz",
    experiment=r"[^/]+",
