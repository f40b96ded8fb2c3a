"""Long computations: what Ctrl-C leaves, and that going on ends in the same bytes."""

from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner

import scans as synthetic
import sunpeak as sp
from conftest import CommandLine
from sunpeak.cli.app import app

Make = Callable[[Path, sp.Run], None]


def converted(path: Path, run: sp.Run) -> None:
    """An isotropic tree in cells that are not: block by block."""
    source = path.with_name("fabric.xml")
    sp.Fabric().write(source, "t3-64")
    sp.Bsdf.load(source).convert("t4-64", run=run).save(path)


def system(path: Path, run: sp.Run) -> None:
    """A pane and a fabric, two bands after each other."""
    source = path.with_name("fabric.xml")
    blind = sp.RollerBlind(0.03, 0.1, 0.4, 0.4)
    blind.write(source, "klems-quarter", solar=blind)
    pane = sp.Pane.from_values((0.8, 0.1, 0.1), (0.7, 0.1, 0.1))
    sp.System([pane, sp.Shade.load(source)]).write(path, "klems-quarter", run=run)


def measured(path: Path, run: sp.Run) -> None:
    """Two modes of an isotropic sample, after each other."""
    matt = synthetic.formula(sp.Formula("phong", diffuse=0.2, specular=0.3, exponent=20))
    given = [
        *synthetic.scans(matt, (0.0, 40.0), reflection=True, step_deg=10.0),
        *synthetic.scans(synthetic.fabric_scatters, (0.0, 40.0), reflection=False, step_deg=10.0),
    ]
    sp.measured_bsdf(given, "klems-quarter", run=run).save(path)


MAKERS: dict[str, Make] = {
    "convert": converted,
    "system": system,
    "measured": measured,
    "formula": lambda path, run: sp.Formula("phong").tabulate("klems-quarter", run=run).save(path),
    "fabric": lambda path, run: sp.Fabric().write(path, "klems-quarter", run=run),
    "datasheet": lambda path, run: sp.RollerBlind(0.03, 0.1, 0.4, 0.4).write(path, "klems-quarter", run=run),
    "blind": lambda path, run: sp.Blind().write(path, "klems-quarter", run=run),
    "sheet": lambda path, run: sp.Perforated(2.0, 4.0, 1.0).write(path, "klems-quarter", run=run),
}


def interrupt(done: int, total: int) -> None:
    """Ctrl-C once something is finished; it is told at the end at the latest."""
    if done:
        raise KeyboardInterrupt


@pytest.mark.parametrize("name", MAKERS)
def test_ctrl_c_keeps_what_is_finished(name: str, tmp_path: Path) -> None:
    make = MAKERS[name]
    whole, path, state = (tmp_path / part for part in ("whole.xml", "out.xml", "out.xml.columns"))
    make(whole, sp.Run())
    with pytest.raises(KeyboardInterrupt), sp.Run(progress=interrupt, state=state) as run:
        make(path, run)
    assert state.exists()
    assert not path.exists()
    with (
        pytest.raises(sp.InputError, match="other options"),
        sp.Run(state=state, resume=True) as run,
    ):
        sp.Formula("phong", exponent=7).tabulate("klems-quarter", run=run)
    assert state.exists()
    with sp.Run(state=state, resume=True) as run:
        make(path, run)
    assert path.read_bytes() == whole.read_bytes()
    assert not state.exists()
    assert not list(tmp_path.glob(".*"))


@pytest.mark.parametrize(
    "command", ["convert", "formula", "fabric", "blind", "perforated", "mesh", "system", "generate", "measured"]
)
def test_commands_that_take_long_go_on(command: str) -> None:
    said = CliRunner().invoke(app, ["bsdf", command, "--help"], env={"COLUMNS": "120"})
    assert said.exit_code == 0, said.exception
    assert "--resume" in said.output


def test_without_a_state_there_is_nothing_to_go_on_with(sunpeak: CommandLine, tmp_path: Path) -> None:
    path = tmp_path / "a.xml"
    said = sunpeak("bsdf", "formula", "lambert", "-o", path, "--resume", expect=1)
    assert "a.xml.columns" in said.err
    assert not path.exists()
    path.with_name("a.xml.columns").write_bytes(b"something else")
    assert "start again without --resume" in sunpeak("bsdf", "formula", "lambert", "-o", path, "--resume", expect=1).err
    with pytest.raises(sp.InputError, match="without state"):
        sp.Run(resume=True)
