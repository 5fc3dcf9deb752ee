"""E57 files from outside: pages of 1024 bytes, each with a checksum, and the XML section that describes the scans.

The points lie in binary sections that pye57 reads; what is here needs no package.
"""

from __future__ import annotations

import os
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO
from xml.dom import minidom
from xml.parsers.expat import ExpatError

import numpy as np
from numpy.typing import NDArray

from . import _motion
from ._cloud import FormatError, PathLike, Points, Scan

SIGNATURE = b"ASTM-E57"
HEADER = struct.Struct("<8sIIQQQQ")  # signature, version, file length, XML offset (both of the file), XML length, page
PAGE = 1024
PAYLOAD = PAGE - 4
PAGES_AT_ONCE = 4096
Pages = NDArray[np.uint8]  # (N, PAGE)


@dataclass(frozen=True)
class Layout:
    """Where the XML section is, in payload bytes, and what it says."""

    length: int  # of the file, in bytes
    xml_start: int
    xml_end: int
    document: minidom.Document


def read_layout(path: PathLike) -> Layout:
    """Reads the header and the XML section. Throws FormatError if the file is cut short or its checksums are wrong."""
    with open(path, "rb") as file:
        length = os.fstat(file.fileno()).st_size
        header = file.read(HEADER.size)
        if header[: len(SIGNATURE)] != SIGNATURE[: len(header)] or not header:
            raise FormatError(path, "byte 0: not an E57 file: it does not begin with ASTM-E57")
        if len(header) < HEADER.size:
            raise FormatError(path, f"byte {length}: the file ends within its header")
        _, _, _, declared, xml_offset, xml_length, page_size = HEADER.unpack(header)
        if page_size != PAGE:
            raise FormatError(path, f"byte 40: pages of {page_size} bytes; E57 has pages of {PAGE}")
        if declared != length or length % PAGE:
            raise FormatError(path, f"byte {length}: the file ends here, its header says at {declared}")
        start = xml_offset // PAGE * PAYLOAD + xml_offset % PAGE
        if xml_offset % PAGE >= PAYLOAD or start + xml_length > length // PAGE * PAYLOAD:
            raise FormatError(path, f"byte 24: no XML section of {xml_length} bytes fits at byte {xml_offset}")
        xml = _read_payload(path, file, start, start + xml_length)
    try:
        document = minidom.parseString(xml)
    except (ExpatError, LookupError, ValueError) as error:  # the latter two of an encoding that there is not
        raise FormatError(path, f"byte {xml_offset}: XML section: {error}") from error
    return Layout(length, start, start + xml_length, document)


def scan_elements(document: minidom.Document) -> list[minidom.Element]:
    return _vector_children(document, "data3D")


def image_elements(document: minidom.Document) -> list[minidom.Element]:
    return _vector_children(document, "images2D")


def coordinate_metadata(document: minidom.Document) -> str:
    root = document.documentElement
    return text_of(child(root, "coordinateMetadata")) if root else ""


def point_fields(element: minidom.Element) -> set[str]:
    """The names of what a scan has for every point."""
    points = child(element, "points")
    prototype = child(points, "prototype") if points else None
    return {node.tagName for node in prototype.childNodes if isinstance(node, minidom.Element)} if prototype else set()


def describe(path: PathLike, element: minidom.Element, index: int) -> Scan:
    points = child(element, "points")
    try:
        count = int(points.getAttribute("recordCount")) if points else 0
        if count < 0:
            raise ValueError(f"it claims {count} points")
        return Scan(text_of(child(element, "name")) or f"scan {index}", count, _pose_of(element))
    except ValueError as error:
        raise FormatError(path, f"scan {index}: {error}") from error


def pose_of_image(path: PathLike, element: minidom.Element, index: int) -> Points | None:
    """file_from_image, None if it has none. Throws FormatError."""
    try:
        return _pose_of(element)
    except ValueError as error:
        raise FormatError(path, f"image {index}: {error}") from error


