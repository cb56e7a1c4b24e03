"""The office of the project: files, settings, provenance, errors, progress."""

from geometry.project.checked import (
    checked as checked,
)
from geometry.project.errors import (
    Caution as Caution,
)
from geometry.project.errors import (
    Fault as Fault,
)
from geometry.project.errors import (
    MeshError as MeshError,
)
from geometry.project.errors import (
    MeshWarning as MeshWarning,
)
from geometry.project.errors import (
    SettingsError as SettingsError,
)
from geometry.project.errors import (
    UserError as UserError,
)
from geometry.project.errors import (
    WriteError as WriteError,
)
from geometry.project.errors import (
    about as about,
)
from geometry.project.errors import (
    shown as shown,
)
from geometry.project.files import (
    read_json as read_json,
)
from geometry.project.files import (
    require_writable as require_writable,
)
from geometry.project.files import (
    whole as whole,
)
from geometry.project.files import (
    write_json as write_json,
)
from geometry.project.files import (
    write_or_keep as write_or_keep,
)
from geometry.project.files import (
    write_whole as write_whole,
)
from geometry.project.progress import (
    WARNING as WARNING,
)
from geometry.project.progress import (
    Say as Say,
)
from geometry.project.progress import (
    bar as bar,
)
from geometry.project.progress import (
    counted as counted,
)
from geometry.project.progress import (
    duration as duration,
)
from geometry.project.progress import (
    left as left,
)
from geometry.project.progress import (
    silent as silent,
)
from geometry.project.provenance import (
    ROOT as ROOT,
)
from geometry.project.provenance import (
    Provenance as Provenance,
)
from geometry.project.provenance import (
    ProvenanceError as ProvenanceError,
)
from geometry.project.provenance import (
    anew as anew,
)
from geometry.project.provenance import (
    code_hash as code_hash,
)
from geometry.project.provenance import (
    file_hash as file_hash,
)
from geometry.project.provenance import (
    fingerprint as fingerprint,
)
from geometry.project.seal import (
    AROUND as AROUND,
)
from geometry.project.seal import (
    intact as intact,
)
from geometry.project.seal import (
    seal as seal,
)
from geometry.project.seal import (
    sealed as sealed,
)
from geometry.project.settings import (
    Settings as Settings,
)
from geometry.project.settings import (
    SettingsFile as SettingsFile,
)
from geometry.project.settings import (
    check_settings as check_settings,
)
from geometry.project.settings import (
    one_of as one_of,
)
from geometry.project.settings import (
    read_settings as read_settings,
)
from geometry.project.sources import (
    sources_of as sources_of,
)
from geometry.project.strict_yaml import (
    MOST_CHARACTERS as MOST_CHARACTERS,
)
from geometry.project.strict_yaml import (
    MOST_VALUES as MOST_VALUES,
)
from geometry.project.strict_yaml import (
    parse as parse,
)
from geometry.project.text_file import (
    csv_rows as csv_rows,
)
from geometry.project.text_file import (
    csv_text as csv_text,
)
from geometry.project.text_file import (
    number as number,
)
from geometry.project.text_file import (
    read_text as read_text,
)
from geometry.project.version import (
    require_format as require_format,
)
from geometry.project.version import (
    version as version,
)
from geometry.project.yaml_file import (
    A_NAME as A_NAME,
)
from geometry.project.yaml_file import (
    MOST_BASES as MOST_BASES,
)
from geometry.project.yaml_file import (
    NAME as NAME,
)
from geometry.project.yaml_file import (
    merged as merged,
)
from geometry.project.yaml_file import (
    names as names,
)
from geometry.project.yaml_file import (
    read_mapping as read_mapping,
)
