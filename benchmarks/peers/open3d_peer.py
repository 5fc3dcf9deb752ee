"""Open3D: FPFH with RANSAC or Fast Global Registration, then point-to-plane ICP; the numbers are its tutorials'."""

from collections.abc import Iterator

import numpy as np
import open3d as o3d

VERSION = o3d.__version__
registration = o3d.pipelines.registration
RANSAC_ITERATIONS = {"ransac_100k": 100_000, "ransac_4m": 4_000_000}
# Its reconstruction system drops a pair of fragments when fewer points than this share of the smaller cloud have a
# neighbour within 1.4 voxels: the only rule of acceptance that Open3D comes with.
ACCEPTED_SHARE, ACCEPTED_DISTANCE = 0.3, 1.4


def prepare(points: np.ndarray, voxel_size: float) -> o3d.geometry.PointCloud:
    """Voxel-filtered with normals. These look to the centroid: a scan that was moved does not know its scanner."""
    cloud = o3d.geometry.PointCloud(o3d.utility.Vector3dVector(points)).voxel_down_sample(voxel_size)
    cloud.estimate_normals(o3d.geometry.KDTreeSearchParamHybrid(2 * voxel_size, 30))
    cloud.orient_normals_towards_camera_location(cloud.get_center())
    return cloud


def icp_after(source, target, voxel_size: float, start: np.ndarray) -> np.ndarray:
    """Point-to-plane ICP on the filtered clouds: first to reach the place, then for the accuracy."""
    for distance in (2.0, 1.0):
        start = registration.registration_icp(source, target, distance * voxel_size, start,
                                              registration.TransformationEstimationPointToPlane(),
                                              registration.ICPConvergenceCriteria(max_iteration=30)).transformation
    return start


def answer(label: str, source, target, voxel_size: float, transformation: np.ndarray) -> dict:
    information = registration.get_information_matrix_from_point_clouds(
        source, target, ACCEPTED_DISTANCE * voxel_size, transformation)
    share = information[5, 5] / min(len(source.points), len(target.points))
    nothing_found = bool(np.array_equal(transformation, np.eye(4)))
    return {"label": label, "target_from_source": transformation, "score": float(share),
            "converged": bool(share >= ACCEPTED_SHARE) and not nothing_found}


def ransac(source, target, source_fpfh, target_fpfh, voxel_size: float, iterations: int) -> np.ndarray:
    distance = 1.5 * voxel_size
    return registration.registration_ransac_based_on_feature_matching(
        source, target, source_fpfh, target_fpfh, True, distance,
        registration.TransformationEstimationPointToPoint(False), 3,
        [registration.CorrespondenceCheckerBasedOnEdgeLength(0.9),
         registration.CorrespondenceCheckerBasedOnDistance(distance)],
        registration.RANSACConvergenceCriteria(iterations, 0.999)).transformation


def fast_global(source, target, source_fpfh, target_fpfh, voxel_size: float) -> np.ndarray:
    option = registration.FastGlobalRegistrationOption(maximum_correspondence_distance=0.5 * voxel_size)
    return registration.registration_fgr_based_on_feature_matching(source, target, source_fpfh, target_fpfh,
                                                                   option).transformation


def register(method: str, source: np.ndarray, target: np.ndarray, voxel_size: float, seed: int, threads: int,
             guess: np.ndarray | None) -> Iterator[dict]:
    o3d.utility.random.seed(seed)
    clouds = [prepare(points, voxel_size) for points in (source, target)]
    fpfh = [registration.compute_fpfh_feature(cloud, o3d.geometry.KDTreeSearchParamHybrid(5 * voxel_size, 100))
            for cloud in clouds]
    if method == "fgr":
        coarse = fast_global(*clouds, *fpfh, voxel_size)
    else:
        coarse = ransac(*clouds, *fpfh, voxel_size, RANSAC_ITERATIONS[method])
    yield answer("", *clouds, voxel_size, coarse)
    yield answer("icp", *clouds, voxel_size, icp_after(*clouds, voxel_size, coarse))
