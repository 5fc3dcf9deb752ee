"""The EPSG code of a coordinate reference system, where the file states it."""

from __future__ import annotations

import re
import struct

# The identifier of the whole system is the last thing in its text; those of its parts come before.
IDENTIFIER_AT_END = re.compile(r'(?:ID|AUTHORITY)\s*[\[(]\s*"EPSG"\s*,\s*"?(\d+)"?\s*[\])]\s*[\])]\s*\0*\s*$')

PROJECTED_KEY, GEOGRAPHIC_KEY = 3072, 2048  # GeoTIFF keys whose value is an EPSG code
USER_DEFINED = 32767


def epsg_of_wkt(wkt: str) -> int | None:
    found = IDENTIFIER_AT_END.search(wkt)
    return int(found.group(1)) if found else None


def epsg_of_geotiff_keys(record: bytes) -> int | None:
    """Of a GeoKeyDirectory: 16-bit words in fours (key, where its value is, count, value), the first four a header."""
    words = struct.unpack(f"<{len(record) // 2}H", record[: len(record) // 2 * 2])
    keys: dict[int, int] = {words[i]: words[i + 3] for i in range(4, len(words) - 3, 4) if words[i + 1] == 0}
    for key in (PROJECTED_KEY, GEOGRAPHIC_KEY):
        if keys.get(key, USER_DEFINED) not in (0, USER_DEFINED):
            return keys[key]
    return None
