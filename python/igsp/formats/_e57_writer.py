"""E57 moved without loss: only the poses of scans and images change, every byte of the points stays as it is."""

from __future__ import annotations

import os
from typing import BinaryIO
from xml.dom import minidom

import numpy as np

from . import _e57_file, _motion
from ._atomic import atomic_output
from ._cloud import PathLike, Points, Selection
from ._e57_file import HEADER, PAGE, PAYLOAD, Layout


def write_aligned(source: PathLike, output: PathLike, target_from_source: Points, selection: Selection) -> None:
    layout = _e57_file.read_layout(source)
    scans = _e57_file.scan_elements(layout.document)
    selection.require_scan(source, len(scans))
    moved_scans = {}  # guid: motion of the file's frame that moved this scan
    for index, element in enumerate(scans):
        pose = _e57_file.describe(source, element, index).pose
        if not selection.includes(index):
            continue
        old = np.eye(4) if pose is None else pose
        new = target_from_source @ old if selection.apply_pose else target_from_source
        _set_pose(layout.document, element, new)
        moved_scans[_e57_file.text_of(_e57_file.child(element, "guid"))] = new @ np.linalg.inv(old)
    _move_images(source, layout.document, moved_scans, target_from_source if _moves_all(selection) else None)
    with open(source, "rb") as file, atomic_output(output) as moved:
        _copy_with_document(source, file, moved, layout)


def _moves_all(selection: Selection) -> bool:
    return selection.scan is None and selection.apply_pose


def _move_images(
    path: PathLike, document: minidom.Document, moved_scans: dict[str, Points], others: Points | None
) -> None:
    """An image moves with the scan it belongs to; one that names none only when the whole file moves."""
    for index, image in enumerate(_e57_file.image_elements(document)):
        guid = _e57_file.text_of(_e57_file.child(image, "associatedData3DGuid"))
        motion = moved_scans.get(guid, others) if guid else others
        pose = _e57_file.pose_of_image(path, image, index)
        if motion is not None and pose is not None:
            _set_pose(document, image, motion @ pose)


def _set_pose(document: minidom.Document, element: minidom.Element, pose: Points) -> None:
    new = _structure(document, "pose")
    for name, axes, values in (
        ("rotation", "wxyz", _motion.to_quaternion(pose)),
        ("translation", "xyz", pose[:3, 3]),
    ):
        part = new.appendChild(_structure(document, name))
        for axis, value in zip(axes, values, strict=True):
            number = part.appendChild(document.createElement(axis))
            number.setAttribute("type", "Float")
            number.appendChild(document.createTextNode(repr(float(value))))
    old = _e57_file.child(element, "pose")
    if old is not None:
        element.replaceChild(new, old)
    else:
        element.appendChild(new)


def _structure(document: minidom.Document, name: str) -> minidom.Element:
    element = document.createElement(name)
    element.setAttribute("type", "Structure")
    return element


def _copy_with_document(source: PathLike, file: BinaryIO, moved: BinaryIO, layout: Layout) -> None:
    """All pages up to the XML section as they are, then the new one; at the end if other sections follow."""
    pages = layout.length // PAGE
    is_last = -(-layout.xml_end // PAYLOAD) == pages
    start = layout.xml_start if is_last else pages * PAYLOAD
    kept = start // PAYLOAD
    for copied in _e57_file.checked_pages(source, file, kept):
        moved.write(copied.tobytes())
    head = next(_e57_file.checked_pages(source, file, 1))[0, : start % PAYLOAD].tobytes() if start % PAYLOAD else b""
    xml = layout.document.toxml(encoding="UTF-8")
    moved.write(_e57_file.make_pages(head + xml).tobytes())
    _patch_header(moved, start, len(xml))


def _patch_header(moved: BinaryIO, xml_start: int, xml_length: int) -> None:
    length = moved.seek(0, os.SEEK_END)
    moved.seek(0)
    first = bytearray(moved.read(PAYLOAD))
    signature, major, minor, _, _, _, page = HEADER.unpack_from(first)
    offset = xml_start // PAYLOAD * PAGE + xml_start % PAYLOAD
    HEADER.pack_into(first, 0, signature, major, minor, length, offset, xml_length, page)
    moved.seek(0)
    moved.write(_e57_file.make_pages(bytes(first)).tobytes())