def _pose_of(element: minidom.Element) -> Points | None:
    """file_from_scan, None if the scan has none. Throws ValueError if it is not a rigid motion."""
    pose = child(element, "pose")
    if pose is None:
        return None
    rotation, translation = child(pose, "rotation"), child(pose, "translation")
    quaternion = [_number(rotation, name) for name in "wxyz"] if rotation else [1.0, 0.0, 0.0, 0.0]
    shift = [_number(translation, name) for name in "xyz"] if translation else [0.0, 0.0, 0.0]
    if not np.isfinite(quaternion + shift).all() or abs(np.linalg.norm(quaternion) - 1) > _motion.RIGID_TOLERANCE:
        raise ValueError(f"its pose is not a rigid motion: rotation {quaternion}, translation {shift}")
    return _motion.from_quaternion(quaternion, shift)


def child(element: minidom.Element, name: str) -> minidom.Element | None:
    for node in element.childNodes:
        if isinstance(node, minidom.Element) and node.tagName == name:
            return node
    return None


def text_of(element: minidom.Element | None) -> str:
    parts = (node.data for node in element.childNodes if isinstance(node, minidom.Text)) if element else ()
    return "".join(parts).strip()


def _number(element: minidom.Element, name: str) -> float:
    return float(text_of(child(element, name)) or 0)  # an empty element is a zero


def _vector_children(document: minidom.Document, name: str) -> list[minidom.Element]:
    root = document.documentElement
    vector = child(root, name) if root else None
    return [node for node in vector.childNodes if isinstance(node, minidom.Element)] if vector else []


def _read_payload(path: PathLike, file: BinaryIO, start: int, end: int) -> bytes:
    first = start // PAYLOAD
    file.seek(first * PAGE)
    pages = b"".join(page[:, :PAYLOAD].tobytes() for page in checked_pages(path, file, -(-end // PAYLOAD) - first))
    return pages[start - first * PAYLOAD : end - first * PAYLOAD]


def checked_pages(path: PathLike, file: BinaryIO, count: int) -> Iterator[Pages]:
    """The next `count` pages, some thousands at a time. Throws FormatError at the first with a wrong checksum."""
    while count > 0:
        first = file.tell()
        pages = np.frombuffer(file.read(min(count, PAGES_AT_ONCE) * PAGE), np.uint8).reshape(-1, PAGE)
        if not len(pages):
            raise FormatError(path, f"byte {first}: the file ends here")
        bad = np.flatnonzero((checksums(pages) != pages[:, PAYLOAD:]).any(axis=1))
        if len(bad):
            raise FormatError(path, f"byte {first + bad[0] * PAGE}: wrong checksum: the file is damaged here")
        count -= len(pages)
        yield pages


def make_pages(payload: bytes) -> Pages:
    """Pages with checksums; the last is filled up with zeros."""
    pages = np.zeros((-(-len(payload) // PAYLOAD), PAGE), np.uint8)
    padded = payload.ljust(len(pages) * PAYLOAD, b"\0")
    pages[:, :PAYLOAD] = np.frombuffer(padded, np.uint8).reshape(-1, PAYLOAD)
    pages[:, PAYLOAD:] = checksums(pages)
    return pages


def checksums(pages: Pages) -> Pages:
    """CRC-32C of the payload of every page, (N, 4) as stored: the highest byte first."""
    columns = np.ascontiguousarray(pages[:, :PAYLOAD].T)
    remainder = np.full(len(pages), 0xFFFFFFFF, np.uint32)
    for column in columns:
        remainder = CRC_TABLE[(remainder ^ column) & 0xFF] ^ (remainder >> 8)
    return (~remainder).astype(">u4").view(np.uint8).reshape(-1, 4)


def _crc_table() -> NDArray[np.uint32]:
    castagnoli = np.uint32(0x82F63B78)  # the polynomial, bits reversed
    table = np.arange(256, dtype=np.uint32)
    for _ in range(8):
        table = np.where(table & 1, castagnoli ^ (table >> 1), table >> 1)
    return table


CRC_TABLE = _crc_table()
