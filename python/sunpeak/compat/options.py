"""Command lines in Radiance's manner.

Options are looked up in tables of how many values each takes. A switch may end in `+` or `-` (or a letter that means
the same); without one it is turned around. `@file` and `$NAME` stand for the words of a file or of an environment
variable.
"""

import os
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from sunpeak._core import InputError

ON = "+1tTyY"
OFF = "-0fFnN"
MAX_EXPANSIONS = 1000
"""More files and variables than a command line has; they name themselves."""

VIEW_VALUES = {
    "-vp": 3, "-vd": 3, "-vu": 3, "-vh": 1, "-vv": 1, "-vo": 1, "-va": 1, "-vs": 1, "-vl": 1, "-vf": 1,
}  # fmt: skip
"""Values of view options; `-vt?` has none."""


def expand_arguments(arguments: Iterable[str]) -> list[str]:
    """Put the words of files and variables in the place of `@file` and `$NAME`."""
    waiting, words = list(arguments)[::-1], []
    expansions = 0
    while waiting:
        word = waiting.pop()
        if word[:1] not in ("@", "$") or len(word) == 1:
            words.append(word)
            continue
        expansions += 1
        if expansions > MAX_EXPANSIONS:
            raise InputError(f"{word}: names itself, directly or through others")
        waiting.extend(words_behind(word)[::-1])
    return words


def words_behind(word: str) -> list[str]:
    """Words of the file after an `@`, or of the variable after a `$`."""
    if word.startswith("@"):
        return Path(word[1:]).read_text(encoding="utf-8").split()
    value = os.environ.get(word[1:])
    if value is None:
        raise InputError(f"{word}: there is no environment variable {word[1:]}")
    return value.split()


class NotDoneError(InputError):
    """What an option asks for Sunpeak does not do, and Radiance's program of the same name does."""


@dataclass
class Table:
    """How options look: names with the number of their values, switches, and those without meaning here."""

    values: Mapping[str, int]
    switches: frozenset[str] = frozenset()
    idle: frozenset[str] = frozenset()
    """Accepted, and named once on standard error."""
    has_view: bool = False


@dataclass
class CommandLine:
    """A command line taken apart."""

    values: dict[str, list[str]] = field(default_factory=dict)
    """The last values of each option that was given."""
    switches: dict[str, bool] = field(default_factory=dict)
    view: list[str] = field(default_factory=list)
    """View options, in order."""
    idle: list[str] = field(default_factory=list)
    """Options that mean nothing here, as given."""
    rest: list[str] = field(default_factory=list)
    """What follows the options."""

    def number(self, option: str, default: float) -> float:
        """Give the value of an option as a number."""
        return self.numbers(option, [default])[0]

    def numbers(self, option: str, default: Sequence[float]) -> list[float]:
        """Give the values of an option as numbers."""
        words = self.values.get(option)
        if words is None:
            return list(default)
        try:
            return [float(word) for word in words]
        except ValueError as error:
            raise InputError(f"{option} {' '.join(words)}: expected {len(words)} number(s)") from error

    def whole(self, option: str, default: int) -> int:
        """Give the value of an option as a whole number."""
        value = self.number(option, default)
        if not float(value).is_integer():
            raise InputError(f"{option} {value}: expected a whole number")
        return int(value)

    def is_on(self, switch: str, default: bool = False) -> bool:
        """Say whether a switch is on."""
        return self.switches.get(switch, default)

    def has(self, option: str) -> bool:
        """Say whether an option was given."""
        return option in self.values

    def note_idle(self, program: str, quiet: bool) -> None:
        """Say once, on standard error, what is accepted and means nothing here."""
        if self.idle and not quiet:
            named = " ".join(dict.fromkeys(self.idle))
            sys.stderr.write(f"{program}: warning - accepted, without meaning in Sunpeak: {named}\n")


def parse(arguments: Sequence[str], table: Table, defaults: Mapping[str, bool] | None = None) -> CommandLine:
    """Take a command line apart: options first, then the rest."""
    line = CommandLine(switches=dict(defaults or {}))
    at = 0
    while at < len(arguments) and len(arguments[at]) > 1 and arguments[at].startswith("-"):
        at += 1 + take(arguments, at, table, line)
    line.rest = list(arguments[at:])
    return line


def take(arguments: Sequence[str], at: int, table: Table, line: CommandLine) -> int:
    """Take the option at a place; how many values it had."""
    option = arguments[at]
    if table.has_view and option.startswith("-v") and (option in VIEW_VALUES or option.startswith("-vt")):
        count = VIEW_VALUES.get(option, 0)
        line.view += [option, *values_of(arguments, at, count)]
        return count
    if option in table.values:
        count = table.values[option]
        values = values_of(arguments, at, count)
        if option in table.idle:
            line.idle.append(option)
        else:
            line.values[option] = values
        return count
    name, state = switch_of(option, table, line)
    if name in table.idle:
        line.idle.append(name)
    else:
        line.switches[name] = state
    return 0


def values_of(arguments: Sequence[str], at: int, count: int) -> list[str]:
    """Give the words after an option."""
    values = list(arguments[at + 1 : at + 1 + count])
    if len(values) < count:
        raise InputError(f"command line error at '{arguments[at]}': expected {count} value(s) after it")
    return values


def switch_of(option: str, table: Table, line: CommandLine) -> tuple[str, bool]:
    """Give the name of a switch and whether it is on now."""
    if option in table.switches:
        return option, not line.switches.get(option, False)
    name, end = option[:-1], option[-1]
    if name in table.switches and end in ON + OFF:
        return name, end in ON
    raise InputError(f"command line error at '{option}': unknown option")
