"""Survey files with some of their bytes changed: points that are finite, or a FormatError, whatever the bytes."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from formats_testing import e57_attributes, make_copc, make_e57, make_las, motion, ptx_text, random_points
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from igsp import formats
from igsp.formats import _e57_file

# More for a search by hand: IGSP_HOSTILE_EXAMPLES=20000 pytest tests/python/test_formats_hostile.py
EXAMPLES = int(os.environ.get("IGSP_HOSTILE_EXAMPLES", "40"))
hostile = settings(
    max_examples=EXAMPLES,
    deadline=None,
    derandomize=EXAMPLES == 40,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)

# What a number can become that is no number of points, of bytes, of metres.
WORDS = [b"nan", b"inf", b"-1", b"0", b"1e400", b"999999999999999999", b"\0", b"\n", b"\r", b" ", b"\xff" * 8, b"\x80"]
WORDS += [(1 << bits).to_bytes(8, "little") for bits in (7, 15, 16, 31, 32, 62, 63)] + [np.float64("nan").tobytes()]
edits = st.lists(
    st.tuples(
        st.floats(0, 1, exclude_max=True),  # where
        st.integers(0, 12),  # how many bytes go
        st.one_of(st.binary(max_size=9), st.sampled_from(WORDS)),  # what comes
    ),
    min_size=1,
    max_size=5,
)
Edits = list[tuple[float, int, bytes]]
Maker = Callable[[Path], None]


def edited(content: bytes, changes: Edits, length: int | None = None) -> bytes:
    """Replaced in place mostly, so that what lies behind stays where its header says; `length`: only before there."""
    for where, gone, come in changes:
        place = int(where * (length or len(content)))
        content = content[:place] + come + content[place + (gone if gone < 6 else len(come)) :]
    return content


def make_small_las(path: Path) -> None:
    make_las(random_points(40), 6 if path.suffix == ".laz" else 3).write(path)


def make_small_copc(path: Path) -> None:
    make_copc(path, random_points(40))


def make_small_e57(path: Path) -> None:
    make_e57(path, [(e57_attributes(random_points(60, seed)), motion()) for seed in (1, 2)])


def make_small_ptx(path: Path) -> None:
    path.write_text(ptx_text([(random_points(6, seed), motion()) for seed in (1, 2)], columns=3))


def make_small_pts(path: Path) -> None:
    path.write_text("3\n1 2 3 4\n5.5 6 7 8\n-1 -2e3 0 1\n2\n1 2 3 4\n1 2 4 4\n")


FORMATS = [
    ("small.las", make_small_las),
    ("small.laz", make_small_las),
    ("copc.laz", make_small_copc),
    ("small.e57", make_small_e57),
    ("small.ptx", make_small_ptx),
    ("small.pts", make_small_pts),
]


def content_of(name: str, make: Maker) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        make(Path(folder) / name)
        return (Path(folder) / name).read_bytes()


CONTENTS = {name: content_of(name, make) for name, make in FORMATS}


def check(path: Path) -> None:
    """Every door: points that are finite or a FormatError, and nothing written but a whole file."""
    read = True
    try:
        cloud = formats.read_cloud(path)
        assert cloud.points.shape == (len(cloud.points), 3) and np.isfinite(cloud.points).all()
    except formats.FormatError as error:
        assert path.name in str(error) and len(str(error)) < 1000
        read = False
    try:
        formats.read_metadata(path)
    except formats.FormatError:
        assert not read, "points, but no metadata"
    output = path.with_name("moved" + path.suffix)
    output.unlink(missing_ok=True)
    try:
        formats.write_aligned(path, output, motion())
    except formats.FormatError:
        assert not output.exists()
    else:
        if read:  # E57 is moved by its poses, and its points are not looked at
            assert len(formats.read_cloud(output).points) == len(cloud.points)
    assert {entry.name for entry in path.parent.iterdir()} <= {path.name, output.name}


@pytest.mark.parametrize("name", CONTENTS)
@hostile
@given(changes=edits)
def test_bytes_changed_anywhere(tmp_path: Path, name: str, changes: Edits) -> None:
    (tmp_path / name).write_bytes(edited(CONTENTS[name], changes))
    check(tmp_path / name)


@pytest.mark.parametrize("name", ["small.las", "small.laz", "copc.laz"])
@hostile
@given(changes=edits)
@example(changes=[(0.75, 0, b"\0\0")])  # an extra dimension of no elements: a division by zero in laspy
def test_bytes_changed_in_the_header_of_las(tmp_path: Path, name: str, changes: Edits) -> None:
    (tmp_path / name).write_bytes(edited(CONTENTS[name], changes, length=375))
    check(tmp_path / name)


@pytest.mark.parametrize("name", CONTENTS)
@hostile
@given(share=st.floats(0, 1))
def test_cut_off(tmp_path: Path, name: str, share: float) -> None:
    (tmp_path / name).write_bytes(CONTENTS[name][: int(share * len(CONTENTS[name]))])
    check(tmp_path / name)


@hostile
@given(changes=edits, in_xml=st.booleans())
def test_e57_whose_checksums_hold(tmp_path: Path, changes: Edits, in_xml: bool) -> None:
    """As somebody would make it on purpose: changed, its pages sealed again, the lengths in its header right."""
    pages = np.frombuffer(CONTENTS["small.e57"], np.uint8).reshape(-1, _e57_file.PAGE)
    payload = pages[:, : _e57_file.PAYLOAD].tobytes()
    start = payload.index(b"<?xml")
    end = payload.rindex(b">") + 1
    xml = edited(payload[start:end], changes) if in_xml else payload[start:end]
    before = payload[:start]
    if not in_xml:
        before = before[: _e57_file.HEADER.size] + edited(before[_e57_file.HEADER.size :], changes)[: start - 48].ljust(
            start - 48, b"\0"
        )
    sealed = bytearray(_e57_file.make_pages(before + xml).tobytes())
    fields = list(_e57_file.HEADER.unpack_from(sealed))
    fields[3], fields[5] = len(sealed), len(xml)
    first = np.frombuffer(sealed[: _e57_file.PAGE], np.uint8)[: _e57_file.PAYLOAD].tobytes()
    header = _e57_file.HEADER.pack(*fields)
    sealed[: _e57_file.PAGE] = _e57_file.make_pages(header + first[len(header) :]).tobytes()
    (tmp_path / "small.e57").write_bytes(sealed)
    check(tmp_path / "small.e57")
