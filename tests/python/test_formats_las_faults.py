"""LAS and LAZ files that are cut short or make no sense."""

from __future__ import annotations

import struct
from pathlib import Path

import laspy
import numpy as np
import pytest
from formats_testing import make_las, motion, random_points
from igsp import formats


@pytest.mark.parametrize("extension", ["las", "laz"])
def test_records_after_the_points_cut_short(tmp_path: Path, extension: str) -> None:
    las = make_las(random_points(50), 6)
    records = [laspy.VLR("surveyor", number, "", b"e" * 100) for number in (1, 2)]
    las.evlrs = laspy.vlrs.vlrlist.VLRList(records)
    source = tmp_path / f"source.{extension}"
    las.write(source)
    content = source.read_bytes()
    for missing in (1, 99, 101, 159, 161, 259, 310):
        source.write_bytes(content[:-missing])
        with pytest.raises(formats.FormatError, match=r"byte \d+: the file ends before variable length record [01]"):
            formats.read_metadata(source)


def test_records_before_the_points_too_long(tmp_path: Path) -> None:
    las = make_las(random_points(50), 1, "1.2")
    las.header.vlrs.append(laspy.VLR("surveyor", 77, "", b"abc"))
    las.write(tmp_path / "source.las")
    content = bytearray((tmp_path / "source.las").read_bytes())
    content[content.index(b"surveyor") + 18] += 1
    (tmp_path / "source.las").write_bytes(content)
    with pytest.raises(formats.FormatError, match="its points begin before variable length record 1"):
        formats.read_cloud(tmp_path / "source.las")


@pytest.mark.parametrize(
    ("position", "content", "fault"),
    [
        (24, b"\x01\x04", "byte 94: a header of 227 bytes, LAS 1.4 has 375"),
        (96, b"\x64\x00\x00\x00", "byte 96: the points begin at byte 100, in the header"),
        (104, b"\x0b", "byte 104: point format 11; LAS has 0 to 10"),
        (105, b"\x0c\x00", "byte 105: points of 12 bytes; point format 1 has at least 28"),
        (131, struct.pack("<d", 0), "byte 131: scale \\(0.0, "),
        (139, struct.pack("<d", np.nan), "byte 131: scale \\(0.001, nan"),
        (147, struct.pack("<d", 1e300), "byte 131: scale"),
        (155, struct.pack("<d", np.inf), "byte 131: scale .*, offset \\(inf"),
    ],
)
def test_header_that_makes_no_sense(tmp_path: Path, position: int, content: bytes, fault: str) -> None:
    source = tmp_path / "source.las"
    make_las(random_points(50), 1, "1.2").write(source)
    whole = bytearray(source.read_bytes())
    whole[position : position + len(content)] = content
    source.write_bytes(whole)
    for action in (
        lambda: formats.read_cloud(source),
        lambda: formats.write_aligned(source, tmp_path / "aligned.las", motion()),
    ):
        with pytest.raises(formats.FormatError, match=f"source.las: {fault}"):
            action()


def test_points_cut_short_are_noticed_before_the_first_is_read(tmp_path: Path) -> None:
    source = tmp_path / "source.las"
    make_las(random_points(50), 1, "1.2").write(source)
    source.write_bytes(source.read_bytes()[:-1])
    with pytest.raises(formats.FormatError, match="the file ends after 49 of 50 points"):
        formats.read_metadata(source)


def test_file_that_shrinks_while_it_is_read(tmp_path: Path) -> None:
    source = tmp_path / "source.las"
    make_las(random_points(50_000), 1, "1.2").write(source)
    reader = formats.read_chunks(source, 1000)
    next(reader)
    content = source.read_bytes()
    start, record_length = struct.unpack_from("<I", content, 96)[0], struct.unpack_from("<H", content, 105)[0]
    source.write_bytes(content[: start + 20_000 * record_length])
    with pytest.raises(formats.FormatError, match=r"source\.las: the file ends after 20000 of 50000 points"):
        list(reader)


@pytest.mark.parametrize(("offset", "value"), [(0, 1), (0, 9), (34, 77), (38, 99)])  # compressor, an item, its version
def test_variants_of_laz_that_the_codec_lacks_are_not_called_damaged(tmp_path: Path, offset: int, value: int) -> None:
    source = tmp_path / "source.laz"
    make_las(random_points(50), 1).write(source)
    content = bytearray(source.read_bytes())
    record = content.index(b"laszip encoded") - 2 + 54
    struct.pack_into("<H", content, record + offset, value)
    source.write_bytes(content)
    with pytest.raises(formats.FormatError, match="(not supported|is unknown).*: write (it|the file) anew"):
        formats.read_cloud(source)


def laz_content(folder: Path) -> tuple[bytearray, int, int]:
    """A LAZ file, where its points begin, and where the record of its compression stands."""
    make_las(random_points(50), 6).write(folder / "whole.laz")
    content = bytearray((folder / "whole.laz").read_bytes())
    return content, struct.unpack_from("<I", content, 96)[0], content.index(b"laszip encoded") - 2


def refused(folder: Path, content: bytes, fault: str) -> None:
    (folder / "source.laz").write_bytes(content)
    with pytest.raises(formats.FormatError, match=f"source.laz: {fault}"):
        formats.read_cloud(folder / "source.laz")
    with pytest.raises(formats.FormatError, match=f"source.laz: {fault}"):
        formats.write_aligned(folder / "source.laz", folder / "aligned.laz", motion())


def test_chunks_that_the_file_cannot_hold(tmp_path: Path) -> None:
    """lazrs takes memory for as many as the table claims, and aborts the process where there is none."""
    content, start, _ = laz_content(tmp_path)
    table = struct.unpack_from("<q", content, start)[0]
    struct.pack_into("<I", content, table + 4, 2**32 - 1)
    refused(tmp_path, content, f"byte {table}: 4294967295 chunks do not fit into the \\d+ bytes before it")
    for place in (-2, 0, start, 2**62):
        struct.pack_into("<q", content, start, place)
        refused(tmp_path, content, f"byte {start}: the table of its chunks would be at byte {place}")


def test_compression_that_does_not_fit_its_points(tmp_path: Path) -> None:
    content, _, record = laz_content(tmp_path)
    begin = record + 54
    changed = bytearray(content)
    struct.pack_into("<H", changed, begin + 32, 999)
    refused(tmp_path, changed, f"byte {begin}: 999 items do not fit into the record")
    changed = bytearray(content)
    struct.pack_into("<H", changed, begin + 34 + 2, 3)
    refused(tmp_path, changed, f"byte {begin}: the items of the compression have \\d+ bytes, a point has \\d+")
    changed = bytearray(content)
    changed[record + 2] = ord("m")
    refused(tmp_path, changed, "its points are compressed, but no record says how")
