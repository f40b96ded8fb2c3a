"""Make a virtual environment with pip, also where Python came without `ensurepip`.

usage: make_venv.py FOLDER

Debian and Ubuntu ship `ensurepip` in a package of its own (python3-venv). Where it is missing, pip itself is fetched
from the Python package index and installed by its own wheel.
"""

import hashlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import urllib.parse
import urllib.request
import venv

PIP_VERSION = "25.3"
PIP_SHA256 = "9655943313a94722b7774661c21049070f6bbb0a1516bf02f7c8d5d9201514cd"
INDEX = os.environ.get("PIP_INDEX_URL", "https://pypi.org/simple").rstrip("/")


def main() -> None:
    """Make the environment unless it is there and works."""
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    if has_pip(folder):
        return
    if sys.version_info < (3, 11):  # noqa: UP036
        found = ".".join(map(str, sys.version_info[:3]))
        sys.exit(f"make_venv.py: Python 3.11 or newer is needed, this is {found}: make PYTHON=python3.x")
    try:
        import ensurepip  # noqa: F401, PLC0415
    except ImportError:
        venv.create(folder, clear=True, symlinks=os.name != "nt")
        install_pip(folder)
    else:
        venv.create(folder, clear=True, symlinks=os.name != "nt", with_pip=True)


def has_pip(folder: pathlib.Path) -> bool:
    """Whether the environment is there, with pip."""
    python = folder / "bin" / "python"
    if not python.exists():
        return False
    return subprocess.run([python, "-m", "pip", "--version"], check=False, capture_output=True).returncode == 0


def install_pip(folder: pathlib.Path) -> None:
    """Fetch pip's wheel, check it and let it install itself."""
    name = f"pip-{PIP_VERSION}-py3-none-any.whl"
    listing = fetch(f"{INDEX}/pip/").decode()
    link = re.search(rf'href="([^"#]*{re.escape(name)})', listing)
    if link is None:
        sys.exit(f"make_venv.py: {name} is not in the package index; install python3-venv instead")
    wheel = fetch(urllib.parse.urljoin(f"{INDEX}/pip/", link[1]))
    if hashlib.sha256(wheel).hexdigest() != PIP_SHA256:
        sys.exit(f"make_venv.py: {name} is not the expected file; install python3-venv instead")
    with tempfile.TemporaryDirectory() as temporary:
        path = pathlib.Path(temporary, name)
        path.write_bytes(wheel)
        command = [
            folder / "bin" / "python",
            path / "pip",
            "install",
            "--no-index",
            "--no-deps",
            path,
        ]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)


def fetch(url: str) -> bytes:
    """What stands at an address."""
    with urllib.request.urlopen(url, timeout=60) as answer:
        return answer.read()


if __name__ == "__main__":
    main()
