"""The office of the project: files, settings, provenance, errors, progress."""

from geometry.base.contents import file_hash, hashes, unchanged
from geometry.base.errors import (
    Caution,
    Check,
    Fault,
    MeshError,
    MeshWarning,
    SettingsError,
    UserError,
    WriteError,
    about,
    command,
    failed,
    printable,
    refuse,
    require,
    shown,
)
from geometry.base.files import (
    AROUND,
    UNREADABLE,
    alone,
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
from geometry.base.progress import (
    WARNING,
    Say,
    bar,
    counted,
    duration,
    memory_of_machine,
    remaining,
    silent,
)
from geometry.base.provenance import (
    ROOT,
    Provenance,
    ProvenanceError,
    anew,
    code_hash,
    fingerprint,
    parsed_json,
    require_format,
    version,
)
from geometry.base.settings import (
    Settings,
    SettingsFile,
    check_settings,
    checked,
    known,
    one_of,
)
from geometry.base.sources import imported_by, sources_of
from geometry.base.strict_yaml import MOST_CHARACTERS, MOST_VALUES, parse
from geometry.base.text_file import (
    csv_rows,
    csv_text,
    number,
    numbers,
    read_text,
    require_file,
    unquoted,
)
from geometry.base.units import FORMER, RPM, converted, in_rpm, shifted
from geometry.base.yaml_file import A_NAME, MOST_BASES, NAME, merged, names, read_mapping
