"""What the tests know of a report page: its data, decoded."""
import base64
import json
import re
from pathlib import Path

import numpy as np


def page_data(path: Path) -> dict:
    """The run and the scene that a page holds."""
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', path.read_text(), re.DOTALL)
    return json.loads(found.group(1))


def drawn_points(cloud: dict) -> np.ndarray:
    """(N, 3) coordinates as drawn, in the frame of the cloud's file."""
    steps = np.frombuffer(base64.b64decode(cloud["coordinates"]), "<u2").reshape(-1, 3)
    return steps / 65535 * np.array(cloud["extent"]) + np.array(cloud["min"]) + np.array(cloud["origin"])


def contradicting(pose: dict, cloud: str) -> np.ndarray | None:
    """(N,) of the drawn points: in space that the other scanner saw through; None where nothing is known."""
    bytes_ = pose["contradicting"][cloud]
    return None if bytes_ is None else np.frombuffer(base64.b64decode(bytes_), np.uint8).astype(bool)


def distances(scene: dict, pose: dict) -> np.ndarray:
    """(N,) distances of the drawn source points to the target at a pose; infinite beyond the reach."""
    steps = np.frombuffer(base64.b64decode(pose["distances"]), np.uint8).astype(float)
    return np.where(steps < 255, steps / 254 * scene["reach"], np.inf)
