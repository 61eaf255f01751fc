"""Headers of the Pythons that Debian 12 does not have, from packages of Ubuntu. An extension module is compiled with headers alone."""

import hashlib
import pathlib
import shutil
import subprocess
import tempfile
import urllib.request

ARCHIVE = "http://archive.ubuntu.com/ubuntu/pool/main/p"
# The versions with which a distribution was released stay in the archive. 3.12 stands for all later ones, by the stable ABI.
PACKAGES = {
    "3.10": ("python3.10/libpython3.10-dev_3.10.4-3_amd64.deb", "89246f12cdfb1fac7675bc94d5cc8b9c72320f152e855197668305c73c8588ec"),
    "3.12": ("python3.12/libpython3.12-dev_3.12.3-1_amd64.deb", "f5924a06298ae0689128498276d3a555e02615a4ecfa8f4417d679a097586f35"),
}


def headers(version: str, folder: pathlib.Path) -> pathlib.Path:
    """The folder `include` of a Python; unpacked into `folder` when it is not there yet."""
    include = folder / version / "include"
    if include.exists():
        return include
    path, digest = PACKAGES[version]
    with urllib.request.urlopen(f"{ARCHIVE}/{path}", timeout=120) as answer:
        package = answer.read()
    if hashlib.sha256(package).hexdigest() != digest:
        raise SystemExit(f"etendue: {ARCHIVE}/{path} is not the package that it was")
    with tempfile.TemporaryDirectory() as temporary:
        file = pathlib.Path(temporary) / "headers.deb"
        file.write_bytes(package)
        subprocess.run(["dpkg-deb", "-x", file, temporary], check=True)
        include.parent.mkdir(parents=True, exist_ok=True)
        shutil.copytree(pathlib.Path(temporary) / "usr" / "include", include)
    return include
