"""The office of the project: files, settings, provenance, errors, progress."""

from geometry.project.contents import file_hash, hashes, unchanged
from geometry.project.errors import (
    Caution,
    Fault,
    MeshError,
    MeshWarning,
    SettingsError,
    UserError,
    WriteError,
    about,
    command,
    printable,
    shown,
)
from geometry.project.files import (
    AROUND,
    intact,
    legible,
    read_json,
    require_writable,
    seal,
    sealed,
    whole,
    write_json,
    write_or_keep,
    write_whole,
)
from geometry.project.progress import WARNING, Say, bar, counted, duration, remaining, silent
from geometry.project.provenance import (
    ROOT,
    Provenance,
    ProvenanceError,
    anew,
    code_hash,
    fingerprint,
    require_format,
    version,
)
from geometry.project.settings import (
    Settings,
    SettingsFile,
    check_settings,
    checked,
    known,
    one_of,
)
from geometry.project.sources import imported_by, sources_of
from geometry.project.strict_yaml import MOST_CHARACTERS, MOST_VALUES, parse
from geometry.project.text_file import csv_rows, csv_text, number, numbers, read_text, require_file
from geometry.project.yaml_file import A_NAME, MOST_BASES, NAME, merged, names, read_mapping
