"""The plan of a sweep, made for its cost."""

from typing import Any

from snakemake.cli import main

from geometry.project import UserError


def plan(files: Any, blocks: int) -> dict[str, int]:
    """Plan a sweep in as many blocks, as `snakemake -n` does; the log of the job has its cost.

    Raises
    ------
    UserError
        When it cannot be planned.
    """
    asked = ["--config", "scenes=[scale-blocks]", f"blocks={blocks}", "--", "sweeps"]
    try:
        main(["-n", "--quiet", "all", *asked])
    except SystemExit as ended:
        if ended.code:
            raise UserError(f"a sweep of {blocks} blocks cannot be planned: see the log") from None
    return {"blocks": blocks}
