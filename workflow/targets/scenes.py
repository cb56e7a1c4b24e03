"""Scenes of a project: their checks, and the files and settings of their jobs."""

from collections.abc import Callable, Collection, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

from geometry.base import SettingsError, hashes
from simulate.scene import Scene, fault_of_blade, own_laws
from workflow.many.design import Design
from workflow.targets.blades import Blades, require_shown
from workflow.targets.inputs import OfJob, Once, Told, with_laws

SHOWN_MODE = 3  # the highest natural mode whose motion pages show


def scene_file(name: str) -> str:
    """Path of a scene's file; that of a variant need not exist."""
    return f"workflow/scenes/{name}.yaml"


class Scenes(Once[Scene]):
    """All scenes by name.

    Parameters
    ----------
    names : of all scenes
    blades : of the project
    explored : names of the scenes with a page to explore
    most_blocks : of a sweep or a design
    """

    def __init__(
        self, names: Iterable[str], blades: Blades, explored: Collection[str], most_blocks: int
    ) -> None:
        super().__init__(names, self._checked)
        self.blades, self.explored, self.most_blocks = blades, explored, most_blocks
        self.designs = dict[str, Design]()  # those read, by scene
        # Files of a scene, of jobs that need one
        self.rom_of_blade = self._file("results/{blade}/rom-{directions}.nc")
        self.basis = self._file("results/{blade}/basis-{directions}.h5")
        self.gauges = self._file("results/{blade}/{scene}/gauges.nc")
        self.stress = self._file("results/{blade}/{scene}/stress.json", self.keeps_motion)
        self.settings = self._file(  # chosen by the pilot
            "results/{blade}/{scene}/settings.json", lambda scene: scene.accuracy
        )
        self.checked = self._file(  # with an accuracy the pilot has the check
            "results/{blade}/{scene}/checked", lambda scene: not scene.accuracy
        )
        # Nothing is marched on a model that misses its tolerance; one from elsewhere is checked
        # where it is taken.
        self.check = self._file(
            "results/{blade}/rom-check-{directions}.nc",
            lambda scene: scene.blade not in blades.foreign,
        )

    def _file(
        self, pattern: str, needed: Callable[[Scene], object] = lambda scene: True
    ) -> OfJob[str | list[str]]:
        """Path of a file of a scene by its ``pattern``; none where it is not ``needed``."""

        def path(wildcards: Any) -> str | list[str]:
            scene = self[wildcards.scene]
            if not needed(scene):
                return []
            return pattern.format(
                blade=wildcards.blade, scene=wildcards.scene, directions=scene.directions
            )

        return path

    def file(self, wildcards: Any) -> str:
        """The scene's own file."""
        return scene_file(wildcards.scene)

    def rom(self, wildcards: Any) -> str:
        """The reduced model that the scene needs; with strain gauges, with what they read."""
        gauged = self[wildcards.scene].record.gauges
        return (self.gauges if gauged else self.rom_of_blade)(wildcards)

    def start(self, wildcards: Any) -> str | list[str]:
        """The sweep that the scene starts from, if any."""
        scene = self[wildcards.scene]
        return f"results/{scene.blade}/{scene.start.scene}/sweep.nc" if scene.start else []

    def mesh_error(self, wildcards: Any) -> str | list[str]:
        """Error of the mesh, for a scene with an accuracy, if a coarser mesh can be made."""
        return self.blades.mesh_error(wildcards) if self[wildcards.scene].accuracy else []

    def stress_of_page(self, wildcards: Any) -> str | list[str]:
        """The stresses for its page; without gaps at rest."""
        self._require_running(wildcards.scene, self[wildcards.scene])
        return self.stress(wildcards)

    def sweep_with_motion(self, wildcards: Any) -> str:
        """The sweep of a scene of whose motion the stresses are known."""
        if not self.keeps_motion(self[wildcards.scene]):
            raise SettingsError(
                f"{scene_file(wildcards.scene)}: without the motion of a meshed blade, of which "
                f"stresses are made: take out design, or another blade"
            )
        return f"results/{wildcards.blade}/{wildcards.scene}/sweep.nc"

    def keeps_motion(self, scene: Scene) -> bool:
        """Whether the sweep of a scene keeps the motion of which pages and stresses are made."""
        return not scene.design and scene.blade in self.blades.meshed

    def told(self, wildcards: Any) -> Told:
        """All settings of the scene.

        Its sweep keeps the motion for its stresses and a page to explore, with or without a page:
        one that is asked for later needs no second sweep.
        """
        scene = self[wildcards.scene]
        if self.keeps_motion(scene) and not scene.record.motion:
            scene = scene.but(record={"motion": SHOWN_MODE})
        return Told(scene.model_dump(mode="json"))

    def told_alone(self, wildcards: Any) -> Told:
        """Its settings without a design."""
        return Told(self[wildcards.scene].but(design=None).model_dump(mode="json"))

    def told_of_gauges(self, wildcards: Any) -> Told:
        """The strain gauges of a scene, as settings of its record."""
        record = self[wildcards.scene].record
        if not record.gauges:
            raise SettingsError(f"{scene_file(wildcards.scene)}: record.gauges: missing")
        return Told({"gauges": record.model_dump(mode="json")["gauges"]})

    def contents(self, wildcards: Any) -> Told:
        """Hashes of the files that runs of the scene read: of its design, and of its own laws."""
        scene = self[wildcards.scene]
        laws, files = dict(scene.liner.law.code_files), ()
        if scene.design:
            design = self.designs[wildcards.scene]
            files = design.files
            for law in design.laws:
                with suppress(SettingsError):  # it is refused in its row
                    laws |= own_laws.named(law).code_files
        return with_laws(hashes(files), laws)

    def blocks(self, wildcards: Any) -> range:
        """Blocks of a sweep or a design, at most one for each speed or row.

        One of speeds in turn.
        """
        scene = self[wildcards.scene]
        if scene.speeds.in_turn:
            return range(1)
        most = self.designs[wildcards.scene].count if scene.design else scene.speeds.count
        return range(min(self.most_blocks, most))

    def block_count(self, wildcards: Any) -> int:
        """Their number."""
        return len(self.blocks(wildcards))

    def of_blocks(self, pattern: str) -> OfJob[list[str]]:
        """A file of each block."""
        return lambda wildcards: [
            pattern.format(blade=wildcards.blade, scene=wildcards.scene, block=block)
            for block in self.blocks(wildcards)
        ]

    def design(self, wildcards: Any) -> Design:
        """The design of a scene."""
        if self[wildcards.scene].design is None:
            raise SettingsError(f"{scene_file(wildcards.scene)}: design: missing: it is no table")
        return self.designs[wildcards.scene]

    def table(self, wildcards: Any) -> str:
        """The CSV file of a scene's design."""
        return str(self.design(wildcards).path)

    def rows_of_block(self, wildcards: Any) -> int:
        """Number of the rows of a block of a design."""
        rows = range(self.design(wildcards).count)
        return len(rows[int(wildcards.block) :: len(self.blocks(wildcards))])

    def of_other_blades(self, name: str, without: Collection[str] = ()) -> OfJob[list[str]]:
        """A file of each blade that only some rows have, but for those ``without`` it."""

        def files(wildcards: Any) -> list[str]:
            directions = self[wildcards.scene].directions
            _, *others = self.design(wildcards).blades
            return [f"results/{of}/{name}-{directions}.nc" for of in others if of not in without]

        return files

    def of_row(
        self, of_scene: OfJob[Any], name: str, without: Collection[str] = ()
    ) -> OfJob[str | list[str]]:
        """A file of the model of a row of a design: that of its scene, or of another blade."""

        def file(wildcards: Any) -> str | list[str]:
            blade = self.design(wildcards).require_row(int(wildcards.row)).blade
            if blade == wildcards.blade:
                return of_scene(wildcards)
            path = f"results/{blade}/{name}-{self[wildcards.scene].directions}.nc"
            return [] if blade in without else path

        return file

    def _checked(self, name: str) -> Scene:
        """A scene, configured or not, that fits its blade and what is asked of it."""
        path = scene_file(name)
        scene = Scene.load(path)
        if fault := fault_of_blade(scene, self.blades.require(scene.blade, path)):
            raise SettingsError(f"{path}: {fault}")
        if scene.start:
            self._require_start(name, scene.start.scene, scene.blade)
        no_mesh = scene.blade not in self.blades.meshed
        without_mesh = {
            "explore": name in self.explored and no_mesh,
            "record.states_rounds": scene.blade in self.blades.foreign
            and scene.record.states_rounds,
            "record.gauges": scene.record.gauges and no_mesh,
        }
        for key in (key for key, refused in without_mesh.items() if refused):
            raise SettingsError(
                f"{path}: {key}: blade {scene.blade!r} is a model or matrices from elsewhere, "
                f"without the mesh that pictures of the whole blade and gauges need: take it out"
            )
        if name in self.explored:
            self._require_running(name, scene)
            if scene.design:
                raise SettingsError(
                    f"workflow/config.yaml: explore: {name!r} is a design: allowed are sweeps"
                )
        if scene.design:
            require_shown(path, "design", scene.design)
            self.designs[name] = design = Design.of(scene, Path(path))
            there = self.blades.settings
            for blade in (blade for blade in design.blades if blade not in there):
                raise SettingsError(
                    f"{design.path}: column blade: {blade!r}: no workflow/blades/{blade}.yaml; "
                    f"there are {', '.join(there)}"
                )
        return scene

    def _require_running(self, name: str, scene: Scene) -> None:
        """Refuse the page of a scene with gaps at rest."""
        if scene.gaps.vary:
            raise SettingsError(
                f"workflow/config.yaml: explore: {name!r}: its page has one gap for all speeds: "
                f"allowed are scenes with `clearance: {{at: running}}`, without a line or a table "
                f"of the shift"
            )

    def _require_start(self, name: str, before: str, blade: str) -> None:
        """Refuse a start from a scene that is not there, of another blade, or without ends."""
        fault = f"{scene_file(name)}: start.scene: {before!r}"
        if before not in self or before == name:
            raise SettingsError(f"{fault}: no other scene of workflow/scenes")
        there = self[before]
        if there.blade != blade:
            raise SettingsError(f"{fault}: its blade is {there.blade!r}, allowed {blade!r}")
        if not there.record.end:
            raise SettingsError(f"{fault}: holds no ends; set `record: {{end: true}}` there")
