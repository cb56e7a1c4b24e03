# What all rules share: the project, and messages in which users find their own files.
import logging
import re
import sys
from pathlib import Path

from snakemake.exceptions import WorkflowError

from geometry.base import WARNING, SettingsError
from geometry.blade import SOURCES
from workflow.at_work import ANOTHER, hold
from workflow.figures import table
from workflow.many.table import last_words as table_words
from workflow.summary import last_words
from workflow.targets import paper
from workflow.targets.experiments import Experiments
from workflow.targets.inputs import code_of, one_of, own_files
from workflow.targets.project import SUMMARY, Project, pictures


def without_sources(record):
    """Leave the modules that a job imports out of a message: errors then name the files of users."""
    if isinstance(getattr(record, "input", None), list):
        record.input = [file for file in record.input if not file.endswith(".py")]
    return True


def without_traceback(record):
    """Of what is refused of files or requests of users, leave the sentences alone."""
    text = str(record.msg)
    if re.match(r"WorkflowError in file|InputFunctionException[\s\S]*?\n +SettingsError:", text):
        around = r"^[\s\S]*?(Workflow|Settings)Error.*\n *|\nWildcards:[\s\S]*|\n +File \"[\s\S]*"
        record.msg = re.sub(around, "", text)
    return True


for of_messages in (without_sources, without_traceback):
    logging.getLogger("snakemake.logging").addFilter(of_messages)

# Not by `configfile:`, which takes the last of equal keys. `config`: what --config gives.
try:
    project = Project.read(config)
    FIGURES = project.figures
except SettingsError as error:
    raise WorkflowError(str(error)) from None
blades, scenes = project.blades, project.scenes
experiments = Experiments(blades, scenes.most_blocks)


wildcard_constraints:
    blade=one_of(blades.settings),
    scene=one_of(scenes),
    block=r"\d+",
    row=r"\d+",
    directions="r|rt|rtz",
