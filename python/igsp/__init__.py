"""igsp puts one 3D point cloud onto another, without an initial guess, and says whether to believe the answer.

>>> import igsp
>>> result = igsp.align("source.ply", "target.ply")
>>> print(result)
>>> result.target_from_source  # p_target = target_from_source * p_source
"""

from igsp._core import (
    CloudSummary,
    Diagnosis,
    Evidence,
    Features,
    FreeDirection,
    IterationRecord,
    MatchQuality,
    Network,
    NetworkContradiction,
    NetworkCycle,
    NetworkLink,
    NetworkScan,
    PoseError,
    Precision,
    Result,
    RunnerUp,
    SimilarityResult,
    SimulatedScan,
    ViewpointFinding,
    simulate,
)
from igsp._core import version as __version__
from igsp.errors import Cancelled, EngineLost, NotRegistered
from igsp.evaluation import match_quality, pose_error, transform_points
from igsp.files import (
    read_features,
    read_points,
    read_result,
    read_transformation,
    write_features,
    write_points,
    write_result,
    write_transformation,
)
from igsp.many_scans import Control, network
from igsp.registration import align, align_similarity, diagnose, extract_features, options
from igsp.viewpoints import find_viewpoint

__all__ = [
    "Cancelled",
    "CloudSummary",
    "Control",
    "Diagnosis",
    "EngineLost",
    "Evidence",
    "Features",
    "FreeDirection",
    "IterationRecord",
    "MatchQuality",
    "Network",
    "NetworkContradiction",
    "NetworkCycle",
    "NetworkLink",
    "NetworkScan",
    "NotRegistered",
    "PoseError",
    "Precision",
    "Result",
    "RunnerUp",
    "SimilarityResult",
    "SimulatedScan",
    "ViewpointFinding",
    "__version__",
    "align",
    "align_similarity",
    "diagnose",
    "extract_features",
    "find_viewpoint",
    "match_quality",
    "network",
    "options",
    "pose_error",
    "read_features",
    "read_points",
    "read_result",
    "read_transformation",
    "simulate",
    "transform_points",
    "write_features",
    "write_points",
    "write_result",
    "write_transformation",
]
